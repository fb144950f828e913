// Where a part may lie on a whole, by the votes of pairs of points (Drost, Ulrich, Navab and Ilic 2010).
#pragma once

#include "ostraka/geom/rigid_fit.h"
#include "ostraka/registration/surface_points.h"

#include <vector>

namespace ostraka {

/// A motion of the part onto the whole, and how many pairs spoke for it.
struct VotedMotion {
    Motion motion;
    double votes = 0;
};

/// All pairs of points of a whole by what they are like whatever their place: the distance of the two points, the angles of
/// their normals with the line between them, and that of the normals with each other. Pairs farther apart than `max_distance` are
/// left out. Built once, asked for many parts.
class PairTable {
public:
    /// `step`: distances that differ by less are alike; angles that differ by less than 15 degrees are. Memory: four bytes a
    /// pair. Throws Error (usage) for more than 4096 points, or lengths that are not positive.
    PairTable(SurfacePoints points, double max_distance, double step);

    /// For `references` points of the part (evenly chosen), each with at most `partners` others (drawn with `seed`): all pairs
    /// of the whole that are like it vote for a point of the whole and a turn about its normal, a rare kind of pair weighing more
    /// than a frequent one; the best `kept` of each reference point come back. Same result for any number of threads.
    [[nodiscard]] std::vector<VotedMotion> vote(const SurfacePoints& part, int references, int partners, int kept,
                                                std::uint64_t seed) const;

    [[nodiscard]] const SurfacePoints& points() const { return points_; }

private:
    struct Entry {
        std::uint16_t reference;
        std::int16_t angle;  ///< 2 pi over 2^16
    };
    [[nodiscard]] long key(const Eigen::Vector3d& p, const Eigen::Vector3d& n, const Eigen::Vector3d& q,
                           const Eigen::Vector3d& m) const;

    SurfacePoints points_;
    double max_distance_, step_;
    int distances_ = 0;
    std::vector<std::size_t> starts_;
    std::vector<Entry> entries_;
};

}  // namespace ostraka

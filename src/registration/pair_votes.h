// Candidate poses of a part on a whole, by voting point pairs (Drost, Ulrich, Navab and Ilic 2010).
#pragma once

#include "ostraka/geom/rigid_fit.h"
#include "registration/surface_points.h"

#include <vector>

namespace ostraka {

/// A motion of the part onto the whole, with the number of votes of point pairs for this motion.
struct VotedMotion {
    Motion motion;
    double votes = 0;
};

/// Index of all pairs of points of a whole by pose-invariant features: the distance of the two points, the angles of their
/// normals with the line between them, and the angle between the normals. Pairs farther apart than `max_distance` are omitted.
/// The table is built once and queried for many parts.
class PairTable {
public:
    /// `step`: bin size of distances; angles have bins of 15 degrees. The table takes four bytes per pair. Throws Error (usage)
    /// for more than 4096 points, or lengths that are not positive.
    PairTable(SurfacePoints points, double max_distance, double step);

    /// Candidate motions of a part: `references` points of the part (evenly chosen) are each paired with at most `partners` other
    /// points (random, by `seed`). All pairs of the whole with equal features vote for a point of the whole and a rotation about
    /// its normal; rare features weigh more than frequent ones. Returns the `kept` motions with the most votes for each reference
    /// point. The result is the same for any number of threads.
    [[nodiscard]] std::vector<VotedMotion> vote(const SurfacePoints& part, int references, int partners, int kept,
                                                std::uint64_t seed) const;

    [[nodiscard]] const SurfacePoints& points() const { return points_; }

private:
    /// A pair of points of the whole.
    struct Entry {
        std::uint16_t reference;  ///< index of the first point of the pair
        std::int16_t angle;       ///< rotation angle of the pair about the first point's normal, in units of 2 pi / 2^16
    };
    /// Bin of the features of points `p` and `q` with normals `n` and `m`; -1: not in the table.
    [[nodiscard]] long key(const Eigen::Vector3d& p, const Eigen::Vector3d& n, const Eigen::Vector3d& q,
                           const Eigen::Vector3d& m) const;

    SurfacePoints points_;
    double max_distance_, step_;
    int distances_ = 0;                ///< number of bins of distances
    std::vector<std::size_t> starts_;  ///< for each bin of features, index of its first entry
    std::vector<Entry> entries_;       ///< pairs of points, ordered by bin of features
};

}  // namespace ostraka

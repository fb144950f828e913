// Pairwise scores of sherds of a vessel over their relative rotations, and the rotations of all sherds at once.
#pragma once

#include "fracture/fracture_align.h"
#include "ostraka/fracture/rotational_matching.h"
#include "ostraka/geom/surface_search.h"

#include <map>
#include <vector>

namespace ostraka {

/// Points on the profile of a surface of revolution about the vertical axis, as cells of the half plane (radius, height).
class ProfileCells {
public:
    ProfileCells(const SurfaceSearch& surface, double width) : surface_(surface), width_(width) {}
    /// The cell of the nearest surface point to `p` with a similar normal; -1 if it is farther than `search_radius`.
    int row(const Eigen::Vector3d& p, const Eigen::Vector3d& normal, double search_radius);
    [[nodiscard]] double width() const { return width_; }
    [[nodiscard]] std::size_t rows() const { return cell_rows_.size(); }

private:
    const SurfaceSearch& surface_;
    double width_;
    std::map<std::pair<long, long>, int> cell_rows_;
};

/// The area that a sherd covers at each of `steps` angles.
class RotationMap {
public:
    /// Points closer than `margin` to the sherd's own fracture are covered, but do not count as overlap.
    RotationMap(ProfileCells& cells, const SurfaceSamples& surface, const std::vector<Eigen::Vector3d>& fracture, int steps,
                double margin, double search_radius);
    /// Area that this sherd shares with `other`, for `other` rotated by each step against this sherd.
    [[nodiscard]] std::vector<double> shared(const RotationMap& other) const;
    [[nodiscard]] double area() const { return area_; }

private:
    struct Place {
        int row, column;
    };
    int steps_;
    double area_ = 0, area_per_sample_ = 0;
    std::vector<Place> deep_;
    std::vector<std::vector<bool>> covered_;  ///< per row; empty: nowhere
};

/// A sherd in the frame whose vertical axis through the origin is the vessel's axis.
struct UprightSherd {
    Mesh mesh;
    FractureSide side;  ///< without fracture: it meets no other sherd
    double radius = 0;  ///< root mean square distance from the axis
    std::unique_ptr<RotationMap> map;
};

/// A rotation of the second sherd at which the two sherds meet.
struct MeetingRotation {
    double rotation = 0;  ///< radians
    double value = 0;     ///< area of the fracture that meets, with the rim, less the area inside the other sherd
    PairCandidate fit;    ///< its pose is the second sherd's, with the first fixed
};

/// Scores of two sherds.
struct RotationPair {
    std::vector<MeetingRotation> meetings;  ///< best first
    std::vector<double> shared;             ///< per step: area that both would cover
    double tolerance = 0;                   ///< radians within which a rotation belongs to a meeting

    /// Score of a rotation of the second sherd against the first: area that meets less area that both cover.
    [[nodiscard]] double value(double rotation) const { return met(rotation) - shared_at(rotation); }
    /// The area that meets, without the shared area.
    [[nodiscard]] double met(double rotation) const;
    [[nodiscard]] double shared_at(double rotation) const;
    /// The meeting at a rotation; none: nullptr.
    [[nodiscard]] const MeetingRotation* meeting(double rotation) const;
};

/// The angle in [-pi, pi].
double wrapped(double angle);
Motion rotated_by(double angle);
/// The rotation about the vertical axis that is nearest to a motion.
double rotation_about_axis(const Motion& motion);

RotationPair meet(const UprightSherd& a, const UprightSherd& b, int steps, double wall, const RotationMatchOptions& options);

/// Scores of all pairs: for i < j the rotation of j against i.
class RotationPairs {
public:
    RotationPairs(std::size_t count, std::vector<RotationPair> pairs) : count_(count), pairs_(std::move(pairs)) {}
    [[nodiscard]] std::size_t count() const { return count_; }
    [[nodiscard]] const RotationPair& at(std::size_t i, std::size_t j) const {
        return pairs_[std::min(i, j) * count_ + std::max(i, j)];
    }
    /// The relative rotation of two sherds in the convention of their pair.
    [[nodiscard]] static double between(std::size_t i, std::size_t j, double rotation_i, double rotation_j) {
        return i < j ? rotation_j - rotation_i : rotation_i - rotation_j;
    }
    [[nodiscard]] double value(std::size_t i, std::size_t j, double rotation_i, double rotation_j) const {
        return at(i, j).value(between(i, j, rotation_i, rotation_j));
    }

private:
    std::size_t count_;
    std::vector<RotationPair> pairs_;  ///< count x count; only i < j is used
};

struct RotationAssembly {
    std::vector<double> rotations;  ///< per sherd
    std::vector<bool> joined;       ///< per sherd: meets other sherds
    double value = 0;
};

/// The rotations with the largest sum over all pairs, starting from `root` and the sherds that are `fixed` (at 0): each step
/// adds one sherd to the best assemblies so far (a beam search). A sherd that meets no other is placed where it overlaps least.
RotationAssembly assemble_rotations(const RotationPairs& pairs, const std::vector<bool>& fixed, std::size_t root, int beam);

/// Rotates the sherds in `side` against all others: the value of all pairs across at the current rotations, and the max area
/// that meets at any other rotation, whether or not there is room.
struct RotationLead {
    double current = 0, best_other = 0;
};
RotationLead rotation_lead(const RotationPairs& pairs, const std::vector<double>& rotations, const std::vector<bool>& counts,
                           const std::vector<bool>& side, int steps);

/// The rotation of one sherd at which it overlaps least with the others that count.
double least_shared_rotation(const RotationPairs& pairs, const std::vector<double>& rotations, const std::vector<bool>& counts,
                             std::size_t sherd, double& shared);

}  // namespace ostraka

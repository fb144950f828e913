// Pairwise scores of sherds of a vessel over their relative rotations, and the rotations of all sherds at once.
#pragma once

#include "fracture/fracture_align.h"
#include "ostraka/fracture/rotational_matching.h"
#include "ostraka/geom/surface_search.h"

#include <map>
#include <vector>

namespace ostraka {

/// Numbers the cells of the half plane (radius, height) that the profile of a surface of revolution about the vertical axis
/// meets.
class ProfileCells {
public:
    ProfileCells(const SurfaceSearch& surface, double width) : surface_(surface), width_(width) {}
    /// Number of the cell that contains the surface point nearest to `p` with a similar normal; -1 if that surface point is
    /// farther than `search_radius`.
    int row(const Eigen::Vector3d& p, const Eigen::Vector3d& normal, double search_radius);
    [[nodiscard]] double width() const { return width_; }                 ///< width of a cell
    [[nodiscard]] std::size_t rows() const { return cell_rows_.size(); }  ///< number of cells numbered so far

private:
    const SurfaceSearch& surface_;
    double width_;
    std::map<std::pair<long, long>, int> cell_rows_;
};

/// The cells of the vessel's surface that a sherd covers: profile cells times `steps` angles.
class RotationMap {
public:
    /// Points closer than `margin` to the sherd's own fracture count as covered, but not as overlap.
    RotationMap(ProfileCells& cells, const SurfaceSamples& surface, const std::vector<Eigen::Vector3d>& fracture, int steps,
                double margin, double search_radius);
    /// For each step: area that both this sherd and `other` cover when `other` is rotated by that many steps against this sherd.
    [[nodiscard]] std::vector<double> shared(const RotationMap& other) const;
    [[nodiscard]] double area() const { return area_; }  ///< area of the sherd

private:
    struct Place {
        int row, column;
    };
    int steps_;
    double area_ = 0, area_per_sample_ = 0;
    std::vector<Place> deep_;
    /// Per profile cell: true for the covered angles; empty: none covered.
    std::vector<std::vector<bool>> covered_;
};

/// A sherd in the frame in which the vessel's axis is the vertical line through the origin.
struct UprightSherd {
    Mesh mesh;                         ///< surface of the sherd
    FractureSide side;                 ///< fracture and rim; a sherd without fracture meets no other sherd
    double radius = 0;                 ///< root mean square distance of the sherd from the axis
    std::unique_ptr<RotationMap> map;  ///< cells that the sherd covers
};

/// A rotation of the second sherd at which the two sherds meet.
struct MeetingRotation {
    double rotation = 0;  ///< rotation of the second sherd relative to the first, in radians
    double value = 0;     ///< score: area of fracture and rim that meet, less the area inside the other sherd
    PairCandidate fit;    ///< refined result; its pose moves the second sherd and leaves the first fixed
};

/// Scores of the relative rotations of two sherds.
struct RotationPair {
    std::vector<MeetingRotation> meetings;  ///< rotations at which the sherds meet, by descending value
    std::vector<double> shared;             ///< for each step of rotation: area that both sherds would cover
    double tolerance = 0;                   ///< max difference in radians between a rotation and a meeting that belongs to it

    /// Score of a rotation of the second sherd against the first: fracture area that meets less surface area that both cover.
    [[nodiscard]] double value(double rotation) const { return met(rotation) - shared_at(rotation); }
    /// Fracture area that meets at a rotation, without subtracting the shared area.
    [[nodiscard]] double met(double rotation) const;
    [[nodiscard]] double shared_at(double rotation) const;  ///< surface area that both sherds cover at a rotation
    /// The meeting to which a rotation belongs; null if there is none.
    [[nodiscard]] const MeetingRotation* meeting(double rotation) const;
};

/// The equivalent angle in [-pi, pi].
double wrapped(double angle);
Motion rotated_by(double angle);  ///< rotation about the vertical axis
/// Angle of the rotation about the vertical axis that is closest to a motion.
double rotation_about_axis(const Motion& motion);

/// Scores all relative rotations of two sherds; `wall`: wall thickness.
RotationPair meet(const UprightSherd& a, const UprightSherd& b, int steps, double wall, const RotationMatchOptions& options);

/// Scores of all pairs of sherds: for i < j, of the rotation of sherd j against sherd i.
class RotationPairs {
public:
    RotationPairs(std::size_t count, std::vector<RotationPair> pairs) : count_(count), pairs_(std::move(pairs)) {}
    [[nodiscard]] std::size_t count() const { return count_; }
    [[nodiscard]] const RotationPair& at(std::size_t i, std::size_t j) const {
        return pairs_[std::min(i, j) * count_ + std::max(i, j)];
    }
    /// Relative rotation of sherds i and j: of the sherd with the larger index against the other.
    [[nodiscard]] static double between(std::size_t i, std::size_t j, double rotation_i, double rotation_j) {
        return i < j ? rotation_j - rotation_i : rotation_i - rotation_j;
    }
    [[nodiscard]] double value(std::size_t i, std::size_t j, double rotation_i, double rotation_j) const {
        return at(i, j).value(between(i, j, rotation_i, rotation_j));
    }

private:
    std::size_t count_;
    std::vector<RotationPair> pairs_;  ///< entry i * count + j: scores of sherds i < j; other entries are unused
};

/// Rotations of all sherds of a vessel.
struct RotationAssembly {
    std::vector<double> rotations;  ///< per sherd: rotation in radians
    std::vector<bool> joined;       ///< per sherd: true if the sherd meets other sherds
    double value = 0;               ///< sum of the scores over all pairs
};

/// Searches the rotations of all sherds with the largest sum of scores over all pairs, by a beam search that starts from `root`
/// and the `fixed` sherds (rotation 0): each step adds one sherd to the `beam` assemblies of the highest sums. A sherd that meets
/// no other sherd is placed where the overlap is smallest.
RotationAssembly assemble_rotations(const RotationPairs& pairs, const std::vector<bool>& fixed, std::size_t root, int beam);

/// How well the current rotation of one side of an assembly against the other side is determined.
struct RotationLead {
    /// Score across the sides at the current rotation; max area that meets at any other, ignoring overlap.
    double current = 0, best_other = 0;
};
/// Rotates the sherds with `side` true against all other sherds with `counts` true, in `steps` steps.
RotationLead rotation_lead(const RotationPairs& pairs, const std::vector<double>& rotations, const std::vector<bool>& counts,
                           const std::vector<bool>& side, int steps);

/// The rotation of one sherd at which its overlap with the other sherds (those with `counts` true) is smallest; `shared` receives
/// this overlap.
double least_shared_rotation(const RotationPairs& pairs, const std::vector<double>& rotations, const std::vector<bool>& counts,
                             std::size_t sherd, double& shared);

}  // namespace ostraka

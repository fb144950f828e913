// How sherds of a vessel with one axis meet at each rotation of one against the other, and the rotations of all at once.
#pragma once

#include "break_align.h"
#include "ostraka/fracture/rotational_matching.h"
#include "ostraka/geom/surface_search.h"

#include <map>
#include <vector>

namespace ostraka {

/// Places on the profile of a surface of revolution about the vertical axis, as cells of the half plane (radius, height).
class ProfileCells {
public:
    ProfileCells(const SurfaceSearch& whole, double width) : whole_(whole), width_(width) {}
    /// The cell of the surface's place nearest to `p` that faces the same way; none farther off than `search_radius`: -1.
    int row(const Eigen::Vector3d& p, const Eigen::Vector3d& normal, double search_radius);
    [[nodiscard]] double width() const { return width_; }
    [[nodiscard]] std::size_t rows() const { return known_.size(); }

private:
    const SurfaceSearch& whole_;
    double width_;
    std::map<std::pair<long, long>, int> known_;
};

/// What a sherd covers at each of `steps` angles.
class RotationMap {
public:
    /// Places closer than `margin` to the sherd's own break are covered, but do not complain of being covered twice.
    RotationMap(ProfileCells& cells, const SurfaceSamples& surface, const std::vector<Eigen::Vector3d>& fracture, int steps,
                double margin, double search_radius);
    /// Area of this sherd on which `other` lies too when it is rotated by each of the steps against this one: one a step.
    [[nodiscard]] std::vector<double> shared(const RotationMap& other) const;
    [[nodiscard]] double area() const { return area_; }

private:
    struct Place {
        int row, column;
    };
    int steps_;
    double area_ = 0, each_ = 0;
    std::vector<Place> deep_;
    std::vector<std::vector<bool>> covered_;  ///< by row; empty: nowhere
};

/// A sherd with the vessel's axis as the vertical one through the origin.
struct UprightSherd {
    Mesh mesh;
    BreakSide side;     ///< no fracture: nothing meets it
    double radius = 0;  ///< root mean square distance from the axis
    std::unique_ptr<RotationMap> map;
};

/// A rotation of the second sherd at which the two meet.
struct MeetingRotation {
    double rotation = 0;  ///< radians
    double value = 0;     ///< area of the fracture that meets, with the rim, less what lies inside
    PairCandidate fit;    ///< its pose is the second sherd's, the first where it is
};

/// All that is known of two sherds.
struct RotationPair {
    std::vector<MeetingRotation> meetings;  ///< best first
    std::vector<double> shared;             ///< at each step: area on which both would lie
    double tolerance = 0;                   ///< radians within which a rotation is that of a meeting

    /// What the pair says of a rotation of the second against the first: area that meets less area on which both lie.
    [[nodiscard]] double value(double rotation) const { return met(rotation) - shared_at(rotation); }
    /// The area that meets alone.
    [[nodiscard]] double met(double rotation) const;
    [[nodiscard]] double shared_at(double rotation) const;
    /// The meeting of a rotation; none: nullptr.
    [[nodiscard]] const MeetingRotation* meeting(double rotation) const;
};

/// Between -pi and pi.
double wrapped(double angle);
Motion rotated_by(double angle);
/// The rotation about the vertical axis that is nearest to a motion.
double rotation_about_axis(const Motion& motion);

RotationPair meet(const UprightSherd& a, const UprightSherd& b, int steps, double wall, const RotationMatchOptions& options);

/// What is known of all pairs: of i < j the rotation of j against i.
class RotationPairs {
public:
    RotationPairs(std::size_t count, std::vector<RotationPair> pairs) : count_(count), pairs_(std::move(pairs)) {}
    [[nodiscard]] std::size_t count() const { return count_; }
    [[nodiscard]] const RotationPair& of(std::size_t i, std::size_t j) const {
        return pairs_[std::min(i, j) * count_ + std::max(i, j)];
    }
    /// The rotation between two as the pair has it.
    [[nodiscard]] static double between(std::size_t i, std::size_t j, double rotation_i, double rotation_j) {
        return i < j ? rotation_j - rotation_i : rotation_i - rotation_j;
    }
    [[nodiscard]] double value(std::size_t i, std::size_t j, double rotation_i, double rotation_j) const {
        return of(i, j).value(between(i, j, rotation_i, rotation_j));
    }

private:
    std::size_t count_;
    std::vector<RotationPair> pairs_;  ///< count x count, of which i < j counts
};

struct RotationAssembly {
    std::vector<double> rotations;  ///< of each sherd
    std::vector<bool> joined;       ///< meets others where it is
    double value = 0;
};

/// The rotations of largest sum over all pairs, from `root` and those `fixed` (at 0) on: at each step one more sherd comes to the
/// best assemblies so far (a beam search). What meets none stands where it shares least surface with the others.
RotationAssembly assemble_rotations(const RotationPairs& pairs, const std::vector<bool>& fixed, std::size_t root, int beam);

/// Rotates the sherds marked against all others: the value of all pairs across at the rotations as they are, and the most that
/// meets at any rotation that is another one, be there room for it or not.
struct RotationLead {
    double here = 0, elsewhere = 0;
};
RotationLead lead_of(const RotationPairs& pairs, const std::vector<double>& rotations, const std::vector<bool>& counts,
                     const std::vector<bool>& side, int steps);

/// The rotation of one sherd at which it shares least surface with the others that count.
double least_shared_rotation(const RotationPairs& pairs, const std::vector<double>& rotations, const std::vector<bool>& counts,
                             std::size_t sherd, double& shared);

}  // namespace ostraka

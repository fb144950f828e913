// Two sherds of a vessel with one axis: how well they meet at each rotation of the second against the first.
#pragma once

#include "break_align.h"
#include "ostraka/fracture/rotational_matching.h"
#include "rotation_map.h"

namespace ostraka {

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

}  // namespace ostraka

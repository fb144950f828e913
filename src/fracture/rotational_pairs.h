// Two sherds of a vessel with one axis: how well they meet at each turn of the second against the first.
#pragma once

#include "break_align.h"
#include "ostraka/fracture/rotational_matching.h"
#include "rotation_map.h"

#include <array>

namespace ostraka {

/// A sherd with the vessel's axis as the vertical one through the origin.
struct TurningSherd {
    Mesh mesh;
    BreakSide side;     ///< no fracture: nothing meets it
    double radius = 0;  ///< root mean square distance from the axis
    std::unique_ptr<TurnMap> map;
};

/// A turn of the second sherd at which the two meet.
struct MeetingTurn {
    double turn = 0;    ///< radians
    double value = 0;   ///< area of the fracture that meets, with the rim, less what lies inside
    PairCandidate fit;  ///< its pose is the second sherd's, the first where it is
};

/// All that is known of two sherds.
struct TurnPair {
    std::vector<MeetingTurn> meetings;  ///< best first
    std::vector<double> shared;         ///< at each step: area on which both would lie
    double reach = 0;                   ///< radians within which a turn is that of a meeting

    /// What the pair says of a turn of the second against the first: area that meets less area on which both lie.
    [[nodiscard]] double value(double turn) const { return met(turn) - shared_at(turn); }
    /// The area that meets alone.
    [[nodiscard]] double met(double turn) const;
    [[nodiscard]] double shared_at(double turn) const;
    /// The meeting of a turn; none: nullptr.
    [[nodiscard]] const MeetingTurn* meeting(double turn) const;
};

/// Between -pi and pi.
double wrapped(double angle);
Motion turned_by(double angle);
/// The turn about the vertical axis that is nearest to a motion.
double turn_of(const Motion& motion);

TurnPair meet(const TurningSherd& a, const TurningSherd& b, int steps, double wall, const BreakTurnOptions& options);

}  // namespace ostraka

// A whole vessel from its sherds: the surface of revolution about their axis through their walls.
#pragma once

#include "ostraka/axis/axis.h"
#include "ostraka/core/options.h"
#include "ostraka/fracture/fragment.h"

#include <string>
#include <vector>

namespace ostraka {

struct RevolutionOptions {
    int rows = 400;                  ///< heights at which the walls are looked at
    int columns = 360;               ///< directions around the axis
    double presence = 3;             ///< degrees of wall that a height must have to count
    double smoothing = 1.5;          ///< of the profile, in rows
    double layout_angle = 2;         ///< degrees by which a sherd may be tilted where it lies, standard deviation
    double layout_shift = 0.02;      ///< share of the vessel's diagonal by which it may lie aside, standard deviation
    std::uint64_t vertices = 25000;  ///< of the template
    AxisOptions axis;

    void describe(OptionList& visit);
};

/// What of a sherd the template rests on.
enum class SherdUse {
    used,      ///< its axis and its walls
    partly,    ///< its walls, where the axis of the others is; or its axis alone
    left_out,  ///< nothing
};
std::string to_string(SherdUse use);

/// How one sherd lies on the template.
struct SherdOnProfile {
    std::string name;
    SherdUse use = SherdUse::used;
    std::string reason;              ///< what a sherd that is partly used does not tell, or why it is left out
    std::string remedy;              ///< how to mend that, where it can be
    Axis axis;                       ///< of the sherd alone
    double lean = 0;                 ///< degrees between its axis and the common one
    double aside = 0;                ///< distance of the two axes at the sherd's middle
    double weight = 0;               ///< share of what is known of the common axis that it tells
    double disagreement = 0;         ///< of its axis with the common one, in standard deviations of it and of the layout
    double on_template = 0;          ///< share of its area (but for breaks that are known) that lies on the template
    Motion motion;                   ///< from where it was given to where its axis and height are those of all
    double lowest = 0, highest = 0;  ///< heights above the foot of the template
    double residual = 0;             ///< root mean square distance of its walls from the template
};

struct RevolutionTemplate {
    Axis axis;                             ///< common to all sherds; its direction points up
    double direction_error = 0;            ///< standard error of the axis, degrees
    double place_error = 0;                ///< the same of its place, at the middle of the sherds
    std::vector<Eigen::Vector2d> profile;  ///< radius and height above the lowest place, from the foot outside up and inside down
    bool base = false;                     ///< the sherds reach the axis at the bottom
    bool rim = false;                      ///< the top ends at one height all around, as far as it is there
    std::vector<double> present;           ///< degrees of wall at equal steps of the height
    Mesh mesh;                             ///< closed, oriented outwards, where the sherds are
    AnnotationSet annotations;
    std::vector<SherdOnProfile> sherds;
    std::vector<std::string> notes;
};

/// Sherds that lie as they did in the vessel (all in one frame, or a single one). Each tells of the axis what its walls do
/// (`AxisWitness`): a short arc little, and along one direction less than along another. The common axis is the one that all of
/// them make most likely, together with how each is tilted and shifted where it lies (`layout_angle`, `layout_shift`), sherds
/// that contradict most others losing their weight (Geman and McClure); breaks are few and the fit is robust where facets are not
/// known. Each sherd is moved by what is then most likely of its own tilt and shift: one without an axis stays where it lies.
///
/// From the axis rays go out at each height in all directions: the wall is where most of the rays that meet any wall at that
/// height are inside a sherd, which drops what a break cut away. The outline of that, a level line with precision below a row, is
/// the profile, swept about the axis with triangles of even size. Heights without a sherd between others are bridged straight.
/// Annotations: regions "outer", "inner" and "base", lines "rim", "widest girth" and "foot", points "base centre" and "floor
/// centre" (where they exist), the axis as an attribute.
///
/// A sherd that cannot be used is left out, with the reason: too few faces, an axis that contradicts that of the others by more
/// than six standard deviations, walls that are not round about it, or nowhere on the vessel that the others make. Of one that is
/// not closed the axis counts, not the walls; one that is inside out is turned. Throws Error (input), naming every sherd and its
/// reason, where none is left; (usage) without sherds. `left_out`: sherds that could not be read, say, to be named with the
/// others.
RevolutionTemplate template_of_revolution(const std::vector<const Fragment*>& sherds, const RevolutionOptions& options = {},
                                          std::vector<SherdOnProfile> left_out = {});

}  // namespace ostraka

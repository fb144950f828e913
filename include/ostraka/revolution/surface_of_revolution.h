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
    std::uint64_t vertices = 25000;  ///< of the template
    AxisOptions axis;

    void describe(OptionList& visit);
};

/// How one sherd lies on the template.
struct SherdOnProfile {
    std::string name;
    Axis axis;                       ///< of the sherd alone
    double lean = 0;                 ///< degrees between its axis and the common one
    double aside = 0;                ///< distance of the two axes at the sherd's middle
    Motion motion;                   ///< from where it was given to where its axis and height are those of all
    double lowest = 0, highest = 0;  ///< heights above the foot of the template
    double residual = 0;             ///< root mean square distance of its walls from the template
};

struct RevolutionTemplate {
    Axis axis;                             ///< common to all sherds; its direction points up
    std::vector<Eigen::Vector2d> profile;  ///< radius and height above the lowest place, from the foot outside up and inside down
    bool base = false;                     ///< the sherds reach the axis at the bottom
    bool rim = false;                      ///< the top ends at one height all around, as far as it is there
    std::vector<double> present;           ///< degrees of wall at equal steps of the height
    Mesh mesh;                             ///< closed, oriented outwards, where the sherds are
    AnnotationSet annotations;
    std::vector<SherdOnProfile> sherds;
    std::vector<std::string> notes;
};

/// Sherds that lie as they did in the vessel (all in one frame, or a single one), each closed: a solid wall. The axis is that of
/// the surface of revolution that fits all faces but those of breaks (`rotation_axis`; breaks are few and its fit is robust where
/// facets are not known). From the axis rays go out at each height in all directions: the wall is where most of the rays that
/// meet any wall at that height are inside a sherd, which drops what a break cut away. The outline of that, a level line with
/// precision below a row, is the profile, swept about the axis with triangles of even size. Heights without a sherd between
/// others are bridged straight. Annotations: regions "outer", "inner" and "base", lines "rim", "widest girth" and "foot", points
/// "base centre" and "floor centre" (where they exist), the axis as an attribute. Throws Error (input) for sherds that are not
/// closed, without a common axis, or not round; (usage) without sherds.
RevolutionTemplate template_of_revolution(const std::vector<const Fragment*>& sherds, const RevolutionOptions& options = {});

}  // namespace ostraka

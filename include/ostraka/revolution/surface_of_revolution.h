// Template of a vessel from its sherds: the surface of revolution through their walls.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/axis/axis.h"
#include "ostraka/core/options.h"
#include "ostraka/fracture/fragment.h"

#include <string>
#include <vector>

namespace ostraka {

struct RevolutionOptions {
    int rows = 400;                  ///< number of heights at which the walls are sampled
    int columns = 360;               ///< number of directions around the axis
    double presence = 3;             ///< min degrees of wall at a height; below it the height is ignored
    double smoothing = 1.5;          ///< standard deviation of the Gaussian that smooths the profile, in rows
    double layout_angle = 2;         ///< standard deviation of a sherd's tilt in the input layout, degrees
    double layout_shift = 0.02;      ///< standard deviation of a sherd's offset in the layout, share of the vessel's diagonal
    std::uint64_t vertices = 25000;  ///< approximate number of vertices of the template
    AxisOptions axis;

    void describe(OptionList& visit);
};

/// Which data of a sherd the template uses.
enum class SherdUse {
    used,      ///< its axis and its walls
    partly,    ///< its walls only, with the axis of the others; or its axis only
    left_out,  ///< neither
};
std::string to_string(SherdUse use);

/// Position of a sherd on the template.
struct SherdOnProfile {
    std::string name;
    SherdUse use = SherdUse::used;
    std::string reason;       ///< contribution that a partly used sherd lacks, or why it is left out
    std::string remedy;       ///< how to remedy that, if possible
    Axis axis;                ///< axis of the sherd alone
    double lean = 0;          ///< degrees between its axis and the common one
    double aside = 0;         ///< distance of the two axes at the sherd's centroid
    double weight = 0;        ///< share of the information on the common axis that comes from this sherd
    double disagreement = 0;  ///< between its axis and the common one, in standard deviations of the axis and of the layout
    double on_template = 0;   ///< share of its area (without known fractures) that lies on the template
    Motion motion;            ///< from the given position to where its axis and height agree with the common ones
    double lowest = 0, highest = 0;  ///< heights above the foot of the template
    double residual = 0;             ///< root mean square distance of its walls from the template
};

/// The mesh is closed, oriented outwards, in the frame of the sherds.
struct RevolutionTemplate : AnnotatedMesh {
    Axis axis;                             ///< common axis of all sherds; its direction points up
    double direction_error = 0;            ///< standard error of the axis, degrees
    double place_error = 0;                ///< standard error of the axis's position, at the centroid of the sherds
    std::vector<Eigen::Vector2d> profile;  ///< radius, height above the lowest point; from the foot, outside then inside
    bool base = false;                     ///< the sherds reach the axis at the bottom
    bool rim = false;                      ///< the top ends at the same height in all directions where it is preserved
    std::vector<double> present;           ///< degrees of wall at equal steps of the height
    std::vector<SherdOnProfile> sherds;
    std::vector<std::string> notes;
};

/// Input: sherds in their original relative positions in the vessel (all in one frame), or a single sherd. Each sherd
/// contributes the information of its walls about the axis (`AxisEvidenceEvaluator`): a short arc contributes little, and less
/// along one direction than along another. The common axis and the tilt and offset of each sherd in the layout (`layout_angle`,
/// `layout_shift`) maximise the likelihood; sherds that contradict most others lose their weight (Geman and McClure). If the
/// facets are not known, fractures are assumed to be a small share of the area, which the robust fit tolerates. Each sherd is
/// moved by its most likely tilt and offset; one without an axis is not moved.
///
/// At each height, rays are cast from the axis in all directions: the wall is where most of the rays that hit any wall at that
/// height are inside a sherd, which discards parts cut away by fractures. Its outline, a level line of sub-row precision, is the
/// profile, swept about the axis with triangles of uniform size. Heights without a sherd between others are bridged by straight
/// lines. Annotations: regions "outer", "inner" and "base", lines "rim", "widest girth" and "foot", points "base centre" and
/// "floor centre" (where they exist), the axis as an attribute.
///
/// A sherd that cannot be used is left out, with the reason: too few faces, an axis that contradicts that of the others by more
/// than six standard deviations, walls that are not rotationally symmetric about the axis, or a position off the vessel formed
/// by the others. An open mesh contributes its axis, but not its walls; one that is inside out is flipped. Throws Error
/// (input), naming every sherd and its reason, if none is left; (usage) without sherds. `left_out`: sherds excluded earlier,
/// such as unreadable files, to be reported with the others.
RevolutionTemplate template_of_revolution(const std::vector<const Fragment*>& sherds, const RevolutionOptions& options = {},
                                          std::vector<SherdOnProfile> left_out = {});

}  // namespace ostraka

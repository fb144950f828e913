// Template of a vessel from its sherds: the surface of revolution that fits the walls of the sherds.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/axis/axis.h"
#include "ostraka/core/options.h"
#include "ostraka/fracture/fragment.h"

#include <string>
#include <vector>

namespace ostraka {

struct RevolutionOptions {
    int rows = 400;           ///< number of heights at which the walls are sampled
    int columns = 360;        ///< number of directions around the axis
    double presence = 3;      ///< min angular extent of wall at a height, degrees; heights with less wall are ignored
    double smoothing = 1.5;   ///< standard deviation of the Gaussian that smooths the profile, in rows (heights)
    double layout_angle = 2;  ///< standard deviation of a sherd's tilt in the input layout, degrees
    /// Standard deviation of a sherd's offset in the input layout, as a share of the vessel's diagonal.
    double layout_shift = 0.02;
    std::uint64_t vertices = 25000;  ///< approximate number of vertices of the template
    AxisOptions axis;                ///< options for estimating the axis of a sherd

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// Which data of a sherd the template uses.
enum class SherdUse {
    used,      ///< the axis and the walls of the sherd
    partly,    ///< its walls only, with the common axis of the other sherds; or its axis only
    left_out,  ///< neither axis nor walls
};
std::string to_string(SherdUse use);

/// Contribution of a sherd to the template, and its position on the template.
struct SherdOnProfile {
    std::string name;               ///< name of the sherd
    SherdUse use = SherdUse::used;  ///< which data of the sherd are used
    std::string reason;             ///< what a partly used sherd does not contribute, or why a sherd is left out; empty: used
    std::string remedy;             ///< how to make the sherd usable, if possible
    Axis axis;                      ///< axis estimated from the sherd alone
    double lean = 0;                ///< angle between the sherd's axis and the common axis, degrees
    double aside = 0;               ///< distance between the sherd's axis and the common axis at the sherd's centroid
    double weight = 0;              ///< share of the information on the common axis that comes from the sherd, 0 to 1
    /// Deviation of the sherd's axis from the common axis, in standard deviations of the axis and of the layout.
    double disagreement = 0;
    double on_template = 0;  ///< share of the sherd's area (without known fractures) that lies on the template
    Motion motion;           ///< maps the sherd from the input layout to where its axis and height agree with the common ones
    double lowest = 0, highest = 0;  ///< lowest and highest height of the sherd above the foot of the template
    double residual = 0;             ///< root mean square distance of the sherd's walls from the template
};

/// A vessel as a surface of revolution, from its sherds. The mesh is closed, oriented outwards, in the coordinates of the sherds;
/// the annotations are the regions, lines and points of the vessel, and its axis.
struct RevolutionTemplate : AnnotatedMesh {
    Axis axis;                   ///< common axis of all sherds; its direction points up
    double direction_error = 0;  ///< standard error of the axis's direction, degrees
    double place_error = 0;      ///< standard error of the axis's position at the centroid of the sherds, a length
    /// Points (radius, height above the lowest point), from the foot along the outside to the rim, then along the inside.
    std::vector<Eigen::Vector2d> profile;
    bool base = false;                   ///< true: the sherds reach the axis at the bottom
    bool rim = false;                    ///< true: the wall ends at the same height in all directions where its top is preserved
    std::vector<double> present;         ///< angular extent of wall in degrees, at equal steps of the height
    std::vector<SherdOnProfile> sherds;  ///< contribution of each sherd
    std::vector<std::string> notes;      ///< remarks on the construction
};

/// Builds a template from sherds in their original relative positions in the vessel (all in one coordinate system), or from a
/// single sherd. Each sherd contributes the information of its walls about the axis (`AxisEvidenceEvaluator`): a short arc
/// contributes little, and less along one direction than along another. The common axis and the tilt and offset of each sherd in
/// the layout (`layout_angle`, `layout_shift`) maximise the likelihood; sherds that contradict most others lose their weight
/// (Geman and McClure). If the facets are not known, fractures are assumed to be a small share of the area, which the robust fit
/// tolerates. Each sherd is moved by its most likely tilt and offset; a sherd without an axis is not moved.
///
/// At each height, rays are cast from the axis in all directions: the wall is where the majority of the rays that hit any wall at
/// that height are inside a sherd, which discards parts cut away by fractures. The outline of the wall, a level line of sub-row
/// precision, is the profile, which is swept about the axis with triangles of uniform size. Heights without a sherd between
/// heights with sherds are bridged by straight lines. Annotations: regions "outer", "inner" and "base", lines "rim", "widest
/// girth" and "foot", points "base centre" and "floor centre" (where they exist), the axis as an attribute.
///
/// A sherd that cannot be used is left out, with the reason: too few faces, an axis that contradicts the axis of the other sherds
/// by more than six standard deviations, walls that are not rotationally symmetric about the axis, or a position off the vessel
/// that the other sherds form. An open mesh contributes its axis, but not its walls; a mesh that is inside out is flipped. Throws
/// Error (input), naming every sherd and its reason, if no sherd is left; (usage) without sherds. `left_out`: sherds excluded by
/// the caller, such as unreadable files, to be reported with the others.
RevolutionTemplate template_of_revolution(const std::vector<const Fragment*>& sherds, const RevolutionOptions& options = {},
                                          std::vector<SherdOnProfile> left_out = {});

}  // namespace ostraka

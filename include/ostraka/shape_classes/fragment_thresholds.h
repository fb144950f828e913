// What a class's members say of the thresholds by which fragments of one object are distinguished from those of others.
#pragma once

#include "ostraka/reconstruction/reconstruct.h"
#include "ostraka/shape_classes/shape_class.h"

#include <functional>

namespace ostraka {

/// As residuals of kind `geometry`, none where it cannot be measured:
/// "residual": of pieces of a member, each a landmark of the template and those nearest to it (a quarter of them, four at least),
/// registered by rotation and translation at the scale that all of its landmarks have: root mean square over spread, of the worst
/// piece; "scale-tolerance": how much the scale of one piece differs from that of its other landmarks, per cent, of the worst
/// piece; "slack": the farthest that a constraint in per cent is off. The first two need eight landmarks.
std::vector<ClassQuantity> fragment_quantities(const ClassTemplate& known, const std::vector<Point>& points,
                                               const std::vector<ClassQuantity>& quantities);

/// A threshold of `fit` as the class has it.
struct FragmentThreshold {
    std::string option;  ///< "residual", "scale-tolerance" or "slack"
    double value = 0;
    std::size_t members = 0;  ///< that it was learnt of
};
/// Those that three members or more say something of.
std::vector<FragmentThreshold> fragment_thresholds(const ShapeClass& learnt);

/// A threshold that a verdict goes by.
struct UsedThreshold : FragmentThreshold {
    std::string from;  ///< "class", "told" or "default"
};
/// What the class's members show takes the place of the defaults in `options`, not of what was specified (`specified` says of
/// which options). What scans and measuring leave is not seen on members: a constraint may always be off by the default. Returns
/// "residual", "scale-tolerance" and "slack" as they are then; without a class none of them changes.
std::vector<UsedThreshold> take_thresholds(ReconstructOptions& options, const ShapeClass* learnt,
                                           const std::function<bool(const std::string&)>& specified);
/// As an assembly has them.
JsonValue thresholds_to_json(const std::vector<UsedThreshold>& thresholds, JsonAllocator& allocator);

/// A checksum of how many vertices there are and which of them the faces join, in their order: the same for members in
/// correspondence, wherever their vertices lie.
std::string topology_checksum(const Mesh& mesh);

/// Throws Error (input), naming both files, unless the class was learnt with a template of this mesh's triangles.
void check_topology(const ShapeClass& learnt, const std::string& class_file, const Mesh& mesh, const std::string& template_file);

}  // namespace ostraka

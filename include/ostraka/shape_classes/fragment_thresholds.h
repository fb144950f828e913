// Thresholds that distinguish fragments of one object from those of others, learnt from the members of a class.
#pragma once

#include "ostraka/reconstruction/reconstruct.h"
#include "ostraka/shape_classes/shape_class.h"

#include <functional>

namespace ostraka {

/// Quantities of one member from which the thresholds are learnt, as residuals of kind `geometry`; without a value if they
/// cannot be measured. "residual": pieces of the member (each a landmark of the template with its nearest landmarks, a quarter
/// of all and at least four) are registered by rotation and translation at the scale of all landmarks; root mean square over
/// spread, of the worst piece. "scale-tolerance": difference between the scale of a piece and that of the other landmarks, in
/// per cent, of the worst piece. "slack": the largest deviation of a constraint in per cent. The first two need eight
/// landmarks.
std::vector<ClassQuantity> fragment_quantities(const ClassTemplate& class_template, const std::vector<Point>& points,
                                               const std::vector<ClassQuantity>& quantities);

/// A threshold of `fit`, learnt from the class.
struct FragmentThreshold {
    std::string option;  ///< "residual", "scale-tolerance" or "slack"
    double value = 0;
    std::size_t members = 0;  ///< number of members it was learnt from
};
/// The thresholds for which at least three members have values.
std::vector<FragmentThreshold> fragment_thresholds(const ShapeClass& learnt);

/// A threshold applied by a verdict.
struct UsedThreshold : FragmentThreshold {
    std::string from;  ///< source: "class", "told" (given by the user) or "default"
};
/// Replaces the defaults in `options` by the thresholds of the class, but not options given by the user (`specified` tests an
/// option by name). Members do not show errors of scans and measuring, so the slack of a constraint is never below the default.
/// Returns the values of "residual", "scale-tolerance" and "slack" in effect; without a class none of them changes.
std::vector<UsedThreshold> apply_class_thresholds(ReconstructOptions& options, const ShapeClass* learnt,
                                                  const std::function<bool(const std::string&)>& specified);
/// JSON form used in assemblies.
JsonValue thresholds_to_json(const std::vector<UsedThreshold>& thresholds, JsonAllocator& allocator);

/// Checksum of the number of vertices and of the vertex indices of the faces, in order. It is equal for members in
/// correspondence, independent of vertex positions.
std::string topology_checksum(const Mesh& mesh);

/// Throws Error (input), naming both files, unless the class was learnt with a template that has the triangles of this mesh.
void check_topology(const ShapeClass& learnt, const std::string& class_file, const Mesh& mesh, const std::string& template_file);

}  // namespace ostraka

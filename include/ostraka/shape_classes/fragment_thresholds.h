// Learns, from the members of a class, thresholds that distinguish fragments of one object from fragments of different objects.
#pragma once

#include "ostraka/reconstruction/reconstruct.h"
#include "ostraka/shape_classes/shape_class.h"

#include <functional>

namespace ostraka {

/// Quantities of one member from which the thresholds are learnt, as residuals of kind `geometry`; quantities that cannot be
/// measured have no value. For the first two, the member is divided into pieces: each piece is a landmark of the template with
/// its nearest landmarks (a quarter of all landmarks, at least four). "residual": each piece is registered by rotation and
/// translation at the scale of all landmarks; the quantity is the largest root mean square residual of a piece divided by its
/// spread. "scale-tolerance": the largest difference between the scale of a piece and the scale of the other landmarks, per
/// cent. "min-tolerance": the largest deviation of a constraint, per cent. "residual" and "scale-tolerance" need eight landmarks.
std::vector<ClassQuantity> fragment_quantities(const ClassTemplate& class_template, const std::vector<Point>& points,
                                               const std::vector<ClassQuantity>& quantities);

/// A threshold of the operation `fit`, learnt from the class.
struct FragmentThreshold {
    std::string option;       ///< "residual", "scale-tolerance" or "min-tolerance"
    double value = 0;         ///< value of the option
    std::size_t members = 0;  ///< number of members from which the threshold was learnt
};
/// The learnt thresholds for which at least three members have values.
std::vector<FragmentThreshold> fragment_thresholds(const ShapeClass& learnt);

/// A threshold on which a verdict is based.
struct UsedThreshold : FragmentThreshold {
    std::string from;  ///< source of the threshold: "class", "option" (given by the user) or "default"
};
/// Replaces the defaults in `options` by the thresholds of the class, except options given by the user (`specified` returns
/// whether the user gave the option of this name). The tolerance of a constraint is never below the default, because the members
/// contain no errors of scanning and measuring. Returns the values of "residual", "scale-tolerance" and "min-tolerance" in
/// effect; without a class the options are unchanged.
std::vector<UsedThreshold> apply_class_thresholds(ReconstructOptions& options, const ShapeClass* learnt,
                                                  const std::function<bool(const std::string&)>& specified);
/// JSON of thresholds, as in assembly files.
JsonValue thresholds_to_json(const std::vector<UsedThreshold>& thresholds, JsonAllocator& allocator);

/// Checksum of the number of vertices and of the vertex indices of the faces, in order. Meshes in correspondence have equal
/// checksums, independent of vertex positions.
std::string topology_checksum(const Mesh& mesh);

/// Throws Error (input), naming both files, unless the class was learnt with a template that has the triangles of `mesh`.
void check_topology(const ShapeClass& learnt, const std::string& class_file, const Mesh& mesh, const std::string& template_file);

}  // namespace ostraka

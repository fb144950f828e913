// Reading and writing of the files of the thesis's prototype: .ant (annotations) and .fct (facets of a fragment).
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/files/file.h"

namespace ostraka {

/// The set in the prototype's .ant format: types Area, Line and Point, the key color, flat attributes. All measures must have a
/// value there (a missing one is measured on the mesh). Descriptors become texts. `notes` reports what the format cannot store:
/// negative ids, the marks of whole components, class, unit and upward direction. `read_annotations` reads such files.
std::string prototype_annotations(AnnotatedMeshView object, std::vector<std::string>& notes);

/// The regions of the set in the prototype's .fct format: label, type (external, internal or fracture, from a semantic
/// attribute "facet" or "type" with such a value, otherwise external), borders and inner vertices. The format has no place for
/// the whole object, lines, points and attributes; `notes` gives their numbers.
std::string prototype_facets(AnnotatedMeshView object, const std::string& mesh_file, std::vector<std::string>& notes);
/// Whether the annotation becomes a facet in such a file: a region other than the whole object.
bool has_facet(const Annotation& annotation);

/// Reads facets onto the mesh they were made for: regions with the label as tag and a semantic attribute "facet". The region is
/// the side of the borders that contains the inner vertices, or the left side if there are none. Throws Error (input) with
/// file, line and remedy.
AnnotationSet read_prototype_facets(const std::string& bytes, const Mesh& mesh, const std::string& where);

}  // namespace ostraka

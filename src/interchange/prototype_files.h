// Reading and writing of the files of the thesis's prototype: .ant (annotations) and .fct (facets of a fragment).
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/files/file.h"

namespace ostraka {

/// Writes a set of annotations in the prototype's .ant format, which `read_annotations` can read: types Area, Line and Point, the
/// key color, flat attributes. The format requires a value for every measure; a missing value is measured on the mesh.
/// Descriptors become texts. `notes` reports what the format cannot store: negative ids, marks of whole-object annotations,
/// class, unit and upward direction.
std::string prototype_annotations(AnnotatedMeshView object, std::vector<std::string>& notes);

/// Writes the regions of a set in the prototype's .fct format: label, type (external, internal or fracture, from a semantic
/// attribute "facet" or "type" with such a value, otherwise external), borders and inner vertices. The format cannot store the
/// whole object, lines, points and attributes; `notes` gives the number of each that was left out.
std::string prototype_facets(AnnotatedMeshView object, const std::string& mesh_file, std::vector<std::string>& notes);
/// True if the annotation becomes a facet in a .fct file: a region other than the whole object.
bool has_facet(const Annotation& annotation);

/// Reads the facets of a .fct file onto the mesh for which the file was made. A facet becomes a region with the facet's label as
/// tag and a semantic attribute "facet". The region lies on the side of the borders that contains the inner vertices, or on the
/// left side if there are no inner vertices. Throws Error (input) with file, line and remedy.
AnnotationSet read_prototype_facets(const std::string& bytes, const Mesh& mesh, const std::string& where);

}  // namespace ostraka

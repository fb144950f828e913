// Files of the thesis's prototype: .ant (annotations) and .fct (facets of a fragment), written and read.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/core/file.h"

namespace ostraka {

/// The set as the prototype's .ant: types Area, Line and Point, the key color, flat attributes. Every measure has a value there
/// (taken on the mesh if it has none). Descriptors become texts; what the format cannot hold is in `notes`: ids below zero and
/// the marks of whole components, class, unit and upward direction. `read_annotations` reads such files.
std::string prototype_annotations(const Mesh& mesh, const AnnotationSet& set, std::vector<std::string>& notes);

/// The regions of the set as the prototype's .fct: label, type (external, internal or fracture, from a semantic attribute "facet"
/// or "type" that says so, otherwise external), borders and inner vertices. The whole object, lines, points and attributes have
/// no place there; `notes` counts them.
std::string prototype_facets(const Mesh& mesh, const AnnotationSet& set, const std::string& mesh_file,
                             std::vector<std::string>& notes);
/// Has this annotation a facet in such a file? Regions have that are not the whole object.
bool has_facet(const Annotation& annotation);

/// Reads facets onto the mesh they were made for: regions with the label as tag and a semantic attribute "facet". The side of the
/// borders that holds the inner vertices is the region; without inner vertices, the side to the left. Throws Error (input) naming
/// file, line and remedy.
AnnotationSet read_prototype_facets(const std::string& bytes, const Mesh& mesh, const std::string& where);

}  // namespace ostraka

// Checks shared by the readers and writers of annotations; each error has the file, the JSON pointer and the remedy.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"

#include <string>
#include <vector>

namespace ostraka {

namespace places {
/// Throws Error (input) for the problem `what`.
[[noreturn]] void fail(const std::string& where, const std::string& pointer, const std::string& what, const std::string& remedy);
/// Throws Error (input) unless the mesh has the vertex.
void check_vertex(const Mesh& mesh, Index vertex, const std::string& where, const std::string& pointer);
/// Throws Error (input) unless the mesh has all vertices of the list at `pointer`.
void check_vertices(const Mesh& mesh, const std::vector<Index>& vertices, const std::string& where, const std::string& pointer);
/// Throws Error (input) unless the mesh has the face.
void check_face(const Mesh& mesh, Index face, const std::string& where, const std::string& pointer);
/// Throws Error (input) unless the mesh has an edge between vertices a and b.
void check_edge(const Mesh& mesh, Index a, Index b, const std::string& where, const std::string& pointer);
/// Checks a set like check_annotations; `settled`: true if the elements of free annotations have just been computed from their
/// curves.
void check_set(AnnotatedMeshView object, const std::string& where, bool settled);
}  // namespace places

/// Converts a prototype document (types Area, Line, Point; key color; flat attributes) to the thesis's format; `notes` report
/// what was guessed or dropped. Throws Error (input).
Json convert_prototype(const JsonValue& document, const std::string& where, std::vector<std::string>& notes);
bool is_prototype(const JsonValue& document);  ///< true if the document is an annotation file of the prototype

}  // namespace ostraka

// Fragments of broken objects.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/geom/rigid_fit.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace ostraka {

/// The class of a face: outer or inner surface of the object, or fracture surface.
enum class Facet : std::uint8_t { outer, inner, fracture };
std::string to_string(Facet facet);

/// A fragment with its annotations and facet classes.
struct Fragment : AnnotatedMesh {
    std::string name;           ///< name in reports
    std::vector<Facet> facets;  ///< class of each face; empty: all faces are outer surface
};

/// The facet class of a region with the tag "outer", "inner" or "fracture" (case-insensitive); none for any other annotation.
std::optional<Facet> named_facet(const Annotation& annotation);

/// The facet class of each face, from annotations that name a facet (`named_facet`); all other faces get the class `other`.
/// Throws Error (input) if two annotations that name facets share a face.
std::vector<Facet> facets_of(AnnotatedMeshView object, Facet other = Facet::outer);

/// A copy of the mesh, moved by a rigid motion.
Mesh moved(const Mesh& mesh, const Motion& motion);
/// A copy of the mesh, scaled about the origin.
Mesh scaled_by(const Mesh& mesh, double scale);

/// For each face: true if the face is intact surface (not fracture); empty if `facets` is empty.
std::vector<bool> intact_faces(const std::vector<Facet>& facets);

}  // namespace ostraka

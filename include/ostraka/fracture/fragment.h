// A scanned fragment of an object.
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

struct Fragment : AnnotatedMesh {
    std::string name;
    std::vector<Facet> facets;  ///< per face; empty: all outer
};

/// The facet that the tag of a region names: "outer", "inner" or "fracture" (case-insensitive); none for any other annotation.
std::optional<Facet> named_facet(const Annotation& annotation);

/// Facets from annotations (`named_facet`); faces in none of them are `other`. Throws Error (input) if two such annotations
/// share a face.
std::vector<Facet> facets_of(AnnotatedMeshView object, Facet other = Facet::outer);

/// The mesh moved, or scaled about the origin.
Mesh moved(const Mesh& mesh, const Motion& motion);
Mesh scaled_by(const Mesh& mesh, double scale);

/// Per face, whether it is intact surface; empty where all are outer.
std::vector<bool> intact_faces(const std::vector<Facet>& facets);

}  // namespace ostraka

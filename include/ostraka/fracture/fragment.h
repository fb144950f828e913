// A scanned fragment of an object.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/geom/rigid_fit.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace ostraka {

/// What a face of a fragment was: of the object's outer or inner surface, or of the break.
enum class Facet : std::uint8_t { outer, inner, fracture };
std::string to_string(Facet facet);

struct Fragment {
    std::string name;
    Mesh mesh;
    AnnotationSet annotations;
    std::vector<Facet> facets;  ///< of each face; empty: all outer
};

/// What a region's tag calls it: "outer", "inner" or "fracture" (capital letters or not); none for any other annotation.
std::optional<Facet> named_facet(const Annotation& annotation);

/// Facets as annotations say (`named_facet`); faces in none of them are `other`. Throws Error (input) where two of them share a
/// face.
std::vector<Facet> facets_of(const Mesh& mesh, const AnnotationSet& set, Facet other = Facet::outer);

/// The mesh moved, or scaled about the origin.
Mesh moved(const Mesh& mesh, const Motion& motion);
Mesh scaled_by(const Mesh& mesh, double scale);

/// Of each face whether it is none of the break; empty where all are outer.
std::vector<bool> not_broken(const std::vector<Facet>& facets);

}  // namespace ostraka

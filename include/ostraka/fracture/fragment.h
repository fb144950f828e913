// A scanned fragment of an object.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/geom/rigid_fit.h"

#include <cstdint>
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

/// Facets as annotations say: regions with the tag "outer", "inner" or "fracture" (capital letters or not); faces in none are
/// `other`. Throws Error (input) where two of them share a face.
std::vector<Facet> facets_of(const Mesh& mesh, const AnnotationSet& set, Facet other = Facet::outer);

/// The mesh moved.
Mesh moved(const Mesh& mesh, const Motion& motion);

}  // namespace ostraka

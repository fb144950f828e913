// Fragments with known fracture faces: objects broken by simulation, and scanned fragments in assembled layout.
#pragma once

#include "shatter.h"

#include <cstdint>
#include <string>
#include <vector>

namespace ostraka::experiments {

struct FacetCase : Sherd {
    std::string object, name;
    bool scanned = false;
    std::vector<bool> known;  ///< per face: whether `broken` is certain; empty: all
};

/// `source`:
///     pot:SEED, thin:SEED     a vessel, or one with thin walls
///     stone:SEED              a block, boulder, head or figure, stretched, possibly with a carved or worn surface
///     made:NAME:SEED          a synthetic object (synthetic/synthetic_object.h)
///     mesh:FILE:SEED          an object of a mesh file, possibly stretched, rounded, with a flat base or another surface;
///     holes are filled
///     ...:whole               not broken
///     FOLDER                  scanned fragments in assembled layout: fracture is what lies close to and faces another fragment
/// The seed determines numbers of pieces, materials, meshes, wear and noise; a few are surfaces reconstructed from point
/// clouds. Throws Error if an object cannot be broken.
std::vector<FacetCase> facet_cases(const std::string& source);
/// A name shared by all sources of one object, however it is broken or scanned: they are left out together.
std::string object_of_source(const std::string& source);

}  // namespace ostraka::experiments

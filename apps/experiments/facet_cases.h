// Fragments whose breaks are known, face by face: objects broken on the computer, and scanned ones in assembled layout.
#pragma once

#include "ostraka/core/mesh.h"

#include <cstdint>
#include <string>
#include <vector>

namespace ostraka::experiments {

struct FacetCase {
    std::string object, name;
    Mesh mesh;
    std::vector<bool> broken;  ///< of each face
    bool scanned = false;
    std::vector<bool> known;  ///< of each face: whether `broken` is certain; empty: all
};

/// `source`:
///     pot:SEED, thin:SEED     a vessel, or one with thin walls
///     stone:SEED              a block, boulder, head or figure, stretched, perhaps with a carved or worn skin
///     made:NAME:SEED          a made object (synthetic/synthetic_object.h)
///     mesh:FILE:SEED          an object of a mesh file, perhaps stretched, rounded, with a flat end or another skin; holes are
///     filled
///     ...:whole               not broken at all
///     FOLDER                  scanned fragments in assembled layout: what lies close to another one and faces it is broken
/// The seed decides on numbers of pieces, materials, meshes, wear and noise; a few come as clouds of points that a surface was
/// made through. Throws Error where an object cannot be broken.
std::vector<FacetCase> facet_cases(const std::string& source);
/// What names all sources of one object, however it is broken or scanned: those are left out together.
std::string object_of_source(const std::string& source);

/// Of a folder.
std::vector<FacetCase> scanned_cases(const std::string& folder);
/// `bare`: its skin stays as it is.
Mesh whole_object(const std::string& kind, const std::string& name, std::uint64_t seed, bool bare);
/// Edges rounded all over, as by long use or by the filter of a scan.
Mesh rounded(const Mesh& mesh, int steps);

}  // namespace ostraka::experiments

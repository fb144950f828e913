// Triangle meshes of synthetic objects at any resolution, with the true part of every face and vertex.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/synthetic/synthetic_object.h"

#include <cstdint>
#include <vector>

namespace ostraka {

struct MakeOptions {
    std::uint64_t vertices = 10000;  ///< wanted; met to 1 %, nearly always exactly
    std::uint64_t seed = 1;          ///< turns and shifts the lattice, so that seeds give independent meshes of one object
    double noise = 0;                ///< vertices are moved along the normal by up to this share of the mean edge length

    void describe(OptionList& visit);
};

struct SyntheticMesh {
    Mesh mesh;                              ///< closed, oriented, manifold, of the object's genus
    std::vector<std::int32_t> face_labels;  ///< part at the face's centroid carried onto the surface; crumbs of up to three faces
                                            ///< join their surroundings
    std::vector<std::int32_t> vertex_labels;  ///< part at the vertex (before noise)
};

/// Meshes the object's surface with triangles of even size. Time and memory grow linearly with the number of vertices.
/// Throws Error (usage) if the options are out of range or the object cannot be held by so few vertices.
SyntheticMesh make_mesh(const SyntheticObject& object, const MakeOptions& options = {});

}  // namespace ostraka

// Triangle meshes of synthetic objects at any resolution, with ground truth part labels of faces and vertices.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/synthetic/synthetic_object.h"

#include <cstdint>
#include <vector>

namespace ostraka {

struct MakeOptions {
    std::uint64_t vertices = 10000;  ///< target number; reached to 1 %, nearly always exactly
    std::uint64_t seed = 1;          ///< rotates and shifts the lattice, so that seeds give independent meshes of one object
    double noise = 0;                ///< maximum displacement of vertices along the normal, relative to the mean edge length

    void list_options(OptionList& list);
};

struct SyntheticMesh {
    Mesh mesh;  ///< closed, oriented, manifold, of the object's genus
    /// Part at the projection of the face's centroid; patches of up to three faces join their surroundings.
    std::vector<std::int32_t> face_labels;
    std::vector<std::int32_t> vertex_labels;  ///< part at the vertex (before noise)
};

/// Meshes the object's surface with triangles of uniform size. Time and memory are linear in the number of vertices. Throws
/// Error (usage) if the options are out of range or the object needs more vertices.
SyntheticMesh make_mesh(const SyntheticObject& object, const MakeOptions& options = {});

}  // namespace ostraka

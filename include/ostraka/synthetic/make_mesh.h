// Triangle meshes of synthetic objects at any resolution, with ground truth part labels of their faces and vertices.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/synthetic/synthetic_object.h"

#include <cstdint>
#include <vector>

namespace ostraka {

struct MakeOptions {
    /// Target number of vertices; the result differs by at most 1 % and is nearly always exact.
    std::uint64_t vertices = 10000;
    std::uint64_t seed = 1;  ///< random seed; rotates and shifts the lattice, so that seeds give independent meshes of one object
    double noise = 0;        ///< max displacement of a vertex along its normal, as a share of the mean edge length

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// Mesh of a synthetic object with its part labels.
struct SyntheticMesh {
    Mesh mesh;  ///< closed, oriented, manifold, with the genus of the object
    /// For each face, the label of the part at the projection of its centroid onto the surface; isolated patches of up to three
    /// faces get the label of their surroundings.
    std::vector<std::int32_t> face_labels;
    std::vector<std::int32_t> vertex_labels;  ///< for each vertex, the label of the part at its position before noise was added
};

/// Meshes the surface of a synthetic object with triangles of uniform size. Time and memory are linear in the number of vertices.
/// Throws Error (usage) if the options are out of range or the object needs more vertices.
SyntheticMesh make_mesh(const SyntheticObject& object, const MakeOptions& options = {});

}  // namespace ostraka

// Synthetic fragments of a mesh, with known pose and position on the object.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/geom/rigid_fit.h"
#include "ostraka/mesh/mesh.h"

#include <vector>

namespace ostraka {

struct FragmentOptions {
    double share = 0.25;     ///< fraction of the surface area
    double roughness = 0.1;  ///< amplitude of the waves of the fracture line, relative to the fragment's size
    double noise = 0;  ///< standard deviation of the vertex displacement along the normal, relative to the diagonal of the object
    double erosion = 0;  ///< width of the eroded strip along the fracture, relative to the diagonal of the object
    bool moved = true;   ///< apply a random rigid motion
    std::uint64_t seed = 1;

    void list_options(OptionList& list);
};

struct SyntheticFragment {
    Mesh mesh;                    ///< a single piece, open at the fracture
    std::vector<Index> vertices;  ///< one per vertex: index of the vertex of the object
    std::vector<Index> faces;     ///< one per face: index of the face of the object
    Motion pose;                  ///< motion from the piece back to the object
};

/// Selects the faces nearest to `centre`, by a distance distorted by random waves, until they cover the requested share of the
/// area, and keeps the connected piece that contains the nearest face. Then removes the eroded strip along the fracture and
/// applies noise and motion. Throws Error (input) for a mesh without area, (usage) for options out of range, (failure) if
/// nothing is left.
SyntheticFragment generate_fragment(const Mesh& object, const Point& centre, const FragmentOptions& options = {});

}  // namespace ostraka

// Generates fragments of a mesh, with known pose and known position on the object.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/geom/rigid_fit.h"
#include "ostraka/mesh/mesh.h"

#include <vector>

namespace ostraka {

struct FragmentOptions {
    double share = 0.25;     ///< share of the object's surface area that the fragment covers
    double roughness = 0.1;  ///< amplitude of the waves of the fracture line, as a share of the fragment's size
    double noise = 0;    ///< standard deviation of the vertex displacement along the normal, as a share of the object's diagonal
    double erosion = 0;  ///< width of the eroded strip along the fracture, as a share of the object's diagonal
    bool moved = true;   ///< true: apply a random rigid motion to the fragment
    std::uint64_t seed = 1;  ///< random seed

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// A generated fragment with its ground truth.
struct SyntheticFragment {
    Mesh mesh;                    ///< a single connected piece, open at the fracture
    std::vector<Index> vertices;  ///< for each vertex of `mesh`, index of the vertex of the object
    std::vector<Index> faces;     ///< for each face of `mesh`, index of the face of the object
    Motion pose;                  ///< motion from the fragment back to the object
};

/// Generates a fragment: selects the faces nearest to `centre`, by a distance distorted by random waves, until they cover the
/// requested share of the area, and keeps the connected piece that contains the nearest face. Then removes the eroded strip along
/// the fracture and applies noise and motion. Throws Error (input) for a mesh without area, (usage) for options out of range,
/// (failure) if no face remains.
SyntheticFragment generate_fragment(const Mesh& object, const Point& centre, const FragmentOptions& options = {});

}  // namespace ostraka

// Fragments of a mesh whose pose and place on the whole are known exactly.
#pragma once

#include "ostraka/core/mesh.h"
#include "ostraka/core/options.h"
#include "ostraka/geom/rigid_fit.h"

#include <vector>

namespace ostraka {

struct BreakOptions {
    double share = 0.25;     ///< of the surface
    double roughness = 0.1;  ///< of the break: waves of its line, as a share of the fragment's size
    double noise = 0;        ///< standard deviation of each vertex along its normal, as a share of the whole's diagonal
    double erosion = 0;      ///< width of the rim that is worn away, as a share of the whole's diagonal
    bool moved = true;       ///< turned and shifted at random
    std::uint64_t seed = 1;

    void describe(OptionList& visit);
};

struct BrokenPiece {
    Mesh mesh;                    ///< one piece, open where it broke
    std::vector<Index> vertices;  ///< of the whole, for each vertex
    std::vector<Index> faces;     ///< of the whole, for each face
    Motion pose;                  ///< from the piece back onto the whole
};

/// The faces nearest to `centre`, in distances that waves of chance stretch, until they have the share of the area (the piece
/// that holds the nearest face); then what lies near the break is taken away; then noise and motion. Throws Error (input) for a
/// mesh without area, (usage) for options out of range, (failure) where nothing is left.
BrokenPiece break_off(const Mesh& whole, const Point& centre, const BreakOptions& options = {});

}  // namespace ostraka

// A synthetic vessel, broken into sherds whose places, neighbours and facets are known exactly.
#pragma once

#include "ostraka/core/mesh.h"
#include "ostraka/core/options.h"

#include <cstdint>
#include <vector>

namespace ostraka {

struct PotOptions {
    double height = 20;       ///< about, in any unit
    double radius = 7;        ///< of the body, about
    double wall = 0.6;        ///< thickness
    double edge = 0.35;       ///< of the triangles
    std::uint64_t shape = 1;  ///< one number a shape
    void describe(OptionList& visit);
};

/// A thrown vessel with a floor about the vertical axis: closed, oriented outwards. Throws Error (usage) for options out of
/// range, or a wall thicker than half of the radius.
Mesh make_pot(const PotOptions& options = {});

struct ShatterOptions {
    int pieces = 6;           ///< at least so many; a cut may part more than one
    double roughness = 0.02;  ///< height of the breaks' waves, as a share of the piece's extent
    double erosion = 0;       ///< what is worn off breaks, and rounded at their edges, as a share of the whole's diagonal
    double noise = 0;         ///< standard deviation of each vertex along its normal, as a share of the whole's diagonal
    std::uint64_t seed = 1;
    void describe(OptionList& visit);
};

/// A piece of a closed mesh, where it was.
struct Sherd {
    Mesh mesh;                 ///< closed
    std::vector<bool> broken;  ///< of each face: of a break
};

/// The largest piece is cut in two by a rough sheet through its middle, across a direction of chance, until there are enough;
/// what a cut parts is a piece each. Throws Error (input) for a mesh that is not closed, (failure) where a cut cannot be made.
std::vector<Sherd> shatter(const Mesh& whole, const ShatterOptions& options = {});

}  // namespace ostraka

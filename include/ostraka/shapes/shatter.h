// A made vessel, broken into sherds whose places, neighbours and facets are known exactly.
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
    template <class Visitor>
    void describe(Visitor& visit) {
        visit("height", height, "of the vessel", Range{1e-9, 1e9});
        visit("radius", radius, "of the body", Range{1e-9, 1e9});
        visit("wall", wall, "thickness of the wall", Range{1e-9, 1e9});
        visit("edge", edge, "length of the triangles' edges", Range{1e-9, 1e9});
        visit("shape", shape, "of the profile: another number is another vessel", Range{0, 9007199254740992.0});
    }
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
    template <class Visitor>
    void describe(Visitor& visit) {
        visit("pieces", pieces, "at least so many pieces", Range{1, 1000});
        visit("roughness", roughness, "height of the breaks' waves, share of the piece's extent", Range{0, 0.2});
        visit("erosion", erosion, "what is worn off breaks and their edges, share of the diagonal", Range{0, 0.1});
        visit("noise", noise, "standard deviation along the normal, share of the diagonal", Range{0, 0.1});
        visit("seed", seed, "of cuts and noise", Range{0, 9007199254740992.0});
    }
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

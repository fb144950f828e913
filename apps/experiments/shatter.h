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

/// The mesh with a surface that is not smooth: vertices moved along their normals by waves, the longest of `longest`, the
/// shortest a tenth of it, of `height` (root mean square) altogether; both are shares of the diagonal. Keep the height well below
/// the wall.
Mesh with_relief(const Mesh& mesh, double height, double longest, std::uint64_t seed);

struct ShatterOptions {
    int pieces = 6;           ///< at least so many; a cut may part more than one
    double roughness = 0.02;  ///< height of the breaks' waves, as a share of the piece's extent
    double hurst = 0.5;       ///< a wave's height goes with its length to this power: low is grainy, high is shell-like
    double finest = 0.06;     ///< shortest wave of a break, as a share of the piece's extent
    double streak = 0;   ///< how far a break's waves run one way: 0 every way, 1 all the same, as in what is layered or fibrous
    double bow = 0;      ///< how far a break arches or dishes at a piece's extent from its middle, at most, as a share of it
    double sheet = 0;    ///< edge of the breaks' facets, as a share of the piece's extent; 0: as fine as the mesh
    double edge = 0;     ///< of each sherd's triangles, meshed by itself, as a share of the whole's diagonal; 0: as cut
    double erosion = 0;  ///< what is worn off breaks, and rounded at their edges, as a share of the whole's diagonal
    double patchiness = 0;  ///< how far erosion differs over the surface: 0 not at all, 1 from none to twice as much
    double noise = 0;       ///< standard deviation of each vertex along its normal, as a share of the whole's diagonal
    std::uint64_t seed = 1;
    void describe(OptionList& visit);
};

/// A piece of a closed mesh, where it was.
struct Sherd {
    Mesh mesh;                 ///< closed
    std::vector<bool> broken;  ///< of each face: of a break; of a sherd meshed anew: whether the nearest face as cut is
};

/// The largest piece is cut in two by a rough sheet through its middle, across a direction of chance, until there are enough;
/// what a cut parts is a piece each. Then each may be meshed anew (mating faces share vertices and edges before that), is worn,
/// and noise is added. Throws Error (input) for a mesh that is not closed, (failure) where a cut cannot be made.
std::vector<Sherd> shatter(const Mesh& whole, const ShatterOptions& options = {});

/// With at most so many vertices, as where an archive wants scans small; facets are those of the nearest faces.
Sherd simplified(const Sherd& sherd, std::uint64_t vertices);

}  // namespace ostraka

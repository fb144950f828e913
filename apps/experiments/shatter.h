// A synthetic vessel, broken into sherds with exactly known positions, neighbours and facets.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/mesh/mesh.h"

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace ostraka {

struct PotOptions {
    double height = 20;       ///< approximate, in any unit
    double radius = 7;        ///< approximate, of the body
    double wall = 0.6;        ///< thickness
    double edge = 0.35;       ///< edge length of the triangles
    std::uint64_t shape = 1;  ///< random seed of the shape
    void declare_options(OptionList& list);
};

/// A wheel-thrown vessel with a floor, about the vertical axis: closed, oriented outwards. Throws Error (usage) for options out
/// of range, or a wall thicker than half of the radius.
Mesh make_pot(const PotOptions& options = {});

/// Adds relief to the surface: displaces vertices along their normals by waves with lengths from `longest` to a tenth of it and
/// total root mean square `height`; both are shares of the diagonal. The height should be much smaller than the wall thickness.
Mesh with_relief(const Mesh& mesh, double height, double longest, std::uint64_t seed);

struct ShatterOptions {
    int pieces = 6;           ///< min number of pieces; a cut may separate more than one
    double roughness = 0.02;  ///< height of the fracture's waves, as a share of the piece's extent
    double hurst = 0.5;       ///< Hurst exponent of the waves, height ~ length^hurst: low is grainy, high is shell-like
    double finest = 0.06;     ///< shortest wave of a fracture, as a share of the piece's extent
    double streak = 0;        ///< anisotropy of the waves: 0 isotropic, 1 parallel, as in layered or fibrous materials
    double bow = 0;      ///< max curvature height of a fracture at the piece's extent from its centre, as a share of the extent
    double sheet = 0;    ///< edge length of the fracture's facets, as a share of the piece's extent; 0: as fine as the mesh
    double edge = 0;     ///< edge length of each sherd after separate remeshing, as a share of the whole's diagonal; 0: as cut
    double erosion = 0;  ///< depth removed from fractures, with rounded edges, as a share of the whole's diagonal
    double patchiness = 0;  ///< variation of erosion over the surface: 0 none, 1 from zero to double
    double noise = 0;       ///< standard deviation of vertices along their normals, as a share of the whole's diagonal
    std::uint64_t seed = 1;
    void declare_options(OptionList& list);
};

/// A piece of a closed mesh, in its original position.
struct Sherd {
    Mesh mesh;                 ///< closed
    std::vector<bool> broken;  ///< per face: belongs to a fracture; after remeshing: whether the nearest original face does
};

/// Repeatedly cuts the largest piece with a rough sheet through its centre in a random direction until there are enough pieces;
/// each connected component is a piece. Then each piece is optionally remeshed (before that, mating faces share vertices and
/// edges), worn, and noise is added. Throws Error (input) for a mesh that is not closed, (failure) if a cut fails.
std::vector<Sherd> shatter(const Mesh& whole, const ShatterOptions& options = {});

/// Centre of gravity of a surface.
Eigen::Vector3d surface_centre(const Mesh& mesh);
/// Per face of another mesh of the sherd, whether the nearest face of the sherd belongs to a fracture.
std::vector<bool> broken_of_nearest(const Mesh& mesh, const Sherd& sherd);
/// Simplifies to at most `vertices` vertices, as small scans in archives; facets are those of the nearest faces.
Sherd simplified(const Sherd& sherd, std::uint64_t vertices);

}  // namespace ostraka

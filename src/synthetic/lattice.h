// Closed triangle meshes of implicit surfaces by marching tetrahedra on a body-centred cubic lattice.
#pragma once

#include "ostraka/core/mesh.h"
#include "ostraka/synthetic/synthetic_object.h"

#include <Eigen/Geometry>

namespace ostraka::shapes {

/// The lattice's frame and the length of its cubes' edges.
struct Lattice {
    Eigen::Matrix3d rotation;
    Eigen::Vector3d origin;
    double cube;
};

/// A plain mesh: points and triangles, counter-clockwise seen from outside.
struct Triangles {
    std::vector<Eigen::Vector3d> points;
    std::vector<std::array<Index, 3>> faces;
};

double area(const Triangles& mesh);

/// Vertices that the lattice gives on a surface of one unit of area when its cubes have edge 1: the mean number of its
/// edges that a unit of area cuts (8 of length sqrt(3)/2 and 6 of length 1 a cube, each seen at half its length).
inline constexpr double lattice_vertices_per_area = 6.4641016151377546;

/// Triangulates the surface; every edge has exactly two triangles whatever the function, and vertices lie on the surface
/// (on lattice edges). Blocks far from the surface are skipped by the bound on the function's slope: work and memory grow with
/// the area only. The seed turns and shifts the lattice. Same result for any number of threads.
Triangles march(const SyntheticObject& object, const Lattice& lattice);

/// Frame turned and shifted by the seed.
Lattice seeded_lattice(const SyntheticObject& object, double cube, std::uint64_t seed);

}  // namespace ostraka::shapes

// Closed triangle meshes of implicit surfaces by marching tetrahedra on a body-centred cubic lattice.
#pragma once

#include "ostraka/mesh/mesh.h"
#include "ostraka/synthetic/synthetic_object.h"

#include <Eigen/Geometry>

namespace ostraka::shapes {

/// Coordinate system of a lattice, and the edge length of its cubes.
struct Lattice {
    Eigen::Matrix3d rotation;
    Eigen::Vector3d origin;
    double cube;  ///< edge length of the cubes
};

/// A triangle soup: points and triangles, counter-clockwise seen from outside.
struct Triangles {
    std::vector<Eigen::Vector3d> points;
    std::vector<std::array<Index, 3>> faces;
};

double area(const Triangles& mesh);  ///< total area of the triangles

/// Number of vertices on a surface of unit area for a lattice of cubes with edge length 1: the mean number of lattice edges that
/// intersect a unit of area (8 edges of length sqrt(3)/2 and 6 of length 1 per cube, each with half its length in projection).
inline constexpr double lattice_vertices_per_area = 6.4641016151377546;

/// Triangulates the surface of an object. Every edge has exactly two triangles for any function, and vertices lie on the surface
/// (on lattice edges). Blocks far from the surface are skipped by the bound on the function's slope: time and memory are
/// proportional to the area. The result does not depend on the number of threads.
Triangles march(const SyntheticObject& object, const Lattice& lattice);

/// A lattice with cubes of this edge length, rotated and shifted at random by the seed.
Lattice seeded_lattice(const SyntheticObject& object, double cube, std::uint64_t seed);

}  // namespace ostraka::shapes

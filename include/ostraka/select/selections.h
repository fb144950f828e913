// Selections by geometry and topology, used by recipes and tools; results are lists of indices or one flag per face.
#pragma once

#include "ostraka/geom/shortest_path.h"
#include "ostraka/mesh/mesh.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace ostraka {

/// A part of space: a function that is true for points inside.
using Volume = std::function<bool(const Point&)>;
Volume box_volume(const Point& min, const Point& max);              ///< closed box
Volume sphere_volume(const Point& centre, double radius);           ///< closed ball
Volume halfspace_volume(const Point& point, const Vector& normal);  ///< closed half-space on the side that the normal points to

/// For each face, whether its centroid lies in the volume.
std::vector<bool> faces_within(const Mesh& mesh, const Volume& volume);
/// Indices of the vertices within the volume that have a face, ascending.
std::vector<Index> vertices_within(const Mesh& mesh, const Volume& volume);

/// The vertex with a face that is nearest to the point; ties go to the lower index. Takes linear time. Throws Error (input) on a
/// mesh without faces.
Index nearest_vertex(const Mesh& mesh, const Point& point);
/// The face nearest to the point; ties go to the lower index. Takes linear time. Throws Error (input) on a mesh without faces.
Index nearest_face(const Mesh& mesh, const Point& point);

/// For each face, whether it is connected with `seed` across edges; if `within` is not empty, through faces marked in `within`
/// only (which must include the seed).
std::vector<bool> component_of(const Mesh& mesh, Index seed, const std::vector<bool>& within = {});

/// The vertices along shortest edge paths through the picked vertices in turn. A closed path repeats the first vertex at the end,
/// and its legs avoid one another where possible. Successive equal picks count once. Throws Error (input), starting with `where`,
/// if two picks are not connected, or if fewer than two picks (closed: three) are distinct.
std::vector<Index> path_through(const Mesh& mesh, const std::vector<Index>& picks, bool closed, PathMetric metric,
                                const std::string& where);

/// For each face, whether it is reached from `seed` without crossing the closed path through the picks, whose legs avoid one
/// another where possible. `seed_point`: position of the seed in its face, if known. Throws Error (input), starting with `where`,
/// if there is no closed path, if the path crosses itself, if the path does not separate the seed's side from the rest, or if the
/// seed lies on the path or on another component of the mesh.
std::vector<bool> lasso(const Mesh& mesh, const std::vector<Index>& picks, Index seed, PathMetric metric,
                        const std::string& where, const std::optional<Point>& seed_point = {});

}  // namespace ostraka

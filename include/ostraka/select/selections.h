// The selections that recipes (and later tools) are made of: plain geometry and topology in, indices or flags out.
#pragma once

#include "ostraka/core/mesh.h"
#include "ostraka/geom/shortest_path.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace ostraka {

/// A part of space.
using Volume = std::function<bool(const Point&)>;
Volume box_volume(const Point& min, const Point& max);              ///< borders belong to it
Volume sphere_volume(const Point& centre, double radius);           ///< border belongs to it
Volume halfspace_volume(const Point& point, const Vector& normal);  ///< the side the normal points to, with the plane

/// Faces whose centroid lies in the volume.
std::vector<bool> faces_within(const Mesh& mesh, const Volume& volume);
/// Vertices (those that have a face) within the volume, ascending.
std::vector<Index> vertices_within(const Mesh& mesh, const Volume& volume);

/// The nearest vertex that has a face; ties go to the lower index. Linear. Throws Error (input) on a mesh without faces.
Index nearest_vertex(const Mesh& mesh, const Point& point);
/// The face with the nearest point; ties go to the lower index. Linear. Throws Error (input) on a mesh without faces.
Index nearest_face(const Mesh& mesh, const Point& point);

/// The faces connected with `seed` over edges; those of `within` only, which holds the seed, where that is not empty.
std::vector<bool> component_of(const Mesh& mesh, Index seed, const std::vector<bool>& within = {});

/// The vertices along shortest edge paths through the picked vertices in turn; closed: first = last, and legs avoid one another
/// where they can. Equal successive picks count
/// once. Throws Error (input), starting with `where`, if two picks are not connected or less than two (closed: three) differ.
std::vector<Index> path_through(const Mesh& mesh, const std::vector<Index>& picks, bool closed, PathMetric metric,
                                const std::string& where);

/// The faces reached from `seed` without crossing the closed path through the picks. Legs avoid one another where they can.
/// `seed_point` is where in its face the seed is, if that is known. Throws Error (input) if there is no closed path, if it
/// crosses itself, if it does not separate the seed's side from the rest, if the seed lies on it, or on another part of the mesh.
std::vector<bool> lasso(const Mesh& mesh, const std::vector<Index>& picks, Index seed, PathMetric metric,
                        const std::string& where, const std::optional<Point>& seed_point = {});

}  // namespace ostraka

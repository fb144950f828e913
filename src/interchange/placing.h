// Maps points given by coordinates to a mesh.
#pragma once

#include "ostraka/geom/point_tree.h"
#include "ostraka/geom/shortest_path.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/interchange/landmarks.h"
#include "ostraka/mesh/mesh.h"

#include <memory>
#include <string>
#include <vector>

namespace ostraka::interchange {

/// Where a point was placed on the mesh.
struct Placed {
    Index vertex = no_index;  ///< the closest vertex
    double to_vertex = 0;     ///< distance of the point from the vertex
    double to_surface = 0;    ///< distance of the point from the surface
};

/// Finds the elements of a mesh that represent points given by coordinates.
class Placer {
public:
    explicit Placer(const Mesh& mesh);

    [[nodiscard]] const Mesh& mesh() const { return mesh_; }
    [[nodiscard]] double diagonal() const { return surface_.diagonal(); }  ///< diagonal of the mesh's bounding box
    /// Places a point at the closest vertex that has a face (the lower index at equal distance).
    [[nodiscard]] Placed place(const Point& point) const;
    /// The point of the surface closest to `point`.
    [[nodiscard]] SurfaceHit nearest(const Point& point) const { return surface_.closest(point); }

    /// The vertices of a path along edges through the picked vertices; consecutive repeats of a pick are ignored and
    /// back-tracking steps are dropped. If `closed`, the first vertex is repeated at the end. If all picks are equal, the path is
    /// one vertex. Throws Error (input), starting with `where`, if two picks are not connected.
    std::vector<Index> vertex_path(const std::vector<Index>& picks, bool closed, const std::string& where);

    /// One flag per face: true for the faces to the left of closed paths, by winding number; if there are several solutions, the
    /// solution whose area is closest to `area`. All flags are false if the paths are not a boundary.
    [[nodiscard]] std::vector<bool> fill(const std::vector<std::vector<Index>>& vertex_paths, double area) const;
    /// One flag per face: true in the connected component of `face`.
    [[nodiscard]] std::vector<bool> component(Index face) const;

private:
    const Mesh& mesh_;
    SurfaceSearch surface_;
    std::vector<Index> vertices_;  ///< indices of the vertices that have a face
    PointTree points_;             ///< search tree of the entries of `vertices_`
    std::unique_ptr<PathSearch> paths_;
};

/// Builds a set of annotations from `native` (the JSON of an annotation file without list and header) and `list` (the JSON of the
/// annotations). `about` may contain the class, the unit and the upward direction. Measures are recomputed unless `same_mesh` is
/// true: the file was made for this mesh.
PlacedAnnotations placed_annotations(Json& native, JsonValue list, const JsonValue* about, const Mesh& mesh,
                                     const std::string& where, bool same_mesh, std::vector<std::string> notes,
                                     std::vector<PlacedAnnotation> placements);

}  // namespace ostraka::interchange

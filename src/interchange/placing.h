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

struct Placed {
    Index vertex = no_index;
    double to_vertex = 0;
    double to_surface = 0;
};

class Placer {
public:
    explicit Placer(const Mesh& mesh);

    [[nodiscard]] const Mesh& mesh() const { return mesh_; }
    [[nodiscard]] double diagonal() const { return surface_.diagonal(); }
    /// The nearest vertex that has a face; the lower index if equally near.
    [[nodiscard]] Placed place(const Point& point) const;
    /// The nearest point of the surface.
    [[nodiscard]] SurfaceHit nearest(const Point& point) const { return surface_.closest(point); }

    /// The vertices of an edge path through the picked vertices; consecutive repeats of a pick are ignored and back-tracking
    /// steps are dropped. If closed, the first vertex is repeated at the end. One vertex if all picks are equal. Throws Error
    /// (input), starting with `where`, if two picks are not connected.
    std::vector<Index> vertex_path(const std::vector<Index>& picks, bool closed, const std::string& where);

    /// The faces to the left of closed paths, by winding number; if there are several solutions, the one whose area is nearest
    /// to `area`. All false if the paths are not a boundary.
    [[nodiscard]] std::vector<bool> fill(const std::vector<std::vector<Index>>& vertex_paths, double area) const;
    [[nodiscard]] std::vector<bool> component(Index face) const;

private:
    const Mesh& mesh_;
    SurfaceSearch surface_;
    std::vector<Index> vertices_;  ///< vertices that have a face
    PointTree points_;             ///< tree of these vertices
    std::unique_ptr<PathSearch> paths_;
};

/// Builds the set from `native` (an annotation file without its list and header) and `list` (its annotations). `about` may
/// contain the class, the unit and the upward direction. Measures are recomputed if the mesh is not the one they were measured
/// on.
PlacedAnnotations placed_annotations(Json& native, JsonValue list, const JsonValue* about, const Mesh& mesh,
                                     const std::string& where, bool same_mesh, std::vector<std::string> notes,
                                     std::vector<PlacedAnnotation> placements);

}  // namespace ostraka::interchange

// Places given by coordinates, found again on a mesh.
#pragma once

#include "ostraka/core/mesh.h"
#include "ostraka/geom/point_tree.h"
#include "ostraka/geom/shortest_path.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/interchange/landmarks.h"

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
    /// At the nearest vertex that has a face, of equally near ones that of the lower index.
    [[nodiscard]] Placed place(const Point& point) const;
    /// The nearest point of the surface.
    [[nodiscard]] SurfaceHit nearest(const Point& point) const { return surface_.closest(point); }

    /// The vertices along the mesh from pick to pick, successive ones joined by edges; repeated picks count once and steps back
    /// and forth are dropped. Closed: the first stands at the end again. One vertex if all picks are the same. Throws Error
    /// (input), starting with `where`, if two picks are not connected.
    std::vector<Index> vertex_path(const std::vector<Index>& picks, bool closed, const std::string& where);

    /// The faces to the left of closed paths, by winding number; of several answers the one nearest to `area`. Empty flags where
    /// the paths bound nothing.
    [[nodiscard]] std::vector<bool> fill(const std::vector<std::vector<Index>>& vertex_paths, double area) const;
    [[nodiscard]] std::vector<bool> component(Index face) const;

private:
    const Mesh& mesh_;
    SurfaceSearch surface_;
    std::vector<Index> vertices_;  ///< that have a face
    PointTree points_;             ///< of those
    std::unique_ptr<PathSearch> paths_;
};

/// The set of `native`, an annotation file without its list and head, and of `list`, its annotations. `about` may carry the
/// class, the unit and the way up. Measures are taken anew where the mesh is not the one they were taken on.
PlacedAnnotations placed_annotations(Json& native, JsonValue list, const JsonValue* about, const Mesh& mesh,
                                     const std::string& where, bool same_mesh, std::vector<std::string> notes,
                                     std::vector<PlacedAnnotation> placements);

}  // namespace ostraka::interchange

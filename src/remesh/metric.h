// Cost of a collapse and position of the remaining vertex.
#pragma once

#include "ostraka/remesh/simplify.h"

#include <memory>
#include <optional>

namespace ostraka {

/// Coordinates in which the bounding box of the mesh is centred and its diagonal has length one, so that costs do not depend on
/// the unit and position of the mesh.
struct Frame {
    Vector centre{0, 0, 0};  ///< centre of the bounding box
    double size = 1;         ///< diagonal of the bounding box
    /// Coordinates of a point in the frame.
    [[nodiscard]] Vector local(const Point& p) const { return (p - CGAL::ORIGIN - centre) / size; }
    /// Point of the mesh for coordinates in the frame.
    [[nodiscard]] Point world(const Vector& x) const { return CGAL::ORIGIN + centre + size * x; }
};
/// The frame of a mesh.
Frame make_frame(const Mesh& mesh);

/// Marks of edges and vertices during the simplification; indices do not change before the garbage is collected.
struct Marks {
    std::vector<bool> edges;     ///< for each edge, whether it belongs to an outline or poly-line
    std::vector<bool> vertices;  ///< for each vertex, whether it is an annotated point
    std::vector<bool> seams;     ///< for each edge, whether it is a seam of the texture
    bool keep_border = false;    ///< true: border vertices and edges stay as they are
};

/// Position of the vertex that remains after a collapse, and cost of the collapse.
struct CollapsePlace {
    Vector position{0, 0, 0};  ///< position in the coordinates of the frame
    double cost = 0;           ///< cost of the collapse
};

/// Cost of collapses by one method.
class CollapseMetric {
public:
    virtual ~CollapseMetric() = default;
    /// The position of least cost for the vertex that replaces the ends of `h`, if there is one.
    [[nodiscard]] virtual std::optional<CollapsePlace> best(const Mesh& mesh, Halfedge h) const = 0;
    /// The cost of collapsing `h` to a given position.
    [[nodiscard]] virtual double cost(const Mesh& mesh, Halfedge h, const Vector& position) const = 0;
    /// Updates the metric; must be called after `removed` was merged into `kept`.
    virtual void merged(Vertex kept, Vertex removed) = 0;
    /// Whether moving a vertex changes the cost of edges whose ends are only neighbours of the vertex.
    [[nodiscard]] virtual bool reaches_second_ring() const = 0;
};

/// Cost by quadric error metrics (Garland and Heckbert 1997).
std::unique_ptr<CollapseMetric> make_quadric_metric(const Mesh& mesh, const Frame& frame, const Marks& marks,
                                                    const SimplifyOptions& options);
/// Cost by Lindstrom and Turk (1998).
std::unique_ptr<CollapseMetric> make_lindstrom_turk_metric(const Frame& frame);

}  // namespace ostraka

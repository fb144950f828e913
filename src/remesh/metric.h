// Cost of a collapse and position of its vertex.
#pragma once

#include "ostraka/remesh/simplify.h"

#include <memory>
#include <optional>

namespace ostraka {

/// Coordinates in which the bounding box of the mesh is centred and its diagonal has length one, so that results do not depend
/// on the unit and position of the object.
struct Frame {
    Vector centre{0, 0, 0};
    double size = 1;
    [[nodiscard]] Vector local(const Point& p) const { return (p - CGAL::ORIGIN - centre) / size; }
    [[nodiscard]] Point world(const Vector& x) const { return CGAL::ORIGIN + centre + size * x; }
};
Frame make_frame(const Mesh& mesh);

/// Marks during the simplification; indices do not change before the garbage is collected.
struct Marks {
    std::vector<bool> edges;     ///< outlines and poly-lines
    std::vector<bool> vertices;  ///< annotated points
};

struct CollapsePlace {
    Vector position{0, 0, 0};  ///< in the frame
    double cost = 0;
};

class CollapseMetric {
public:
    virtual ~CollapseMetric() = default;
    /// The best position for the vertex that replaces the ends of h, if it exists.
    [[nodiscard]] virtual std::optional<CollapsePlace> best(const Mesh& mesh, Halfedge h) const = 0;
    /// The cost of a given position.
    [[nodiscard]] virtual double cost(const Mesh& mesh, Halfedge h, const Vector& position) const = 0;
    /// Call it after `removed` was merged into `kept`.
    virtual void merged(Vertex kept, Vertex removed) = 0;
    /// Whether moving a vertex changes the cost of edges that touch only its neighbours.
    [[nodiscard]] virtual bool reaches_second_ring() const = 0;
};

std::unique_ptr<CollapseMetric> make_quadric_metric(const Mesh& mesh, const Frame& frame, const Marks& marks,
                                                    const SimplifyOptions& options);
std::unique_ptr<CollapseMetric> make_lindstrom_turk_metric(const Frame& frame);

}  // namespace ostraka

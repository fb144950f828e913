#include "remesh/collapse.h"
#include "remesh/metric.h"
#include "remesh/quadric.h"

namespace ostraka {

namespace {

/// Weight of the distance to the replaced vertices in the cost. It makes every system solvable, distributes the vertices of
/// flat parts evenly, and is too small to move a vertex off the surface (compare Trettner and Kobbelt, "Fast and robust QEF
/// minimization", 2020).
constexpr double evenness = 1e-6;

class QuadricMetric final : public CollapseMetric {
public:
    QuadricMetric(const Mesh& mesh, const Frame& frame, const Marks& marks, const SimplifyOptions& options)
        : frame_(frame), quadric_(mesh.number_of_vertices() + mesh.number_of_removed_vertices()) {
        for (const Face f : mesh.faces()) add_face(mesh, f);
        for (const Edge e : mesh.edges()) {
            const bool border = mesh.is_border(e);
            const double weight = border           ? options.border_weight
                                  : marks.edges[e] ? options.outline_weight
                                  : marks.seams[e] ? 1
                                                   : 0;
            if (weight > 0) add_fence(mesh, e, weight);
        }
    }

    [[nodiscard]] std::optional<CollapsePlace> best(const Mesh& mesh, Halfedge h) const override {
        const Quadric q = sum(mesh, h);
        const std::optional<Vector> x = q.minimum();
        if (!x) return {};
        return CollapsePlace{*x, std::max(0.0, q(*x))};
    }
    [[nodiscard]] double cost(const Mesh& mesh, Halfedge h, const Vector& position) const override {
        return std::max(0.0, sum(mesh, h)(position));
    }
    void merged(Vertex kept, Vertex removed) override { quadric_[kept] += quadric_[removed]; }
    [[nodiscard]] bool reaches_second_ring() const override { return false; }

private:
    [[nodiscard]] Quadric sum(const Mesh& mesh, Halfedge h) const {
        Quadric q = quadric_[mesh.source(h)];
        return q += quadric_[mesh.target(h)];
    }
    void add_face(const Mesh& mesh, Face f) {
        const auto vertices = corners(mesh, f);
        const Vector p = frame_.local(mesh.point(vertices[0])), q = frame_.local(mesh.point(vertices[1])),
                     r = frame_.local(mesh.point(vertices[2]));
        const Vector n = CGAL::cross_product(q - p, r - p);
        const double length = std::sqrt(n.squared_length());
        if (!(length > 0)) return;
        const double third = length / 6;  // a third of the area
        Quadric plane;
        plane.add_plane(n / length, p, third);
        for (const Vertex v : vertices) {
            quadric_[v] += plane;
            quadric_[v].add_point(frame_.local(mesh.point(v)), evenness * third);
        }
    }
    /// Planes through an edge, perpendicular to its faces, that keep a border or an outline in place.
    void add_fence(const Mesh& mesh, Edge e, double weight) {
        for (const Halfedge h : {mesh.halfedge(e, 0), mesh.halfedge(e, 1)}) {
            if (mesh.is_border(h)) continue;
            const Vector p = frame_.local(mesh.point(mesh.source(h))), q = frame_.local(mesh.point(mesh.target(h)));
            const Vector r = frame_.local(mesh.point(mesh.target(mesh.next(h))));
            const Vector n = CGAL::cross_product(q - p, CGAL::cross_product(q - p, r - p));
            const double length = std::sqrt(n.squared_length());
            if (!(length > 0)) continue;
            Quadric fence;
            fence.add_plane(n / length, p, weight * (q - p).squared_length());
            quadric_[mesh.source(h)] += fence;
            quadric_[mesh.target(h)] += fence;
        }
    }

    Frame frame_;
    std::vector<Quadric> quadric_;
};

}  // namespace

Frame make_frame(const Mesh& mesh) {
    Frame frame;
    if (mesh.number_of_vertices() == 0) return frame;
    const CGAL::Bbox_3 box = bounding_box(mesh);
    frame.centre = Vector(box.xmin() + (box.xmax() - box.xmin()) / 2, box.ymin() + (box.ymax() - box.ymin()) / 2,
                          box.zmin() + (box.zmax() - box.zmin()) / 2);
    const double size = std::hypot(box.xmax() - box.xmin(), box.ymax() - box.ymin(), box.zmax() - box.zmin());
    if (size > 0 && std::isfinite(size)) frame.size = size;
    return frame;
}

std::unique_ptr<CollapseMetric> make_quadric_metric(const Mesh& mesh, const Frame& frame, const Marks& marks,
                                                    const SimplifyOptions& options) {
    return std::make_unique<QuadricMetric>(mesh, frame, marks, options);
}

}  // namespace ostraka

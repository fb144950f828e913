#include "cage/shrink.h"

#include "cage/triangle_grid.h"

#include "ostraka/algebra/dense.h"
#include "ostraka/core/angles.h"
#include "ostraka/core/progress.h"
#include "ostraka/geom/eigen.h"

#include <CGAL/boost/graph/Euler_operations.h>

#include <queue>
#include <set>

namespace ostraka::cage {

namespace {

/// Weighted sum of squared distances to planes: x'Ax - 2 b'x + c.
struct Quadric {
    Matrix3d a = Matrix3d::Zero();
    Vector3d b = Vector3d::Zero();
    double c = 0;
    void add_plane(const Vector3d& normal, double height, double weight) {
        a += weight * normal * normal.transpose();
        b += weight * height * normal;
        c += weight * height * height;
    }
    Quadric operator+(const Quadric& other) const { return {a + other.a, b + other.b, c + other.c}; }
    [[nodiscard]] double value_at(const Vector3d& x) const { return std::max(0.0, x.dot(a * x) - 2 * b.dot(x) + c); }
};

double solid_angle(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    return 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

CGAL::Bbox_3 box_of(const std::array<Point, 3>& t) { return t[0].bbox() + t[1].bbox() + t[2].bbox(); }

class Shrinker {
public:
    Shrinker(Mesh& mesh, const Obstacle& obstacle, double clearance, const CageDensity& density,
             const std::optional<MirrorPlane>& mirror)
        : mesh_(mesh),
          obstacle_(obstacle),
          clearance_(clearance),
          mirror_(mirror),
          grid_(mean_edge_length(mesh)),
          origin_(CGAL::ORIGIN) {
        const CGAL::Bbox_3 box = bounding_box(mesh);
        origin_ = Point((box.xmin() + box.xmax()) / 2, (box.ymin() + box.ymax()) / 2, (box.zmin() + box.zmax()) / 2);
        diagonal_ = box_diagonal(mesh);
        quadrics_.resize(mesh.number_of_vertices());
        density_.assign(mesh.number_of_vertices(), 1);
        stamps_.assign(mesh.number_of_edges(), 0);
        if (mirror_) unit_ = mirror_->normal / std::sqrt(mirror_->normal.squared_length());
        if (density)
            for (const Vertex v : mesh.vertices()) density_[v] = density(mesh.point(v));
        for (const Face f : mesh.faces()) {
            const std::array<Point, 3> points = corner_points(f);
            grid_.insert(f, box_of(points));
            const Vector3d area = eigen(area_vector(mesh, f));
            const double size = area.norm();
            if (!(size > 0)) continue;
            const Vector3d normal = area / size;
            for (const Vertex v : corners(mesh, f)) quadrics_[v].add_plane(normal, normal.dot(local(points[0])), size / 3);
        }
        for (const Edge e : mesh.edges()) {
            check_cancelled();
            push(e, 0);
        }
    }

    std::size_t run(std::size_t target) {
        std::size_t count = mirror_ ? whole_size(mesh_) : mesh_.number_of_vertices();
        while (count > target && !queue_.empty()) {
            check_cancelled();
            const Entry entry = queue_.top();
            queue_.pop();
            const Edge e(entry.edge);
            if (mesh_.is_removed(e) || entry.stamp != stamps_[entry.edge]) continue;
            const Halfedge h = mesh_.halfedge(e);
            if (!CGAL::Euler::does_satisfy_link_condition(e, mesh_) || pinches(h)) continue;
            std::optional<Point> position;
            for (const auto& [cost, p] : candidates(h, entry.stage))
                if (admissible(h, p, entry.stage)) {
                    position = p;
                    break;
                }
            if (!position) {
                if (entry.stage + 1 < stages) push(e, entry.stage + 1);
                continue;
            }
            const bool both_on_plane = mirror_ && mesh_.is_border(mesh_.source(h)) && mesh_.is_border(mesh_.target(h));
            count -= !mirror_ || both_on_plane ? 1 : 2;
            collapse(h, *position);
        }
        return count;
    }

private:
    /// Stages of candidate positions. 0: near the surface; 1: enclosing what was enclosed before; 2: as 1, without checks of
    /// triangle shape.
    static constexpr int stages = 3;

    struct Entry {
        double cost;
        Index edge;
        std::uint32_t stamp;
        int stage;
        bool operator<(const Entry& other) const {
            return cost != other.cost ? cost > other.cost : edge != other.edge ? edge > other.edge : stage > other.stage;
        }
    };

    [[nodiscard]] Vector3d local(const Point& p) const { return eigen(p - origin_); }
    [[nodiscard]] Point world(const Vector3d& v) const { return origin_ + vector_of(v); }
    [[nodiscard]] std::array<Point, 3> corner_points(Face f) const {
        const auto [a, b, c] = corners(mesh_, f);
        return {mesh_.point(a), mesh_.point(b), mesh_.point(c)};
    }

    void push(Edge e, int stage) {
        const auto positions = candidates(mesh_.halfedge(e), stage);
        if (!positions.empty()) queue_.push({positions.front().first, e.idx(), stamps_[e], stage});
    }

    /// True if a collapse in a half would leave or create an edge between two vertices on the plane that is not on the border;
    /// mirrored, such an edge would be doubled.
    [[nodiscard]] bool pinches(Halfedge h) const {
        if (!mirror_) return false;
        const Vertex a = mesh_.source(h), b = mesh_.target(h);
        const bool on_a = mesh_.is_border(a), on_b = mesh_.is_border(b);
        if (on_a && on_b) {
            if (!mesh_.is_border(mesh_.edge(h))) return true;
        } else if (!on_a && !on_b) {
            return false;
        }
        // Neighbours on the plane must be connected to the new vertex along the border.
        for (const Vertex v : {a, b})
            for (const Halfedge incident : mesh_.halfedges_around_target(mesh_.halfedge(v))) {
                const Vertex other = mesh_.source(incident);
                if (other == a || other == b || !mesh_.is_border(other)) continue;
                if (!mesh_.is_border(v) || !mesh_.is_border(mesh_.edge(incident))) return true;
            }
        return false;
    }

    /// Candidate positions of the vertex that the edge collapses to, cheapest first.
    [[nodiscard]] std::vector<std::pair<double, Point>> candidates(Halfedge h, int stage) const {
        const Vertex a = mesh_.source(h), b = mesh_.target(h);
        const Vector3d pa = local(mesh_.point(a)), pb = local(mesh_.point(b));
        const Quadric q = quadrics_[a] + quadrics_[b];
        const double trace = q.a.trace();
        const Vector3d middle = (pa + pb) / 2;
        const Matrix3d soft = q.a + 1e-3 * trace * Matrix3d::Identity();
        const Vector3d best = solve_ldlt<3>(soft, q.b + 1e-3 * trace * middle);
        const double length = (pa - pb).squaredNorm(), density = std::max(density_[a], density_[b]);
        std::vector<Vector3d> positions;
        if (stage == 0) positions = {best, middle, pa, pb};
        else positions = outer_places(h, middle, best);
        const bool on_plane = mirror_ && (mesh_.is_border(a) || mesh_.is_border(b));
        const bool both_on_plane = on_plane && mesh_.is_border(a) && mesh_.is_border(b);
        std::vector<std::pair<double, Point>> result;
        for (Vector3d p : positions) {
            if (on_plane) {
                if (!both_on_plane && (p == pa || p == pb)) p = mesh_.is_border(a) ? pa : pb;
                const Vector3d n = eigen(unit_);
                p -= n * n.dot(p - local(mirror_->point));
            }
            if (!p.allFinite()) continue;
            const double deviation = q.value_at(p) + 1e-4 * trace * (length + (p - middle).squaredNorm());
            result.emplace_back(deviation * density * density, world(p));
        }
        std::stable_sort(result.begin(), result.end(), [](const auto& x, const auto& y) { return x.first < y.first; });
        return result;
    }

    /// Candidate positions outside the planes of all faces around the edge, by successive projections (Dykstra), and points
    /// farther out along the normal.
    [[nodiscard]] std::vector<Vector3d> outer_places(Halfedge h, const Vector3d& middle, const Vector3d& best) const {
        std::vector<std::pair<Vector3d, double>> planes;
        Vector3d normal_sum = Vector3d::Zero();
        for (const Face f : faces_around(h)) {
            const Vector3d area = eigen(area_vector(mesh_, f));
            normal_sum += area;
            if (!(area.norm() > 0)) continue;
            const Vector3d n = area.normalized();
            planes.emplace_back(n, n.dot(local(corner_points(f)[0])));
        }
        std::vector<Vector3d> positions;
        const double size = std::sqrt(normal_sum.norm());
        for (const Vector3d& start : {best, middle}) {
            Vector3d x = start;
            std::vector<double> pushed(planes.size(), 0);
            for (int round = 0; round < 40; ++round)
                for (std::size_t i = 0; i < planes.size(); ++i) {
                    const double below = planes[i].second - planes[i].first.dot(x) + pushed[i];
                    const double push = std::max(0.0, below);
                    x += (push - pushed[i]) * planes[i].first;
                    pushed[i] = push;
                }
            if ((x - start).norm() < 4 * size) positions.push_back(x);
        }
        if (normal_sum.norm() > 0)
            for (const double fraction : {0.1, 0.25, 0.5, 1.0})
                positions.push_back(middle + fraction * size * normal_sum.normalized());
        return positions;
    }

    /// The faces around both ends of the edge.
    [[nodiscard]] std::vector<Face> faces_around(Halfedge h) const {
        std::vector<Face> faces;
        for (const Vertex v : {mesh_.source(h), mesh_.target(h)})
            for (const Face f : mesh_.faces_around_target(mesh_.halfedge(v)))
                if (f != Mesh::null_face()) faces.push_back(f);
        std::sort(faces.begin(), faces.end());
        faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
        return faces;
    }

    [[nodiscard]] bool admissible(Halfedge h, const Point& p, int stage) const {
        const Vertex a = mesh_.source(h), b = mesh_.target(h);
        if (mirror_ && !mesh_.is_border(a) && !mesh_.is_border(b) && (p - mirror_->point) * unit_ <= 1e-5 * diagonal_)
            return false;
        const std::vector<Face> old = faces_around(h);
        std::vector<Triangle> triangles;
        std::vector<std::array<Point, 3>> new_points;
        for (const Face f : old) {
            Triangle corner = corners(mesh_, f);
            std::array<Point, 3> points = corner_points(f);
            int moved = 0;
            for (std::size_t k = 0; k < 3; ++k)
                if (corner[k] == a || corner[k] == b) corner[k] = b, points[k] = p, ++moved;
            if (moved == 2) continue;  // removed by the collapse
            if (CGAL::collinear(points[0], points[1], points[2])) return false;
            const Vector3d old_area = eigen(area_vector(mesh_, f));
            const Vector3d u = eigen(points[1] - points[0]), v = eigen(points[2] - points[0]), w = eigen(points[2] - points[1]);
            const Vector3d new_area = u.cross(v) / 2;
            if (stage < 2) {
                if (new_area.dot(old_area) < 0.2 * new_area.norm() * old_area.norm()) return false;
                const double longest = std::max({u.squaredNorm(), v.squaredNorm(), w.squaredNorm()});
                if (new_area.norm() < 0.02 * longest) return false;
            } else if (new_area.norm() < 1e-4 * std::max({u.squaredNorm(), v.squaredNorm(), w.squaredNorm()})) {
                return false;
            }
            triangles.push_back(corner);
            new_points.push_back(points);
        }
        for (const auto& t : new_points) {
            if (obstacle_.meets(t[0], t[1], t[2])) return false;
            if (stage == 2) continue;
            // The triangle moved inwards by the clearance must not meet the object either.
            Vector n = CGAL::cross_product(t[1] - t[0], t[2] - t[0]);
            n = -clearance_ / std::sqrt(n.squared_length()) * n;
            if (obstacle_.meets(t[0] + n, t[1] + n, t[2] + n)) return false;
        }
        if (!keeps_pieces(old, new_points)) return false;
        const std::set<Face> removed_faces(old.begin(), old.end());
        for (std::size_t i = 0; i < triangles.size(); ++i) {
            for (std::size_t j = i + 1; j < triangles.size(); ++j)
                if (overlap(triangles[i], new_points[i], triangles[j], new_points[j])) return false;
            const bool overlaps = grid_.any(box_of(new_points[i]), [&](Face f) {
                return removed_faces.count(f) == 0 && overlap(triangles[i], new_points[i], corners(mesh_, f), corner_points(f));
            });
            if (overlaps) return false;
        }
        return true;
    }

    /// True if no piece of the object lies in the volume between the old and the new faces.
    [[nodiscard]] bool keeps_pieces(const std::vector<Face>& old, const std::vector<std::array<Point, 3>>& new_triangles) const {
        CGAL::Bbox_3 box;
        for (const Face f : old) box += box_of(corner_points(f));
        for (const auto& t : new_triangles) box += box_of(t);
        for (const Point& piece : obstacle_.pieces()) {
            // For a half, also tested with the image of the piece, which stands for the piece relative to the other half.
            double change = 0;
            bool is_near = false;
            for (int side = 0; side < (mirror_ ? 2 : 1); ++side) {
                const Point q = side == 0 ? piece : image(piece, *mirror_);
                if (!CGAL::do_overlap(q.bbox(), box)) continue;
                is_near = true;
            }
            if (!is_near) continue;
            for (int side = 0; side < (mirror_ ? 2 : 1); ++side) {
                const Vector3d q = local(side == 0 ? piece : image(piece, *mirror_));
                for (const Face f : old) {
                    const auto t = corner_points(f);
                    change -= solid_angle(local(t[0]) - q, local(t[1]) - q, local(t[2]) - q);
                }
                for (const auto& t : new_triangles) change += solid_angle(local(t[0]) - q, local(t[1]) - q, local(t[2]) - q);
            }
            if (std::abs(change) > pi) return false;
        }
        return true;
    }

    void collapse(Halfedge h, const Point& p) {
        const Vertex a = mesh_.source(h), b = mesh_.target(h);
        for (const Face f : faces_around(h)) grid_.remove(f, box_of(corner_points(f)));
        const Quadric q = quadrics_[a] + quadrics_[b];
        const double density = std::max(density_[a], density_[b]);
        const Vertex merged_vertex = CGAL::Euler::collapse_edge(mesh_.edge(h), mesh_);
        mesh_.point(merged_vertex) = p;
        quadrics_[merged_vertex] = q;
        density_[merged_vertex] = density;
        for (const Face f : mesh_.faces_around_target(mesh_.halfedge(merged_vertex)))
            if (f != Mesh::null_face()) grid_.insert(f, box_of(corner_points(f)));
        // Edges that were evaluated with the old faces are evaluated again.
        std::set<Edge> affected_edges;
        for (const Vertex v : mesh_.vertices_around_target(mesh_.halfedge(merged_vertex)))
            for (const Halfedge g : mesh_.halfedges_around_target(mesh_.halfedge(v))) affected_edges.insert(mesh_.edge(g));
        for (const Edge e : affected_edges) {
            ++stamps_[e];
            push(e, 0);
        }
    }

    Mesh& mesh_;
    const Obstacle& obstacle_;
    double clearance_;
    const std::optional<MirrorPlane>& mirror_;
    TriangleGrid grid_;
    Point origin_;
    Vector unit_{0, 0, 0};
    double diagonal_ = 0;
    std::vector<Quadric> quadrics_;
    std::vector<double> density_;
    std::vector<std::uint32_t> stamps_;
    std::priority_queue<Entry> queue_;
};

}  // namespace

std::size_t shrink(Mesh& surface, const Obstacle& obstacle, std::size_t target, double clearance, const CageDensity& density,
                   const std::optional<MirrorPlane>& mirror) {
    const std::size_t count = Shrinker(surface, obstacle, clearance, density, mirror).run(target);
    surface.collect_garbage();
    return count;
}

}  // namespace ostraka::cage

#include "synthetic/uniform_remesher.h"

#include "ostraka/core/progress.h"
#include "ostraka/execution/parallel.h"

#include <cmath>
#include <numbers>

namespace ostraka::shapes {

namespace {

/// Minimum cosine between a triangle's normal and the surface normal.
constexpr double min_agreement = 0.35;
/// Twice the area over the square of the longest edge: 0.87 for an equilateral triangle. Minimum after any change.
constexpr double min_fullness = 0.12;

class UniformRemesher {
public:
    UniformRemesher(const SyntheticObject& object, Triangles&& mesh, std::size_t target_vertices)
        : object_(object),
          table_(mesh),
          edge_(std::sqrt(area(mesh) / static_cast<double>(target_vertices) * 2 / std::numbers::sqrt3)),
          points_(std::move(mesh.points)),
          normals_(points_.size()),
          target_vertices_(target_vertices) {
        mesh.faces = {};
    }

    Triangles run() {
        set_normals();
        for (const double share : {0.25, 0.4}) collapse_below(share);
        flip_all();
        relax();
        for (double share = 0.5; share < 1.2 && !has_reached_target(); share += 0.08) {
            collapse_below(share);
            if (!has_reached_target()) flip_all();
            relax();
        }
        // If the shape allows no more collapses, collapse edges of any length.
        for (double share = 1.2; share < 6 && !has_reached_target(); share *= 1.2) {
            collapse_below(share);
            flip_all();
            relax();
        }
        for (int round = 0; round < 5; ++round) {
            flip_all();
            relax();
        }
        flip_all();
        return compacted();
    }

private:
    [[nodiscard]] bool has_reached_target() const { return table_.living_vertices() <= target_vertices_; }

    void set_normals() {
        parallel_for(points_.size(), [&](std::size_t v) {
            if (table_.outgoing(static_cast<Index>(v)) != no_index)
                normals_[v] = object_.sample(points_[v]).gradient.normalized();
        });
    }

    /// Whether a triangle with these corners has good shape and faces outward.
    [[nodiscard]] static bool has_good_shape(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& normals,
                                             double fullness) {
        const Vector3d cross = (b - a).cross(c - a);
        const double twice_area = cross.norm();
        const double longest = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
        return twice_area > fullness * longest && cross.dot(normals) > min_agreement * twice_area * normals.norm();
    }
    [[nodiscard]] double fullness(Index a, Index b, Index c) const {
        const Vector3d &p = points_[a], &q = points_[b], &r = points_[c];
        const double longest = std::max({(q - p).squaredNorm(), (r - q).squaredNorm(), (p - r).squaredNorm()});
        return longest > 0 ? (q - p).cross(r - p).norm() / longest : 0;
    }

    void collapse_below(double share) {
        const double limit = share * share * edge_ * edge_;
        CancelCheck check;
        for (Index h = 0; h < table_.halfedges() && !has_reached_target(); ++h) {
            check();
            if (!table_.alive(h) || h > table_.opposite(h)) continue;
            if ((points_[table_.origin(h)] - points_[table_.target(h)]).squaredNorm() < limit) try_collapse(h, share);
        }
    }

    void try_collapse(Index h, double share) {
        if (!table_.can_collapse(h)) return;
        const Index a = table_.origin(h), b = table_.target(h);
        const Vector3d sum = normals_[a] + normals_[b];
        if (sum.squaredNorm() < 1) return;  // the surface normals differ by more than 120 degrees
        const Vector3d normal = sum.normalized();
        const double longest = std::max(1.5, 1.4 * share) * edge_;
        // Thin triangles may stay thin (they are improved later), but none may become thinner than the thinnest was.
        double floor = min_fullness;
        for (const Index v : {a, b}) {
            table_.around(v, [&](Index g) {
                floor = std::min(floor, fullness(v, table_.target(g), table_.target(HalfedgeTable::next(g))));
            });
        }
        const auto is_valid_position = [&](const Vector3d& position, Index from, Index other) {
            bool valid = true;
            table_.around(from, [&](Index g) {
                const Index p = table_.target(g), q = table_.target(HalfedgeTable::next(g));
                if (!valid || p == other || q == other) return;
                valid = (points_[p] - position).squaredNorm() < longest * longest &&
                        has_good_shape(position, points_[p], points_[q], normal + normals_[p] + normals_[q], 0.999 * floor);
            });
            return valid;
        };
        for (const Vector3d& position : {Vector3d(0.5 * (points_[a] + points_[b])), points_[a], points_[b]}) {
            if (!is_valid_position(position, a, b) || !is_valid_position(position, b, a)) continue;
            table_.collapse(h);
            points_[a] = position;
            normals_[a] = normal;
            return;
        }
    }

    /// Sweeps over the edges until no flip improves an angle (at most four sweeps).
    void flip_all() {
        CancelCheck check;
        for (int sweep = 0; sweep < 4; ++sweep) {
            std::size_t flips = 0;
            for (Index h = 0; h < table_.halfedges(); ++h) {
                check();
                if (table_.alive(h) && h < table_.opposite(h) && try_flip(h)) ++flips;
            }
            if (flips == 0) break;
        }
    }

    bool try_flip(Index h) {
        const Index a = table_.origin(h), b = table_.target(h), o = table_.opposite(h);
        const Index c = table_.target(HalfedgeTable::next(h)), d = table_.target(HalfedgeTable::next(o));
        const Vector3d ca = points_[a] - points_[c], cb = points_[b] - points_[c];
        const Vector3d da = points_[a] - points_[d], db = points_[b] - points_[d];
        // Delaunay: flip if the opposite angles sum to more than 180 degrees, that is, if the sine of the sum is negative.
        const double sine_c = ca.cross(cb).norm(), sine_d = da.cross(db).norm();
        const double cosine_c = ca.dot(cb), cosine_d = da.dot(db);
        const double size = std::sqrt(ca.squaredNorm() * cb.squaredNorm() * da.squaredNorm() * db.squaredNorm());
        if (sine_c * cosine_d + sine_d * cosine_c > -1e-9 * size) return false;
        const double old_fullness = std::min(fullness(a, b, c), fullness(b, a, d));
        const double floor = std::min(min_fullness, old_fullness);
        const Vector3d normal_sum = normals_[c] + normals_[d];
        if (!has_good_shape(points_[c], points_[d], points_[b], normal_sum + normals_[b], floor)) return false;
        if (!has_good_shape(points_[d], points_[c], points_[a], normal_sum + normals_[a], floor)) return false;
        if (!table_.can_flip(h)) return false;
        table_.flip(h);
        return true;
    }

    /// Moves every vertex within its tangent plane towards the area-weighted centre of its triangles and projects it onto the
    /// surface; moves that degrade a triangle are undone.
    void relax() {
        std::vector<Vector3d> old_points = points_, old_normals = normals_;
        parallel_for(points_.size(), [&](std::size_t i) {
            const auto v = static_cast<Index>(i);
            if (table_.outgoing(v) == no_index) return;
            Vector3d weighted = Vector3d::Zero();
            double weights = 0;
            table_.around(v, [&](Index h) {
                const Vector3d &p = old_points[table_.target(h)], &q = old_points[table_.target(HalfedgeTable::next(h))];
                const double area = (p - old_points[v]).cross(q - old_points[v]).norm();
                weighted += area * (p + q + old_points[v]) / 3;
                weights += area;
            });
            Vector3d move = weights > 0 ? Vector3d(weighted / weights - old_points[v]) : Vector3d(Vector3d::Zero());
            move -= normals_[v].dot(move) * normals_[v];
            Vector3d p = old_points[v] + move;
            Sample s;
            for (int step = 0; step < 8; ++step) {
                s = object_.sample(p);
                const Vector3d correction = s.value / std::max(s.gradient.squaredNorm(), 1e-2) * s.gradient;
                if (correction.squaredNorm() < 1e-20 * edge_ * edge_) break;
                p -= correction;
            }
            // Rejects moves to another sheet of the surface.
            if ((p - old_points[v]).squaredNorm() > edge_ * edge_ || s.gradient.normalized().dot(old_normals[v]) < 0.3) return;
            points_[v] = p;
            normals_[v] = s.gradient.normalized();
        });
        undo_degrading_moves(old_points, old_normals);
    }

    void undo_degrading_moves(const std::vector<Vector3d>& old_points, const std::vector<Vector3d>& old_normals) {
        std::vector<std::uint8_t> degraded(table_.halfedges() / 3);
        for (int round = 0; round < 12; ++round) {
            parallel_for(degraded.size(), [&](std::size_t f) {
                degraded[f] = 0;
                const auto h = static_cast<Index>(3 * f);
                if (!table_.alive(h)) return;
                const Index a = table_.origin(h), b = table_.origin(h + 1), c = table_.origin(h + 2);
                if (has_good_shape(points_[a], points_[b], points_[c], normals_[a] + normals_[b] + normals_[c], 0.02)) return;
                const auto moved = [&](Index v) { return points_[v] != old_points[v]; };
                degraded[f] = moved(a) || moved(b) || moved(c);
            });
            std::vector<Index> vertices;
            for (std::size_t f = 0; f < degraded.size(); ++f) {
                if (degraded[f] == 0) continue;
                for (Index k = 0; k < 3; ++k) vertices.push_back(table_.origin(static_cast<Index>(3 * f) + k));
            }
            if (vertices.empty()) return;
            for (const Index v : vertices) points_[v] = old_points[v], normals_[v] = old_normals[v];
        }
    }

    Triangles compacted() const {
        Triangles mesh;
        std::vector<Index> new_index(points_.size(), no_index);
        for (Index v = 0; v < points_.size(); ++v) {
            if (table_.outgoing(v) == no_index) continue;
            new_index[v] = static_cast<Index>(mesh.points.size());
            mesh.points.push_back(points_[v]);
        }
        for (Index h = 0; h < table_.halfedges(); h += 3) {
            if (table_.alive(h))
                mesh.faces.push_back(
                    {new_index[table_.origin(h)], new_index[table_.origin(h + 1)], new_index[table_.origin(h + 2)]});
        }
        return mesh;
    }

    const SyntheticObject& object_;
    HalfedgeTable table_;
    double edge_;  ///< of uniform triangles: each vertex has an area of sqrt(3)/2 times its square
    std::vector<Vector3d> points_, normals_;
    std::size_t target_vertices_;
};

}  // namespace

Triangles remesh_uniformly(const SyntheticObject& object, Triangles mesh, std::size_t vertices) {
    return UniformRemesher(object, std::move(mesh), vertices).run();
}

}  // namespace ostraka::shapes

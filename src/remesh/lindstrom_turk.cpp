#include "remesh/collapse.h"
#include "remesh/metric.h"

#include <array>
#include <cmath>

namespace ostraka {

namespace {

double component(const Vector& v, int i) { return i == 0 ? v.x() : i == 1 ? v.y() : v.z(); }

/// A unit vector perpendicular to a non-zero vector.
Vector perpendicular(const Vector& n) {
    const double x = std::abs(n.x()), y = std::abs(n.y()), z = std::abs(n.z());
    const Vector normal = CGAL::cross_product(n, x <= y && x <= z ? Vector(1, 0, 0) : y <= z ? Vector(0, 1, 0) : Vector(0, 0, 1));
    return normal / std::sqrt(normal.squared_length());
}

/// Up to three linear conditions n . x = d that determine a point. A condition nearly parallel to the span of the earlier ones
/// is ignored (Lindstrom and Turk 1998, section 4.1; their angle of one degree).
class Conditions {
public:
    [[nodiscard]] bool full() const { return count_ == 3; }

    void add(const Vector& n, double d) {
        const double length = std::sqrt(n.squared_length());
        if (full() || !(length > 0)) return;
        const Vector unit = n / length;
        if (count_ == 1 && std::abs(unit * row_[0]) > cosine) return;
        if (count_ == 2) {
            const Vector normal = CGAL::cross_product(row_[0], row_[1]);
            if (std::abs(unit * normal) < sine * std::sqrt(normal.squared_length())) return;
        }
        row_[count_] = unit;
        right_[count_++] = d / length;
    }

    /// Minimises x^T H x + 2 c . x over the remaining degrees of freedom: the gradient vanishes along the free directions.
    void add_minimum(const std::array<Vector, 3>& H, const Vector& c) {
        const auto times = [&](const Vector& z) { return Vector(H[0] * z, H[1] * z, H[2] * z); };
        if (count_ == 0) {
            for (int i = 0; i < 3; ++i) add(H[i], -component(c, i));
        } else if (count_ == 1) {
            const Vector n = row_[0];
            const Vector z1 = perpendicular(n);
            const Vector z2 = CGAL::cross_product(n, z1);
            add(times(z1), -(z1 * c));
            add(times(z2), -(z2 * c));
        } else if (count_ == 2) {
            const Vector z = CGAL::cross_product(row_[0], row_[1]);
            add(times(z), -(z * c));
        }
    }

    [[nodiscard]] Vector solve() const {
        const Vector a = CGAL::cross_product(row_[1], row_[2]), b = CGAL::cross_product(row_[2], row_[0]),
                     c = CGAL::cross_product(row_[0], row_[1]);
        return (right_[0] * a + right_[1] * b + right_[2] * c) / (row_[0] * a);
    }

private:
    static constexpr double cosine = 0.99984769515639124, sine = 0.017452406437283512;  // of one degree
    std::array<Vector, 3> row_;
    std::array<double, 3> right_{};
    int count_ = 0;
};

/// All positions are relative to the midpoint of the edge, to avoid cancellation in determinants.
class LindstromTurkMetric final : public CollapseMetric {
public:
    explicit LindstromTurkMetric(const Frame& frame) : frame_(frame) {}

    [[nodiscard]] std::optional<CollapsePlace> best(const Mesh& mesh, Halfedge h) const override {
        const Surroundings s = gather_surroundings(mesh, h);
        Conditions conditions;
        conditions.add(s.normal_sum, s.volume_sum);  // volume preservation
        if (s.has_border) {                          // boundary preservation
            const double length = s.e1.squared_length();
            if (length > 0) {
                // |e1 x x + e2| is smallest where z . x = z . (e1 x e2) / |e1|^2 for every z perpendicular to e1.
                const Vector e3 = CGAL::cross_product(s.e1, s.e2) / length;
                const Vector z1 = perpendicular(s.e1), z2 = CGAL::cross_product(s.e1, z1);
                conditions.add(z1, z1 * e3);
                conditions.add(z2, z2 * e3);
            }
        }
        if (!conditions.full()) {  // volume and boundary optimisation
            const double w = boundary_share * s.edge_length_squared;
            std::array<Vector, 3> H;
            for (int i = 0; i < 3; ++i) H[i] = (1 - boundary_share) * s.volume_H[i] / 18.0 + w * s.border_H[i] / 2.0;
            conditions.add_minimum(H, (1 - boundary_share) * s.volume_c / 18.0 + w * s.border_c / 2.0);
        }
        if (!conditions.full()) {  // shapes of the triangles
            const double n = s.link_count;
            conditions.add_minimum({Vector(n, 0, 0), Vector(0, n, 0), Vector(0, 0, n)}, -1.0 * s.link_sum);
        }
        if (!conditions.full()) return {};
        const Vector x = conditions.solve();
        return CollapsePlace{s.origin + x, cost(s, x)};
    }
    [[nodiscard]] double cost(const Mesh& mesh, Halfedge h, const Vector& position) const override {
        const Surroundings s = gather_surroundings(mesh, h);
        return cost(s, position - s.origin);
    }
    void merged(Vertex, Vertex) override {}
    [[nodiscard]] bool reaches_second_ring() const override { return true; }

private:
    static constexpr double boundary_share = 0.5;  ///< lambda of section 4.4
    static constexpr double shape_share = 1e-7;    ///< breaks ties on flat parts in favour of short edges

    struct Surroundings {
        Vector origin{0, 0, 0};
        Vector normal_sum{0, 0, 0};
        double volume_sum = 0;
        std::array<Vector, 3> volume_H{Vector(0, 0, 0), Vector(0, 0, 0), Vector(0, 0, 0)};
        Vector volume_c{0, 0, 0};
        double volume_k = 0;
        bool has_border = false;
        Vector e1{0, 0, 0}, e2{0, 0, 0};
        std::array<Vector, 3> border_H{Vector(0, 0, 0), Vector(0, 0, 0), Vector(0, 0, 0)};
        Vector border_c{0, 0, 0};
        double border_k = 0;
        Vector link_sum{0, 0, 0};
        double link_count = 0, link_squares = 0;
        double edge_length_squared = 0;
    };

    [[nodiscard]] Surroundings gather_surroundings(const Mesh& mesh, Halfedge h) const {
        Surroundings s;
        const Vertex u = mesh.source(h), v = mesh.target(h);
        const Vector pu = frame_.local(mesh.point(u)), pv = frame_.local(mesh.point(v));
        s.origin = pu + (pv - pu) / 2;
        s.edge_length_squared = (pv - pu).squared_length();
        const auto position = [&](Vertex w) { return frame_.local(mesh.point(w)) - s.origin; };
        const auto add_face = [&](Halfedge g) {
            const Vector a = position(mesh.source(g)), b = position(mesh.target(g)), c = position(mesh.target(mesh.next(g)));
            const Vector n = CGAL::cross_product(b - a, c - a);
            const double d = CGAL::cross_product(a, b) * c;
            s.normal_sum += n;
            s.volume_sum += d;
            for (int i = 0; i < 3; ++i) s.volume_H[i] += component(n, i) * n;
            s.volume_c -= d * n;
            s.volume_k += d * d;
        };
        const auto add_border = [&](Halfedge g) {
            const Vector a = position(mesh.source(g)), b = position(mesh.target(g));
            const Vector e = b - a, m = CGAL::cross_product(a, b);
            s.has_border = true;
            s.e1 += e;
            s.e2 += m;
            // |m + e x x|^2 is the square of twice the area of the triangle between the edge and x
            const double length = e.squared_length();
            s.border_H[0] += Vector(length - e.x() * e.x(), -e.x() * e.y(), -e.x() * e.z());
            s.border_H[1] += Vector(-e.y() * e.x(), length - e.y() * e.y(), -e.y() * e.z());
            s.border_H[2] += Vector(-e.z() * e.x(), -e.z() * e.y(), length - e.z() * e.z());
            s.border_c += CGAL::cross_product(m, e);
            s.border_k += m.squared_length();
        };
        const auto add_ring = [&](Vertex centre, bool skip_shared) {
            for_each_incoming(mesh, centre, [&](Halfedge g) {
                const Vertex w = mesh.source(g);
                if (w != u && w != v) {
                    const Vector p = position(w);
                    s.link_sum += p;
                    s.link_squares += p.squared_length();
                    s.link_count += 1;
                }
                for (const Halfedge k : {g, mesh.opposite(g)})
                    if (mesh.is_border(k) && !(skip_shared && (w == u || w == v))) add_border(k);
                if (mesh.is_border(g)) return;
                if (skip_shared && (mesh.face(g) == mesh.face(h) || mesh.face(g) == mesh.face(mesh.opposite(h)))) return;
                add_face(g);
            });
        };
        add_ring(u, false);
        add_ring(v, true);
        return s;
    }

    [[nodiscard]] static double cost(const Surroundings& s, const Vector& x) {
        const auto quadratic = [&](const std::array<Vector, 3>& H, const Vector& c, double k) {
            return x * Vector(H[0] * x, H[1] * x, H[2] * x) + 2 * (c * x) + k;
        };
        const double volume = std::max(0.0, quadratic(s.volume_H, s.volume_c, s.volume_k)) / 36;
        const double border = s.has_border ? std::max(0.0, quadratic(s.border_H, s.border_c, s.border_k)) / 4 : 0;
        const double shape = s.link_count * x.squared_length() - 2 * (s.link_sum * x) + s.link_squares;
        const double length = s.edge_length_squared;
        return (1 - boundary_share) * volume + boundary_share * length * border +
               shape_share * length * length * std::max(0.0, shape);
    }

    Frame frame_;
};

}  // namespace

std::unique_ptr<CollapseMetric> make_lindstrom_turk_metric(const Frame& frame) {
    return std::make_unique<LindstromTurkMetric>(frame);
}

}  // namespace ostraka

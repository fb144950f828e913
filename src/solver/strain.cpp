// Edges, triangles and tetrahedra with limited strain (ShapeUp; Bouaziz et al. 2014, Projective Dynamics).
#include "solver/create.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace ostraka::solver {

namespace {

class EdgeStrain final : public Constraint {
public:
    EdgeStrain(const ConstraintArguments& a, const kinds::EdgeStrain& kind)
        : Constraint(a.kind, a.ids, a.weight),
          rest_(a.rest.col(1) - a.rest.col(0)),
          range_(a.range_of(kind.length, kind.absolute, rest_.norm())) {
        map_.rows = 1;
        map_.entries = {{0, 0, -1.0}, {0, 1, 1.0}};
    }
    void project(const RowsIn& rows, RowsOut projected) const override {
        const double length = rows.col(0).norm(), wanted = range_.clamp(length), rest = rest_.norm();
        if (length > 0) projected.col(0) = rows.col(0) * (wanted / length);
        else projected.col(0) = rest > 0 ? Eigen::Vector3d(rest_ * (wanted / rest)) : Eigen::Vector3d(wanted, 0, 0);
    }

private:
    Eigen::Vector3d rest_;
    Interval range_;
};

/// The s >= 0 with product t closest to a, for two factors a >= b >= 0: s_i = (a_i +- sqrt(a_i^2 + 4 mu)) / 2, where mu is a
/// multiple of the Lagrange multiplier. The smaller factor takes the minus sign if the product must fall below its value at 4
/// mu = -b^2.
std::array<double, 3> with_product(const std::array<double, 3>& a, int n, double t) {
    if (!(t > 0)) {
        std::array<double, 3> s = a;
        s[n - 1] = 0;
        return s;
    }
    const auto at = [&](double mu, bool minus) {
        std::array<double, 3> s{1, 1, 1};
        for (int i = 0; i < n; ++i) {
            const double root = std::sqrt(std::max(a[i] * a[i] + 4 * mu, 0.0));
            const bool less = minus && i == n - 1;
            // Written to avoid cancellation.
            if ((a[i] >= 0) != less) s[i] = (a[i] + (less ? -root : root)) / 2;
            else s[i] = (less ? a[i] + root : a[i] - root) != 0 ? -2 * mu / (less ? a[i] + root : a[i] - root) : 0;
        }
        return s;
    };
    const auto excess = [&](double mu, bool minus) {
        const auto s = at(mu, minus);
        return s[0] * s[1] * s[2] - t;
    };
    const auto bisect = [&](double below, double above, bool minus) {  // excess(below) <= 0 <= excess(above)
        for (int i = 0; i < 200 && below != above; ++i) {
            const double middle = below + (above - below) / 2;
            if (middle == below || middle == above) break;
            (excess(middle, minus) < 0 ? below : above) = middle;
        }
        return at(above, minus);
    };
    const auto distance = [&](const std::array<double, 3>& s) {
        double sum = 0;
        for (int i = 0; i < n; ++i) sum += (s[i] - a[i]) * (s[i] - a[i]);
        return sum;
    };
    const double minimum = a[n - 1];
    const double start = minimum > 0 ? -minimum * minimum / 4 : 0.0;
    std::array<double, 3> best{};
    double best_distance = std::numeric_limits<double>::infinity();
    const auto consider = [&](const std::array<double, 3>& s) {
        if (const double here = distance(s); here < best_distance) {
            best_distance = here;
            best = s;
        }
    };
    if (excess(start, false) <= 0) {
        double high = std::max(std::abs(start), std::pow(t, 2.0 / n));
        while (excess(high, false) < 0) high *= 2;
        consider(bisect(start, high, false));
    }
    if (minimum > 0) {
        // With the minus sign the product ends at 0 as mu goes from `start` to 0, but it may rise before; therefore it is
        // sampled.
        constexpr int samples = 64;
        double previous = start, value = excess(start, true);
        for (int i = 1; i <= samples; ++i) {
            const double mu = start * (1 - static_cast<double>(i) / samples), here = excess(mu, true);
            if (value >= 0 && here <= 0) consider(bisect(mu, previous, true));
            if (value <= 0 && here >= 0) consider(bisect(previous, mu, true));
            previous = mu;
            value = here;
        }
    }
    return best;
}

struct SvdOfTwo : Eigen::JacobiSVD<Eigen::Matrix<double, 3, 2>> {
    explicit SvdOfTwo(const Eigen::Matrix<double, 3, 2>& matrix) : JacobiSVD(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV) {}
};

enum class Limits { singular_values, product };

/// Rows: the columns of the deformation gradient F of a simplex times a length, the 1/2 or 1/3 power of its rest area or
/// volume. Limits apply to each singular value (strain) or to their product (area, volume). An inverted tetrahedron is
/// restored.
template <int N>
class Simplex final : public Constraint {
    using Edges = Eigen::Matrix<double, 3, N>;
    using Square = Eigen::Matrix<double, N, N>;
    using Decomposition = std::conditional_t<N == 3, Svd3, SvdOfTwo>;

public:
    /// An absolute range is in the unit of the area or volume.
    Simplex(const ConstraintArguments& a, Limits limits, const Interval& range, bool absolute = false)
        : Constraint(a.kind, a.ids, a.weight), limits_(limits) {
        Edges edges;
        for (int i = 0; i < N; ++i) edges.col(i) = a.rest.col(i + 1) - a.rest.col(0);
        // Edges in a local frame, by Gram-Schmidt orthogonalisation.
        Square local = Square::Zero();
        Edges frame = edges;
        for (int i = 0; i < N; ++i) {
            for (int j = 0; j < i; ++j) {
                local(j, i) = frame.col(j).dot(frame.col(i));
                frame.col(i) -= local(j, i) * frame.col(j);
            }
            local(i, i) = frame.col(i).norm();
            if (local(i, i) > 0) frame.col(i) /= local(i, i);
        }
        const double measure = std::abs(local.determinant()) / (N == 2 ? 2.0 : 6.0);
        const double size = edges.cwiseAbs().maxCoeff();
        if (!(measure > 1e-14 * std::pow(size, N)))
            a.fail(N == 2 ? "the triangle has no area in the rest state" : "the tetrahedron has no volume in the rest state",
                   "leave it out");
        scale_ = std::pow(measure, 1.0 / N);
        const Square inverse = local.inverse();
        // F = (x_i - x_0) inverse; each column is a combination of the points.
        map_.rows = N;
        for (int c = 0; c < N; ++c) {
            map_.entries.push_back({c, 0, -scale_ * inverse.col(c).sum()});
            for (int i = 0; i < N; ++i) map_.entries.push_back({c, i + 1, scale_ * inverse(i, c)});
        }
        range_ = a.checked(range);
        if (absolute) {
            range_.min /= measure;
            range_.max /= measure;
        }
        // Orientation: F of the rest state is the frame itself, whose determinant may be -1.
        if constexpr (N == 3) flipped_ = (edges * inverse).determinant() < 0;
    }

    void project(const RowsIn& rows, RowsOut projected) const override {
        const Edges f = rows / scale_;
        if (!f.allFinite()) {
            projected = rows;
            return;
        }
        const Decomposition svd(f);
        Eigen::Matrix<double, 3, N> u = svd.matrixU().template leftCols<N>();
        const Square& v = svd.matrixV();
        std::array<double, 3> s{1, 1, 1};
        for (int i = 0; i < N; ++i) s[i] = svd.singularValues()[i];
        if constexpr (N == 3) {
            if ((u.determinant() * v.determinant() < 0) != flipped_) {
                u.col(2) *= -1;
                s[2] *= -1;
            }
        }
        if (limits_ == Limits::singular_values) {
            for (int i = 0; i < N; ++i) s[i] = range_.clamp(s[i]);
        } else {
            const double product = s[0] * s[1] * s[2];
            if (product < range_.min || product > range_.max) s = with_product(s, N, range_.clamp(product));
        }
        Edges result = Edges::Zero();
        for (int i = 0; i < N; ++i) result += s[i] * u.col(i) * v.col(i).transpose();
        projected = result * scale_;
    }

private:
    Limits limits_;
    double scale_ = 1;
    bool flipped_ = false;
    Interval range_{1, 1};
};

}  // namespace

ConstraintPtr create(const kinds::EdgeStrain& kind, const ConstraintArguments& a) {
    return std::make_unique<EdgeStrain>(a, kind);
}
ConstraintPtr create(const kinds::TriangleStrain& kind, const ConstraintArguments& a) {
    return std::make_unique<Simplex<2>>(a, Limits::singular_values, kind.stretch);
}
ConstraintPtr create(const kinds::TetrahedronStrain& kind, const ConstraintArguments& a) {
    return std::make_unique<Simplex<3>>(a, Limits::singular_values, kind.stretch);
}
ConstraintPtr create(const kinds::Area& kind, const ConstraintArguments& a) {
    return std::make_unique<Simplex<2>>(a, Limits::product, kind.area, kind.absolute);
}
ConstraintPtr create(const kinds::Volume& kind, const ConstraintArguments& a) {
    return std::make_unique<Simplex<3>>(a, Limits::product, kind.volume, kind.absolute);
}

}  // namespace ostraka::solver

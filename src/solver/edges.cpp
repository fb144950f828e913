// Constraints on differences of points: lengths, angles and directions.
#include "ostraka/core/angles.h"
#include "solver/create.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ostraka::solver {

namespace {

using Eigen::Index;
using Eigen::Vector3d;

/// Rows x_b - x_a for pairs (a, b) of positions.
class Edges : public Constraint {
protected:
    Edges(const ConstraintArguments& a, const std::vector<std::pair<int, int>>& pairs) : Constraint(a.kind, a.ids, a.weight) {
        map_.rows = static_cast<Index>(pairs.size());
        rest_.resize(3, map_.rows);
        for (Index r = 0; r < map_.rows; ++r) {
            const auto [from, to] = pairs[static_cast<std::size_t>(r)];
            map_.entries.push_back({static_cast<std::int32_t>(r), from, -1.0});
            map_.entries.push_back({static_cast<std::int32_t>(r), to, 1.0});
            rest_.col(r) = a.rest.col(to) - a.rest.col(from);
        }
    }
    /// Row r scaled to another length; a row of zero length takes the direction of the rest state.
    [[nodiscard]] Vector3d with_length(const RowsIn& rows, Index r, double length) const {
        if (const double now = rows.col(r).norm(); now > 0) return rows.col(r) * (length / now);
        if (const double then = rest_.col(r).norm(); then > 0) return rest_.col(r) * (length / then);
        return {length, 0, 0};
    }
    Points rest_;
};

std::vector<std::pair<int, int>> path_edges(int begin, int end) {
    std::vector<std::pair<int, int>> pairs;
    for (int i = begin; i + 1 < end; ++i) pairs.emplace_back(i, i + 1);
    return pairs;
}

std::vector<std::pair<int, int>> pairs_of(const ConstraintArguments& a) {
    if (a.ids.size() % 2 != 0) a.fail("there is an odd number of points", "give two for each segment");
    std::vector<std::pair<int, int>> pairs;
    for (int i = 0; i + 1 < static_cast<int>(a.ids.size()); i += 2) pairs.emplace_back(i, i + 1);
    return pairs;
}

/// The closest pair of vectors at the angle `wanted`, in the plane of both. Both rotate, the shorter one more: with A and B
/// their squared lengths and D the excess angle, A sin^2 a + B sin^2 (D - a) is minimal for 2 a = arg(A + B exp(2 i D)).
void bring_to_angle(Vector3d& u, Vector3d& v, double wanted) {
    const double lu = u.norm(), lv = v.norm();
    if (!(lu > 0) || !(lv > 0)) return;  // a zero vector has no angle
    const Vector3d eu = u / lu, ev = v / lv;
    Vector3d across = ev - eu.dot(ev) * eu;  // perpendicular to u, on v's side
    const double sine = across.norm();
    across = sine > 1e-15 ? Vector3d(across / sine) : any_perpendicular(eu);
    const double now = std::atan2(across.dot(ev), eu.dot(ev));
    const double excess = now - wanted;  // positive: the angle must decrease
    if (std::abs(excess) > pi / 2) {
        (lu < lv ? u : v).setZero();
        return;
    }
    const double largest = std::max(lu, lv), a2 = (lu / largest) * (lu / largest), b2 = (lv / largest) * (lv / largest);
    const double a = std::atan2(b2 * std::sin(2 * excess), a2 + b2 * std::cos(2 * excess)) / 2;
    const auto at = [&](double angle) { return Vector3d(std::cos(angle) * eu + std::sin(angle) * across); };
    u = lu * std::cos(a) * at(a);
    v = lv * std::cos(excess - a) * at(a + wanted);
}

class Angle final : public Edges {
public:
    Angle(const ConstraintArguments& a, const std::vector<std::pair<int, int>>& pairs, Interval range)
        : Edges(a, pairs), range_(range) {}
    void project(const RowsIn& rows, RowsOut projected) const override {
        Vector3d u = rows.col(0), v = rows.col(1);
        const double now = std::atan2(u.cross(v).norm(), u.dot(v)), wanted = range_.clamp(now);
        if (now != wanted) bring_to_angle(u, v, wanted);
        projected.col(0) = u;
        projected.col(1) = v;
    }

private:
    Interval range_;
};

class Parallel final : public Edges {
public:
    explicit Parallel(const ConstraintArguments& a) : Edges(a, pairs_of(a)) {}
    void project(const RowsIn& rows, RowsOut projected) const override {
        const Vector3d d = principal(outer_sum(rows, rows)).eigenvectors().col(2);
        for (Index r = 0; r < rows.cols(); ++r) projected.col(r) = d * d.dot(rows.col(r));
    }
};

/// The closest lengths l'_i = max(l_i + s_i delta, 0), s_i = 1 or -1, with sum of s_i l'_i = total. The sum is piecewise linear
/// and increasing in delta.
void shift_lengths(std::vector<double>& lengths, const std::vector<double>& sign, double total) {
    std::vector<double> breaks;  // values of delta at which a length becomes zero
    for (std::size_t i = 0; i < lengths.size(); ++i) breaks.push_back(-sign[i] * lengths[i]);
    std::sort(breaks.begin(), breaks.end());
    const auto sum = [&](double delta) {
        double s = 0;
        for (std::size_t i = 0; i < lengths.size(); ++i) s += sign[i] * std::max(lengths[i] + sign[i] * delta, 0.0);
        return s;
    };
    // Bisection for the interval of delta that contains the solution; the sum is linear within it.
    std::size_t low = 0, high = breaks.size();
    while (low < high) {
        const std::size_t middle = (low + high) / 2;
        if (sum(breaks[middle]) < total) low = middle + 1;
        else high = middle;
    }
    const double from = low > 0 ? breaks[low - 1] : breaks.front() - 1;
    double moving = 0, at_zero = 0;
    for (std::size_t i = 0; i < lengths.size(); ++i) {
        const double middle = low < breaks.size() ? (from + breaks[low]) / 2 : from + 1;
        if (lengths[i] + sign[i] * middle > 0) {
            moving += 1;
            at_zero += sign[i] * lengths[i];
        }
    }
    if (!(moving > 0)) return;
    const double delta = (total - at_zero) / moving;
    for (std::size_t i = 0; i < lengths.size(); ++i) lengths[i] = std::max(lengths[i] + sign[i] * delta, 0.0);
}

class PolylineLength final : public Edges {
public:
    PolylineLength(const ConstraintArguments& a, const kinds::PolylineLength& kind)
        : Edges(a, path_edges(0, static_cast<int>(a.ids.size()))) {
        range_ = a.range_of(kind.length, kind.absolute, rest_.colwise().norm().sum());
    }
    void project(const RowsIn& rows, RowsOut projected) const override {
        std::vector<double> lengths(static_cast<std::size_t>(rows.cols()));
        for (Index r = 0; r < rows.cols(); ++r) lengths[static_cast<std::size_t>(r)] = rows.col(r).norm();
        const double now = std::accumulate(lengths.begin(), lengths.end(), 0.0), wanted = range_.clamp(now);
        projected = rows;
        if (std::abs(now - wanted) <= 1e-15 * now) return;
        shift_lengths(lengths, std::vector<double>(lengths.size(), 1.0), wanted);
        for (Index r = 0; r < rows.cols(); ++r) projected.col(r) = with_length(rows, r, lengths[static_cast<std::size_t>(r)]);
    }

private:
    Interval range_{0, 0};
};

class EqualLengths final : public Edges {
public:
    explicit EqualLengths(const ConstraintArguments& a) : Edges(a, pairs_of(a)) {}
    void project(const RowsIn& rows, RowsOut projected) const override {
        const double mean = rows.colwise().norm().mean();
        for (Index r = 0; r < rows.cols(); ++r) projected.col(r) = with_length(rows, r, mean);
    }
};

class EqualLength final : public Edges {
public:
    EqualLength(const ConstraintArguments& a, const std::vector<std::pair<int, int>>& first,
                const std::vector<std::pair<int, int>>& second)
        : Edges(a, joined(first, second)), first_(static_cast<Index>(first.size())) {}
    void project(const RowsIn& rows, RowsOut projected) const override {
        std::vector<double> lengths, sign;
        for (Index r = 0; r < rows.cols(); ++r) {
            lengths.push_back(rows.col(r).norm());
            sign.push_back(r < first_ ? 1.0 : -1.0);
        }
        shift_lengths(lengths, sign, 0);
        for (Index r = 0; r < rows.cols(); ++r) projected.col(r) = with_length(rows, r, lengths[static_cast<std::size_t>(r)]);
    }

private:
    static std::vector<std::pair<int, int>> joined(std::vector<std::pair<int, int>> first,
                                                   const std::vector<std::pair<int, int>>& second) {
        first.insert(first.end(), second.begin(), second.end());
        return first;
    }
    Index first_;
};

}  // namespace

ConstraintPtr create(const kinds::Angle& kind, const ConstraintArguments& a) {
    const Interval range = a.checked(kind.angle);
    if (range.max > pi) a.fail("an angle is at most pi", "angles are in radians");
    return std::make_unique<Angle>(a, std::vector<std::pair<int, int>>{{0, 1}, {0, 2}}, range);
}

ConstraintPtr create(const kinds::Perpendicular&, const ConstraintArguments& a) {
    return std::make_unique<Angle>(a, pairs_of(a), Interval{pi / 2, pi / 2});
}
ConstraintPtr create(const kinds::Parallel&, const ConstraintArguments& a) { return std::make_unique<Parallel>(a); }
ConstraintPtr create(const kinds::PolylineLength& kind, const ConstraintArguments& a) {
    return std::make_unique<PolylineLength>(a, kind);
}
ConstraintPtr create(const kinds::EqualLengths&, const ConstraintArguments& a) { return std::make_unique<EqualLengths>(a); }
ConstraintPtr create(const kinds::EqualLength& kind, const ConstraintArguments& a) {
    const int count = static_cast<int>(a.ids.size());
    if (kind.first < 2 || kind.first > count - 2)
        a.fail("the first polyline has " + std::to_string(kind.first) + " points", "both polylines need at least two points");
    return std::make_unique<EqualLength>(a, path_edges(0, kind.first), path_edges(kind.first, count));
}

}  // namespace ostraka::solver

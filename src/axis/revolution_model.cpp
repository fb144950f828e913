// Variable projection: splines and deviations from roundness are linear, the axis is not.
#include "axis/revolution_model.h"

#include "ostraka/core/angles.h"
#include "ostraka/stats/summary.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace ostraka::detail {

using Eigen::Vector3d;

namespace {

constexpr std::size_t no_sheet = static_cast<std::size_t>(-1);
constexpr double min_sigma = 1e-5;  ///< noise below this share of the diagonal is not distinguished

double wrapped(double angle) { return angle - 2 * pi * std::round(angle / (2 * pi)); }

/// Position in cylindrical coordinates about a line.
struct Cylindrical {
    double radius, height;
    Vector3d outward;
};
Cylindrical cylindrical(const SpaceLine& line, const Vector3d& p) {
    const Vector3d d = p - line.point;
    const double height = d.dot(line.direction);
    const Vector3d across = d - height * line.direction;
    const double radius = across.norm();
    return {radius, height, radius > 0 ? Vector3d(across / radius) : Vector3d::Zero()};
}

/// Values and derivatives of the four cubic B-splines that do not vanish at a parameter.
struct Basis {
    std::size_t first;
    std::array<double, 4> value, slope;
};
Basis basis_at(double parameter, int knots) {
    const double x = std::clamp(parameter, 0.0, 1.0) * (knots - 3);
    const double cell = std::min(std::floor(x), knots - 4.0), u = x - cell, v = 1 - u;
    Basis basis{static_cast<std::size_t>(cell), {}, {}};
    basis.value = {v * v * v / 6, (3 * u * u * u - 6 * u * u + 4) / 6, (3 * v * v * v - 6 * v * v + 4) / 6, u * u * u / 6};
    basis.slope = {-v * v / 2, (3 * u * u - 4 * u) / 2, (-3 * v * v + 4 * v) / 2, u * u / 2};
    for (double& slope : basis.slope) slope *= knots - 3;
    return basis;
}

/// Symmetric banded system of a spline: lower half bandwidth 3.
class BandedSystem {
public:
    BandedSystem(int size, int columns) : band_(Eigen::MatrixXd::Zero(4, size)), right_(Eigen::MatrixXd::Zero(columns, size)) {}
    void add(const Basis& basis, double weight, const double* values) {
        for (std::size_t a = 0; a < 4; ++a) {
            const auto row = static_cast<Eigen::Index>(basis.first + a);
            for (std::size_t b = 0; b <= a; ++b)
                band_(static_cast<Eigen::Index>(a - b), row) += weight * basis.value[a] * basis.value[b];
            const double scaled = weight * basis.value[a];
            for (Eigen::Index c = 0; c < right_.rows(); ++c) right_(c, row) += scaled * values[c];
        }
    }
    /// Solves in place; the weak penalty keeps coefficients without data close to straight.
    void solve() {
        const Eigen::Index n = band_.cols();
        const double penalty = 1e-7 * band_.row(0).sum() / double(n) + 1e-300;
        for (Eigen::Index k = 0; k + 2 < n; ++k) {
            const std::array<double, 3> d{1, -2, 1};
            for (Eigen::Index a = 0; a < 3; ++a)
                for (Eigen::Index b = 0; b <= a; ++b)
                    band_(a - b, k + a) += penalty * d[static_cast<std::size_t>(a)] * d[static_cast<std::size_t>(b)];
        }
        band_.row(0).array() += 1e-6 * penalty;
        // band_(d, i) = L(i, i - d)
        for (Eigen::Index i = 0; i < n; ++i) {
            for (Eigen::Index d = std::min<Eigen::Index>(3, i); d >= 0; --d) {
                const Eigen::Index j = i - d;
                double sum = band_(d, i);
                for (Eigen::Index k = std::max<Eigen::Index>(0, i - 3); k < j; ++k)
                    if (j - k <= 3) sum -= band_(i - k, i) * band_(j - k, j);
                band_(d, i) = d == 0 ? std::sqrt(std::max(sum, 1e-300)) : sum / band_(0, j);
            }
        }
        half_ = right_;
        for (Eigen::Index i = 0; i < n; ++i) {
            for (Eigen::Index k = std::max<Eigen::Index>(0, i - 3); k < i; ++k) half_.col(i) -= band_(i - k, i) * half_.col(k);
            half_.col(i) /= band_(0, i);
        }
        right_ = half_;
        for (Eigen::Index i = n - 1; i >= 0; --i) {
            for (Eigen::Index k = i + 1; k <= std::min(n - 1, i + 3); ++k) right_.col(i) -= band_(k - i, k) * right_.col(k);
            right_.col(i) /= band_(0, i);
        }
    }
    /// Coefficients of each column (rows of the result).
    [[nodiscard]] const Eigen::MatrixXd& coefficients() const { return right_; }
    /// What the spline explains of the inner products of the columns.
    [[nodiscard]] Eigen::MatrixXd explained() const { return half_.lazyProduct(half_.transpose()); }

private:
    Eigen::MatrixXd band_, right_, half_;
};

/// Cholesky factor of a small matrix in place, and the logarithm of its determinant.
double factorise(Eigen::MatrixXd& A) {
    double log_determinant = 0;
    for (Eigen::Index j = 0; j < A.cols(); ++j) {
        for (Eigen::Index k = 0; k < j; ++k) A(j, j) -= A(j, k) * A(j, k);
        A(j, j) = std::sqrt(std::max(A(j, j), 1e-300));
        log_determinant += 2 * std::log(A(j, j));
        for (Eigen::Index i = j + 1; i < A.rows(); ++i) {
            for (Eigen::Index k = 0; k < j; ++k) A(i, j) -= A(i, k) * A(j, k);
            A(i, j) /= A(j, j);
        }
    }
    return log_determinant;
}
/// L^-1 B in place.
void solve_lower(const Eigen::MatrixXd& L, Eigen::MatrixXd& B) {
    for (Eigen::Index c = 0; c < B.cols(); ++c)
        for (Eigen::Index i = 0; i < L.rows(); ++i) {
            for (Eigen::Index k = 0; k < i; ++k) B(i, c) -= L(i, k) * B(k, c);
            B(i, c) /= L(i, i);
        }
}

}  // namespace

/// Coordinates of the cells in the charts of their sheets, about one line.
struct RevolutionModel::Chart {
    std::vector<double> t, s;                          ///< along the tangent and the normal of the sheet
    std::vector<double> radius, height, cosine, sine;  ///< cylindrical coordinates
    std::vector<std::pair<double, double>> range;      ///< of t, for each sheet
    [[nodiscard]] double parameter(std::size_t i, std::size_t sheet) const {
        const auto& [low, high] = range[sheet];
        return high > low ? (t[i] - low) / (high - low) : 0.5;
    }
};

RevolutionModel::RevolutionModel(const WallVertices& vertices, const SpaceLine& line, std::size_t max_cells, double max_sine)
    : reference_(line) {
    make_sheets(vertices, max_sine);
    make_cells(vertices, max_cells);
    if (enough()) make_frame();
}

bool RevolutionModel::enough() const {
    return cells_.size() >= 40 && std::any_of(sheets_.begin(), sheets_.end(), [](const WallSheet& s) { return s.wall; });
}

void RevolutionModel::make_sheets(const WallVertices& vertices, double max_sine) {
    const std::size_t count = vertices.points.size();
    std::vector<double> angle(count, 0);
    std::vector<int> sector(count, -1);
    Eigen::Vector2d doubled = Eigen::Vector2d::Zero();
    for (std::size_t i = 0; i < count; ++i) {
        const Cylindrical at = cylindrical(reference_, vertices.points[i]);
        const Vector3d& n = vertices.normals[i];
        if (at.radius < 1e-6 || std::abs(n.dot(reference_.direction.cross(at.outward))) > max_sine || n.squaredNorm() < 0.5)
            continue;
        angle[i] = std::atan2(n.dot(reference_.direction), n.dot(at.outward));
        sector[i] = 0;
        doubled += Eigen::Vector2d(std::cos(2 * angle[i]), std::sin(2 * angle[i]));
    }
    const double mean = std::atan2(doubled.y(), doubled.x()) / 2;
    constexpr double half_sector = 50 * pi / 180;
    for (std::size_t i = 0; i < count; ++i) {
        if (sector[i] < 0) continue;
        const double off = wrapped(angle[i] - mean);
        sector[i] = std::abs(off) < half_sector ? 0 : std::abs(off) > pi - half_sector ? 2 : off > 0 ? 1 : 3;
    }
    std::vector<std::size_t> root(count);
    std::iota(root.begin(), root.end(), std::size_t{0});
    const auto find = [&](std::size_t i) {
        while (root[i] != i) i = root[i] = root[root[i]];
        return i;
    };
    for (const auto& [a, b] : vertices.edges)
        if (sector[a] >= 0 && sector[a] == sector[b]) {
            const std::size_t x = find(a), y = find(b);
            root[std::max(x, y)] = std::min(x, y);
        }
    std::vector<std::size_t> size(count, 0), sheet_of_root(count, no_sheet);
    std::size_t total = 0;
    for (std::size_t i = 0; i < count; ++i)
        if (sector[i] >= 0) ++size[find(i)], ++total;
    const std::size_t smallest = std::max<std::size_t>(16, total / 250);
    sheet_of_vertex_.assign(count, no_sheet);
    std::vector<Eigen::Vector2d> sums;
    for (std::size_t i = 0; i < count; ++i) {
        if (sector[i] < 0 || size[find(i)] < smallest) continue;
        std::size_t& sheet = sheet_of_root[find(i)];
        if (sheet == no_sheet) {
            sheet = sheets_.size();
            sheets_.emplace_back().wall = sector[i] % 2 == 0;
            sums.emplace_back(0, 0);
        }
        sheet_of_vertex_[i] = sheet;
        sheets_[sheet].vertices += 1;
        sums[sheet] += Eigen::Vector2d(std::cos(angle[i]), std::sin(angle[i]));
    }
    for (std::size_t k = 0; k < sheets_.size(); ++k) sheets_[k].angle = std::atan2(sums[k].y(), sums[k].x());
}

void RevolutionModel::make_cells(const WallVertices& vertices, std::size_t max_cells) {
    double edge = 0, edges = 0;
    for (const auto& [a, b] : vertices.edges)
        if (sheet_of_vertex_[a] != no_sheet && sheet_of_vertex_[a] == sheet_of_vertex_[b])
            edge += (vertices.points[a] - vertices.points[b]).norm(), ++edges;
    if (!(edges > 0)) return;
    edge /= edges;
    std::vector<std::vector<std::size_t>> members(sheets_.size());
    for (std::size_t i = 0; i < sheet_of_vertex_.size(); ++i)
        if (sheet_of_vertex_[i] != no_sheet) members[sheet_of_vertex_[i]].push_back(i);
    cell_of_vertex_.assign(sheet_of_vertex_.size(), no_sheet);
    const auto [e1, e2] = [&] {
        const Vector3d u = reference_.direction.unitOrthogonal();
        return std::pair(u, Vector3d(reference_.direction.cross(u)));
    }();
    for (std::size_t k = 0; k < sheets_.size(); ++k) {
        std::vector<Cylindrical> at;
        std::vector<double> t, turn;
        const double c = std::cos(sheets_[k].angle), s = std::sin(sheets_[k].angle);
        // Angles are measured from the mean direction, so that a sheet that is no full circle is in one piece.
        Vector3d mean = Vector3d::Zero();
        for (const std::size_t i : members[k]) {
            at.push_back(cylindrical(reference_, vertices.points[i]));
            mean += at.back().outward;
        }
        const double middle = std::atan2(mean.dot(e2), mean.dot(e1));
        for (const Cylindrical& p : at) {
            t.push_back(c * p.height - s * p.radius);
            turn.push_back(wrapped(std::atan2(p.outward.dot(e2), p.outward.dot(e1)) - middle));
        }
        const auto [low, high] = std::minmax_element(t.begin(), t.end());
        const auto [left, right] = std::minmax_element(turn.begin(), turn.end());
        const double range = *high - *low, width = *right - *left;
        sheets_[k].knots = std::clamp(static_cast<int>(range / (1.6 * edge)) + 3, 5, 36);
        std::map<std::pair<int, int>, std::size_t> cells;
        const bool grouped = members[k].size() > max_cells;
        const int rows = std::clamp(static_cast<int>(range / (0.8 * edge)), 8, max_cells < 300 ? 20 : 50),
                  columns = std::max(6, static_cast<int>(max_cells) / rows);
        std::vector<Eigen::Vector3d> sums;  // radius, height, angle
        const std::size_t first = cells_.size();
        for (std::size_t m = 0; m < members[k].size(); ++m) {
            std::size_t cell = cells_.size();
            if (grouped) {
                const std::pair key(static_cast<int>((t[m] - *low) / range * rows * 0.999999),
                                    static_cast<int>((turn[m] - *left) / width * columns * 0.999999));
                cell = cells.emplace(key, cell).first->second;
            }
            if (cell == cells_.size()) {
                cells_.emplace_back().sheet = k;
                sums.emplace_back(0, 0, 0);
            }
            cells_[cell].count += 1;
            sums[cell - first] += Eigen::Vector3d(at[m].radius, at[m].height, turn[m]);
            cell_of_vertex_[members[k][m]] = cell;
        }
        for (std::size_t i = first; i < cells_.size(); ++i) {
            const Eigen::Vector3d p = sums[i - first] / cells_[i].count;
            const double angle = p[2] + middle;
            cells_[i].p = reference_.point + p[1] * reference_.direction + p[0] * (std::cos(angle) * e1 + std::sin(angle) * e2);
        }
        sheets_[k].knots = std::min(sheets_[k].knots, std::max(4, static_cast<int>(cells_.size() - first) / 6));
    }
    slope_.assign(cells_.size(), 0);
    robust_.assign(cells_.size(), 1);
    residuals_.assign(cells_.size(), 0);
}

void RevolutionModel::make_frame() {
    std::size_t largest = 0;
    double most = -1;
    for (std::size_t k = 0; k < sheets_.size(); ++k)
        if (sheets_[k].wall && sheets_[k].vertices > most) largest = k, most = sheets_[k].vertices;
    Vector3d mean = Vector3d::Zero();
    double count = 0;
    for (const WallCell& cell : cells_)
        if (cell.sheet == largest) mean += cell.count * cell.p, count += cell.count;
    mean /= count;
    double nearest = 1e300;
    for (const WallCell& cell : cells_)
        if (const double d = (cell.p - mean).squaredNorm(); cell.sheet == largest && d < nearest) nearest = d, place_ = cell.p;
    const Cylindrical at = cylindrical(reference_, place_);
    const double angle = sheets_[largest].angle;
    const double side = std::cos(angle) < 0 ? -1 : 1;
    normal_ = side * (std::cos(angle) * at.outward + std::sin(angle) * reference_.direction);
    around_ = reference_.direction.cross(at.outward);
    tangent_ = around_.cross(normal_);
    if (tangent_.dot(reference_.direction) < 0) tangent_ = -tangent_;
    frame_angle_ = std::atan2(normal_.dot(reference_.direction), tangent_.dot(reference_.direction));
    curvature_ = std::abs(std::cos(angle)) / at.radius;
    reference_.point += at.height * reference_.direction;
    std::vector<double> angles;
    double low = 1e300, high = -1e300;
    for (const WallCell& cell : cells_) {
        const Cylindrical c = cylindrical(reference_, cell.p);
        low = std::min(low, c.height), high = std::max(high, c.height);
        angles.push_back(std::atan2(c.outward.dot(around_), c.outward.dot(at.outward)));
    }
    middle_height_ = (low + high) / 2, half_height_ = std::max(1e-9, (high - low) / 2);
    std::sort(angles.begin(), angles.end());
    double gap = angles.front() + 2 * pi - angles.back();
    for (std::size_t i = 1; i < angles.size(); ++i) gap = std::max(gap, angles[i] - angles[i - 1]);
    arc_ = 2 * pi - gap;
    short_arc_ = arc_ < 2 * pi / 3 && std::abs(std::cos(angle)) > 0.25;
}

SpaceLine RevolutionModel::line(const AxisStep& x) const {
    if (!short_arc_) {
        const Vector3d outward = (place_ - reference_.point).normalized();
        return {reference_.point + x[0] * outward + x[1] * around_,
                (reference_.direction + x[2] * outward + x[3] * around_).normalized()};
    }
    const double angle = frame_angle_ + x[2];
    return {place_ - (normal_ + x[1] * around_) / x[0],
            std::cos(x[3]) * (std::cos(angle) * tangent_ + std::sin(angle) * normal_) + std::sin(x[3]) * around_};
}

AxisStep RevolutionModel::step(const SpaceLine& given) const {
    SpaceLine line = given;
    if (line.direction.dot(reference_.direction) < 0) line.direction = -line.direction;
    if (!short_arc_) {
        const Vector3d outward = (place_ - reference_.point).normalized();
        const double along = line.direction.dot(reference_.direction);
        const Vector3d tilt = line.direction / along;
        const Vector3d foot = line.point + tilt * (reference_.point - line.point).dot(reference_.direction) - reference_.point;
        return {foot.dot(outward), foot.dot(around_), tilt.dot(outward), tilt.dot(around_)};
    }
    const Vector3d& a = line.direction;
    const double along = a.dot(tangent_);
    Vector3d v = line.point - place_;
    v -= v.dot(tangent_) / (std::abs(along) > 1e-9 ? along : 1e-9) * a;
    const double depth = -v.dot(normal_);
    const double curvature = 1 / (std::abs(depth) > 1e-9 ? depth : 1e-9);
    return {curvature, -v.dot(around_) * curvature, std::atan2(a.dot(normal_), along) - frame_angle_,
            std::asin(std::clamp(a.dot(around_), -1.0, 1.0))};
}

RevolutionModel::Chart RevolutionModel::chart(const AxisStep& x) const {
    const SpaceLine axis = line(x);
    const double side = short_arc_ && x[0] < 0 ? -1 : 1, turn = short_arc_ ? x[2] : 0;
    const Cylindrical at = cylindrical(axis, place_);
    const Vector3d e2 = axis.direction.cross(at.outward);
    std::vector<std::pair<double, double>> charts;
    for (const WallSheet& sheet : sheets_) charts.emplace_back(std::cos(sheet.angle + turn), std::sin(sheet.angle + turn));
    Chart chart;
    const std::size_t count = cells_.size();
    for (auto* list : {&chart.t, &chart.s, &chart.radius, &chart.height, &chart.cosine, &chart.sine}) list->resize(count);
    chart.range.assign(sheets_.size(), {1e300, -1e300});
    const Vector3d& a = axis.direction;
    for (std::size_t i = 0; i < count; ++i) {
        const Vector3d d = cells_[i].p - axis.point;
        const double along = d.dot(a);
        const Vector3d out = d - along * a;
        const double distance = out.norm(), r = side * (distance - at.radius), h = along - at.height;
        const auto& [c, s] = charts[cells_[i].sheet];
        chart.s[i] = c * r + s * h;
        chart.t[i] = c * h - s * r;
        chart.radius[i] = side * distance;
        chart.height[i] = h;
        chart.cosine[i] = out.dot(at.outward) / std::max(distance, 1e-300);
        chart.sine[i] = out.dot(e2) / std::max(distance, 1e-300);
        auto& [low, high] = chart.range[cells_[i].sheet];
        low = std::min(low, chart.t[i]), high = std::max(high, chart.t[i]);
    }
    return chart;
}

std::vector<double> RevolutionModel::radii(const AxisStep& x) const { return chart(x).radius; }
std::vector<double> RevolutionModel::heights(const AxisStep& x) const { return chart(x).height; }

namespace {

/// Standard deviations of the deviations from roundness, as shares of the amplitude: cosine and sine of two and three
/// times the angle, the same growing with height, and the height of a lip.
constexpr std::array<double, 14> extra_scale{1, 1, 0.35, 0.35, 0.3, 0.3, 0.1, 0.1, 0.15, 0.15, 0.15, 0.15, 0.1, 0.1};

/// Displacements of a cell along its profile's normal for unit deviations.
void fill_extras(double* row, double radius, double c1, double s1, double height, double outward, double upward, bool lip) {
    double c2 = c1 * c1 - s1 * s1, c3 = c2 * c1 - 2 * c1 * s1 * s1;
    const double s2 = 2 * c1 * s1, s3 = s2 * c1 + c2 * s1;
    const double out = radius * outward, up = lip ? radius * upward : 0;
    // Less their values at the middle of the wall, which the profile contains.
    c2 -= 1, c3 -= 1, c1 -= 1;
    const std::array<double, 14> values{out * c2,          out * s2,          out * c3,          out * s3, out * c2 * height,
                                        out * s2 * height, out * c3 * height, out * s3 * height, up * c1,  up * s1,
                                        up * c2,           up * s2,           up * c3,           up * s3};
    for (std::size_t k = 0; k < 14; ++k) row[k] = values[k] * extra_scale[k];
}

}  // namespace

/// Weight of a cell's squared residual.
double RevolutionModel::cell_weight(std::size_t i) const {
    const WallSheet& sheet = sheets_[cells_[i].sheet];
    return robust_[i] * cells_[i].count / (sheet.sigma * sheet.sigma * correlation_ * (1 + slope_[i] * slope_[i]));
}

/// Slopes of the fitted profiles at the cells.
std::vector<double> RevolutionModel::profile_slopes(const Chart& at) const {
    std::vector<double> slope(cells_.size(), 0);
    std::vector<BandedSystem> splines;
    for (const WallSheet& sheet : sheets_) splines.emplace_back(sheet.knots, 1);
    for (std::size_t i = 0; i < cells_.size(); ++i) {
        const std::size_t k = cells_[i].sheet;
        if (sheets_[k].used) splines[k].add(basis_at(at.parameter(i, k), sheets_[k].knots), cell_weight(i), &at.s[i]);
    }
    for (BandedSystem& spline : splines) spline.solve();
    for (std::size_t i = 0; i < cells_.size(); ++i) {
        const std::size_t k = cells_[i].sheet;
        const Basis basis = basis_at(at.parameter(i, k), sheets_[k].knots);
        const double range = std::max(1e-12, at.range[k].second - at.range[k].first);
        for (std::size_t a = 0; a < 4; ++a)
            slope[i] += basis.slope[a] * splines[k].coefficients()(0, static_cast<Eigen::Index>(basis.first + a)) / range;
    }
    return slope;
}

/// Central differences of the chart: for each cell, the derivatives of s and then of t by the four parameters of the step.
std::vector<double> RevolutionModel::chart_derivatives(const AxisStep& x) const {
    std::vector<double> derivative(8 * cells_.size());
    for (int k = 0; k < 4; ++k) {
        AxisStep plus = x, minus = x;
        const double h = 1e-5 * (k == 0 && short_arc_ ? std::abs(x[0]) : 1);
        plus[k] += h, minus[k] -= h;
        const Chart after = chart(plus), before = chart(minus);
        for (std::size_t i = 0; i < cells_.size(); ++i) {
            derivative[8 * i + static_cast<std::size_t>(k)] = (after.s[i] - before.s[i]) / (2 * h);
            derivative[8 * i + 4 + static_cast<std::size_t>(k)] = (after.t[i] - before.t[i]) / (2 * h);
        }
    }
    return derivative;
}

std::vector<RevolutionFit> RevolutionModel::fit(const AxisStep& x, const std::vector<RoundnessLevel>& levels,
                                                bool derivatives) const {
    const Chart at = chart(x);
    const bool deviations = std::any_of(levels.begin(), levels.end(), [](const auto& level) { return level.amplitude > 0; });
    const int slopes = derivatives ? 4 : 0, free = deviations ? extras : 0, columns = 1 + slopes + free;
    const double turn = short_arc_ ? x[2] : 0;
    const std::vector<double> slope = derivatives ? profile_slopes(at) : slope_;
    const std::vector<double> derivative = derivatives ? chart_derivatives(x) : std::vector<double>();
    std::vector<BandedSystem> splines;
    for (const WallSheet& sheet : sheets_) splines.emplace_back(sheet.knots, columns);
    Eigen::MatrixXd G = Eigen::MatrixXd::Zero(columns, columns);
    std::array<double, 1 + 4 + extras> row{};
    for (std::size_t i = 0; i < cells_.size(); ++i) {
        const std::size_t k = cells_[i].sheet;
        if (!sheets_[k].used) continue;
        row[0] = at.s[i];
        for (std::size_t a = 0; a < static_cast<std::size_t>(slopes); ++a)
            row[1 + a] = derivative[8 * i + a] - slope[i] * derivative[8 * i + 4 + a];
        if (deviations) {
            const double c = std::cos(sheets_[k].angle + turn), s = std::sin(sheets_[k].angle + turn);
            fill_extras(&row[static_cast<std::size_t>(1 + slopes)], at.radius[i], at.cosine[i], at.sine[i],
                        (at.height[i] - middle_height_) / half_height_, c + slope_[i] * s, s - slope_[i] * c, !sheets_[k].wall);
        }
        const double weight = cell_weight(i);
        splines[k].add(basis_at(at.parameter(i, k), sheets_[k].knots), weight, row.data());
        for (Eigen::Index a = 0; a < columns; ++a) {
            const double scaled = weight * row[static_cast<std::size_t>(a)];
            for (Eigen::Index b = 0; b <= a; ++b) G(a, b) += scaled * row[static_cast<std::size_t>(b)];
        }
    }
    G.triangularView<Eigen::StrictlyUpper>() = G.transpose();
    for (BandedSystem& spline : splines) {
        spline.solve();
        G -= spline.explained();
    }
    std::vector<RevolutionFit> fits;
    for (const RoundnessLevel& level : levels) {
        Eigen::MatrixXd reduced = G.topLeftCorner(1 + slopes, 1 + slopes);
        RevolutionFit& fit = fits.emplace_back();
        if (deviations && level.amplitude > 0) {
            const double e = level.amplitude;
            Eigen::MatrixXd A = e * e * G.bottomRightCorner(extras, extras) + Eigen::MatrixXd::Identity(extras, extras);
            Eigen::MatrixXd B = e * G.bottomLeftCorner(extras, 1 + slopes);
            fit.log_volume = -factorise(A) / 2;
            solve_lower(A, B);
            reduced -= B.transpose().lazyProduct(B);
            Eigen::MatrixXd F = Eigen::MatrixXd::Zero(extras, 2);
            for (Eigen::Index k = 0; k < 4; ++k) {
                F(k, 0) = e * mean_extra_[static_cast<std::size_t>(k)];
                F(k + 4, 1) = e * mean_extra_[static_cast<std::size_t>(k + 4)];
            }
            solve_lower(A, F);
            fit.deviation = F.transpose().lazyProduct(B.col(0));
            Eigen::MatrixXd covariance = F.transpose().lazyProduct(F);
            factorise(covariance);
            fit.deviation_root << covariance(0, 0), 0, covariance(1, 0), covariance(1, 1);
        }
        fit.squares = reduced(0, 0);
        if (derivatives) fit.H = reduced.bottomRightCorner<4, 4>(), fit.g = reduced.bottomLeftCorner<4, 1>();
    }
    return fits;
}

namespace {

/// Posterior mean of the deviations from roundness, of which `amplitude` is the standard deviation. G: normal matrix of the
/// column of targets and the columns of deviations.
Eigen::VectorXd expected_deviation(const Eigen::MatrixXd& G, double amplitude) {
    const Eigen::Index count = G.rows() - 1;
    if (!(amplitude > 0)) return Eigen::VectorXd::Zero(count);
    Eigen::MatrixXd A = amplitude * amplitude * G.bottomRightCorner(count, count) + Eigen::MatrixXd::Identity(count, count);
    Eigen::MatrixXd b = amplitude * G.block(1, 0, count, 1);
    factorise(A);
    solve_lower(A, b);
    for (Eigen::Index i = count - 1; i >= 0; --i) {
        for (Eigen::Index k = i + 1; k < count; ++k) b(i, 0) -= A(k, i) * b(k, 0);
        b(i, 0) /= A(i, i);
    }
    return amplitude * b.col(0);
}

}  // namespace

/// Sets the robust weights of the cells and the noise of the sheets from the residuals, of which `errors` are the absolute values
/// for each sheet. `select_sheets`: sheets that are much noisier than the best wall are no longer used.
void RevolutionModel::update_noise(const std::vector<std::vector<double>>& errors, bool select_sheets) {
    std::vector<double> scale(sheets_.size());
    for (std::size_t k = 0; k < sheets_.size(); ++k)
        scale[k] = std::max(min_sigma, errors[k].empty() ? 0 : 1.4826 * upper_median(errors[k]));
    std::vector<double> sum(sheets_.size(), 0), weight(sheets_.size(), 0);
    for (std::size_t i = 0; i < cells_.size(); ++i) {
        const std::size_t k = cells_[i].sheet;
        const double u = residuals_[i] / (4.685 * scale[k]);
        robust_[i] = std::abs(u) < 1 ? (1 - u * u) * (1 - u * u) : 0;
        sum[k] += robust_[i] * residuals_[i] * residuals_[i], weight[k] += robust_[i];
    }
    double best = 1e300;
    for (std::size_t k = 0; k < sheets_.size(); ++k) {
        // Weighted sums of Tukey's biweight: of normal errors they give 0.83 of the variance.
        const double cells = std::max(1.0, static_cast<double>(errors[k].size()));
        sheets_[k].sigma = std::max(
            min_sigma, std::sqrt(sum[k] / std::max(1e-300, weight[k]) * 1.207 * cells / std::max(1.0, cells - sheets_[k].knots)));
        if (sheets_[k].wall && sheets_[k].vertices > 0) best = std::min(best, sheets_[k].sigma);
    }
    if (select_sheets)
        for (WallSheet& sheet : sheets_) sheet.used = sheet.sigma < (sheet.wall ? 6 : 3) * best;
}

/// Means of the deviations from roundness over the walls.
void RevolutionModel::average_extras(const Chart& at) {
    mean_extra_.fill(0);
    double total = 0;
    for (std::size_t i = 0; i < cells_.size(); ++i) {
        if (!sheets_[cells_[i].sheet].wall) continue;
        const double c = at.cosine[i], s = at.sine[i], n = cells_[i].count;
        const std::array<double, 4> values{c * c - s * s, 2 * c * s, 4 * c * c * c - 3 * c, 3 * s - 4 * s * s * s};
        for (std::size_t k = 0; k < 4; ++k) {
            mean_extra_[k] += n * values[k] * extra_scale[k];
            mean_extra_[k + 4] += n * values[k] * extra_scale[k + 4];
        }
        total += n;
    }
    for (double& value : mean_extra_) value /= std::max(1.0, total);
}

/// Estimates how much neighbouring residuals agree, from their sums over patches of the walls.
void RevolutionModel::estimate_correlation(const Chart& at, double amplitude) {
    // Patches of the wall: neighbouring residuals that agree are not independent.
    std::map<std::array<int, 3>, std::array<double, 2>> patches;
    std::vector<std::pair<double, double>> turns(sheets_.size(), {1e300, -1e300});
    for (std::size_t i = 0; i < cells_.size(); ++i) {
        const double angle = std::atan2(at.sine[i], at.cosine[i]);
        auto& [low, high] = turns[cells_[i].sheet];
        low = std::min(low, angle), high = std::max(high, angle);
    }
    for (std::size_t i = 0; i < cells_.size(); ++i) {
        const std::size_t k = cells_[i].sheet;
        if (!sheets_[k].used || !sheets_[k].wall) continue;
        const double angle = std::atan2(at.sine[i], at.cosine[i]), width = std::max(1e-12, turns[k].second - turns[k].first);
        auto& patch = patches[{static_cast<int>(k), static_cast<int>(7.99 * at.parameter(i, k)),
                               static_cast<int>(7.99 * (angle - turns[k].first) / width)}];
        patch[0] += robust_[i] * residuals_[i] / sheets_[k].sigma, patch[1] += robust_[i] * robust_[i];
    }
    double observed = 0, expected = 0;
    for (const auto& [key, patch] : patches) observed += patch[0] * patch[0], expected += patch[1];
    // The fit takes part of the means over patches: one for each row of patches, and the axis and the deviations.
    const double rows =
        8 * double(std::count_if(sheets_.begin(), sheets_.end(), [](const WallSheet& s) { return s.used && s.wall; }));
    expected *= std::max(0.4, 1 - (rows + 4 + (amplitude > 0 ? 8 : 0)) / double(std::max<std::size_t>(1, patches.size())));
    correlation_ = std::max(1.0, expected > 0 ? observed / expected : 1);
}

void RevolutionModel::weigh(const AxisStep& x, double amplitude) {
    const Chart at = chart(x);
    const double turn = short_arc_ ? x[2] : 0;
    for (int round = 0; round < 5; ++round) {
        const int columns = 1 + extras;
        std::vector<BandedSystem> splines;
        for (const WallSheet& sheet : sheets_) splines.emplace_back(sheet.knots, columns);
        Eigen::MatrixXd G = Eigen::MatrixXd::Zero(columns, columns);
        std::vector<std::array<double, 1 + extras>> rows(cells_.size());
        for (std::size_t i = 0; i < cells_.size(); ++i) {
            const WallSheet& sheet = sheets_[cells_[i].sheet];
            const double c = std::cos(sheet.angle + turn), s = std::sin(sheet.angle + turn);
            rows[i][0] = at.s[i];
            fill_extras(&rows[i][1], at.radius[i], at.cosine[i], at.sine[i], (at.height[i] - middle_height_) / half_height_,
                        c + slope_[i] * s, s - slope_[i] * c, !sheet.wall);
            const double weight = robust_[i] * cells_[i].count / (sheet.sigma * sheet.sigma * (1 + slope_[i] * slope_[i]));
            splines[cells_[i].sheet].add(basis_at(at.parameter(i, cells_[i].sheet), sheet.knots), weight, rows[i].data());
            if (!sheet.used) continue;
            for (Eigen::Index a = 0; a < columns; ++a)
                for (Eigen::Index b = 0; b < columns; ++b)
                    G(a, b) += weight * rows[i][static_cast<std::size_t>(a)] * rows[i][static_cast<std::size_t>(b)];
        }
        for (std::size_t k = 0; k < sheets_.size(); ++k) {
            splines[k].solve();
            if (sheets_[k].used) G -= splines[k].explained();
        }
        const Eigen::VectorXd deviation = expected_deviation(G, amplitude);
        std::vector<std::vector<double>> errors(sheets_.size());
        for (std::size_t i = 0; i < cells_.size(); ++i) {
            const std::size_t k = cells_[i].sheet;
            const Basis basis = basis_at(at.parameter(i, k), sheets_[k].knots);
            const double range = std::max(1e-12, at.range[k].second - at.range[k].first);
            double slope = 0, value = rows[i][0];
            for (Eigen::Index c = 0; c < extras; ++c) value -= deviation[c] * rows[i][static_cast<std::size_t>(c + 1)];
            for (std::size_t a = 0; a < 4; ++a) {
                const auto column = splines[k].coefficients().col(static_cast<Eigen::Index>(basis.first + a));
                const double coefficient = column[0] - deviation.dot(column.tail(extras));
                value -= basis.value[a] * coefficient;
                slope += basis.slope[a] * coefficient / range;
            }
            slope_[i] = std::clamp(slope, -4.0, 4.0);
            residuals_[i] = value / std::sqrt(1 + slope_[i] * slope_[i]) * std::sqrt(cells_[i].count);
            errors[k].push_back(std::abs(residuals_[i]));
        }
        update_noise(errors, round >= 2);
    }
    average_extras(at);
    estimate_correlation(at, amplitude);
}

}  // namespace ostraka::detail

// Best axis by Levenberg-Marquardt from several lines; posterior by adaptive importance sampling.
#include "axis/revolution_posterior.h"

#include "ostraka/core/angles.h"
#include "ostraka/stats/random.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>

namespace ostraka::detail {

using Eigen::Matrix3d;
using Eigen::Matrix4d;
using Eigen::Vector3d;
using Eigen::Vector4d;

namespace {

/// Lower Cholesky factor of the inverse of a symmetric matrix, regularised where it is nearly singular.
Matrix4d root_of_inverse(const Matrix4d& H, double floor) {
    Matrix4d A = H;
    A.diagonal().array() += 1e-12 * H.trace();
    for (int k = 0; k < 4; ++k) A(k, k) += floor;
    const Matrix4d inverse = A.inverse();
    Matrix4d L = Matrix4d::Zero();
    for (int j = 0; j < 4; ++j)
        for (int i = j; i < 4; ++i) {
            double sum = (inverse(i, j) + inverse(j, i)) / 2;
            for (int k = 0; k < j; ++k) sum -= L(i, k) * L(j, k);
            L(i, j) = i == j ? std::sqrt(std::max(sum, 1e-30)) : sum / L(j, j);
        }
    return L;
}

double log_determinant(const Matrix4d& H) {
    const double value = H.determinant();
    return value > 0 ? std::log(value) : -700;
}

/// Levenberg-Marquardt steps to the best axis at one level of roundness.
AxisStep climb(const RevolutionModel& model, AxisStep x, double amplitude, int rounds) {
    const std::vector<RoundnessLevel> level{{amplitude, 1}};
    RevolutionFit now = model.fit(x, level, true)[0];
    double damping = 1e-4;
    for (int round = 0; round < rounds; ++round) {
        Matrix4d A = now.H;
        for (int k = 0; k < 4; ++k) A(k, k) += damping * now.H(k, k) + 1e-12 * now.H.trace();
        Vector4d step = -(A.inverse() * now.g);
        if (!step.allFinite()) break;
        const double most = model.short_arc() ? std::max(0.2, 0.5 * std::abs(x[0])) : 0.3;
        step *= std::min({1.0, most / std::max(1e-300, std::abs(step[0])), 0.3 / std::max(1e-300, step.tail<3>().norm())});
        const AxisStep next = x + step;
        const double squares = model.fit(next, level, false)[0].squares;
        const double gain = now.squares - squares;
        if (gain > 0 || (gain > -1e-9 * now.squares && step.norm() < 1e-6)) {
            x = next;
            damping = std::max(1e-9, damping / 8);
            if (gain < 1e-4) break;
            now = model.fit(x, level, true)[0];
        } else {
            damping = std::max(1e-3, damping * 10);
            if (damping > 1e8) break;
        }
    }
    return x;
}

/// Sum over all vertices of the logarithm of the residual: few vertices far off, such as those of fractures, count less than many
/// with a small residual. Vertices on no sheet count with the largest.
double deviation_of(const RevolutionModel& model, std::size_t vertices) {
    constexpr double limit = 0.02, unit = 1e-3;
    const auto score = [](double square) { return std::log1p(std::min(limit * limit, square) / (unit * unit)); };
    double sum = 0, counted = 0;
    for (std::size_t i = 0; i < model.cells().size(); ++i) {
        const double count = model.cells()[i].count, residual = model.residuals()[i] / std::sqrt(count);
        const double sigma = model.sheets()[model.cells()[i].sheet].sigma;
        sum += count * score(residual * residual + sigma * sigma);
        counted += count;
    }
    return sum + score(limit * limit) * std::max(0.0, double(vertices) - counted);
}

struct Candidate {
    SpaceLine line;
    double deviation;
};

/// Improves an initial line; none if too few vertices are on walls about it.
std::optional<Candidate> improve(const WallVertices& vertices, SpaceLine line, double amplitude, int rounds, std::size_t cells) {
    double deviation = 1e300;
    for (int round = 0; round < rounds; ++round) {
        RevolutionModel model(vertices, line, cells);
        if (!model.enough()) return {};
        AxisStep x = model.step(line);
        if (!x.allFinite()) return {};
        for (int again = 0; again < 2; ++again) {
            model.weigh(x, amplitude);
            x = climb(model, x, amplitude, 12);
        }
        model.weigh(x, amplitude);
        if (!x.allFinite()) return {};
        line = model.line(x);
        deviation = deviation_of(model, vertices.points.size());
        if (!line.point.allFinite() || line.point.norm() > 1e5) return {};
    }
    return Candidate{line, deviation};
}

std::vector<RoundnessLevel> levels_of(double out_of_round) {
    if (!(out_of_round > 0)) return {{0, 1}};
    return {{0, 0.1}, {out_of_round / 2, 0.15}, {out_of_round, 0.4}, {2 * out_of_round, 0.35}};
}

/// A multivariate t distribution with six degrees of freedom.
struct Component {
    Vector4d mean;
    Matrix4d L;
    double weight;
    [[nodiscard]] double log_density(const Vector4d& x) const {
        Vector4d z = x - mean;
        double log_volume = 0;
        for (int i = 0; i < 4; ++i) {
            for (int k = 0; k < i; ++k) z[i] -= L(i, k) * z[k];
            z[i] /= L(i, i);
            log_volume += std::log(L(i, i));
        }
        return -log_volume - 5 * std::log(1 + z.squaredNorm() / 6);
    }
};

double log_sum(const std::vector<double>& values) {
    const double most = *std::max_element(values.begin(), values.end());
    double sum = 0;
    for (const double value : values) sum += std::exp(value - most);
    return most + std::log(sum);
}

class Sampler {
public:
    Sampler(RevolutionPosterior& posterior, const PosteriorOptions& options)
        : posterior_(posterior),
          model_(*posterior.model),
          options_(options),
          levels_(levels_of(options.out_of_round)),
          random_(options.seed) {}

    void run(const std::vector<AxisStep>& modes) {
        std::vector<double> evidence;
        for (const AxisStep& mode : modes)
            for (const RoundnessLevel& level : levels_) {
                const AxisStep x = climb(model_, mode, level.amplitude, 10);
                const RevolutionFit fit = model_.fit(x, {level}, true)[0];
                components_.push_back({x, 1.2 * root_of_inverse(fit.H, 1e-2), 0});
                evidence.push_back(std::log(level.prior) + fit.log_volume - fit.squares / 2);
            }
        const auto most = static_cast<std::size_t>(std::max_element(evidence.begin(), evidence.end()) - evidence.begin());
        posterior_.best = components_[most].mean;
        posterior_.amplitude = levels_[most % levels_.size()].amplitude;
        const double total = log_sum(evidence);
        for (std::size_t k = 0; k < components_.size(); ++k) components_[k].weight = std::exp(evidence[k] - total) + 0.03;
        make_prior(components_[most]);
        constexpr int fewest_rounds = 3;
        for (int round = 1;; ++round) {
            draw();
            weigh();
            if (round >= options_.rounds || (round >= fewest_rounds && posterior_.effective >= options_.enough)) break;
            adapt();
        }
    }

private:
    /// Jeffreys' prior: half the logarithm of the determinant of the information, as a separable quadratic function of the
    /// principal coordinates about the best axis.
    void make_prior(const Component& mode) {
        prior_mode_ = mode;
        const auto value = [&](const Vector4d& z) {
            const double result = log_determinant(model_.fit(mode.mean + mode.L * z, {{0, 1}}, true)[0].H) / 2;
            return std::isfinite(result) ? result : 0;
        };
        const double middle = value(Vector4d::Zero());
        for (int k = 0; k < 4; ++k) {
            const double after = value(1.5 * Vector4d::Unit(k)) - middle, before = value(-1.5 * Vector4d::Unit(k)) - middle;
            prior_slope_[k] = (after - before) / 3;
            prior_bend_[k] = std::min(0.0, (after + before) / 4.5);
        }
    }
    [[nodiscard]] double log_prior(const AxisStep& x) const {
        Vector4d z = x - prior_mode_.mean;
        for (int i = 0; i < 4; ++i) {
            for (int k = 0; k < i; ++k) z[i] -= prior_mode_.L(i, k) * z[k];
            z[i] /= prior_mode_.L(i, i);
        }
        z = z.cwiseMax(-4).cwiseMin(4);
        return prior_slope_.dot(z) + prior_bend_.dot(z.cwiseAbs2());
    }
    [[nodiscard]] double log_target(const AxisStep& x, Eigen::Vector2d& deviation) {
        if (model_.short_arc() && std::abs(x[0]) < 1e-5) return -1e300;
        if (model_.short_arc() && (std::abs(x[2]) > 1.4 || std::abs(x[3]) > 1.4)) return -1e300;
        std::vector<double> terms;
        const std::vector<RevolutionFit> fits = model_.fit(x, levels_, false);
        for (std::size_t k = 0; k < levels_.size(); ++k)
            terms.push_back(std::log(levels_[k].prior) + fits[k].log_volume - fits[k].squares / 2);
        const double total = log_sum(terms);
        // One level of roundness and one deviation of the arc for each sample.
        double choice = random_.uniform();
        std::size_t k = 0;
        while (k + 1 < terms.size() && choice > std::exp(terms[k] - total)) choice -= std::exp(terms[k++] - total);
        const double first = random_.normal();
        deviation = fits[k].deviation + fits[k].deviation_root * Eigen::Vector2d(first, random_.normal());
        return total + log_prior(x);
    }
    void draw() {
        double total = 0;
        for (const Component& c : components_) total += c.weight;
        for (int i = 0; i < options_.draws; ++i) {
            double choice = random_.uniform() * total;
            std::size_t k = 0;
            while (k + 1 < components_.size() && choice > components_[k].weight) choice -= components_[k++].weight;
            Vector4d z;
            for (int d = 0; d < 4; ++d) z[d] = random_.normal();
            double chi = 0;
            for (int d = 0; d < 6; ++d) chi += std::pow(random_.normal(), 2);
            const AxisStep x = components_[k].mean + components_[k].L * z * std::sqrt(6 / chi);
            posterior_.samples.push_back(x);
            targets_.push_back(log_target(x, posterior_.deviations.emplace_back(0, 0)));
        }
        rounds_.push_back(components_);
    }
    /// Weights of all samples against the mixture of all rounds.
    void weigh() {
        logs_.clear();
        for (std::size_t i = 0; i < posterior_.samples.size(); ++i) {
            std::vector<double> terms;
            for (const auto& round : rounds_) {
                double total = 0;
                for (const Component& c : round) total += c.weight;
                for (const Component& c : round)
                    terms.push_back(std::log(c.weight / total) + c.log_density(posterior_.samples[i]));
            }
            logs_.push_back(targets_[i] - log_sum(terms));
        }
        posterior_.weights = tempered(1);
        posterior_.effective = effective_number(posterior_.weights);
    }
    /// Importance weights to a power, with the sum 1.
    [[nodiscard]] std::vector<double> tempered(double power) const {
        std::vector<double> weights;
        for (const double value : logs_) weights.push_back(power * value);
        const double total = log_sum(weights);
        for (double& weight : weights) weight = std::exp(weight - total);
        return weights;
    }
    static double effective_number(const std::vector<double>& weights) {
        double squares = 0;
        for (const double weight : weights) squares += weight * weight;
        return 1 / squares;
    }
    /// Adds a component with the mean and covariance of the samples to the proposal, and a wider one. While few samples have most
    /// of the weight, weights are evened out so that the covariance is not that of these few.
    void adapt() {
        constexpr double fewest = 50;
        std::vector<double> weights = posterior_.weights;
        for (double power = 0.8; effective_number(weights) < fewest && power > 1e-3; power *= 0.8) weights = tempered(power);
        Vector4d mean = Vector4d::Zero();
        Matrix4d covariance = Matrix4d::Zero();
        for (std::size_t i = 0; i < weights.size(); ++i) mean += weights[i] * posterior_.samples[i];
        for (std::size_t i = 0; i < weights.size(); ++i) {
            const Vector4d d = posterior_.samples[i] - mean;
            covariance += weights[i] * d * d.transpose();
        }
        Component component{mean, root_of_inverse(covariance.inverse(), 0), 0};
        if (!component.L.allFinite()) {
            for (Component& c : components_) c.L *= 1.5;
            return;
        }
        double total = 0;
        for (const Component& c : components_) total += c.weight;
        component.weight = 0.7 * total;
        components_.push_back(component);
        component.L *= 2;
        component.weight = 0.3 * total;
        components_.push_back(component);
    }

    RevolutionPosterior& posterior_;
    const RevolutionModel& model_;
    const PosteriorOptions& options_;
    std::vector<RoundnessLevel> levels_;
    Random random_;
    std::vector<Component> components_;
    std::vector<std::vector<Component>> rounds_;
    std::vector<double> targets_, logs_;
    Component prior_mode_;
    Vector4d prior_slope_ = Vector4d::Zero(), prior_bend_ = Vector4d::Zero();
};

}  // namespace

double RevolutionPosterior::quantile(const std::vector<double>& values, double fraction) const {
    std::vector<std::size_t> order(values.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
    double sum = 0;
    for (const std::size_t i : order)
        if (sum += weights[i]; sum >= fraction) return values[i];
    return values[order.back()];
}

RevolutionPosterior revolution_posterior(const WallVertices& vertices, const std::vector<SpaceLine>& starts,
                                         const PosteriorOptions& options) {
    RevolutionPosterior posterior;
    std::vector<Candidate> candidates;
    const double amplitude = options.out_of_round / 2;
    for (const SpaceLine& start : starts)
        if (const auto candidate = improve(vertices, start, amplitude, 1, 120)) candidates.push_back(*candidate);
    if (candidates.empty()) return posterior;
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Candidate& a, const Candidate& b) { return a.deviation < b.deviation; });
    constexpr double other_direction = 15 * degree;
    for (const Candidate& candidate : candidates)
        if (candidate.line.direction.cross(candidates[0].line.direction).norm() > std::sin(other_direction))
            posterior.margin = std::min(posterior.margin, (candidate.deviation - candidates[0].deviation) /
                                                              double(std::max<std::size_t>(1, vertices.points.size())));
    if (const auto better = improve(vertices, candidates[0].line, amplitude, 2, 250)) candidates[0] = *better;
    RevolutionModel& model = posterior.model.emplace(vertices, candidates[0].line, 500);
    if (!model.enough()) {
        posterior.model.reset();
        return posterior;
    }
    AxisStep x = model.step(candidates[0].line);
    for (int round = 0; round < 3; ++round) {
        model.weigh(x, amplitude);
        x = climb(model, x, amplitude, 20);
    }
    model.weigh(x, amplitude);
    Sampler(posterior, options).run({x});
    return posterior;
}

namespace {

double arc_of(const std::vector<double>& turns) {
    std::vector<double> sorted = turns;
    std::sort(sorted.begin(), sorted.end());
    double gap = sorted.front() + 2 * pi - sorted.back();
    for (std::size_t i = 1; i < sorted.size(); ++i) gap = std::max(gap, sorted[i] - sorted[i - 1]);
    return 2 * pi - gap;
}

/// Share of the circle over which cells lie, with half a cell at both ends.
double share_of(const RevolutionPosterior& posterior, const std::vector<std::size_t>& cells) {
    const SpaceLine line = posterior.model->line(posterior.best);
    const Vector3d u = line.direction.unitOrthogonal(), w = line.direction.cross(u);
    std::vector<double> turns;
    for (const std::size_t i : cells) {
        const Vector3d d = posterior.model->cells()[i].p - line.point;
        turns.push_back(std::atan2(d.dot(w), d.dot(u)));
    }
    return turns.empty() ? 0 : std::min(1.0, arc_of(turns) / (2 * pi) * (1 + 1.0 / double(turns.size())));
}

/// Mean of the cells' radii and heights, and its error. `place_variance`: of the radius of the ring among the cells.
void finish(const RevolutionPosterior& posterior, const std::vector<double>& radius, double ring_radius, double place_variance,
            WallRing& ring) {
    const std::vector<double> heights = posterior.model->heights(posterior.best);
    double sum = 0, count = 0, height = 0;
    for (const std::size_t i : ring.cells) {
        const double n = posterior.model->cells()[i].count;
        sum += radius[i], count += n, height += heights[i];
    }
    ring.correction = ring_radius - sum / double(ring.cells.size());
    ring.height = std::clamp(posterior.model->relative_height(height / double(ring.cells.size())), -1.0, 1.0);
    const double sigma = posterior.model->sheets()[posterior.model->cells()[ring.cells[0]].sheet].sigma;
    ring.error = std::sqrt(sigma * sigma / std::max(1.0, count) + place_variance);
    ring.share = share_of(posterior, ring.cells);
}

/// Radius of the highest place of a section, and its variance.
struct SectionTop {
    double radius, variance;
};
/// A section about a point in it: distance as a cubic of the angle from the vertical.
class PolarSection {
public:
    explicit PolarSection(const Eigen::Vector4d& coefficients, double low, double high)
        : coefficients_(coefficients), low_(low), high_(high) {}
    [[nodiscard]] double at(double angle) const {
        return coefficients_[0] + angle * (coefficients_[1] + angle * (coefficients_[2] + angle * coefficients_[3]));
    }
    /// Angle of the highest place.
    [[nodiscard]] double top() const {
        constexpr int steps = 60;
        double best = low_, high = -1e300;
        for (int k = 0; k <= steps; ++k) {
            const double angle = low_ + (high_ - low_) * k / steps, height = at(angle) * std::cos(angle);
            if (height > high) high = height, best = angle;
        }
        double left = std::max(low_, best - (high_ - low_) / steps), right = std::min(high_, best + (high_ - low_) / steps);
        for (int k = 0; k < 60; ++k) {
            const double a = left + (right - left) / 3, b = right - (right - left) / 3;
            (at(a) * std::cos(a) < at(b) * std::cos(b) ? left : right) = at(a) * std::cos(a) < at(b) * std::cos(b) ? a : b;
        }
        return (left + right) / 2;
    }
    /// Distance aside of the highest place.
    [[nodiscard]] double aside() const {
        const double angle = top();
        return at(angle) * std::sin(angle);
    }

private:
    Eigen::Vector4d coefficients_;
    double low_, high_;
};

/// The highest place of points of a section (radius, height upwards), from a polar curve about the centre of their circle. None
/// if they are flat or if the highest place is at their end.
std::optional<SectionTop> top_of_section(const std::vector<Eigen::Vector2d>& points) {
    if (points.size() < 12) return {};
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    for (const auto& p : points) mean += p;
    mean /= double(points.size());
    Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
    Vector3d b = Vector3d::Zero();
    double extent = 0;
    for (const auto& p : points) {
        const Eigen::Vector2d d = p - mean;
        const Vector3d row(2 * d.x(), 2 * d.y(), 1);
        A += row * row.transpose(), b += d.squaredNorm() * row;
        extent = std::max(extent, std::abs(d.x()));
    }
    const Vector3d circle = A.inverse() * b;
    const Eigen::Vector2d centre = mean + circle.head<2>();
    const double radius = std::sqrt(std::max(0.0, circle[2] + circle.head<2>().squaredNorm()));
    // Flat, or hollow.
    if (!circle.allFinite() || radius > 4 * extent || circle[1] > 0) return {};
    Matrix4d normal = Matrix4d::Zero();
    Vector4d right = Vector4d::Zero();
    double low = 1e300, high = -1e300, squares = 0;
    std::vector<std::pair<double, double>> polar;
    for (const auto& p : points) {
        const Eigen::Vector2d d = p - centre;
        const double u = std::atan2(d.x(), d.y());
        if (std::abs(u) > 1.4) continue;
        polar.emplace_back(u, d.norm());
        const Vector4d row(1, u, u * u, u * u * u);
        normal += row * row.transpose(), right += d.norm() * row;
        low = std::min(low, u), high = std::max(high, u);
    }
    if (polar.size() < 12 || high - low < 0.4) return {};
    for (int k = 0; k < 4; ++k) normal(k, k) *= 1 + 1e-9;
    const Matrix4d inverse = normal.inverse();
    const Vector4d coefficients = inverse * right;
    const PolarSection section(coefficients, low, high);
    const double angle = section.top();
    if (!inverse.allFinite() || angle < low + 0.02 * (high - low) || angle > high - 0.02 * (high - low)) return {};
    for (const auto& [u, distance] : polar) squares += std::pow(distance - section.at(u), 2);
    Vector4d slope;
    for (int k = 0; k < 4; ++k) {
        const double step = 1e-3 * radius;
        slope[k] = (PolarSection(coefficients + step * Vector4d::Unit(k), low, high).aside() -
                    PolarSection(coefficients - step * Vector4d::Unit(k), low, high).aside()) /
                   (2 * step);
    }
    return SectionTop{centre.x() + section.aside(), squares / double(polar.size() - 4) * slope.dot(inverse * slope)};
}

/// The ring of a lip, and how far the lip falls off from its top.
struct Lip {
    WallRing ring;
    double depth;
};
/// None for a floor or for a lip that is no end of the walls.
std::optional<Lip> ring_of_lip(const RevolutionPosterior& posterior, std::size_t sheet, const std::vector<double>& radius,
                               const std::vector<double>& height) {
    const RevolutionModel& model = *posterior.model;
    // Above or below the walls, whatever the orientation of the faces.
    double lip_height = 0, wall_height = 0, lip_cells = 0, wall_cells = 0;
    for (std::size_t i = 0; i < radius.size(); ++i) {
        if (model.cells()[i].sheet == sheet) lip_height += height[i], ++lip_cells;
        else if (model.sheets()[model.cells()[i].sheet].wall) wall_height += height[i], ++wall_cells;
    }
    const double side = lip_height * wall_cells > wall_height * lip_cells ? 1 : -1;
    std::vector<std::size_t> members;
    double inner = 1e300, outer = -1e300, top = -1e300, walls = -1e300, lowest_wall = 1e300, lowest_lip = 1e300;
    for (std::size_t i = 0; i < radius.size(); ++i) {
        const double h = side * height[i], r = std::abs(radius[i]);
        if (model.cells()[i].sheet == sheet)
            members.push_back(i), inner = std::min(inner, r), outer = std::max(outer, r), top = std::max(top, h),
                                  lowest_lip = std::min(lowest_lip, h);
        else if (model.sheets()[model.cells()[i].sheet].wall) walls = std::max(walls, h), lowest_wall = std::min(lowest_wall, h);
    }
    if (members.size() < 8 || outer - inner > 0.25 * outer || top < walls - 0.02 * (walls - lowest_wall)) return {};
    // On a leaning wall the top is beyond the sheet of the lip: cells of its neighbours are used too.
    const double margin = 0.7 * (outer - inner), from = inner - margin, width = outer - inner + 2 * margin;
    std::vector<std::size_t> near;
    for (std::size_t i = 0; i < radius.size(); ++i)
        if (model.sheets()[model.cells()[i].sheet].used && side * height[i] > lowest_lip - margin && std::abs(radius[i]) > from &&
            std::abs(radius[i]) < from + width)
            near.push_back(i);
    // Mean heights of rows by radius have the top.
    constexpr int rows = 13;
    std::array<double, rows> sum{}, count{};
    for (const std::size_t i : near) {
        const auto row =
            static_cast<std::size_t>(std::clamp(rows * (std::abs(radius[i]) - from) / std::max(1e-12, width), 0.0, rows - 1.0));
        sum[row] += side * height[i], count[row] += 1;
    }
    const double most = *std::max_element(count.begin(), count.end());
    double best = -1e300, lowest = 1e300;
    for (std::size_t k = 0; k < rows; ++k)
        if (count[k] > most / 4) best = std::max(best, sum[k] / count[k]), lowest = std::min(lowest, sum[k] / count[k]);
    // A polar curve through the points near the top, or the middle of a flat lip.
    const double depth = std::max(0.25 * (outer - inner), 3 * model.sheets()[sheet].sigma);
    WallRing ring;
    ring.rim = true;
    std::vector<Eigen::Vector2d> section, wide_section;
    double mean = 0, squares = 0;
    for (const std::size_t i : near) {
        if (side * height[i] > best - 1.5 * depth) wide_section.emplace_back(std::abs(radius[i]), side * height[i]);
        if (side * height[i] < best - depth) continue;
        ring.cells.push_back(i);
        section.emplace_back(std::abs(radius[i]), side * height[i]);
        mean += section.back().x(), squares += section.back().x() * section.back().x();
    }
    if (ring.cells.size() < 5) return {};
    mean /= double(ring.cells.size());
    const double sign = radius[ring.cells[0]] < 0 ? -1 : 1, spread = squares / double(ring.cells.size()) - mean * mean;
    SectionTop at = top_of_section(section).value_or(SectionTop{mean, std::max(0.0, spread) / 16});
    // The top depends on the shape of the lip too: the difference from that of a wider section counts as an error.
    if (const auto wider = top_of_section(wide_section)) at.variance += std::pow(wider->radius - at.radius, 2) / 2;
    finish(posterior, radius, sign * at.radius, at.variance, ring);
    // A lip that is preserved along less than half of the wall is a corner of it.
    if (ring.share < 0.5 * model.arc() / (2 * pi)) return {};
    return Lip{std::move(ring), best - lowest};
}

}  // namespace

WallRing widest_ring(const RevolutionPosterior& posterior) {
    const RevolutionModel& model = *posterior.model;
    const std::vector<double> radius = model.radii(posterior.best), height = model.heights(posterior.best);
    std::vector<std::pair<double, std::size_t>> wide;
    double low = 1e300, high = -1e300;
    for (std::size_t i = 0; i < radius.size(); ++i)
        if (model.sheets()[model.cells()[i].sheet].used && model.robust()[i] > 0) {
            wide.emplace_back(std::abs(radius[i]), i);
            low = std::min(low, height[i]), high = std::max(high, height[i]);
        }
    std::sort(wide.begin(), wide.end());
    // The height of the widest cells, and the cells of their sheet near this height.
    WallRing ring;
    if (wide.empty()) return ring;
    const std::size_t few = std::max<std::size_t>(1, wide.size() / 50);
    std::vector<double> heights;
    for (std::size_t k = wide.size() - few; k < wide.size(); ++k) heights.push_back(height[wide[k].second]);
    std::nth_element(heights.begin(), heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2), heights.end());
    const double middle = heights[heights.size() / 2];
    const std::size_t sheet = model.cells()[wide.back().second].sheet;
    for (const auto& [r, i] : wide)
        if (model.cells()[i].sheet == sheet && std::abs(height[i] - middle) < 0.05 * (high - low)) ring.cells.push_back(i);
    if (ring.cells.empty()) ring.cells.push_back(wide.back().second);
    // Widest cells are widest by noise too: the ring has the largest radius of a smooth profile through the cells.
    Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
    Vector3d b = Vector3d::Zero();
    const auto row_at = [&](double h) {
        const double x = (h - middle) / (0.05 * (high - low) + 1e-12);
        return Vector3d(1, x, x * x);
    };
    for (const std::size_t i : ring.cells)
        A += row_at(height[i]) * row_at(height[i]).transpose(), b += std::abs(radius[i]) * row_at(height[i]);
    A.diagonal().array() += 1e-6 * A(0, 0);
    const Matrix3d inverse = A.inverse();
    const Vector3d profile = inverse * b;
    double most = -1e300, variance = 0;
    const double sigma = model.sheets()[sheet].sigma;
    for (const std::size_t i : ring.cells)
        if (const double r = row_at(height[i]).dot(profile); r > most)
            most = r, variance = sigma * sigma * row_at(height[i]).dot(inverse * row_at(height[i]));
    finish(posterior, radius, radius[ring.cells[0]] < 0 ? -most : most, variance, ring);
    return ring;
}

WallRing diameter_ring(const RevolutionPosterior& posterior) {
    const RevolutionModel& model = *posterior.model;
    const std::vector<double> radius = model.radii(posterior.best), height = model.heights(posterior.best);
    std::optional<WallRing> best;
    double most = -1;
    for (std::size_t k = 0; k < model.sheets().size(); ++k) {
        if (model.sheets()[k].wall || !model.sheets()[k].used) continue;
        // A rounded lip is preferred to a flat cut.
        if (std::optional<Lip> lip = ring_of_lip(posterior, k, radius, height); lip && lip->depth > most)
            most = lip->depth, best = std::move(lip->ring);
    }
    return best ? *best : widest_ring(posterior);
}

std::vector<double> ring_diameters(const RevolutionPosterior& posterior, const WallRing& ring) {
    std::vector<double> diameters;
    Random random(1, 1);
    for (std::size_t k = 0; k < posterior.samples.size(); ++k) {
        const std::vector<double> radius = posterior.model->radii(posterior.samples[k]);
        double sum = 0;
        for (const std::size_t i : ring.cells) sum += radius[i];
        const double value = sum / double(ring.cells.size()) + ring.correction + ring.error * random.normal();
        const double deviation = posterior.deviations[k][0] + ring.height * posterior.deviations[k][1];
        diameters.push_back(value > 0 ? 2 * value / (1 + std::max(-0.5, deviation)) : std::numeric_limits<double>::infinity());
    }
    return diameters;
}

}  // namespace ostraka::detail

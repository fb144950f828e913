// Best axis by Levenberg-Marquardt from several lines; posterior by adaptive importance sampling.
#include "axis/revolution_posterior.h"

#include "ostraka/core/angles.h"
#include "ostraka/stats/random.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>

namespace ostraka::detail {

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
        const double most = model.short_arc() ? 0.5 * std::abs(x[0]) : 0.3;
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

/// Mean square of the residuals of all vertices; those on no sheet count with the largest.
double deviation_of(const RevolutionModel& model, std::size_t vertices) {
    constexpr double limit = 0.02;
    double sum = 0, counted = 0;
    for (std::size_t i = 0; i < model.cells().size(); ++i) {
        const double count = model.cells()[i].count, residual = model.residuals()[i] / std::sqrt(count);
        const double sigma = model.sheets()[model.cells()[i].sheet].sigma;
        sum += count * std::min(limit * limit, residual * residual + sigma * sigma);
        counted += count;
    }
    return sum + limit * limit * std::max(0.0, double(vertices) - counted);
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
    return {{0, 0.3}, {out_of_round / 5, 0.2}, {out_of_round / 2, 0.2}, {out_of_round, 0.2}, {2 * out_of_round, 0.1}};
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
        for (int round = 0; round < 3; ++round) {
            draw();
            weigh();
            if (round < 2) adapt();
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
    [[nodiscard]] double log_target(const AxisStep& x, double& deviation) {
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
        deviation = fits[k].deviation + std::sqrt(std::max(0.0, fits[k].deviation_variance)) * random_.normal();
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
            targets_.push_back(log_target(x, posterior_.deviations.emplace_back(0)));
        }
        rounds_.push_back(components_);
    }
    /// Weights of all samples against the mixture of all rounds.
    void weigh() {
        std::vector<double> logs;
        for (std::size_t i = 0; i < posterior_.samples.size(); ++i) {
            std::vector<double> terms;
            for (const auto& round : rounds_) {
                double total = 0;
                for (const Component& c : round) total += c.weight;
                for (const Component& c : round)
                    terms.push_back(std::log(c.weight / total) + c.log_density(posterior_.samples[i]));
            }
            logs.push_back(targets_[i] - log_sum(terms));
        }
        const double total = log_sum(logs);
        posterior_.weights.clear();
        double squares = 0;
        for (const double value : logs) {
            posterior_.weights.push_back(std::exp(value - total));
            squares += std::pow(posterior_.weights.back(), 2);
        }
        posterior_.effective = 1 / squares;
    }
    /// Replaces the proposal by one of the mean and covariance of the samples, with a wider one behind it.
    void adapt() {
        Vector4d mean = Vector4d::Zero();
        Matrix4d covariance = Matrix4d::Zero();
        for (std::size_t i = 0; i < posterior_.samples.size(); ++i) mean += posterior_.weights[i] * posterior_.samples[i];
        for (std::size_t i = 0; i < posterior_.samples.size(); ++i) {
            const Vector4d d = posterior_.samples[i] - mean;
            covariance += posterior_.weights[i] * d * d.transpose();
        }
        Component component{mean, root_of_inverse(covariance.inverse(), 0), 0};
        if (!component.L.allFinite() || posterior_.effective < 8) {
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
    std::vector<double> targets_;
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

/// Mean of the cells' radii, and its error.
void finish(const RevolutionPosterior& posterior, const std::vector<double>& radius, double ring_radius, WallRing& ring) {
    double sum = 0, count = 0;
    for (const std::size_t i : ring.cells) {
        const double n = posterior.model->cells()[i].count;
        sum += radius[i], count += n;
    }
    ring.correction = ring_radius - sum / double(ring.cells.size());
    const double sigma = posterior.model->sheets()[posterior.model->cells()[ring.cells[0]].sheet].sigma;
    ring.error = sigma / std::sqrt(std::max(1.0, count));
    ring.share = share_of(posterior, ring.cells);
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
    const double margin = 0.35 * (outer - inner), from = inner - margin, width = outer - inner + 2 * margin;
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
    // A parabola through the points near the top, or the middle of a flat lip.
    const double depth = std::max(0.12 * (outer - inner), 2 * model.sheets()[sheet].sigma);
    WallRing ring;
    ring.rim = true;
    Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
    Vector3d b = Vector3d::Zero();
    const double middle = from + width / 2, half = std::max(1e-12, width / 2);
    double mean = 0;
    for (const std::size_t i : near) {
        if (side * height[i] < best - depth) continue;
        ring.cells.push_back(i);
        const double x = (std::abs(radius[i]) - middle) / half;
        const Vector3d row(1, x, x * x);
        A += row * row.transpose(), b += side * height[i] / half * row;
        mean += std::abs(radius[i]);
    }
    if (ring.cells.size() < 5) return {};
    mean /= double(ring.cells.size());
    A.diagonal().array() += 1e-9;
    const Vector3d parabola = A.inverse() * b;
    const double apex = middle + half * std::clamp(-parabola[1] / (2 * parabola[2]), -1.0, 1.0);
    const double sign = radius[ring.cells[0]] < 0 ? -1 : 1;
    finish(posterior, radius, sign * (parabola[2] < -0.05 ? apex : mean), ring);
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
    double sum = 0;
    for (const auto& [r, i] : wide)
        if (model.cells()[i].sheet == sheet && std::abs(height[i] - middle) < 0.03 * (high - low))
            ring.cells.push_back(i), sum += radius[i];
    if (ring.cells.empty()) ring.cells.push_back(wide.back().second), sum = radius[wide.back().second];
    // Widest cells are widest by noise too: the ring has their mean radius, at the level of the profile.
    finish(posterior, radius, sum / double(ring.cells.size()), ring);
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
        diameters.push_back(value > 0 ? 2 * value / (1 + std::max(-0.5, posterior.deviations[k]))
                                      : std::numeric_limits<double>::infinity());
    }
    return diameters;
}

}  // namespace ostraka::detail

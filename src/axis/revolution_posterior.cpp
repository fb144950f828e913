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

}  // namespace ostraka::detail

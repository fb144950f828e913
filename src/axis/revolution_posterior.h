// Posterior distribution of the axis of a wall: the most likely axis and weighted samples around it.
#pragma once

#include "axis/revolution_model.h"

#include <cstdint>
#include <limits>
#include <optional>

namespace ostraka::detail {

struct PosteriorOptions {
    double out_of_round = 0.005;  ///< typical deviation from roundness, as a share of the radius; 0: perfectly round
    int draws = 300;              ///< number of samples of each round
    int rounds = 8;               ///< greatest number of rounds
    double enough = 200;          ///< effective number of samples with which no more rounds are made
    std::uint64_t seed = 1;       ///< random seed
};

/// Samples of the posterior of a model, with importance weights that sum to 1.
struct RevolutionPosterior {
    std::optional<RevolutionModel> model;  ///< empty: too few vertices on walls
    AxisStep best = AxisStep::Zero();      ///< most likely axis
    double amplitude = 0;                  ///< most likely deviation from roundness
    /// How much worse the best axis in another direction fits: mean difference of the logarithms of the squares of the residuals.
    double margin = std::numeric_limits<double>::infinity();
    std::vector<AxisStep> samples;
    std::vector<double> weights;
    /// For each sample, a draw of the mean deviation of the arc from the circle of the vessel, as a share of the radius: at the
    /// middle of the height, and its change over half the height.
    std::vector<Eigen::Vector2d> deviations;
    double effective = 0;  ///< effective number of samples
    /// Weighted quantile of a value of each sample.
    [[nodiscard]] double quantile(const std::vector<double>& values, double fraction) const;
};

/// Finds the best axis from several initial lines and samples the posterior about it. Jeffreys' prior of the axis.
RevolutionPosterior revolution_posterior(const WallVertices& vertices, const std::vector<SpaceLine>& starts,
                                         const PosteriorOptions& options);

}  // namespace ostraka::detail

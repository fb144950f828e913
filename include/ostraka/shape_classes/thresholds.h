// Rejection thresholds at a given rate from few members: prediction intervals of a normal sample.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace ostraka {

/// Moments of the values that a new value is compared with.
struct SampleMoments {
    std::size_t count = 0;
    double mean = 0;
    double variance = 0;  ///< divisor count - 1
    double freedom = 0;   ///< degrees of freedom of the variance
};
SampleMoments moments_of(std::span<const double> values);

struct PredictionInterval {
    double low = 0, high = 0;
};

/// Interval that contains one more value of the same normal distribution except for the rate `reject` (both sides together;
/// with `one_sided` all of it above): mean +- t s sqrt(1 + 1/n), where t is the quantile of Student's distribution with the
/// variance's degrees of freedom (e.g. Hahn and Meeker 1991, section 4.7). `resolution` is added to s in quadrature: a standard
/// deviation below which values cannot be distinguished. Throws Error (usage) unless 0 < reject < 1, count > 0 and freedom > 0.
PredictionInterval predict(const SampleMoments& moments, bool one_sided, double reject, double resolution = 0);

/// Distribution of the variance of one quantity over classes: a scaled inverse chi-squared distribution.
struct VariancePrior {
    double variance = 0, freedom = 0;  ///< freedom is infinite if the variances differ no more than by chance
    /// The variance shrunk towards the prior: (d0 s0^2 + d s^2) / (d0 + d), with d0 + d degrees of freedom.
    [[nodiscard]] SampleMoments moderate(const SampleMoments& sample) const;
};

/// Empirical Bayes estimate from the variances of several samples, by the moments of their logarithms (Smyth 2004, section
/// 6.2). Zero variances are left out; none for fewer than three samples.
std::optional<VariancePrior> variance_prior(std::span<const SampleMoments> samples);

}  // namespace ostraka

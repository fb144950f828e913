// Learns thresholds from few members, such that further members are rejected at a given rate: prediction intervals of a normal
// sample.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace ostraka {

/// Mean and variance of the values with which a new value is compared.
struct SampleMoments {
    std::size_t count = 0;  ///< number of values
    double mean = 0;
    double variance = 0;  ///< variance with divisor count - 1
    double freedom = 0;   ///< degrees of freedom of the variance
};
/// Moments of a list of values.
SampleMoments moments_of(std::span<const double> values);

/// Interval that contains a further value of the same distribution with a given probability.
struct PredictionInterval {
    double low = 0, high = 0;  ///< bounds of the interval
};

/// Interval that contains a further value of the same normal distribution with probability 1 - `reject` (values on both sides
/// are outside; with `one_sided` only values above): mean +- t s sqrt(1 + 1/n), where t is the quantile of Student's
/// distribution with the variance's degrees of freedom (e.g. Hahn and Meeker 1991, section 4.7). `resolution`, a standard
/// deviation below which values cannot be distinguished, is added to s in quadrature. Throws Error (usage) unless 0 < reject <
/// 1, count > 0 and freedom > 0.
PredictionInterval predict(const SampleMoments& moments, bool one_sided, double reject, double resolution = 0);

/// Distribution of the variance of one quantity over classes: a scaled inverse chi-squared distribution.
struct VariancePrior {
    /// Variance and degrees of freedom of the prior; freedom is infinite if the variances differ only as much as expected by
    /// chance.
    double variance = 0, freedom = 0;
    /// The sample with its variance shrunk towards the prior: (d0 s0^2 + d s^2) / (d0 + d), with d0 + d degrees of freedom.
    [[nodiscard]] SampleMoments moderate(const SampleMoments& sample) const;
};

/// Empirical Bayes estimate of the prior from the variances of several samples, by the moments of the logarithms of the variances
/// (Smyth 2004, section 6.2). Zero variances are ignored; empty for fewer than three samples.
std::optional<VariancePrior> variance_prior(std::span<const SampleMoments> samples);

}  // namespace ostraka

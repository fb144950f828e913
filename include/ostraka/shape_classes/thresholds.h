// What may be refused at a stated rate, knowing few members: prediction intervals of a normal sample.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace ostraka {

/// Mean and variance of values that a new one is to be compared with.
struct SampleMoments {
    std::size_t count = 0;
    double mean = 0;
    double variance = 0;  ///< count - 1 below the line
    double freedom = 0;   ///< degrees of freedom of the variance
};
SampleMoments moments_of(std::span<const double> values);

struct PredictionInterval {
    double low = 0, high = 0;
};

/// Where one more value of the same normal distribution lies but for the share `reject` of cases (both sides together; with
/// `one_sided` all of it above): mean +- t s sqrt(1 + 1/n), t the quantile of Student's distribution with the variance's degrees
/// of freedom (e.g. Hahn and Meeker 1991, section 4.7). `resolution` is a standard deviation that is added to s: what values
/// cannot be distinguished by. Throws Error (usage) unless 0 < reject < 1, count > 0 and freedom > 0.
PredictionInterval predict(const SampleMoments& known, bool one_sided, double reject, double resolution = 0);

/// How variances of the same quantity are spread over classes: a scaled inverse chi-squared distribution.
struct VariancePrior {
    double variance = 0, freedom = 0;  ///< freedom is infinite where the variances differ by no more than chance has them
    /// The variance with what the others have: (d0 s0^2 + d s^2) / (d0 + d), with d0 + d degrees of freedom.
    [[nodiscard]] SampleMoments moderate(const SampleMoments& own) const;
};

/// Empirical Bayes from the variances of several samples, by the moments of their logarithms (Smyth 2004, section 6.2). Those of
/// zero are left out; nothing for fewer than three.
std::optional<VariancePrior> variance_prior(std::span<const SampleMoments> samples);

}  // namespace ostraka

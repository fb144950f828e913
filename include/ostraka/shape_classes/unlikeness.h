// How unlike the members of a class an object is: all quantities of geometry in one number.
#pragma once

#include "ostraka/shape_classes/shape_class.h"

namespace ostraka {

/// Mean of the absolute deviations of the logarithms (of shares: of the logits) of what is measured from the members' means, each
/// in standard deviations of one more member: s sqrt(1 + 1/n), s^2 with `resolution` squared added and moderated by `priors`.
/// Residuals count above the mean only. Where `learnt.dependence` is known the deviations are decorrelated first, so that what
/// several quantities say together counts once: z becomes R^-1/2 z (zero-phase component analysis: Kessy, Lewin and Strimmer
/// 2018), R the correlation within classes with the weight of its degrees of freedom, and none at all with that of as many as
/// there are quantities; what an object lacks counts as the mean. 0 for an object like the mean; near 1 for members.
struct Unlikeness {
    double value = 0;
    std::size_t count = 0;  ///< quantities
    std::size_t worst = 0;  ///< which of the ranges is farthest off, before deviations are decorrelated
    double off = 0;         ///< that one's deviation, in standard deviations, with its sign
};

/// `values`: one a range. `without`: one of the members is left out of means and deviations. Nothing where fewer than three
/// quantities have a value and two members' values or more.
std::optional<Unlikeness> unlikeness(const ShapeClass& learnt, const std::vector<std::optional<double>>& values,
                                     std::optional<std::size_t> without = {});

/// Whether a quantity counts for it: residuals of the fit and numbers of the whole surface.
bool counts_for_unlikeness(const ClassQuantity& quantity);
/// Mean and variance of what counts as normal of the members' values.
SampleMoments unlikeness_moments(const LearntRange& range, std::optional<std::size_t> without = {});

/// How what counts for unlikeness depends on each other within classes that are asked together: cross products of the members'
/// deviations from their class's means.
Dependence dependence_of(const std::vector<ShapeClass>& classes);

/// The name of the range of the members' own values, each by the others.
inline constexpr const char* unlike_the_members = "unlike the members";

/// Sets the members' and the strangers' values of that range, which is made if it is missing; nothing for fewer than three
/// members.
void measure_unlikeness(ShapeClass& learnt);

/// Logarithms of the strangers' values.
std::vector<double> stranger_logs(const LearntRange& range);

/// Up to which unlikeness an object is recognised as a member, where more refuses nothing yet: what at most the share `accept` of
/// strangers falls below (three strangers or more; several classes that are asked together share it), else what at most the
/// share `unsure` of members exceeds, and half a deviation at least. `members` and `strangers` are the moments of the logarithms
/// of their values. Never above `range.high`, which strangers lower: what is as unlike as they are on average (geometric mean) is
/// refused.
void set_recognised(LearntRange& range, const SampleMoments& members, const SampleMoments& strangers, double accept,
                    double unsure);

}  // namespace ostraka

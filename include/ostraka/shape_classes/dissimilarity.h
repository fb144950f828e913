// Dissimilarity of an object to the members of a class: all geometry quantities combined into one number.
#pragma once

#include "ostraka/shape_classes/shape_class.h"

namespace ostraka {

/// Mean absolute deviation of the logarithms (logits for shares) of the quantities from the members' means, each in standard
/// deviations of one more member: s sqrt(1 + 1/n), where s^2 includes `resolution` squared and is moderated by `priors`.
/// Residuals count only above the mean. If `learnt.dependence` is known, the deviations are decorrelated first, so that
/// dependent quantities are not counted several times: z becomes R^-1/2 z (zero-phase component analysis: Kessy, Lewin and
/// Strimmer 2018). R is the within-class correlation weighted by its degrees of freedom, shrunk towards the identity with the
/// number of quantities as weight. A missing quantity counts as the mean. The value is 0 for an object equal to the mean and
/// near 1 for members.
struct Dissimilarity {
    double value = 0;
    std::size_t count = 0;  ///< number of quantities
    std::size_t worst = 0;  ///< index of the range that is farthest off, before decorrelation
    double off = 0;         ///< signed deviation of that range, in standard deviations
};

/// `values` has one entry per range. `without` leaves one member out of means and deviations. None unless at least three
/// quantities have a value here and on at least two members.
std::optional<Dissimilarity> dissimilarity(const ShapeClass& learnt, const std::vector<std::optional<double>>& values,
                                           std::optional<std::size_t> without = {});

/// Whether a quantity enters the dissimilarity: residuals of the fit and measures of the whole surface.
bool counts_for_dissimilarity(const ClassQuantity& quantity);
/// Mean and variance of the members' values on the scale that is assumed to be normal.
SampleMoments dissimilarity_moments(const LearntRange& range, std::optional<std::size_t> without = {});

/// Dependence of the quantities that enter the dissimilarity, within classes that are queried together: cross products of the
/// members' deviations from the means of their classes.
Dependence dependence_of(const std::vector<ShapeClass>& classes);

/// Name of the range of the members' own dissimilarities, computed leave-one-out.
inline constexpr const char* unlike_the_members = "unlike the members";

/// Sets the values of the members and out-of-class objects in that range, which is added if missing; does nothing for fewer
/// than three members.
void measure_dissimilarity(ShapeClass& learnt);

/// Logarithms of the values of the out-of-class objects.
std::vector<double> out_of_class_logs(const LearntRange& range);

/// Sets the dissimilarity up to which an object is recognised as a member; larger values alone do not reject it. With at least
/// three out-of-class objects the bound is the value below which at most the share `accept` of them falls (classes that are
/// queried together share this rate); otherwise it is the value that at most the share `unsure` of members exceeds, and at
/// least half a deviation. `members` and `out_of_class` are the moments of the logarithms of their values. The bound never
/// exceeds `range.high`, which out-of-class objects lower: objects as dissimilar as they are on average (geometric mean) are
/// rejected.
void set_recognised(LearntRange& range, const SampleMoments& members, const SampleMoments& out_of_class, double accept,
                    double unsure);

}  // namespace ostraka

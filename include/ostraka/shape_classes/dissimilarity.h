// Dissimilarity of an object to the members of a class: one number computed from all geometric quantities.
#pragma once

#include "ostraka/shape_classes/shape_class.h"

namespace ostraka {

/// Dissimilarity of an object to the members: mean absolute deviation of the logarithms (logits for shares) of the quantities
/// from the members' means. Each deviation is divided by the prediction standard deviation of a further member, s sqrt(1 +
/// 1/n), where s^2 includes the square of `resolution` and is moderated by `priors`. Residuals below the mean are not counted.
/// If `learnt.dependence` is known, the deviations are decorrelated first, so that dependent quantities are not counted several
/// times: z becomes R^-1/2 z (zero-phase component analysis: Kessy, Lewin and Strimmer 2018). R is the within-class correlation
/// weighted by its degrees of freedom, shrunk towards the identity with the number of quantities as weight. A missing quantity
/// is replaced by the mean. The dissimilarity is 0 for an object equal to the mean and near 1 for members.
struct Dissimilarity {
    double value = 0;       ///< the dissimilarity
    std::size_t count = 0;  ///< number of quantities with a value
    std::size_t worst = 0;  ///< index in `ranges` of the quantity that deviates most, before decorrelation
    double off = 0;         ///< signed deviation of that quantity, in standard deviations
};

/// Dissimilarity of an object to the members of the class. `values`: value of the object for each range; `without`: index of a
/// member that is excluded from means and deviations. Empty unless at least three quantities have a value on the object and on at
/// least two members.
std::optional<Dissimilarity> dissimilarity(const ShapeClass& learnt, const std::vector<std::optional<double>>& values,
                                           std::optional<std::size_t> without = {});

/// True if a quantity is used for the dissimilarity: residuals of the fit, and measures of the whole surface.
bool counts_for_dissimilarity(const ClassQuantity& quantity);
/// Mean and variance of the members' values, transformed (logarithm or logit) to an approximately normal distribution;
/// `without`: index of an excluded member.
SampleMoments dissimilarity_moments(const LearntRange& range, std::optional<std::size_t> without = {});

/// Statistical dependence between the quantities that are used for the dissimilarity. `classes`: classes that are compared
/// together. The result contains the cross products of the members' deviations from the means of their classes.
Dependence dependence_of(const std::vector<ShapeClass>& classes);

/// Name of the range that holds the members' own dissimilarities, computed leave-one-out.
inline constexpr const char* unlike_the_members = "unlike the members";

/// Computes the dissimilarities of the members and of the out-of-class objects and stores them in the range "unlike the
/// members", which is added if missing. Does nothing for fewer than three members.
void measure_dissimilarity(ShapeClass& learnt);

/// Logarithms of the out-of-class objects' values in a range.
std::vector<double> out_of_class_logs(const LearntRange& range);

/// Sets `range.recognised`, the dissimilarity up to which an object is recognised as a member; larger values alone do not reject
/// the object. With at least three out-of-class objects the bound is chosen so that at most the share `accept` of out-of-class
/// objects is below it (this share is divided among classes that are queried together). Otherwise the bound is chosen so that
/// at most the share `unsure` of members is above it, and it is at least half a standard deviation above the members' mean.
/// `members` and `out_of_class` are the moments of the logarithms of the values of members and out-of-class objects. The bound
/// never exceeds `range.high`. If there are out-of-class objects, `range.high` is at most the geometric mean of their
/// dissimilarities.
void set_recognised(LearntRange& range, const SampleMoments& members, const SampleMoments& out_of_class, double accept,
                    double unsure);

}  // namespace ostraka

// Decides whether an object belongs to a class, with reasons.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/shape_classes/shape_class.h"

namespace ostraka {

struct ClassifyOptions {
    MemberFitOptions fit;
    CorrespondenceChoice correspondence = CorrespondenceChoice::automatic;
    bool attributes = false;
    bool strict = false;
    double close = 0.05;

    void list_options(OptionList& list);
};

/// A quantity of the object compared with the learnt range.
struct QuantityCheck {
    ClassQuantity quantity;  ///< with the value of the object
    std::optional<double> low, high;
    double off = 0;                    ///< distance of the value from the accepted range, in its unit; 0 inside
    double excess = 0;                 ///< `off` relative to the width of the accepted range (for a residual, to its threshold)
    bool decides = true;               ///< whether the check can reject the object
    std::string worst;                 ///< for combined quantities: the worst component and its deviation, as text
    std::optional<double> recognised;  ///< larger values are not rejected, but not recognised either
};

enum class Membership { member, other, undecided };
std::string to_string(Membership membership);

/// Result of comparing an object with one class.
struct ClassAnswer {
    std::string name;
    Membership verdict = Membership::undecided;
    std::string undecided;  ///< the reason if undecided
    MemberFit fit;
    std::string off;      ///< message that the template does not lie on the object, which is then not a member; empty otherwise
    double most_off = 0;  ///< larger values of FitResiduals::off give this message
    bool hopeless =
        false;  ///< more than half of both surfaces is off (uninformative_fit): rejects the object whatever the other checks say
    std::optional<double> unlike;  ///< dissimilarity to the members (dissimilarity.h)
    std::vector<QuantityCheck> checks;
    std::vector<std::size_t>
        against;  ///< indices of failed deciding checks: proportions, constraints and relations first, then by excess
    /// Lower is better; needs no thresholds. Ten times the sum of both fit distances, the unmatched and unexplained shares,
    /// stretch and bend, plus twice the absolute logarithms of compactness and geodesics relative to the members' means.
    /// `decide` replaces these by the dissimilarity if all classes have one. The parts together are added in both cases.
    double score = 0;
    double parts = 0;              ///< contribution of the parts to the score
    ShapeCoordinates coordinates;  ///< coordinates of the fitted template
    /// Messages on unusual properties: more than three times as large as the largest member or less than a third of the
    /// smallest, or, in correspondence, a mirror image that is less than half as far from the mean. Without `sizes` neither
    /// rejects the object.
    std::vector<std::string> odd;
    [[nodiscard]] std::vector<std::string> reasons() const;
};

/// Compares a fitted and measured object with the class.
ClassAnswer compare_with(const ShapeClass& learnt, const LearntMember& object, const ClassifyOptions& options = {});

struct Classification {
    std::string object;
    std::vector<ClassAnswer> answers;  ///< one per class, in the given order
    int best = -1;                     ///< index of the class it belongs to, or -1
    int nearest = -1;                  ///< index of the class with the best score, whether the object belongs to it or not
    Membership verdict = Membership::undecided;
    std::string text;     ///< the result as text
    std::string problem;  ///< why there are no answers: the object could not be read or measured; empty otherwise
};

/// Selects, among the classes that accept the object, the one with the best score. The verdict is "other" (no class) if every
/// class that can decide rejects the object and the nearest class can decide. It is undecided if the nearest class cannot
/// decide, or if the scores of two accepting classes are `close`.
Classification decide(std::string object, std::vector<ClassAnswer> answers, const ClassifyOptions& options = {});

}  // namespace ostraka

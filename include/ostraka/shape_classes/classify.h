// Whether an object belongs to a class, and what speaks against it.
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

    void describe(OptionList& visit);
};

/// One quantity of the object against what was learnt of it.
struct QuantityCheck {
    ClassQuantity quantity;  ///< with the object's value
    std::optional<double> low, high;
    double off = 0;                    ///< how far the value is out of what is accepted, in its unit; 0 inside
    double excess = 0;                 ///< the same as a share of the accepted range's width (of a residual: of its threshold)
    bool decides = true;               ///< it may speak against the object
    std::string worst;                 ///< of what is put together: what is farthest off, and by how much, in words
    std::optional<double> recognised;  ///< not refused, but not recognised above this either
};

enum class Membership { member, other, undecided };
std::string to_string(Membership membership);

/// What one class says.
struct ClassAnswer {
    std::string name;
    Membership verdict = Membership::undecided;
    std::string undecided;  ///< why
    MemberFit fit;
    std::string off;      ///< in words that the template does not lie on the object, which then is no member; empty if it does
    double most_off = 0;  ///< more of both surfaces off the other is that
    bool hopeless =
        false;  ///< more than half of both is off (hopeless_fit): it speaks against the object, whatever else is measured
    std::optional<double> unlike;  ///< how unlike the members it is (unlikeness.h)
    std::vector<QuantityCheck> checks;
    std::vector<std::size_t>
        against;  ///< checks that decide and fail: proportions, constraints and relations first, then by excess
    /// Ten times the distances of the fit both ways, what is unmatched and unexplained, stretch and bend, and twice the absolute
    /// logarithms of compactness and geodesics over the members' means. Less is better; it needs no thresholds. `decide` puts
    /// unlikeness in the place of these where all classes know it. Parts together are added to either.
    double score = 0;
    double parts = 0;              ///< of the score
    ShapeCoordinates coordinates;  ///< of the fitted template
    /// In words what is odd about it: three times as large as the largest member or a third of the smallest, or, in
    /// correspondence, a mirror image that is less than half as far from the mean. Without `sizes` neither speaks against it.
    std::vector<std::string> odd;
    [[nodiscard]] std::vector<std::string> reasons() const;
};

/// What an object that was fitted and measured is to the class.
ClassAnswer compare_with(const ShapeClass& learnt, const LearntMember& object, const ClassifyOptions& options = {});

struct Classification {
    std::string object;
    std::vector<ClassAnswer> answers;  ///< of each class, in the order given
    int best = -1;                     ///< the class it belongs to
    int nearest = -1;                  ///< the class with the best score, whether it belongs to it or not
    Membership verdict = Membership::undecided;
    std::string text;     ///< the answer in words
    std::string problem;  ///< why there are no answers: it could not be read or measured; empty if it could
};

/// Of the classes the object belongs to the one with the best score. "other" (none) where every class that can tell says no, and
/// the nearest can; undecided where that one cannot, and where two that the object belongs to are `close`.
Classification decide(std::string object, std::vector<ClassAnswer> answers, const ClassifyOptions& options = {});

}  // namespace ostraka

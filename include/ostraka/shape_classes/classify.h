// Decides whether an object belongs to a class, with reasons.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/shape_classes/shape_class.h"

namespace ostraka {

struct ClassifyOptions {
    MemberFitOptions fit;  ///< options for registering the template to the object
    /// Treatment of objects that have the template's triangles.
    CorrespondenceChoice correspondence = CorrespondenceChoice::automatic;
    bool check_attributes = false;  ///< true: an object is also rejected if attribute values are out of the class's ranges
    /// True: the decision whether the template lies on the object uses only MemberFitOptions::max_off; false: it also uses the
    /// dissimilarity to the members.
    bool strict = false;
    /// Two classes are distinguished if their scores differ by at least this share of the better score.
    double tie_tolerance = 0.05;

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// A quantity of the object compared with the range learnt from the members.
struct QuantityCheck {
    ClassQuantity quantity;           ///< the quantity, with the value of the object
    std::optional<double> low, high;  ///< bounds of the accepted range; empty: no bound
    double distance_from_range = 0;   ///< distance of the value from the accepted range, in the unit of the value; 0 inside
    double excess = 0;    ///< `distance_from_range` divided by the width of the accepted range (for a residual, by its threshold)
    bool decides = true;  ///< true: the check can reject the object
    std::string worst;    ///< for combined quantities: the component that deviates most, and its deviation, as text
    /// An object is recognised as a member only up to this value; larger values up to `high` leave the answer undecided.
    std::optional<double> recognised;
};

/// Whether an object belongs to a class.
enum class Membership { member, other, undecided };
std::string to_string(Membership membership);

/// Result of comparing an object with one class.
struct ClassAnswer {
    std::string name;                            ///< name of the class
    Membership verdict = Membership::undecided;  ///< whether the object belongs to the class
    std::string undecided;                       ///< reason if the verdict is undecided; empty for other verdicts
    MemberFit fit;                               ///< registration of the class's template to the object
    /// Message if the template does not lie on the object, which is then not a member; empty if it lies on the object.
    std::string fit_problem;
    double misfit_limit = 0;  ///< value of FitResiduals::off above which the message `fit_problem` is given
    /// True: more than half of the two surfaces do not lie on each other (uninformative_fit); the object is then rejected
    /// regardless of the other checks.
    bool fit_failed = false;
    std::optional<double> dissimilarity;  ///< dissimilarity to the members (dissimilarity.h); empty: unknown
    std::vector<QuantityCheck> checks;    ///< comparison of each quantity with its range
    /// Indices of the failed checks that can reject: proportions, constraints and relations first, then by descending excess.
    std::vector<std::size_t> rejecting_checks;
    /// Score of the class for the object; lower is better. The score is ten times the sum of the two fit distances, the
    /// unmatched share, the unexplained share, stretch and bend, plus twice the absolute logarithms of compactness and
    /// geodesics relative to the members' means. `decide` uses the dissimilarity instead of this sum if it is known for all
    /// classes. The contribution of the parts is added in both cases.
    double score = 0;
    double parts = 0;              ///< contribution of the parts to the score
    ShapeCoordinates coordinates;  ///< coordinates of the fitted template
    /// Messages about unusual properties: the object is more than three times as large as the largest member or smaller than a
    /// third of the smallest member; or, for an object in correspondence, its mirror image is less than half as far from the
    /// mean as the object. These properties do not reject the object unless the class was learnt with `sizes`.
    std::vector<std::string> unusual_findings;
    [[nodiscard]] std::vector<std::string> reasons() const;  ///< reasons for the verdict, as sentences
};

/// Compares a fitted and measured object with the class.
ClassAnswer compare_with(const ShapeClass& learnt, const LearntMember& object, const ClassifyOptions& options = {});

/// Result of comparing an object with several classes.
struct Classification {
    std::string object;                ///< name of the object
    std::vector<ClassAnswer> answers;  ///< one answer per class, in the given order
    int best = -1;                     ///< index of the class to which the object belongs; -1: none
    int nearest = -1;                  ///< index of the class with the best score, whether the object belongs to it or not
    Membership verdict = Membership::undecided;  ///< whether the object belongs to a class
    std::string text;                            ///< the result as a sentence
    std::string problem;  ///< reason if there are no answers: the object could not be read or measured; otherwise empty
};

/// Selects, among the classes that accept the object, the class with the best score. The verdict is "other" (no class) if every
/// class that can decide rejects the object and the nearest class can decide. The verdict is "undecided" if the nearest class
/// cannot decide, or if the scores of two accepting classes differ by less than the share `tie_tolerance`.
Classification decide(std::string object, std::vector<ClassAnswer> answers, const ClassifyOptions& options = {});

}  // namespace ostraka

// Decides whether an object belongs to a class, with reasons.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/shape_classes/shape_class.h"

namespace ostraka {

struct ClassifyOptions {
    MemberFitOptions fit;  ///< options for registering the template to the object
    /// Whether an object with the template's triangles is used as given.
    CorrespondenceChoice correspondence = CorrespondenceChoice::automatic;
    bool attributes = false;  ///< true: attribute values out of range also reject the object
    /// True: whether the template lies on the object is decided by max_off alone, not also by its distance from the members.
    bool strict = false;
    /// Min relative difference of the scores of two classes that are distinguished, as a share of the better score.
    double close = 0.05;

    void list_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// A quantity of the object compared with the range learnt from the members.
struct QuantityCheck {
    ClassQuantity quantity;           ///< the quantity, with the value of the object
    std::optional<double> low, high;  ///< bounds of the accepted range; empty: no bound
    double off = 0;                   ///< distance of the value from the accepted range, in the unit of the value; 0 inside
    double excess = 0;    ///< `off` relative to the width of the accepted range (for a residual, relative to its threshold)
    bool decides = true;  ///< true: the check can reject the object
    std::string worst;    ///< for combined quantities: the component that deviates most, and its deviation, as text
    /// Max value of a recognised object; larger values are not rejected, but not recognised either.
    std::optional<double> recognised;
};

/// Whether an object belongs to a class.
enum class Membership { member, other, undecided };
std::string to_string(Membership membership);

/// Result of comparing an object with one class.
struct ClassAnswer {
    std::string name;                            ///< name of the class
    Membership verdict = Membership::undecided;  ///< whether the object belongs to the class
    std::string undecided;                       ///< why the verdict is undecided; empty for other verdicts
    MemberFit fit;                               ///< registration of the class's template to the object
    std::string off;      ///< message that the template does not lie on the object, which is then not a member; empty if it does
    double most_off = 0;  ///< max value of FitResiduals::off without this message
    /// True: more than half of both surfaces is off (uninformative_fit), which rejects the object whatever the other checks say.
    bool hopeless = false;
    std::optional<double> unlike;       ///< dissimilarity to the members (dissimilarity.h); empty: unknown
    std::vector<QuantityCheck> checks;  ///< comparison of each quantity with its range
    /// Indices of the failed checks that can reject: proportions, constraints and relations first, then by descending excess.
    std::vector<std::size_t> against;
    /// Score of the class for the object; lower is better. The score needs no thresholds: it is ten times the sum of both fit
    /// distances, the unmatched and unexplained shares, stretch and bend, plus twice the absolute logarithms of compactness and
    /// geodesics relative to the members' means. `decide` replaces this sum by the dissimilarity if all classes have one. The
    /// contribution of the parts is added in both cases.
    double score = 0;
    double parts = 0;              ///< contribution of the parts to the score
    ShapeCoordinates coordinates;  ///< coordinates of the fitted template
    /// Messages on unusual properties: an object more than three times as large as the largest member or less than a third of the
    /// smallest, or, in correspondence, a mirror image that is less than half as far from the mean. Without `sizes` neither
    /// property rejects the object.
    std::vector<std::string> odd;
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
    std::string problem;  ///< why there are no answers: the object could not be read or measured; empty if there are answers
};

/// Selects, among the classes that accept the object, the class with the best score. The verdict is "other" (no class) if every
/// class that can decide rejects the object and the nearest class can decide. The verdict is "undecided" if the nearest class
/// cannot decide, or if the scores of two accepting classes differ by less than the share `close`.
Classification decide(std::string object, std::vector<ClassAnswer> answers, const ClassifyOptions& options = {});

}  // namespace ostraka

// A class of objects learnt from members: ranges of what is measured, mean shape, modes of variation, thresholds (thesis 1.2).
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/core/provenance.h"
#include "ostraka/reconstruction/shape_prior.h"
#include "ostraka/shape_classes/quantities.h"
#include "ostraka/shape_classes/thresholds.h"

#include <map>

namespace ostraka {

struct LearnOptions {
    MemberFitOptions fit;
    ModeOptions modes;
    CorrespondenceChoice correspondence = CorrespondenceChoice::automatic;
    double reject = 0.05;
    double resolution = 0.02;
    double unsure = 0.15;
    double accept = 0.05;

    void describe(OptionList& visit);
};

/// The values that one quantity has on the members, and what is accepted of another object.
struct LearntRange {
    ClassQuantity quantity;                             ///< without value
    std::vector<std::optional<double>> values;          ///< of each member; geometry against the others: each left out
    std::vector<std::optional<double>> strangers = {};  ///< of each stranger
    std::size_t count = 0;
    double min = 0, max = 0, mean = 0;
    double percentile_5 = 0, percentile_25 = 0, median = 0, percentile_75 = 0, percentile_95 = 0;
    std::optional<double> deviation;  ///< standard deviation; none of a single value
    bool logarithm = false;           ///< its logarithm counts as normal: what is positive on all members, but for constraints
    double reject = 0;                ///< share of members that it alone refuses; 0: it does not decide
    std::optional<double> low, high;  ///< accepted; none where nothing can be learnt, no low of a residual
    /// Of what is unlike the members: above it an object is not recognised, though only what is above `high` is refused.
    std::optional<double> recognised = {};
};

struct ClassMember {
    std::string name, placed_by;
    double scale = 1;  ///< of the template
    std::vector<std::string> notes;
};

/// Cross products of deviations within classes, by the keys of the quantities.
struct Dependence {
    std::map<std::string, Eigen::Index> rows;
    Eigen::MatrixXd products;
    double freedom = 0;  ///< members less classes
};

struct ShapeClass {
    std::string name;
    std::string template_file;  ///< beside the class's file
    bool sizes = false;
    std::vector<ClassMember> members;
    std::vector<LearntRange> ranges;
    std::vector<LearntRange> fragments;  ///< what members say of the thresholds for fragments (fragment_thresholds.h)
    std::string topology;                ///< of the template's mesh (topology_checksum)
    ShapeModes modes;
    std::vector<std::string> strangers;   ///< objects that do not belong to it, whose values the ranges have
    double unsure = 0.15, accept = 0.05;  ///< of LearnOptions
    /// How off the template may be on an object (FitResiduals::off) as members are: none of members in correspondence.
    std::optional<double> most_off;
    std::map<std::string, VariancePrior> variances;  ///< by key, of the classes that are asked together; not kept in files
    std::optional<Dependence> dependence;            ///< of those classes; as above
    double diversity = 0;                            ///< mean distance between two members, as a share of the mean size
    double reject = 0.05, resolution = 0.02;         ///< of LearnOptions
    std::vector<std::string> notes;                  ///< what could not be learnt, in words

    [[nodiscard]] const LearntRange* find(const std::string& key) const;
    /// Thresholds were learnt: there are three members or more. Of two the deviation is known to nobody (Student's distribution
    /// with one degree of freedom has no mean).
    [[nodiscard]] bool has_thresholds() const { return members.size() >= min_members; }
    static constexpr std::size_t min_members = 3;
};

/// Whether the template is registered to `member` as it is or by a fit.
MemberFit fit_by_method(const ClassTemplate& known, const WholeObject& member, CorrespondenceChoice correspondence,
                        const MemberFitOptions& options);

struct LearntMember {
    std::string name;
    MemberFit fit;
    std::vector<ClassQuantity> quantities;  ///< all but what refers to the other members
    std::vector<ClassQuantity> fragments;   ///< of pieces of it (fragment_quantities)
};
/// The fit of one member and all that is measured of it alone. `whole` spares measuring the surface anew where many templates are
/// registered to one object.
LearntMember learn_member(const ClassTemplate& known, const WholeObject& member, const LearnOptions& options = {},
                          const WholeShape* whole = nullptr);

/// What is measured of a member that the template was registered to already: with its own annotations, where it has regions, and
/// those of the template.
LearntMember measure_member(const ClassTemplate& known, const WholeObject& member, MemberFit fit,
                            const LearnOptions& options = {}, const WholeShape* whole = nullptr);

/// Puts the members together. Those with a problem are left out and said. `strangers` are objects that do not belong to the
/// class: what is measured of them says up to where an object is recognised. Throws Error (input) if no member is left.
ShapeClass learn_class(const ClassTemplate& known, const std::vector<LearntMember>& members, const LearnOptions& options = {},
                       const std::vector<LearntMember>& strangers = {});

/// Sets of each range whether it decides, its share of `reject`, and what is accepted: the prediction interval (`predict`) of
/// its values or their logarithms, one-sided for residuals. The rate is shared by the kinds of quantities that there are, and by
/// the quantities of each kind (Bonferroni), so that it holds however they depend on each other. Of single parts nothing decides,
/// nor of what counts for unlikeness (unlikeness.h), only of all together. Attributes get bounds as if they were a kind, which
/// comes on top where they are specified to decide.
void learn_thresholds(ShapeClass& learnt);

/// The same for classes that are asked together: what a quantity of geometry or of parts together varies by is moderated by how
/// much it varies in the other classes (`variance_prior`), where three classes or more have it. Unlikeness is measured anew with
/// that, and with how quantities depend on each other in all of them; what members and strangers show of it counts for all of
/// them, and they share the rate at which strangers are accepted.
void moderate_thresholds(std::vector<ShapeClass>& classes);

/// What is measured of single parts put together, as residuals of kind `part`: "sizes of the parts", "places of the parts";
/// `worst` is the range that is farthest off.
struct PartsTogether {
    ClassQuantity quantity;
    std::size_t worst = 0;
    double expected = 0;  ///< of that range
};
/// `values` and `expected` are one a range.
std::vector<PartsTogether> parts_together(const std::vector<LearntRange>& ranges,
                                          const std::vector<std::optional<double>>& values,
                                          const std::vector<std::optional<double>>& expected);
/// The geometric mean of the members' values of each range of a part; nothing of others. `without`: one of them is left out.
std::vector<std::optional<double>> expected_parts(const std::vector<LearntRange>& ranges,
                                                  std::optional<std::size_t> without = {});

/// Mean distance between all pairs of shapes in correspondence, each registered to the mean of the class, as a share of its mean
/// size.
double mean_distance(const ShapeModes& modes, const std::vector<Landmarks>& shapes);

/// What `fit` takes for the shape of what fragments do not show.
ShapePrior prior_of(const ShapeModes& modes);

}  // namespace ostraka

// A class of objects learnt from members: ranges of measured quantities, mean shape, modes of variation, thresholds (thesis
// 1.2).
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/files/provenance.h"
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

    void list_options(OptionList& list);
};

/// The values of one quantity on the members, and the range accepted for other objects.
struct LearntRange {
    ClassQuantity quantity;                                ///< without value
    std::vector<std::optional<double>> values;             ///< one per member; relative to other members: leave-one-out
    std::vector<std::optional<double>> out_of_class = {};  ///< one per out-of-class object
    std::size_t count = 0;
    double min = 0, max = 0, mean = 0;
    double percentile_5 = 0, percentile_25 = 0, median = 0, percentile_75 = 0, percentile_95 = 0;
    std::optional<double> deviation;  ///< standard deviation; none for a single value
    bool logarithm = false;           ///< whether its logarithm is assumed to be normal: positive values, except constraints
    double reject = 0;                ///< rate at which this quantity alone rejects members; 0: it cannot reject
    std::optional<double> low, high;  ///< accepted range; none if it cannot be learnt; a residual has no low
    /// Dissimilarity only: above it an object is not recognised, but only above `high` is it rejected.
    std::optional<double> recognised = {};
};

struct ClassMember {
    std::string name, placed_by;
    double scale = 1;  ///< scale of the template
    std::vector<std::string> notes;
};

/// Within-class cross products of deviations, indexed by the keys of the quantities.
struct Dependence {
    std::map<std::string, Eigen::Index> rows;
    Eigen::MatrixXd products;
    double freedom = 0;  ///< degrees of freedom: number of members minus number of classes
};

struct ShapeClass {
    std::string name;
    std::string template_file;  ///< in the folder of the class file
    bool sizes = false;
    std::vector<ClassMember> members;
    std::vector<LearntRange> ranges;
    std::vector<LearntRange> fragments;  ///< ranges for the fragment thresholds (fragment_thresholds.h)
    std::string topology;                ///< topology_checksum of the template's mesh
    ShapeModes modes;
    std::vector<std::string> out_of_class;  ///< names of the out-of-class objects, whose values are in the ranges
    double unsure = 0.15, accept = 0.05;    ///< from LearnOptions
    /// Upper bound of FitResiduals::off for members; none if the members are in correspondence.
    std::optional<double> most_off;
    std::map<std::string, VariancePrior> variances;  ///< by key, from the classes that are queried together; not kept in files
    std::optional<Dependence> dependence;            ///< from the classes that are queried together; not kept in files
    double diversity = 0;                            ///< mean distance between two members, relative to the mean size
    double reject = 0.05, resolution = 0.02;         ///< from LearnOptions
    std::vector<std::string> notes;                  ///< messages on what could not be learnt

    [[nodiscard]] const LearntRange* find(const std::string& key) const;
    /// Whether thresholds were learnt, which needs at least three members. Two members do not determine a deviation (Student's
    /// distribution with one degree of freedom has no mean).
    [[nodiscard]] bool has_thresholds() const { return members.size() >= min_members; }
    static constexpr std::size_t min_members = 3;
};

/// Registers the template to `member`, by correspondence or by a fit.
MemberFit fit_by_method(const ClassTemplate& class_template, const WholeObject& member, CorrespondenceChoice correspondence,
                        const MemberFitOptions& options);

struct LearntMember {
    std::string name;
    MemberFit fit;
    std::vector<ClassQuantity> quantities;  ///< all quantities except those relative to other members
    std::vector<ClassQuantity> fragments;   ///< quantities of its pieces (fragment_quantities)
};
/// Fits one member and measures everything that does not depend on other members. `whole_shape`, if given, saves measuring the
/// surface again when several templates are registered to one object.
LearntMember learn_member(const ClassTemplate& class_template, const WholeObject& member, const LearnOptions& options = {},
                          const WholeShape* whole_shape = nullptr);

/// Measures a member to which the template is already registered: its own annotations where it has regions, and those of the
/// template.
LearntMember measure_member(const ClassTemplate& class_template, const WholeObject& member, MemberFit fit,
                            const LearnOptions& options = {}, const WholeShape* whole_shape = nullptr);

/// Learns a class from its members. Members with a problem are left out, and a note reports it. `out_of_class` are out-of-class
/// objects: their values determine up to which dissimilarity an object is recognised. Throws Error (input) if no member is
/// left.
ShapeClass learn_class(const ClassTemplate& class_template, const std::vector<LearntMember>& members,
                       const LearnOptions& options = {}, const std::vector<LearntMember>& out_of_class = {});

/// Sets, for each range, whether it can reject, its share of `reject`, and the accepted range: the prediction interval
/// (`predict`) of its values or their logarithms, one-sided for residuals. The rate is divided among the kinds of quantities
/// present and among the quantities of each kind (Bonferroni), so that it holds for any dependence between them. Quantities of
/// single parts, and those that enter the dissimilarity (dissimilarity.h), only reject in combination. Attributes get bounds as
/// if they were a separate kind; their rate is additional if they are set to decide.
void learn_thresholds(ShapeClass& learnt);

/// The same for classes that are queried together. The variance of a geometry quantity, or of the combined parts, is moderated
/// by its variance in the other classes (`variance_prior`) if at least three classes have it. The dissimilarity is computed
/// again with these variances and with the dependence of quantities pooled over the classes. Its values on members and
/// out-of-class objects are pooled too, and the classes share the rate at which out-of-class objects are accepted.
void moderate_thresholds(std::vector<ShapeClass>& classes);

/// The quantities of single parts, combined into residuals of kind `part`: "sizes of the parts", "places of the parts"; `worst`
/// is the index of the range that is farthest off.
struct CombinedParts {
    ClassQuantity quantity;
    std::size_t worst = 0;
    double expected = 0;  ///< expected value of that range
};
/// `values` and `expected` have one entry per range.
std::vector<CombinedParts> combined_parts(const std::vector<LearntRange>& ranges,
                                          const std::vector<std::optional<double>>& values,
                                          const std::vector<std::optional<double>>& expected);
/// The geometric mean of the members' values for each range of a part; none for other ranges. `without` leaves out one member.
std::vector<std::optional<double>> expected_parts(const std::vector<LearntRange>& ranges,
                                                  std::optional<std::size_t> without = {});

/// Mean distance over all pairs of shapes in correspondence, each registered to the mean of the class, relative to its mean
/// size.
double mean_distance(const ShapeModes& modes, const std::vector<Landmarks>& shapes);

/// The prior that `fit` uses for the shape not covered by fragments.
ShapePrior prior_of(const ShapeModes& modes);

}  // namespace ostraka

// A class of objects learnt from members: ranges of measured quantities, mean shape, modes of variation, thresholds (thesis,
// section 1.2).
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/files/provenance.h"
#include "ostraka/reconstruction/shape_prior.h"
#include "ostraka/shape_classes/quantities.h"
#include "ostraka/shape_classes/thresholds.h"

#include <map>

namespace ostraka {

struct LearnOptions {
    MemberFitOptions fit;  ///< options for registering the template to members
    ModeOptions modes;     ///< options of the mean shape and the modes
    /// Whether members with the template's triangles are used as given.
    CorrespondenceChoice correspondence = CorrespondenceChoice::automatic;
    /// Max share of members that all thresholds together reject, if the quantities are normal or log-normal.
    double reject = 0.05;
    double resolution = 0.02;  ///< standard deviation of the measurements of one member, as a share of the value
    double unsure = 0.15;  ///< max share of members that are not recognised, if there are fewer than three out-of-class objects
    double accept = 0.05;  ///< max share of out-of-class objects that are accepted by all classes queried together

    void list_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// The values of one quantity on the members, and the range accepted for other objects.
struct LearntRange {
    ClassQuantity quantity;  ///< the quantity, without a value
    /// Value of each member, relative to the other members if leave-one-out; empty: not measured.
    std::vector<std::optional<double>> values;             ///< one per member; relative to other members: leave-one-out
    std::vector<std::optional<double>> out_of_class = {};  ///< value of each out-of-class object
    std::size_t count = 0;                                 ///< number of members with a value
    double min = 0, max = 0, mean = 0;                     ///< statistics of the members' values
    double percentile_5 = 0, percentile_25 = 0, median = 0, percentile_75 = 0, percentile_95 = 0;
    std::optional<double> deviation;  ///< standard deviation; empty for a single value
    bool logarithm = false;           ///< true: the logarithm is assumed to be normal, as for positive values except constraints
    double reject = 0;                ///< rate at which this quantity alone rejects members; 0: it cannot reject
    /// Bounds of the accepted range; empty if they cannot be learnt; a residual has no lower bound.
    std::optional<double> low, high;
    /// For the dissimilarity only: max value of a recognised object. Above `recognised` an object is not recognised; above `high`
    /// it is rejected.
    std::optional<double> recognised = {};
};

/// A member from which the class was learnt.
struct ClassMember {
    std::string name, placed_by;     ///< placed_by: as in MemberFit
    double scale = 1;                ///< scale of the template
    std::vector<std::string> notes;  ///< remarks on the member
};

/// Cross products of the members' deviations from the means of their classes, for pairs of quantities.
struct Dependence {
    std::map<std::string, Eigen::Index> rows;  ///< from the key of a quantity to its row in `products`
    Eigen::MatrixXd products;                  ///< row and column per quantity
    double freedom = 0;                        ///< degrees of freedom: number of members minus number of classes
};

/// A learnt class.
struct ShapeClass {
    std::string name;                       ///< name of the class
    std::string template_file;              ///< file name in the folder of the class file
    bool sizes = false;                     ///< true: size is part of the shape
    std::vector<ClassMember> members;       ///< members from which the class was learnt
    std::vector<LearntRange> ranges;        ///< one range per quantity
    std::vector<LearntRange> fragments;     ///< ranges of the quantities for the fragment thresholds (fragment_thresholds.h)
    std::string topology;                   ///< topology_checksum of the template's mesh
    ShapeModes modes;                       ///< mean shape and modes of variation
    std::vector<std::string> out_of_class;  ///< names of the out-of-class objects
    double unsure = 0.15, accept = 0.05;    ///< from LearnOptions
    /// Max value of FitResiduals::off for members; empty if the members are in correspondence.
    std::optional<double> most_off;
    /// From the key of a quantity to the prior of its variance, from classes queried together; not kept in files.
    std::map<std::string, VariancePrior> variances;
    std::optional<Dependence> dependence;     ///< dependence of quantities in classes queried together; not kept in files
    double diversity = 0;                     ///< mean distance between two members, relative to the mean size
    double reject = 0.05, resolution = 0.02;  ///< from LearnOptions
    std::vector<std::string> notes;           ///< messages on what could not be learnt

    [[nodiscard]] const LearntRange* find(const std::string& key) const;  ///< range of the quantity with this key; null: none
    /// Whether thresholds were learnt, which needs at least three members: two members do not determine a standard deviation
    /// (Student's distribution with one degree of freedom has no mean).
    [[nodiscard]] bool has_thresholds() const { return members.size() >= min_members; }
    static constexpr std::size_t min_members = 3;  ///< min number of members for thresholds
};

/// Registers the template to `member`: by correspondence if `correspondence` allows, otherwise by a fit.
MemberFit fit_by_method(const ClassTemplate& class_template, const WholeObject& member, CorrespondenceChoice correspondence,
                        const MemberFitOptions& options);

/// Quantities of one member, from which a class is learnt.
struct LearntMember {
    std::string name;                       ///< name of the member
    MemberFit fit;                          ///< registration of the template to the member
    std::vector<ClassQuantity> quantities;  ///< quantities of the member, except those relative to other members
    std::vector<ClassQuantity> fragments;   ///< quantities of the member's pieces (fragment_quantities)
};
/// Fits the template to one member and measures all quantities that do not depend on other members. `whole_shape`: measures of
/// the member's surface, if already known; null: they are measured.
LearntMember learn_member(const ClassTemplate& class_template, const WholeObject& member, const LearnOptions& options = {},
                          const WholeShape* whole_shape = nullptr);

/// Measures the quantities of a member to which the template is already registered: on the member's own annotations where it has
/// regions, and on the template's annotations.
LearntMember measure_member(const ClassTemplate& class_template, const WholeObject& member, MemberFit fit,
                            const LearnOptions& options = {}, const WholeShape* whole_shape = nullptr);

/// Learns a class from its members. Members with a problem are left out, and a note reports them. `out_of_class` are out-of-class
/// objects: their values determine up to which dissimilarity an object is recognised. Throws Error (input) if no member is left.
ShapeClass learn_class(const ClassTemplate& class_template, const std::vector<LearntMember>& members,
                       const LearnOptions& options = {}, const std::vector<LearntMember>& out_of_class = {});

/// Sets, for each range, whether it can reject, its share of `reject`, and the accepted range: the prediction interval
/// (`predict`) of the values or their logarithms, one-sided for residuals. The rate is divided among the kinds of quantities
/// present and among the quantities of each kind (Bonferroni), so that the total rate holds for any dependence between
/// quantities. Quantities of single parts, and quantities that count for the dissimilarity (dissimilarity.h), only reject in
/// combination. Attributes get bounds as if they were a separate kind; their rate is additional if attributes are set to decide.
void learn_thresholds(ShapeClass& learnt);

/// Sets the thresholds of classes that are queried together. The variance of a geometry quantity, or of the combined parts, is
/// moderated by its variance in the other classes (`variance_prior`) if at least three classes have the quantity. The
/// dissimilarity is computed again with these variances and with the dependence of quantities pooled over the classes. The
/// dissimilarities of members and out-of-class objects are pooled too, and the classes share the rate at which out-of-class
/// objects are accepted.
void moderate_thresholds(std::vector<ShapeClass>& classes);

/// All quantities of single parts, combined into one residual of kind `part`: "sizes of the parts" or "places of the parts".
struct CombinedParts {
    ClassQuantity quantity;  ///< the combined residual
    std::size_t worst = 0;   ///< index of the range that deviates most
    double expected = 0;     ///< expected value of the quantity that deviates most
};
/// Combines the deviations of the parts' quantities. `values` and `expected`: value and expected value for each range.
std::vector<CombinedParts> combined_parts(const std::vector<LearntRange>& ranges,
                                          const std::vector<std::optional<double>>& values,
                                          const std::vector<std::optional<double>>& expected);
/// For each range of a part, the geometric mean of the members' values; empty for other ranges. `without`: index of a member that
/// is excluded.
std::vector<std::optional<double>> expected_parts(const std::vector<LearntRange>& ranges,
                                                  std::optional<std::size_t> without = {});

/// Mean distance over all pairs of shapes in correspondence, each registered to the mean of the class, relative to the mean size
/// of the class.
double mean_distance(const ShapeModes& modes, const std::vector<Landmarks>& shapes);

/// Shape prior that `fit` uses for the part of the shape not covered by fragments.
ShapePrior prior_of(const ShapeModes& modes);

}  // namespace ostraka

// Learns a class of objects from members: ranges of measured quantities, mean shape, modes of variation, thresholds (thesis,
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
    /// Treatment of members that have the template's triangles.
    CorrespondenceChoice correspondence = CorrespondenceChoice::automatic;
    /// The thresholds are chosen so that all of them together reject at most this share of members, if the quantities are
    /// normal or log-normal.
    double reject = 0.05;
    double resolution = 0.02;  ///< standard deviation of the measurement error, as a share of the value
    /// At most this share of members is not recognised; used if there are fewer than three out-of-class objects.
    double unsure = 0.15;
    /// At most this share of out-of-class objects is accepted by at least one of the classes that are queried together.
    double accept = 0.05;

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// The values of one quantity on the members, and the range accepted for other objects.
struct LearntRange {
    ClassQuantity quantity;  ///< the quantity, without a value
    /// Value of each member (empty: not measured). A value that is relative to the members is computed without the member
    /// itself (leave-one-out).
    std::vector<std::optional<double>> values;             ///< one value per member
    std::vector<std::optional<double>> out_of_class = {};  ///< value of each out-of-class object
    std::size_t count = 0;                                 ///< number of members with a value
    double min = 0, max = 0, mean = 0;                     ///< statistics of the members' values
    double percentile_5 = 0, percentile_25 = 0, median = 0, percentile_75 = 0, percentile_95 = 0;
    std::optional<double> deviation;  ///< standard deviation; empty for a single value
    /// True: the logarithm of the quantity is assumed to be normally distributed; used for positive values except those of
    /// constraints.
    bool logarithm = false;
    double reject = 0;  ///< share of members that this quantity alone rejects; 0: the quantity cannot reject
    /// Bounds of the accepted range. Empty if they cannot be learnt; a residual has no lower bound.
    std::optional<double> low, high;
    /// Only for the dissimilarity: an object is recognised up to this value, undecided from this value to `high`, and rejected
    /// above `high`.
    std::optional<double> recognised = {};
};

/// A member from which the class was learnt.
struct ClassMember {
    std::string name, placed_by;     ///< name of the object; method by which the template was registered (MemberFit::placed_by)
    double scale = 1;                ///< scale of the template
    std::vector<std::string> notes;  ///< remarks on the member
};

/// Cross products of the members' deviations from the means of their classes, for pairs of quantities.
struct Dependence {
    std::map<std::string, Eigen::Index> rows;  ///< from the key of a quantity to its row in `products`
    Eigen::MatrixXd products;                  ///< matrix with one row and one column per quantity
    double freedom = 0;                        ///< degrees of freedom: number of members minus number of classes
};

/// A learnt class.
struct ShapeClass {
    std::string name;                       ///< name of the class
    std::string template_file;              ///< file name of the template, which is in the folder of the class file
    bool sizes = false;                     ///< true: size is part of the shape
    std::vector<ClassMember> members;       ///< members from which the class was learnt
    std::vector<LearntRange> ranges;        ///< one range per quantity
    std::vector<LearntRange> fragments;     ///< ranges of the quantities for the fragment thresholds (fragment_thresholds.h)
    std::string topology;                   ///< topology_checksum of the template's mesh
    ShapeModes modes;                       ///< mean shape and modes of variation
    std::vector<std::string> out_of_class;  ///< names of the out-of-class objects
    double unsure = 0.15, accept = 0.05;    ///< from LearnOptions
    /// Max value of FitResiduals::off over the members; empty if the members are in correspondence.
    std::optional<double> most_off;
    /// Prior of the variance of each quantity (by key), estimated from classes that are queried together; not stored in files.
    std::map<std::string, VariancePrior> variances;
    /// Correlation of quantities in classes that are queried together; not stored in files.
    std::optional<Dependence> dependence;
    double diversity = 0;                     ///< mean distance between two members, relative to the mean size
    double reject = 0.05, resolution = 0.02;  ///< from LearnOptions
    std::vector<std::string> notes;           ///< messages about properties that could not be learnt

    [[nodiscard]] const LearntRange* find(const std::string& key) const;  ///< range of the quantity with this key; null: none
    /// True if thresholds were learnt. Thresholds need at least three members, because the standard deviation of two members is
    /// too uncertain (Student's distribution with one degree of freedom has no mean).
    [[nodiscard]] bool has_thresholds() const { return members.size() >= min_members; }
    static constexpr std::size_t min_members = 3;  ///< min number of members for thresholds
};

/// Registers the template to `member`, by correspondence if the member has the template's triangles and `correspondence` allows
/// it, otherwise by a fit.
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

/// Measures the quantities of a member to which the template is already registered. Quantities are measured on the member's own
/// annotations if it has regions, otherwise on the template's annotations.
LearntMember measure_member(const ClassTemplate& class_template, const WholeObject& member, MemberFit fit,
                            const LearnOptions& options = {}, const WholeShape* whole_shape = nullptr);

/// Learns a class from its members. Members with a problem are left out, and a note reports them. `out_of_class`: objects that
/// are not members; their dissimilarities determine the bound up to which an object is recognised. Throws Error (input) if no
/// member is left.
ShapeClass learn_class(const ClassTemplate& class_template, const std::vector<LearntMember>& members,
                       const LearnOptions& options = {}, const std::vector<LearntMember>& out_of_class = {});

/// Computes for each range: whether the range can reject an object, its share of the rate `reject`, and its bounds. The
/// bounds are the prediction interval (`predict`) of the values or their logarithms, one-sided for residuals. The rate is
/// divided among the kinds of quantities present, and then among the quantities of each kind (Bonferroni), so that the total
/// rate is valid for any dependence between quantities. Quantities of single parts, and quantities used for the dissimilarity
/// (dissimilarity.h), reject only in combination. Attributes are treated as a separate kind; if attributes are allowed to
/// reject, their rate is added to the total.
void learn_thresholds(ShapeClass& learnt);

/// Sets the thresholds of classes that are queried together. The variance of a geometric quantity, or of the combined parts, is
/// shrunk towards its variances in the other classes (`variance_prior`) if at least three classes have the quantity. The
/// dissimilarity is computed again with these variances and with the correlation of quantities pooled over the classes. The
/// dissimilarities of members and out-of-class objects are pooled too, and the rate at which out-of-class objects are accepted
/// is divided among the classes.
void moderate_thresholds(std::vector<ShapeClass>& classes);

/// One residual of kind `part` computed from the quantities of all single parts: "sizes of the parts" or "places of the parts".
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

/// Mean distance between two shapes, over all pairs. The shapes are in correspondence and are registered to the mean of the
/// class; the distance is relative to the mean size of the class.
double mean_distance(const ShapeModes& modes, const std::vector<Landmarks>& shapes);

/// Converts modes to the shape prior that `fit` uses for the unobserved part of an object.
ShapePrior prior_of(const ShapeModes& modes);

}  // namespace ostraka

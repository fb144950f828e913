// A class of objects learnt from members: ranges of what is measured, mean shape, modes of variation, thresholds (thesis 1.2).
#pragma once

#include "ostraka/core/provenance.h"
#include "ostraka/family/quantities.h"
#include "ostraka/fitting/shape_prior.h"

namespace ostraka {

struct LearnOptions {
    MemberFitOptions fit;
    ModeOptions modes;
    std::string correspondence = "auto";
    double margin = 1;
    double least = 0.02;

    template <class Visitor>
    void describe(Visitor& visit) {
        fit.describe(visit);
        modes.describe(visit);
        visit(
            "correspondence", correspondence,
            "members whose triangles are the template's are taken as they are, the template is fitted to others (auto); all have "
            "to be in correspondence (given); it is fitted to all (fitted)",
            Choices{"auto", "given", "fitted"});
        visit("margin", margin,
              "what is accepted goes beyond the members' range by so many times the farthest that a member lay outside of the "
              "range "
              "of the others",
              Range{0, 1000});
        visit("least-margin", least, "and by at least this share of the range's greatest value", Range{0, 10});
    }
};

/// The values that one quantity has on the members, and what is accepted of another object.
struct LearntRange {
    ClassQuantity quantity;                     ///< without value
    std::vector<std::optional<double>> values;  ///< of each member; geometry against the others: each left out
    std::size_t count = 0;
    double min = 0, max = 0, mean = 0;
    double percentile_5 = 0, percentile_25 = 0, median = 0, percentile_75 = 0, percentile_95 = 0;
    std::optional<double> deviation;  ///< standard deviation; none of a single value
    double overshoot = 0;             ///< the farthest that a member lies outside of the range of the others
    std::optional<double> low, high;  ///< accepted; none where nothing can be learnt, no low of a residual
};

struct ClassMember {
    std::string name, placed_by;
    double scale = 1;  ///< of the template
    std::vector<std::string> notes;
};

struct ShapeClass {
    std::string name;
    std::string template_file;  ///< beside the class's file
    bool sizes = false;
    std::vector<ClassMember> members;
    std::vector<LearntRange> ranges;
    ShapeModes modes;
    double diversity = 0;            ///< mean distance between two members, as a share of the mean size
    std::vector<std::string> notes;  ///< what could not be learnt, in words

    [[nodiscard]] const LearntRange* find(const std::string& key) const;
    /// Thresholds were learnt: there are two members or more.
    [[nodiscard]] bool has_thresholds() const { return members.size() > 1; }
};

/// Whether the template is laid onto `member` as it is or by a fit.
MemberFit fit_as_told(const ClassTemplate& known, const WholeObject& member, const std::string& correspondence,
                      const MemberFitOptions& options);

struct LearntMember {
    std::string name;
    MemberFit fit;
    std::vector<ClassQuantity> quantities;  ///< all but what refers to the other members
};
/// The fit of one member and all that is measured of it alone. `whole` spares measuring the surface anew where many templates are
/// laid onto one object.
LearntMember learn_member(const ClassTemplate& known, const WholeObject& member, const LearnOptions& options = {},
                          const WholeShape* whole = nullptr);

/// Puts the members together. Those with a problem are left out and said. Throws Error (input) if none is left.
ShapeClass learn_class(const ClassTemplate& known, const std::vector<LearntMember>& members, const LearnOptions& options = {});

/// The accepted range of `values` (see LearnOptions): none for fewer than two.
void learn_range(LearntRange& range, double margin, double least);

/// Mean distance between all pairs of shapes in correspondence, each laid onto the mean of the class, as a share of its mean
/// size.
double mean_distance(const ShapeModes& modes, const std::vector<Landmarks>& shapes);

/// What `fit` takes for the shape of what fragments do not show.
ShapePrior prior_of(const ShapeModes& modes);

}  // namespace ostraka

// Draws random new members of a class. A draw is accepted only if it satisfies the constraints of the class.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/shape_classes/classify.h"

namespace ostraka {

struct SampleOptions {
    int count = 10;          ///< number of members to draw
    std::uint64_t seed = 1;  ///< random seed
    /// Method of drawing. modes: random coefficients of the modes; edits: random parts of the mean shape are stretched or
    /// scaled.
    enum class Way { modes, edits } by = Way::modes;
    double spread = 1;  ///< coefficients are drawn within the range of the members' coefficients times this factor
    double edit = 0.2;  ///< standard deviation of the logarithm of the factor by which a part is stretched (method edits)
    int attempts = 20;  ///< max number of draws per member

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// A drawn member.
struct ClassSample {
    std::vector<Point> points;         ///< positions of the template's vertices
    std::vector<double> coefficients;  ///< drawn coefficients of the modes; empty with the method edits
    std::vector<std::string> edits;    ///< descriptions of the edits
    double moved = 0;  ///< largest displacement of a vertex when the constraints were restored, relative to the diagonal
};

/// Result of `sample_class`.
struct Sampling {
    std::vector<ClassSample> samples;  ///< the accepted draws
    std::size_t tried = 0;             ///< number of draws
    std::size_t by_constraints = 0;    ///< number of draws rejected because a constraint does not hold after restoring
    /// Number of draws rejected because a proportion, relation or distance is outside the accepted range.
    std::size_t by_ranges = 0;
    std::size_t by_intersections = 0;  ///< number of draws rejected because faces intersect that do not intersect on the template
    std::vector<std::string> examples;  ///< the first reason for rejection of each kind
    /// Mean distance between two samples, and between two members, relative to the mean size.
    double diversity = 0, of_members = 0;
    /// Share of the draws that were accepted.
    [[nodiscard]] double acceptance() const {
        return tried > 0 ? static_cast<double>(samples.size()) / static_cast<double>(tried) : 0;
    }
};

/// Draws new shapes of a class. Each draw has its own random stream of the seed. Coefficients are normal with the standard
/// deviations of the modes, drawn again until they lie within `spread` times the range of the members; if size is not part of
/// the shape, a centroid size is drawn from the range of the members. Then the shape is deformed so that it satisfies the
/// constraints of the template. A draw is accepted if all constraints hold, if every quantity on the template's annotations is
/// in the accepted range, and if no faces intersect except faces that intersect on the template. Returns fewer than `count`
/// shapes if the attempts are used up. Throws Error (input) for a class without modes (method modes) or a template without
/// parts (method edits).
Sampling sample_class(const ShapeClass& learnt, const ClassTemplate& class_template, const SampleOptions& options = {});

}  // namespace ostraka

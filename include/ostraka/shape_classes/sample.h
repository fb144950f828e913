// Random new members of a class, which are accepted only if the constraints of the class hold.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/shape_classes/classify.h"

namespace ostraka {

struct SampleOptions {
    int count = 10;          ///< number of members to draw
    std::uint64_t seed = 1;  ///< random seed
    /// modes: random coefficients of the modes; edits: the mean shape with random parts stretched or scaled.
    enum class Way { modes, edits } by = Way::modes;
    double spread = 1;  ///< factor on the range of the members' coefficients
    double edit = 0.2;  ///< edits: standard deviation of the logarithm of a part's stretch
    int attempts = 20;  ///< max number of draws per member

    void list_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// A drawn member.
struct ClassSample {
    std::vector<Point> points;         ///< positions of the template's vertices
    std::vector<double> coefficients;  ///< coefficients of the modes as drawn; empty for edits
    std::vector<std::string> edits;    ///< descriptions of the edits
    double moved = 0;  ///< largest displacement of a vertex by restoring the constraints, relative to the diagonal
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
    /// Accepted share of the draws.
    [[nodiscard]] double acceptance() const {
        return tried > 0 ? static_cast<double>(samples.size()) / static_cast<double>(tried) : 0;
    }
};

/// Draws new shapes of a class. Each draw has its own random stream of the seed. Coefficients are normal with the standard
/// deviations of the modes, drawn again until they lie within `spread` times the range of the members; if sizes do not count, a
/// centroid size is drawn from the range of the members. Then the constraints of the template are restored. A draw is accepted if
/// all constraints hold, if every quantity on the template's annotations is in the accepted range, and if no faces intersect
/// except faces that intersect on the template. Returns fewer than `count` shapes if the attempts are used up. Throws Error
/// (input) for a class without modes (by modes) or a template without parts (by edits).
Sampling sample_class(const ShapeClass& learnt, const ClassTemplate& class_template, const SampleOptions& options = {});

}  // namespace ostraka

// Random new members of a class, accepted only if the constraints of the class hold.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/shape_classes/classify.h"

namespace ostraka {

struct SampleOptions {
    int count = 10;
    std::uint64_t seed = 1;
    enum class Way { modes, edits } by = Way::modes;
    double spread = 1;
    double edit = 0.2;
    int attempts = 20;

    void list_options(OptionList& list);
};

struct ClassSample {
    std::vector<Point> points;
    std::vector<double> coefficients;  ///< as drawn; empty for edits
    std::vector<std::string> edits;    ///< descriptions of the edits
    double moved = 0;  ///< largest displacement of a vertex while the constraints were restored, relative to the diagonal
};

struct Sampling {
    std::vector<ClassSample> samples;
    std::size_t tried = 0;
    std::size_t by_constraints = 0;        ///< rejected: a constraint does not hold after restoring
    std::size_t by_ranges = 0;             ///< rejected: a proportion, relation or distance is outside the accepted range
    std::size_t by_intersections = 0;      ///< rejected: faces intersect that do not intersect on the template
    std::vector<std::string> examples;     ///< the first reason of each kind
    double diversity = 0, of_members = 0;  ///< mean distance of two samples, of two members, relative to the mean size
    [[nodiscard]] double acceptance() const {
        return tried > 0 ? static_cast<double>(samples.size()) / static_cast<double>(tried) : 0;
    }
};

/// Draws new shapes. Each draw has its own random stream of the seed. Coefficients are normal with the standard deviations of
/// the modes, drawn again until they lie within `spread` times the range of the members; if sizes do not count, a centroid size
/// is drawn from the range of the members. Then the constraints of the template are restored. A draw is accepted if all
/// constraints hold, if every quantity on the template's annotations is in the accepted range, and if no faces intersect except
/// those that do on the template. Returns fewer than `count` shapes if the attempts are used up. Throws Error (input) for a
/// class without modes (by modes) or a template without parts (by edits).
Sampling sample_class(const ShapeClass& learnt, const ClassTemplate& class_template, const SampleOptions& options = {});

}  // namespace ostraka

// New members of a class, drawn at random and kept only where the class's constraints hold.
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

    void describe(OptionList& visit);
};

struct ClassSample {
    std::vector<Point> points;
    std::vector<double> coefficients;  ///< as drawn; empty of edits
    std::vector<std::string> edits;    ///< in words
    double moved = 0;  ///< greatest way of a vertex while the constraints were restored, as a share of the diagonal
};

struct Sampling {
    std::vector<ClassSample> samples;
    std::size_t tried = 0;
    std::size_t by_constraints = 0;        ///< rejected: a constraint does not hold after restoring
    std::size_t by_ranges = 0;             ///< rejected: a proportion, relation or distance outside of what the class accepts
    std::size_t by_intersections = 0;      ///< rejected: faces cross that do not on the template
    std::vector<std::string> examples;     ///< a first reason of each kind
    double diversity = 0, of_members = 0;  ///< mean distance of two samples, and of two members, as a share of the mean size
    [[nodiscard]] double acceptance() const {
        return tried > 0 ? static_cast<double>(samples.size()) / static_cast<double>(tried) : 0;
    }
};

/// Each draw has a stream of the seed of its own: coefficients normal with the modes' deviations, drawn again until they are
/// within `spread` times the range of the members', and where sizes do not count a centroid size among the members'. Then the
/// template's constraints are restored; the draw is kept if all of them hold, nothing that can be measured on the template's
/// annotations is out of what the class accepts, and no faces cross but those that do on the template. Fewer than `count` are
/// returned where the attempts do not suffice. Throws Error (input) for a class without modes (by modes) or a template without
/// parts (by edits).
Sampling sample_class(const ShapeClass& learnt, const ClassTemplate& known, const SampleOptions& options = {});

}  // namespace ostraka

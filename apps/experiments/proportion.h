// Proportions of parts (thesis, section 5.3.2), constrained as in the thesis and as in this library.
#pragma once

#include "semantics.h"

namespace ostraka::experiments {

/// Constrains length of `part` / length of `reference` to a range by changing the part. Lengths are the parts' measures
/// "length".
struct Ratio {
    std::string part, reference;
    double min, max;
};

const Measure& measure_of(const Annotation& part);
double length(const Measure& measure, const std::vector<Point>& points);
double value_of(const Subject& subject, const Ratio& ratio, const std::vector<Point>& points);

/// As in the thesis: parts stretched about their mean (or from their joint), and Laplacians along their borders, of equal
/// weight.
Constraints thesis_proportions(const Subject& subject, const std::vector<Point>& edited, const std::vector<Ratio>& ratios,
                               bool anchored);
/// As in this library.
RelationGraph proportion_graph(const Subject& subject, const std::vector<Ratio>& ratios, bool hard);

const SolveOptions five{5, 0, 0, 0}, many{2000, 1e-7, 0, 5};

}  // namespace ostraka::experiments

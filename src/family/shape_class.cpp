#include "ostraka/family/shape_class.h"

#include "ostraka/core/error.h"
#include "ostraka/stats/summary.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace ostraka {

const LearntRange* ShapeClass::find(const std::string& key) const {
    for (const LearntRange& range : ranges)
        if (range.quantity.key() == key) return &range;
    return nullptr;
}

MemberFit fit_as_told(const ClassTemplate& known, const WholeObject& member, const std::string& correspondence,
                      const MemberFitOptions& options) {
    if (correspondence == "given" || (correspondence == "auto" && in_correspondence(known.mesh, member.mesh)))
        return member_in_correspondence(known.mesh, member);
    return fit_member(known.mesh, known.set, member, options);
}

LearntMember learn_member(const ClassTemplate& known, const WholeObject& member, const LearnOptions& options,
                          const WholeShape* whole) {
    check_options(options, "learn");
    LearntMember learnt;
    learnt.name = member.name;
    learnt.fit = fit_as_told(known, member, options.correspondence, options.fit);
    if (!learnt.fit.problem.empty()) return learnt;
    learnt.quantities = measure_quantities(known, learnt.fit.points, options.modes.sizes);
    for (ClassQuantity& quantity : geometry_quantities(learnt.fit.residuals)) learnt.quantities.push_back(std::move(quantity));
    for (ClassQuantity& quantity : geometry_quantities(whole != nullptr ? *whole : measure_whole_shape(member.mesh)))
        learnt.quantities.push_back(std::move(quantity));
    return learnt;
}

void learn_range(LearntRange& range, double margin, double least) {
    std::vector<double> known;
    for (const auto& value : range.values)
        if (value) known.push_back(*value);
    range.count = known.size();
    range.low.reset();
    range.high.reset();
    if (known.empty()) return;
    const Summary summary = summarise(known, range.quantity.key());
    range.min = summary.min;
    range.max = summary.max;
    range.mean = summary.mean;
    range.median = summary.median;
    range.deviation = summary.deviation;
    range.percentile_5 = sample_quantile(known, 0.05);
    range.percentile_25 = sample_quantile(known, 0.25);
    range.percentile_75 = sample_quantile(known, 0.75);
    range.percentile_95 = sample_quantile(known, 0.95);
    if (known.size() < 2) return;
    std::sort(known.begin(), known.end());
    // Only the least and the greatest lie outside of the range of the others.
    const double above = known.back() - known[known.size() - 2], below = known[1] - known[0];
    range.overshoot = range.quantity.one_sided ? above : std::max(above, below);
    // Rounding is no overshoot; nor is what a range in per cent tolerates (solver: a tenth).
    const bool per_cent = range.quantity.kind == QuantityKind::constraint && range.quantity.unit == "%";
    const double more =
        margin * range.overshoot + least * std::max(std::abs(range.min), std::abs(range.max)) + (per_cent ? 0.1 : 1e-6);
    range.high = range.max + more;
    if (!range.quantity.one_sided) range.low = range.min - more;
}

double mean_distance(const ShapeModes& modes, const std::vector<Landmarks>& shapes) {
    if (shapes.size() < 2) return 0;
    std::vector<Landmarks> laid;
    for (const Landmarks& shape : shapes) laid.push_back(coordinates_in(modes, shape).map.apply(shape));
    double sum = 0;
    for (std::size_t i = 0; i < laid.size(); ++i)
        for (std::size_t j = i + 1; j < laid.size(); ++j) sum += (laid[i] - laid[j]).norm();
    return sum / (0.5 * static_cast<double>(laid.size() * (laid.size() - 1))) / modes.mean_size;
}

namespace {

void add_ranges(ShapeClass& learnt, const std::vector<const LearntMember*>& members, const LearnOptions& options) {
    std::map<std::string, std::size_t> known;
    for (std::size_t i = 0; i < members.size(); ++i)
        for (const ClassQuantity& quantity : members[i]->quantities) {
            const auto [entry, fresh] = known.try_emplace(quantity.key(), learnt.ranges.size());
            if (fresh) {
                learnt.ranges.emplace_back().quantity = quantity;
                learnt.ranges.back().quantity.value.reset();
                learnt.ranges.back().values.resize(members.size());
            }
            learnt.ranges[entry->second].values[i] = quantity.value;
        }
    const auto add = [&](const char* name, const std::vector<double>& values) {
        LearntRange& range = learnt.ranges.emplace_back();
        range.quantity.name = name;
        range.quantity.one_sided = true;
        range.values.resize(members.size());
        for (std::size_t i = 0; i < values.size(); ++i) range.values[i] = values[i];
    };
    add("from the mean shape", learnt.modes.left_out_distances);
    add("outside the modes", learnt.modes.left_out_outside);
    if (learnt.sizes) {
        add("centroid size", learnt.modes.centroid_sizes);
        learnt.ranges.back().quantity.one_sided = false;
    }
    for (LearntRange& range : learnt.ranges) learn_range(range, options.margin, options.least);
}

}  // namespace

ShapeClass learn_class(const ClassTemplate& known, const std::vector<LearntMember>& members, const LearnOptions& options) {
    check_options(options, "learn");
    ShapeClass learnt;
    learnt.sizes = options.modes.sizes;
    std::vector<const LearntMember*> used;
    std::vector<Landmarks> shapes;
    for (const LearntMember& member : members) {
        if (!member.fit.problem.empty()) {
            learnt.notes.push_back(member.name + " is left out: " + member.fit.problem);
            continue;
        }
        used.push_back(&member);
        shapes.push_back(landmarks_of(member.fit.points));
        learnt.members.push_back({member.name, member.fit.placed_by, member.fit.scale, member.fit.notes});
    }
    if (used.empty())
        fail_input("class", members.empty() ? "has no member" : "has no member that the template could be laid onto",
                   "give one or more whole objects");
    learnt.modes = learn_modes(shapes, landmarks_of({known.mesh.points().begin(), known.mesh.points().end()}), options.modes);
    learnt.diversity = mean_distance(learnt.modes, shapes);
    add_ranges(learnt, used, options);
    if (used.size() == 1)
        learnt.notes.push_back("there is one member: neither modes nor thresholds can be learnt; give two or more");
    else if (used.size() < 5)
        learnt.notes.push_back("there are only " + std::to_string(used.size()) + " members: the thresholds are rough");
    const bool constrained = std::any_of(known.graph.relationships.begin(), known.graph.relationships.end(),
                                         [](const Relationship& one) { return one.is_constraint && one.weight > 0; });
    if (!constrained) learnt.notes.push_back("the template has no constraint: relations and geometry alone decide");
    return learnt;
}

ShapePrior prior_of(const ShapeModes& modes) {
    ShapePrior prior;
    for (Eigen::Index i = 0; i < modes.mean.rows(); ++i) prior.mean.emplace_back(modes.mean.row(i).transpose());
    prior.modes = modes.modes.transpose();
    for (const double variance : modes.variances) prior.deviations.push_back(std::sqrt(variance));
    return prior;
}

}  // namespace ostraka

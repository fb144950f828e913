// The report on the result: verdicts, objections, and conflicts of constraints.
#include "semantic/deformer.h"

#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"
#include "ostraka/core/text.h"
#include "semantic/verdict.h"

#include <algorithm>

namespace ostraka::semantic {

DeformResult Deformer::follow(const Edit& edit) {
    DeformResult result;
    result.selected = follow_steps(edit);
    result.edited = shape_of_edit(space_, last_, options_);
    asked_ = semantic::edited_vertices(space_, last_, columns_of(result.edited) - rest_);
    result = finish(std::move(result));
    result.followed = semantic::followed_edit(space_, last_, asked_, rest_, edited_, columns_of(result.points));
    if (result.followed.share < options_.followed)
        result.objections.push_back("the result follows the edit by " + percent(result.followed.share) + ", " +
                                    percent(options_.followed) + " are required");
    add_surface(result);
    result.acceptable = result.objections.empty();
    return result;
}

DeformResult Deformer::restore(const std::vector<Point>& points, const std::vector<bool>& held) {
    last_.handles = points;
    last_.touched = held;
    DeformResult result;
    result.edited = points;
    result = finish(std::move(result));
    result.acceptable = result.objections.empty();
    return result;
}

void Deformer::add_surface(DeformResult& result) const {
    const Mesh now = with_points(space_.mesh, result.points);
    result.surface = semantic::surface_change(space_.mesh, edited_mesh_, now);
    const auto& [crossings, before, added, folds, kinks] = result.surface;
    if (added > 0)
        result.objections.push_back(counted(added, "pair") + " of faces cross that did not at rest (" +
                                    std::to_string(crossings) + " in all, " + std::to_string(before) + " at rest)");
    if (folds > 0) result.objections.push_back(counted(folds, "edge") + (folds == 1 ? " is" : " are") + " folded over");
    if (kinks > 0) result.objections.push_back("the constraints kink the surface at " + counted(kinks, "edge"));
    if (space_.cage != nullptr)
        for (const std::string& reason : reasons_against_deformation(check_cage(*space_.cage, space_.mesh), *space_.coordinates))
            result.objections.push_back("the cage is not fit for deformation: " + reason);
    if (!result.solved) return;
    result.distorted = semantic::distorted_parts(space_, expected(result), edited_mesh_, now, options_);
    const double diagonal = box_diagonal(space_.mesh);
    for (const DistortedPart& part : result.distorted) {
        const std::string who = "'" + part.tag + "', which was not to change, ";
        if (part.distorted)
            result.objections.push_back(who + "is distorted by " + percent(part.distance / diagonal) +
                                        " of the diagonal in the root mean square, " + percent(part.largest / diagonal) +
                                        " at most");
        if (part.thinned)
            result.objections.push_back("'" + part.tag + "' is less than half as thick on " + percent(part.thin) +
                                        " of its surface");
    }
}

semantic::Expected Deformer::expected(const DeformResult& result) const {
    semantic::Expected flags{asked_, std::vector<bool>(space_.mesh.number_of_vertices(), false)};
    if (flags.change.empty()) flags.change.assign(flags.size.size(), false);
    for (std::size_t i = 0; i < statements_.size(); ++i) {
        const ConstraintReport& report = result.constraints[i];
        // Constraints enforced by values change their members even within the tolerance.
        const bool enforced = statements_[i].hard && !statements_[i].sized.empty();
        if (!report.used || (report.before == Verdict::holds && !enforced)) continue;
        for (const int id : report.annotations)
            for (const Index v : vertices_of(space_.mesh, *space_.annotations.find(id))) {
                flags.change[v] = true;
                if (statements_[i].resizes) flags.size[v] = true;
            }
    }
    return flags;
}

DeformResult Deformer::finish(DeformResult result) {
    edited_ = columns_of(result.edited);
    if (!edited_.allFinite() || edited_.cwiseAbs().maxCoeff() > 1e60)
        throw Error(ErrorKind::input, where_, "leads to points beyond what can be computed with (1e60)",
                    "look at the edit, and at the weights of the cage");
    edited_mesh_ = with_points(space_.mesh, result.edited);
    understand(result);
    const std::vector<bool> all = used(result);
    const Outcome outcome = solve(all);
    result.points = list_of(outcome.points);
    result.cage = list_of(outcome.cage);
    result.summary = outcome.summary;
    result.rounds = outcome.rounds;
    result.passes = outcome.passes;
    result.solved = outcome.solved;
    report(result, outcome);
    if (!result.objections.empty() && options_.conflicts > 0) find_conflicts(result, all);
    return result;
}

std::string Deformer::name_of(const ConstraintReport& report) {
    return "constraint " + std::to_string(report.id) + " (" + report.type + ")";
}

void Deformer::report(DeformResult& result, const Outcome& outcome) const {
    const semantic::State before(edited_mesh_);
    for (std::size_t i = 0; i < result.constraints.size(); ++i) {
        ConstraintReport& report = result.constraints[i];
        if (!report.used) {
            if (report.weight != 0) result.objections.push_back(name_of(report) + " is left out");
            continue;
        }
        const semantic::Measured then = statements_[i].measure(before), &now = outcome.measured[i];
        report.before = then.verdict;
        report.verdict = now.verdict;
        for (const Deviation& deviation : then.deviations) report.before_values.push_back(deviation.value.value_or(0));
        report.deviations = now.deviations;
        report.text = now.text;
        if (const auto by = contradicted(i, used(result)))
            report.text += (report.text.empty() ? "" : "; ") + std::string("not solved for: it contradicts ") +
                           name_of(result.constraints[by->first]) + ", " + by->second;
        if (!outcome.texts[i].empty()) report.text += (report.text.empty() ? "" : "; ") + outcome.texts[i];
        if (now.verdict == Verdict::fails)
            if (const std::string why = contradiction(result, i); !why.empty()) report.text += "; " + why;
        if (now.verdict != Verdict::holds)
            result.objections.push_back(name_of(report) +
                                        (now.verdict == Verdict::fails ? " does not hold" : " is not known to hold"));
        if (i >= outcome.residuals.size() || outcome.residuals[i].low_level_residuals.empty()) continue;
        auto list = outcome.residuals[i].low_level_residuals;
        std::sort(list.begin(), list.end());
        report.distance = outcome.residuals[i].distance;
        if (!report.hard) report.cost = outcome.residuals[i].cost, report.cost_before = outcome.residuals[i].cost_before;
        if (report.hard && options_.space == DeformOptions::Space::cage && report.verdict != Verdict::holds)
            report.text += (report.text.empty() ? "" : "; ") + std::string("off by ") + std::to_string(report.distance) +
                           (space_.annotations.unit.empty() ? "" : " ") + space_.annotations.unit +
                           " at its worst point, with these weights in this cage";
        report.low_level = list.size();
        report.minimum = list.front();
        report.maximum = list.back();
        report.median = (list[(list.size() - 1) / 2] + list[list.size() / 2]) / 2;
        for (const double value : list) report.mean += value / static_cast<double>(list.size());
    }
}

std::string Deformer::contradiction(const DeformResult& result, std::size_t i) const {
    const semantic::State state(edited_mesh_);
    for (std::size_t j = 0; j < statements_.size(); ++j) {
        if (j == i || !result.constraints[j].used) continue;
        for (const semantic::Sized& a : statements_[i].sized)
            for (const semantic::Sized& b : statements_[j].sized) {
                const bool inner = contradict(a, b, state);
                if (!inner && !contradict(b, a, state)) continue;
                const auto& [part, whole] = inner ? std::pair(&a, &b) : std::pair(&b, &a);
                return digits(part->range(state).first, 6) + " of a part and " + digits(whole->range(state).second, 6) +
                       " of what holds it, in one direction, cannot both be: see " + name_of(result.constraints[j]);
            }
    }
    return {};
}

void Deformer::find_conflicts(DeformResult& result, const std::vector<bool>& all) {
    const auto maximum = static_cast<std::size_t>(options_.conflicts);
    std::vector<std::size_t> order;
    for (const bool failing : {true, false})
        for (std::size_t i = 0; i < all.size(); ++i)
            if (all[i] && (result.constraints[i].verdict != Verdict::holds) == failing) order.push_back(i);
    if (order.size() < 2) return;
    if (order.size() > maximum) result.untried = order.size() - maximum;
    order.resize(std::min(order.size(), maximum));
    for (const std::size_t left_out : order) {
        std::vector<bool> active = all;
        active[left_out] = false;
        const Outcome outcome = solve(active);
        ConstraintConflict conflict;
        conflict.id = result.constraints[left_out].id;
        for (std::size_t i = 0; i < all.size(); ++i)
            if (active[i] && result.constraints[i].verdict != Verdict::holds && outcome.measured[i].verdict == Verdict::holds)
                conflict.freed.push_back(result.constraints[i].id);
        conflict.deviations = outcome.measured[left_out].deviations;
        if (!conflict.freed.empty()) result.conflicts.push_back(std::move(conflict));
    }
}

}  // namespace ostraka::semantic

// The constraints of an edit and a graph, and the passes of the solve: each pass updates references that the previous one moved.
#include "semantic/deformer.h"

#include "ostraka/core/error.h"
#include "ostraka/files/json_build.h"
#include "semantic/verdict.h"

#include <algorithm>
#include <map>

namespace ostraka::semantic {

Deformer::Solved Deformer::solve_only(const Edit& edit) {
    follow_steps(edit);
    const std::vector<Point> shape = shape_of_edit(space_, last_, options_);
    edited_ = columns_of(shape);
    edited_mesh_ = with_points(space_.mesh, shape);
    asked_ = semantic::edited_vertices(space_, last_, edited_ - rest_);
    DeformResult result;
    understand(result);
    return {edited_, solve(used(result)).points};
}

CageSystem Deformer::begin(const Edit& edit, const std::vector<Index>& handles, std::vector<Point>& cage) {
    follow_steps(edit);
    for (const Index handle : handles) last_.touched[handle] = true;
    last_.by_handles = true;
    is_under_way_ = true;
    cage = last_.handles;
    const std::vector<Point> shape = shape_of_edit(space_, last_, options_);
    edited_ = columns_of(shape);
    edited_mesh_ = with_points(space_.mesh, shape);
    EditState dragged = last_;  // an arbitrary position, to determine the vertices that follow
    for (const Index handle : handles)
        dragged.handles[handle] = dragged.handles[handle] + Vector(0, 0, 0.01 * box_diagonal(space_.mesh));
    asked_ = semantic::edited_vertices(space_, dragged, columns_of(shape_of_edit(space_, dragged, options_)) - rest_);
    DeformResult result;
    understand(result);
    begin_sizes(used(result));
    Outcome outcome;
    outcome.points = edited_;
    outcome.texts.resize(statements_.size());
    return lower(used(result), outcome) ? cage_system() : CageSystem();
}

std::vector<std::size_t> Deformer::follow_steps(const Edit& edit) {
    std::vector<std::size_t> selected;
    last_.handles = points_of(space_.cage != nullptr ? *space_.cage : space_.mesh);
    last_.touched.assign(last_.handles.size(), false);
    last_.is_referenced.assign(space_.mesh.number_of_vertices(), false);
    for (auto& state : follow_edit(edit, space_, where_)) {
        last_ = std::move(state);
        selected.push_back(last_.selected.size());
    }
    return selected;
}

void Deformer::understand(DeformResult& result) {
    const semantic::Shape shape{space_, rest_};
    std::map<Index, int> reattached;  // vertex -> feature
    for (const Relationship& relationship : graph_.relationships) {
        if (!relationship.is_constraint) continue;
        statements_.push_back(semantic::understand(shape, relationship, tolerances_, graph_where_));
        result.constraints.push_back(semantic::report_of(relationship, statements_.back()));
    }
    let_levels_be_resized(shape, result);
    for (std::size_t i = 0; i < statements_.size(); ++i) {
        const semantic::Statement& statement = statements_[i];
        const ConstraintReport& relationship = result.constraints[i];
        if (statement.reattachment && relationship.weight > 0)
            for (const Annotation* feature : statement.reattachment->features)
                for (const Index v : vertices_of(space_.mesh, *feature)) {
                    const auto [other, fresh] = reattached.try_emplace(v, feature->id);
                    if (!fresh)
                        throw Error(ErrorKind::input, graph_where_ + ", constraint " + std::to_string(relationship.id),
                                    "seats annotation " + std::to_string(feature->id) + ", which touches annotation " +
                                        std::to_string(other->second) + ", seated as well",
                                    "seat one of them, or make one annotation of both");
                }
    }
}

void Deformer::let_levels_be_resized(const semantic::Shape& shape, const DeformResult& result) {
    std::set<int> resized;
    for (std::size_t i = 0; i < statements_.size(); ++i)
        if (statements_[i].resizes && result.constraints[i].used)
            resized.insert(result.constraints[i].annotations.begin(), result.constraints[i].annotations.end());
    std::size_t place = 0;
    for (const Relationship& relationship : graph_.relationships) {
        if (!relationship.is_constraint) continue;
        const std::size_t i = place++;
        if (relationship.type != "same level" || std::none_of(relationship.annotations.begin(), relationship.annotations.end(),
                                                              [&](int id) { return resized.count(id) > 0; }))
            continue;
        Json parameters =
            relationship.constraint.empty() ? Json(rapidjson::kObjectType) : parse_json(relationship.constraint, graph_where_);
        if (parameters.HasMember("shapes")) continue;
        add_members(parameters, parameters.GetAllocator(), "shapes", "similar");
        Relationship& similar = resized_levels_.emplace_back(relationship);
        similar.constraint = to_compact_text(parameters);
        statements_[i] = semantic::understand(shape, similar, tolerances_, graph_where_);
    }
}

std::optional<std::pair<std::size_t, std::string>> Deformer::contradicted(std::size_t i, const std::vector<bool>& active) const {
    for (std::size_t k = 0; k < i && statements_[i].hard; ++k)
        if (active[k] && statements_[k].hard)
            if (std::string why = semantic::contradiction(statements_[k], statements_[i]); !why.empty())
                return std::pair{k, std::move(why)};
    return {};
}

std::vector<bool> Deformer::used(const DeformResult& result) {
    std::vector<bool> flags;
    for (const ConstraintReport& report : result.constraints) flags.push_back(report.used);
    return flags;
}

Outcome Deformer::solve(const std::vector<bool>& active) {
    const semantic::State edited(edited_mesh_);
    std::vector<bool> solved = active;
    for (std::size_t i = 0; i < statements_.size(); ++i)
        solved[i] = active[i] && !(statements_[i].left_alone && semantic::is_within(statements_[i].measure(edited)));
    for (;;) {
        Outcome outcome = solve_for(solved);
        bool lost = false;
        for (std::size_t i = 0; i < statements_.size(); ++i) {
            if (!active[i] || solved[i]) continue;
            outcome.texts[i] = "left alone, since it holds where the edit leaves it";
            solved[i] = !semantic::is_within(outcome.measured[i]);
            lost = lost || solved[i];
        }
        if (!lost) return outcome;
    }
}

Outcome Deformer::solve_for(const std::vector<bool>& active) {
    Outcome outcome;
    hard_scale_ = 1;
    outcome.points = edited_;
    if (space_.cage != nullptr) outcome.cage = columns_of(last_.handles);
    outcome.texts.resize(statements_.size());
    begin_sizes(active);
    Points before;
    if (sizes_->empty()) before = make_passes(active, outcome);
    else before = search_sizes(active, outcome);
    std::vector<semantic::Reattachment> reattachments;
    for (std::size_t i = 0; i < statements_.size(); ++i)
        if (active[i] && statements_[i].reattachment) reattachments.push_back(*statements_[i].reattachment);
    if (!reattachments.empty()) {
        const auto reattached = semantic::reattach(space_.mesh, rest_, reattachments, outcome.points);
        outcome.solved = true;
        for (std::size_t i = 0; i < statements_.size(); ++i)
            if (active[i] && statements_[i].reattachment && reattached.folded > 0)
                outcome.texts[i] = std::to_string(reattached.folded) + " faces around the features fold over";
    }
    const Mesh deformed = with_points(space_.mesh, list_of(outcome.points));
    const semantic::State state(deformed);
    keep_residuals(active, before, state, outcome);
    for (const semantic::Statement& statement : statements_)
        outcome.measured.push_back(statement.unknown.empty() ? statement.measure(state) : semantic::Measured());
    return outcome;
}

Points Deformer::make_passes(const std::vector<bool>& active, Outcome& outcome) {
    bool follows = false, gauges = false;
    for (std::size_t i = 0; i < statements_.size(); ++i) {
        follows = follows || (active[i] && statements_[i].follows);
        gauges = gauges || (active[i] && statements_[i].until_it_holds);
    }
    // Measures are met to a thousandth.
    const double still = (gauges ? 1e-6 : 1e-4) * box_diagonal(space_.mesh);
    // Failing hard constraints get further passes as long as they improve; the best result is used.
    const int usual = follows ? options_.passes : 1, most = follows ? 4 * usual : 1;
    constexpr int patience = 5;
    double least = std::numeric_limits<double>::infinity();
    int since = 0;
    Points before = outcome.points, best, before_best;
    while (outcome.passes < usual || (outcome.passes < most && since < patience && least > 1)) {
        if (outcome.passes > 0 && !another_pass(active, outcome)) break;
        before = outcome.points;
        if (!solve_once(active, outcome)) break;
        outcome.solved = true;
        ++outcome.passes;
        if (outcome.passes > 1 && (outcome.points - before).colwise().norm().maxCoeff() <= still) break;
        if (!follows || outcome.passes < usual) continue;
        const double off = shortfall(active, outcome);
        since = off < 0.9 * least ? 0 : since + 1;
        if (off < least) least = off, best = outcome.points, before_best = before;
    }
    if (best.size() > 0 && least < shortfall(active, outcome)) outcome.points = best, before = before_best;
    return before;
}

Points Deformer::search_sizes(const std::vector<bool>& active, Outcome& outcome) {
    constexpr double near = 1e-4;  // a tenth of the tolerance of a measure
    constexpr int patience = 5, most = 40;
    double least = std::numeric_limits<double>::infinity();
    int since = 0;
    Points before = outcome.points, best = outcome.points;
    while (outcome.passes < most) {
        if (since >= patience) {
            if (!sizes_->allow_whole_ranges()) break;
            outcome.points = best;
            const Mesh reached = with_points(space_.mesh, list_of(best));
            least = sizes_->off(semantic::State(reached));
            since = 0;
            if (least <= near) break;
        }
        const Mesh mesh = with_points(space_.mesh, list_of(outcome.points));
        sizes_->follow(semantic::State(mesh));
        before = outcome.points;
        if (!solve_once(active, outcome)) break;
        outcome.solved = true;
        ++outcome.passes;
        const Mesh after = with_points(space_.mesh, list_of(outcome.points));
        const double off = sizes_->off(semantic::State(after));
        since = off < 0.9 * least ? 0 : since + 1;
        if (off < least) least = off, best = outcome.points;
        if (off <= near && !other_references_moved(active, outcome, before)) break;
    }
    outcome.points = best;
    return before;
}

double Deformer::shortfall(const std::vector<bool>& active, const Outcome& outcome) const {
    const Mesh mesh = with_points(space_.mesh, list_of(outcome.points));
    const semantic::State now(mesh);
    double worst = 0;
    for (std::size_t i = 0; i < statements_.size(); ++i) {
        if (!active[i] || !statements_[i].hard || !statements_[i].follows || contradicted(i, active)) continue;
        for (const Deviation& one : statements_[i].measure(now).deviations)
            if (one.value && one.tolerance && *one.tolerance > 0) worst = std::max(worst, *one.value / *one.tolerance);
    }
    return worst;
}

bool Deformer::other_references_moved(const std::vector<bool>& active, const Outcome& outcome, const Points& before) const {
    std::vector<bool> others = active;
    for (std::size_t i = 0; i < others.size(); ++i)
        if (is_sized(i)) others[i] = false;
    return outcome.passes < options_.passes && another_pass(others, outcome) &&
           (outcome.points - before).colwise().norm().maxCoeff() > 1e-4 * box_diagonal(space_.mesh);
}

bool Deformer::another_pass(const std::vector<bool>& active, const Outcome& outcome) const {
    const Mesh mesh = with_points(space_.mesh, list_of(outcome.points));
    const semantic::State now(mesh);
    for (std::size_t i = 0; i < statements_.size(); ++i)
        if (active[i] && statements_[i].follows &&
            !(statements_[i].until_it_holds && statements_[i].measure(now).verdict == Verdict::holds))
            return true;
    return false;
}

void Deformer::keep_residuals(const std::vector<bool>& active, const Points& before, const semantic::State& finished,
                              Outcome& outcome) const {
    if (!outcome.solved) return;
    outcome.residuals.assign(statements_.size(), {});
    const Mesh mesh = with_points(space_.mesh, list_of(before));
    const semantic::State last(mesh);
    semantic::State edited(edited_mesh_);
    edited.asked = asked_;
    edited.is_dragging = is_under_way_;
    for (std::size_t i = 0; i < statements_.size(); ++i) {
        if (!active[i]) continue;
        const bool axes = statements_[i].follows && !statements_[i].until_it_holds;
        Outcome::Residuals& residuals = outcome.residuals[i];
        for (const auto& constraint : statements_[i].lower(edited, axes ? finished : last)) {
            residuals.low_level_residuals.push_back(constraint->normalised_residual(finished.points));
            residuals.distance = std::max(residuals.distance, constraint->greatest_distance(finished.points));
            residuals.cost += constraint->weight() * constraint->squared_distance(finished.points);
            residuals.cost_before += constraint->weight() * constraint->squared_distance(edited.points);
        }
    }
}

}  // namespace ostraka::semantic

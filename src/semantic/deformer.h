// How an edit and constraints become a shape: what 'deform', 'restore_constraints' and live drags share.
#pragma once

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <set>
#include "distortion.h"
#include "ostraka/cage/cage.h"
#include "ostraka/coords/nested.h"
#include "ostraka/core/error.h"
#include "ostraka/core/json_build.h"
#include "ostraka/core/text.h"
#include "ostraka/core/words.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/with_points.h"
#include "ostraka/semantic/deform.h"
#include "sizes.h"
#include "statement.h"
#include "verdict.h"

namespace ostraka::semantic {

/// Without any, nothing would hold positions.
inline constexpr double min_laplacian = 1e-3;

/// Weight of the positions of points an edge apart, so that changes fade out over the spread, and over three edges at least.
inline double closeness(const DeformOptions& options, const Mesh& mesh, double edge) {
    return std::max(options.laplacian, min_laplacian) *
           std::pow(std::min(edge / (options.spread * box_diagonal(mesh)), 1.0 / 3), 4);
}

inline void add_closeness(const std::vector<int>& ids, double weight, const Points& targets, int offset, const Points& rest,
                          std::vector<std::unique_ptr<Constraint>>& list) {
    if (ids.empty() || weight == 0) return;
    ConstraintParameters parameters;
    parameters.target.emplace(3, static_cast<Eigen::Index>(ids.size()));
    for (std::size_t i = 0; i < ids.size(); ++i)
        parameters.target->col(static_cast<Eigen::Index>(i)) = targets.col(ids[i] - offset);
    list.push_back(make_constraint("Closeness", ids, weight, parameters, rest));
}

/// On every vertex, those that `shape` has; within parts that are made larger or smaller, as these.
inline void add_displacements(const Mesh& mesh, double weight, const Points& shape, const std::set<Index>& others,
                              const Sizes* sizes, std::vector<std::unique_ptr<Constraint>>& list) {
    if (weight == 0) return;
    for (const Vertex v : mesh.vertices()) {
        if (mesh.is_isolated(v) || others.count(v.idx()) > 0) continue;
        std::vector<int> star = semantic::star_of(mesh, v);
        ConstraintParameters parameters;
        if (sizes != nullptr) {
            Eigen::Vector3d mean = Eigen::Vector3d::Zero();
            for (std::size_t i = 1; i < star.size(); ++i) mean += shape.col(star[i]) - shape.col(star[0]);
            parameters.target = sizes->around(v.idx()) * mean / static_cast<double>(star.size() - 1);
        }
        list.push_back(make_constraint("LaplacianDisplacement", std::move(star), weight, parameters, shape));
    }
}

/// What solving for some of the constraints gives.
struct Outcome {
    Points points, cage;
    SolveSummary summary;
    int rounds = 0, passes = 0;
    bool solved = false;
    struct Residuals {
        std::vector<double> of_low_level;
        double distance = 0, cost = 0, cost_before = 0;
    };
    std::vector<Residuals> residuals;  ///< of each constraint
    std::vector<std::string> texts;    ///< what is to be said of each
    std::vector<semantic::Measured> measured;
};

/// Constraints over the vertices of a cage.
struct CageSystem {
    /// Rows for the cage's own points below those of the mesh, so that handles are constrained like any point.
    std::unique_ptr<CageWeights> extended;
    std::unique_ptr<CageSpaceSolver> solver;
    std::size_t first_displacement = 0, displacements = 0;  ///< places of the Laplacian displacements of the cage
};

class Deformer {
public:
    Deformer(const HandleSpace& space, const RelationGraph& graph, const DeformOptions& options,
             const RelationOptions& tolerances, const std::string& where, const std::string& graph_where)
        : space_(space),
          graph_(graph),
          options_(options),
          tolerances_(tolerances),
          where_(where),
          graph_where_(graph_where),
          rest_(columns_of(space.mesh)) {}

    DeformResult follow(const JsonValue& edit) {
        DeformResult result;
        result.selected = follow_steps(edit);
        result.edited = shape_of_edit(space_, last_, options_);
        asked_ = semantic::asked_vertices(space_, last_, columns_of(result.edited) - rest_);
        result = finish(std::move(result));
        result.followed = semantic::followed_edit(space_, last_, asked_, rest_, edited_, columns_of(result.points));
        if (result.followed.share < options_.followed)
            result.objections.push_back("the edit is followed by " + percent(result.followed.share) + ", " +
                                        percent(options_.followed) + " are asked");
        add_surface(result);
        result.acceptable = result.objections.empty();
        return result;
    }

    DeformResult restore(const std::vector<Point>& points, const std::vector<bool>& held) {
        last_.handles = points;
        last_.touched = held;
        DeformResult result;
        result.edited = points;
        result = finish(std::move(result));
        result.acceptable = result.objections.empty();
        return result;
    }

    struct Solved {
        Points edited, points;
    };
    /// The shape after the edit, and after solving; nothing is judged.
    Solved solve_only(const JsonValue& edit) {
        follow_steps(edit);
        const std::vector<Point> shape = shape_of_edit(space_, last_, options_);
        edited_ = columns_of(shape);
        edited_mesh_ = with_points(space_.mesh, shape);
        asked_ = semantic::asked_vertices(space_, last_, edited_ - rest_);
        DeformResult result;
        understand(result);
        return {edited_, solve(used(result)).points};
    }
    [[nodiscard]] const std::vector<semantic::Statement>& statements() const { return statements_; }

    /// For a drag of these handles from where the edit leaves the cage, whose vertices are handed over; no solver where no
    /// constraint asks for anything.
    CageSystem begin(const JsonValue& edit, const std::vector<Index>& handles, std::vector<Point>& cage) {
        follow_steps(edit);
        for (const Index handle : handles) last_.touched[handle] = true;
        last_.by_handles = true;
        is_under_way_ = true;
        cage = last_.handles;
        const std::vector<Point> shape = shape_of_edit(space_, last_, options_);
        edited_ = columns_of(shape);
        edited_mesh_ = with_points(space_.mesh, shape);
        EditState dragged = last_;  // somewhere: what counts is which vertices go along
        for (const Index handle : handles)
            dragged.handles[handle] = dragged.handles[handle] + Vector(0, 0, 0.01 * box_diagonal(space_.mesh));
        asked_ = semantic::asked_vertices(space_, dragged, columns_of(shape_of_edit(space_, dragged, options_)) - rest_);
        DeformResult result;
        understand(result);
        begin_sizes(used(result));
        Outcome outcome;
        outcome.points = edited_;
        outcome.texts.resize(statements_.size());
        return lower(used(result), outcome) ? cage_system() : CageSystem();
    }

private:
    /// To the state after the last step. How many handles each step selects.
    std::vector<std::size_t> follow_steps(const JsonValue& edit) {
        std::vector<std::size_t> selected;
        last_.handles = points_of(space_.cage != nullptr ? *space_.cage : space_.mesh);
        last_.touched.assign(last_.handles.size(), false);
        last_.named.assign(space_.mesh.number_of_vertices(), false);
        for (auto& state : follow_edit(edit, space_, where_)) {
            last_ = std::move(state);
            selected.push_back(last_.selected.size());
        }
        return selected;
    }

    void add_surface(DeformResult& result) const {
        const Mesh now = with_points(space_.mesh, result.points);
        result.surface = semantic::surface_change(space_.mesh, edited_mesh_, now);
        const auto& [crossings, before, added, folds, kinks] = result.surface;
        if (added > 0)
            result.objections.push_back(counted(added, "pair") + " of faces cross that did not at rest (" +
                                        std::to_string(crossings) + " in all, " + std::to_string(before) + " at rest)");
        if (folds > 0) result.objections.push_back(counted(folds, "edge") + (folds == 1 ? " is" : " are") + " folded over");
        if (kinks > 0) result.objections.push_back("the constraints kink the surface at " + counted(kinks, "edge"));
        if (space_.cage != nullptr)
            for (const std::string& reason : unfit_for_deformation(check_cage(*space_.cage, space_.mesh), *space_.coordinates))
                result.objections.push_back("the cage is not fit for deformation: " + reason);
        if (!result.solved) return;
        result.distorted = semantic::distorted_parts(space_.mesh, space_.set, expected(result), edited_mesh_, now, options_);
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

    /// What the edit and the constraints that did not hold give leave to change.
    [[nodiscard]] semantic::Expected expected(const DeformResult& result) const {
        semantic::Expected flags{asked_, std::vector<bool>(space_.mesh.number_of_vertices(), false)};
        if (flags.change.empty()) flags.change.assign(flags.size.size(), false);
        for (std::size_t i = 0; i < statements_.size(); ++i) {
            const ConstraintReport& report = result.constraints[i];
            // What is enforced by its values changes its members also within its tolerance.
            const bool enforced = statements_[i].hard && !statements_[i].sized.empty();
            if (!report.used || (report.before == Verdict::holds && !enforced)) continue;
            for (const int id : report.annotations)
                for (const Index v : vertices_of(space_.mesh, *space_.set.find(id))) {
                    flags.change[v] = true;
                    if (statements_[i].resizes) flags.size[v] = true;
                }
        }
        return flags;
    }

    static std::string percent(double share) { return digits(100 * share, 3) + " %"; }

    DeformResult finish(DeformResult result) {
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

    void understand(DeformResult& result) {
        const semantic::Shape shape{space_.mesh, space_.set, rest_};
        std::map<Index, int> reattached;  // by which feature
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

    /// Parts on one level keep their shape; but their size only where no other constraint changes it, and where the constraint
    /// does not say itself how they are kept.
    void let_levels_be_resized(const semantic::Shape& shape, const DeformResult& result) {
        std::set<int> resized;
        for (std::size_t i = 0; i < statements_.size(); ++i)
            if (statements_[i].resizes && result.constraints[i].used)
                resized.insert(result.constraints[i].annotations.begin(), result.constraints[i].annotations.end());
        std::size_t place = 0;
        for (const Relationship& relationship : graph_.relationships) {
            if (!relationship.is_constraint) continue;
            const std::size_t i = place++;
            if (relationship.type != "same level" ||
                std::none_of(relationship.annotations.begin(), relationship.annotations.end(),
                             [&](int id) { return resized.count(id) > 0; }))
                continue;
            Json parameters = relationship.constraint.empty() ? Json(rapidjson::kObjectType)
                                                              : parse_json(relationship.constraint, graph_where_);
            if (parameters.HasMember("shapes")) continue;
            add_members(parameters, parameters.GetAllocator(), "shapes", "similar");
            Relationship& similar = resized_levels_.emplace_back(relationship);
            similar.constraint = to_compact_text(parameters);
            statements_[i] = semantic::understand(shape, similar, tolerances_, graph_where_);
        }
    }

    /// By a hard constraint before it, why a hard one is not solved for: it would only crush the part.
    [[nodiscard]] std::optional<std::pair<std::size_t, std::string>> contradicted(std::size_t i,
                                                                                  const std::vector<bool>& active) const {
        for (std::size_t k = 0; k < i && statements_[i].hard; ++k)
            if (active[k] && statements_[k].hard)
                if (std::string why = semantic::contradiction(statements_[k], statements_[i]); !why.empty())
                    return std::pair{k, std::move(why)};
        return {};
    }

    static std::vector<bool> used(const DeformResult& result) {
        std::vector<bool> flags;
        for (const ConstraintReport& report : result.constraints) flags.push_back(report.used);
        return flags;
    }

    /// For the active constraints; all others are only measured. What holds where the edit leaves it is left alone, until others
    /// take it away.
    Outcome solve(const std::vector<bool>& active) {
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

    Outcome solve_for(const std::vector<bool>& active) {
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

    /// Solves until what constraints follow stands still. The points before the last pass.
    Points make_passes(const std::vector<bool>& active, Outcome& outcome) {
        bool follows = false, gauges = false;
        for (std::size_t i = 0; i < statements_.size(); ++i) {
            follows = follows || (active[i] && statements_[i].follows);
            gauges = gauges || (active[i] && statements_[i].until_it_holds);
        }
        // Measures are held to a thousandth of a part.
        const double still = (gauges ? 1e-6 : 1e-4) * box_diagonal(space_.mesh);
        Points before = outcome.points;
        while (outcome.passes < (follows ? options_.passes : 1)) {
            if (outcome.passes > 0 && !another_pass(active, outcome)) break;
            before = outcome.points;
            if (!solve_once(active, outcome)) break;
            outcome.solved = true;
            ++outcome.passes;
            if (outcome.passes > 1 && (outcome.points - before).colwise().norm().maxCoeff() <= still) break;
        }
        return before;
    }

    /// Passes with other factors for the parts that must have certain sizes, until these have them; else the best of them.
    Points search_sizes(const std::vector<bool>& active, Outcome& outcome) {
        constexpr double near = 1e-4;  // a tenth of what a measure may be off
        constexpr int patience = 5, most = 40;
        double least = std::numeric_limits<double>::infinity();
        int since = 0;
        Points before = outcome.points, best = outcome.points;
        while (outcome.passes < most && since < patience) {
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
            if (off <= near && !others_go_on(active, outcome, before)) break;
        }
        outcome.points = best;
        return before;
    }

    /// Whether a constraint that is no measure still follows what has moved.
    [[nodiscard]] bool others_go_on(const std::vector<bool>& active, const Outcome& outcome, const Points& before) const {
        std::vector<bool> others = active;
        for (std::size_t i = 0; i < others.size(); ++i)
            if (is_sized(i)) others[i] = false;
        return outcome.passes < options_.passes && another_pass(others, outcome) &&
               (outcome.points - before).colwise().norm().maxCoeff() > 1e-4 * box_diagonal(space_.mesh);
    }

    /// Whether the constraint is enforced by the values of its measures.
    [[nodiscard]] bool is_sized(std::size_t i) const {
        return statements_[i].hard && !statements_[i].sized.empty() && options_.space == DeformOptions::Space::mesh;
    }

    void begin_sizes(const std::vector<bool>& active) {
        std::vector<const semantic::Sized*> parts;
        for (std::size_t i = 0; i < statements_.size(); ++i)
            if (active[i] && is_sized(i))
                for (const semantic::Sized& part : statements_[i].sized) parts.push_back(&part);
        semantic::State edited(edited_mesh_);
        edited.asked = asked_;
        sizes_.emplace(std::move(parts), semantic::Shape{space_.mesh, space_.set, rest_}, edited);
    }

    /// Whether what a constraint follows may have moved.
    [[nodiscard]] bool another_pass(const std::vector<bool>& active, const Outcome& outcome) const {
        const Mesh mesh = with_points(space_.mesh, list_of(outcome.points));
        const semantic::State now(mesh);
        for (std::size_t i = 0; i < statements_.size(); ++i)
            if (active[i] && statements_[i].follows &&
                !(statements_[i].until_it_holds && statements_[i].measure(now).verdict == Verdict::holds))
                return true;
        return false;
    }

    /// The low-level constraints, from the outcome so far: parts that others refer to are as it has them. False if there are
    /// none.
    bool lower(const std::vector<bool>& active, Outcome& outcome) {
        lowered_.clear();
        support_.clear();
        owner_.clear();
        anchors_.clear();
        rotating_.clear();
        referred_.clear();
        const Mesh mesh = with_points(space_.mesh, list_of(outcome.points));
        const semantic::State now(mesh);
        semantic::State edited(edited_mesh_);
        edited.asked = asked_;
        edited.is_under_way = is_under_way_;
        for (std::size_t i = 0; i < statements_.size(); ++i) {
            if (!active[i] || is_sized(i) || contradicted(i, active)) continue;
            anchors_.insert(statements_[i].anchors.begin(), statements_[i].anchors.end());
            rotating_.insert(statements_[i].rotating.begin(), statements_[i].rotating.end());
            referred_.insert(statements_[i].referred.begin(), statements_[i].referred.end());
            for (auto& constraint : statements_[i].lower(edited, now)) {
                lowered_.push_back(std::move(constraint));
                owner_.push_back(i);
            }
            if (statements_[i].prepare && outcome.passes == 0 && options_.space == DeformOptions::Space::mesh)
                statements_[i].prepare(now, outcome.points);
            if (statements_[i].support && options_.space == DeformOptions::Space::mesh)  // a cage is stiff by itself
                for (auto& constraint : statements_[i].support(edited, now)) support_.push_back(std::move(constraint));
        }
        add_sizes();
        if (lowered_.empty() && support_.empty()) return false;
        if (space_.coordinates != nullptr && space_.coordinates->has_normals())
            throw Error(ErrorKind::usage, "coordinates",
                        "are Green coordinates, which serve unconstrained deformation only: constraints are solved without their "
                        "normal term",
                        "use mean value coordinates, or a graph without constraints");
        return true;
    }

    /// Copies of the parts that must have certain sizes. Those that hold others give way to them over a third of the spread.
    void add_sizes() {
        const std::vector<Index> anchors = sizes_->anchors();
        anchors_.insert(anchors.begin(), anchors.end());
        const double stiff = options_.handles, loose = 81 * closeness(options_, space_.mesh, mean_edge_length(space_.mesh));
        for (const semantic::Sizes::Copy& copy : sizes_->copies()) {
            ConstraintParameters parameters;
            parameters.target = copy.shape;
            support_.push_back(
                make_constraint("Rigid", copy.ids, copy.holds_others ? std::min(stiff, loose) : stiff, parameters, rest_));
        }
    }

    /// Starts from the outcome. False if there is nothing to solve.
    bool solve_once(const std::vector<bool>& active, Outcome& outcome) {
        if (!lower(active, outcome)) return false;
        if (options_.space == DeformOptions::Space::mesh) solve_mesh(outcome);
        else solve_cage(outcome);
        if (!outcome.summary.usable)
            throw Error(ErrorKind::failure, where_, "the constraints have no usable solution: " + outcome.summary.text(),
                        "look for constraints that contradict each other");
        return true;
    }

    /// The low-level constraints move into the list; first_ is where they begin.
    std::vector<std::unique_ptr<Constraint>> take(std::vector<std::unique_ptr<Constraint>> others) {
        for (auto& constraint : support_) others.push_back(std::move(constraint));
        first_ = others.size();
        for (auto& constraint : lowered_) others.push_back(std::move(constraint));
        return others;
    }

    /// Vertices that the edit moves itself: its handles, or through a cage those of the parts that it names, unless these are
    /// most of the object.
    [[nodiscard]] std::vector<bool> handles_on_mesh() const {
        if (space_.cage == nullptr) return last_.touched;
        const auto named = static_cast<std::size_t>(std::count(last_.named.begin(), last_.named.end(), true));
        if (2 * named <= last_.named.size()) return last_.named;
        return std::vector<bool>(last_.named.size(), false);
    }

    void solve_mesh(Outcome& outcome) {
        std::vector<std::unique_ptr<Constraint>> list;
        std::vector<bool> constrained(space_.mesh.number_of_vertices(), false);
        for (const auto& constraint : lowered_)
            for (const int v : constraint->ids()) constrained[static_cast<std::size_t>(v)] = true;
        for (const semantic::Sizes::Copy& copy : sizes_->copies())
            for (const int v : copy.ids) constrained[static_cast<std::size_t>(v)] = true;
        const std::vector<bool> handles = handles_on_mesh();
        std::vector<int> free, held, yielding;
        for (const Vertex v : space_.mesh.vertices()) {
            if (space_.mesh.is_isolated(v)) continue;
            const bool handle = handles[v], anchor = anchors_.count(v.idx()) > 0;
            const bool stands = handle || (referred_.count(v.idx()) > 0 && rotating_.count(v.idx()) == 0);
            (anchor || (stands && !constrained[v]) ? held : handle ? yielding : free).push_back(static_cast<int>(v.idx()));
        }
        const double edge = mean_edge_length(space_.mesh);
        add_closeness(free, closeness(options_, space_.mesh, edge), edited_, 0, rest_, list);
        add_closeness(yielding, std::min(options_.handles, 81 * closeness(options_, space_.mesh, edge)), edited_, 0, rest_, list);
        add_closeness(held, options_.handles, edited_, 0, rest_, list);
        add_displacements(space_.mesh, options_.laplacian, options_.details == DeformOptions::Details::rest ? rest_ : edited_,
                          rotating_, sizes_->empty() ? nullptr : &*sizes_, list);
        const bool any_hard = std::any_of(owner_.begin(), owner_.end(), [&](std::size_t i) { return statements_[i].hard; });
        auto all = take(std::move(list));
        if (any_hard) {
            std::vector<bool> hard(all.size(), false);
            for (std::size_t i = 0; i < owner_.size(); ++i) hard[first_ + i] = statements_[owner_[i]].hard;
            HardSolver solver(std::move(all), hard, rest_);
            HardOptions options;
            options.inner = options_.solve;
            options.inner.iterations = std::min(options.inner.iterations, HardOptions().inner.iterations);
            options.rounds = options_.rounds;
            options.start = hard_scale_;
            const HardSummary summary = solver.solve(outcome.points, options);
            outcome.summary = summary.last;
            outcome.rounds += summary.rounds;
            hard_scale_ = std::sqrt(summary.scale);
        } else {
            MeshSpaceSolver solver(std::move(all), rest_);
            outcome.summary = solver.solve(outcome.points, options_.solve);
        }
    }

    /// Of cages within a cage, the handles of the levels that hold what constraints are about: the others shall stand, so that
    /// each part is brought to what is asked of it by its own cage.
    [[nodiscard]] std::vector<bool> handles_asked() const {
        const std::vector<CageLevel> levels = cage_levels(*space_.cage);
        std::vector<bool> asked(space_.cage->number_of_vertices(), levels.size() == 1);
        if (levels.size() == 1) return asked;
        const std::vector<WeightMatrix> carrying = carrying_weights(levels);
        for (const auto& constraint : lowered_) {
            const std::vector<Index> points(constraint->ids().begin(), constraint->ids().end());
            const std::size_t level = level_that_holds(space_.coordinates->vertex, points, levels, carrying);
            for (const Index v : levels[level].cage.vertices) asked[v] = true;
        }
        return asked;
    }

    /// All constraints over the cage's vertices. Its first one holds the handles that steps moved, if there are any.
    CageSystem cage_system() {
        CageSystem system;
        const WeightMatrix& weights = space_.coordinates->vertex;
        const Eigen::Index n = weights.rows(), c = weights.cols();
        system.extended = std::make_unique<CageWeights>(n + c, c);
        system.extended->topRows(n) = weights;
        system.extended->bottomRows(c).setIdentity();
        const Points rest_cage = columns_of(*space_.cage), edited_cage = columns_of(last_.handles);
        Points rest(3, n + c);
        rest << rest_, rest_cage;
        std::vector<std::unique_ptr<Constraint>> list;
        // A point of the cage stands for as many of the mesh.
        const double share = static_cast<double>(n) / static_cast<double>(c);
        const std::vector<bool> asked = handles_asked();
        std::vector<int> stiff;
        for (const bool touched : {true, false}) {
            std::vector<int> ids;
            for (Eigen::Index j = 0; j < c; ++j) {
                const auto handle = static_cast<std::size_t>(j);
                if (last_.touched[handle] == touched) (touched || asked[handle] ? ids : stiff).push_back(static_cast<int>(n + j));
            }
            const double weight = closeness(options_, space_.mesh, mean_edge_length(*space_.cage));
            add_closeness(ids, touched ? options_.handles : std::min(options_.handles, share * weight), edited_cage,
                          static_cast<int>(n), rest, list);
        }
        add_closeness(stiff, share * options_.handles, edited_cage, static_cast<int>(n), rest, list);
        // What the cage tends to between constraints; else its points fly off for little.
        Points shape = rest;
        shape.rightCols(c) = options_.details == DeformOptions::Details::rest ? rest_cage : edited_cage;
        system.first_displacement = list.size();
        if (options_.laplacian > 0)
            for (const Vertex v : space_.cage->vertices()) {
                if (space_.cage->is_isolated(v)) continue;
                list.push_back(make_constraint("LaplacianDisplacement", semantic::star_of(*space_.cage, v, static_cast<int>(n)),
                                               share * options_.laplacian, {}, shape));
            }
        system.displacements = list.size() - system.first_displacement;
        system.solver = std::make_unique<CageSpaceSolver>(take(std::move(list)), *system.extended, rest_cage);
        for (std::size_t i = 0; i < owner_.size(); ++i) {
            const Constraint& constraint = system.solver->constraint(first_ + i);
            // What must hold counts a thousandfold: a cage may not be able to do it. The level of a part counts as much as all of
            // its points, whose shape a cage can keep only so far.
            double factor = statements_[owner_[i]].hard ? 1e3 : 1;
            if (constraint.kind() == "MeansOnLevel")
                factor *= static_cast<double>(constraint.ids().size()) / static_cast<double>(constraint.map().rows);
            if (factor != 1) system.solver->set_weight(first_ + i, factor * constraint.weight());
        }
        return system;
    }

    void solve_cage(Outcome& outcome) {
        const CageSystem system = cage_system();
        outcome.cage = columns_of(last_.handles);
        outcome.summary = system.solver->solve(outcome.cage, options_.solve);
        outcome.points = points_of(*system.extended, outcome.cage).leftCols(space_.coordinates->vertex.rows());
    }

    /// Of the low-level constraints of each, divided by their points (section 4.2.3), on the finished shape: against axes as they
    /// are there, and measures as they were before the last pass.
    void keep_residuals(const std::vector<bool>& active, const Points& before, const semantic::State& finished,
                        Outcome& outcome) const {
        if (!outcome.solved) return;
        outcome.residuals.assign(statements_.size(), {});
        const Mesh mesh = with_points(space_.mesh, list_of(before));
        const semantic::State last(mesh);
        semantic::State edited(edited_mesh_);
        edited.asked = asked_;
        edited.is_under_way = is_under_way_;
        for (std::size_t i = 0; i < statements_.size(); ++i) {
            if (!active[i]) continue;
            const bool axes = statements_[i].follows && !statements_[i].until_it_holds;
            Outcome::Residuals& residuals = outcome.residuals[i];
            for (const auto& constraint : statements_[i].lower(edited, axes ? finished : last)) {
                residuals.of_low_level.push_back(constraint->normalised_residual(finished.points));
                residuals.distance = std::max(residuals.distance, constraint->greatest_distance(finished.points));
                residuals.cost += constraint->weight() * constraint->squared_distance(finished.points);
                residuals.cost_before += constraint->weight() * constraint->squared_distance(edited.points);
            }
        }
    }

    static std::string name_of(const ConstraintReport& report) {
        return "constraint " + std::to_string(report.id) + " (" + report.type + ")";
    }

    void report(DeformResult& result, const Outcome& outcome) const {
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
            if (i >= outcome.residuals.size() || outcome.residuals[i].of_low_level.empty()) continue;
            auto list = outcome.residuals[i].of_low_level;
            std::sort(list.begin(), list.end());
            report.distance = outcome.residuals[i].distance;
            if (!report.hard) report.cost = outcome.residuals[i].cost, report.cost_before = outcome.residuals[i].cost_before;
            if (report.hard && options_.space == DeformOptions::Space::cage && report.verdict != Verdict::holds)
                report.text += (report.text.empty() ? "" : "; ") + std::string("off by ") + std::to_string(report.distance) +
                               (space_.set.unit.empty() ? "" : " ") + space_.set.unit +
                               " at its worst point, with these weights in this cage";
            report.low_level = list.size();
            report.minimum = list.front();
            report.maximum = list.back();
            report.median = (list[(list.size() - 1) / 2] + list[list.size() / 2]) / 2;
            for (const double value : list) report.mean += value / static_cast<double>(list.size());
        }
    }

    /// Why the measure of this constraint cannot be, if that of another shows it.
    [[nodiscard]] std::string contradiction(const DeformResult& result, std::size_t i) const {
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

    /// Leaves out one constraint after another. Those that fail are tried first.
    void find_conflicts(DeformResult& result, const std::vector<bool>& all) {
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

    const HandleSpace& space_;
    const RelationGraph& graph_;
    const DeformOptions& options_;
    const RelationOptions& tolerances_;
    std::string where_, graph_where_;
    Points rest_;
    EditState last_;
    std::vector<bool> asked_;    ///< vertices that the edit asks to move; empty: none is told from others
    bool is_under_way_ = false;  ///< handles are being dragged
    Mesh edited_mesh_;
    Points edited_;
    std::vector<semantic::Statement> statements_;  ///< of the constraints in the report
    std::deque<Relationship> resized_levels_;      ///< that statements refer to
    std::vector<std::unique_ptr<Constraint>> lowered_;
    std::vector<std::unique_ptr<Constraint>> support_;
    std::vector<std::size_t> owner_;  ///< of each lowered constraint, in the report
    std::size_t first_ = 0;           ///< its place in the solver's list
    std::set<Index> anchors_, rotating_, referred_;
    std::optional<semantic::Sizes> sizes_;
    double hard_scale_ = 1;  ///< from which hard constraints are enforced, as passes so far tell
};

}  // namespace ostraka::semantic

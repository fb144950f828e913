#include "ostraka/semantic/deform.h"

#include "lower.h"

#include "ostraka/core/error.h"
#include "ostraka/geom/eigen.h"

#include <algorithm>
#include <set>

namespace ostraka {

namespace {

using semantic::columns_of;

Mesh with_points(const Mesh& mesh, const std::vector<Point>& points) {
    Mesh result = mesh;
    for (const Vertex v : result.vertices()) result.point(v) = points[v];
    return result;
}

Points columns_of(const std::vector<Point>& list) {
    Points points(3, static_cast<Eigen::Index>(list.size()));
    for (std::size_t i = 0; i < list.size(); ++i) points.col(static_cast<Eigen::Index>(i)) = eigen(list[i]);
    return points;
}

std::vector<Point> list_of(const Points& points) {
    std::vector<Point> list;
    for (Eigen::Index i = 0; i < points.cols(); ++i) list.push_back(point_of(points.col(i)));
    return list;
}

bool is_hard(const Relationship& relationship) {
    if (relationship.constraint.empty()) return false;
    const Json parameters = parse_json(relationship.constraint, "constraint " + std::to_string(relationship.id));
    const JsonValue* hard = find_member(parameters, "hard");
    return hard != nullptr && hard->IsBool() && hard->GetBool();
}

class Deformer {
public:
    Deformer(const HandleSpace& space, const RelationGraph& graph, const DeformOptions& options,
             const RelationOptions& tolerances, const std::string& where)
        : space_(space),
          graph_(graph),
          options_(options),
          tolerances_(tolerances),
          where_(where),
          rest_(columns_of(space.mesh)) {}

    DeformResult run(const JsonValue& edit) {
        DeformResult result;
        EditState last;
        last.handles = points_of(space_.cage != nullptr ? *space_.cage : space_.mesh);
        last.touched.assign(last.handles.size(), false);
        for (auto& state : follow_edit(edit, space_, where_)) last = std::move(state);
        result.edited = space_.cage != nullptr ? deformed(*space_.coordinates, *space_.cage, last.handles) : last.handles;
        result.points = result.edited;
        if (space_.cage != nullptr) result.cage = last.handles;
        lower_all(result);
        if (!lowered_.empty()) {
            if (space_.coordinates != nullptr && space_.coordinates->has_normals())
                throw Error(
                    ErrorKind::usage, "coordinates",
                    "are Green coordinates, which serve unconstrained deformation only: constraints are solved without their "
                    "normal term",
                    "use mean value coordinates, or a graph without constraints");
            if (options_.space == "mesh") solve_mesh(result, last);
            else solve_cage(result, last);
            result.solved = true;
        }
        report(result);
        return result;
    }

private:
    void lower_all(DeformResult& result) {
        const semantic::Shape shape{space_.mesh, space_.set, rest_};
        for (const Relationship& relationship : graph_.relationships) {
            if (!relationship.is_constraint) continue;
            ConstraintReport report;
            report.id = relationship.id;
            report.type = relationship.type;
            report.weight = relationship.weight;
            report.hard = is_hard(relationship);
            auto lowered = semantic::lower(shape, relationship, where_);
            report.used = !lowered.constraints.empty() && relationship.weight > 0;
            if (lowered.constraints.empty()) report.text = "left out: deformation does not know this type";
            else if (!report.used) report.text = "left out: its weight is zero";
            if (report.used) anchors_.insert(lowered.anchors.begin(), lowered.anchors.end());
            if (report.used)
                for (auto& constraint : lowered.constraints) {
                    lowered_.push_back(std::move(constraint));
                    owner_.push_back(result.constraints.size());
                }
            relationships_.push_back(&relationship);
            result.constraints.push_back(std::move(report));
        }
    }

    /// The low-level constraints move into the list; `first` is where they begin.
    std::vector<std::unique_ptr<Constraint>> take(std::vector<std::unique_ptr<Constraint>> others) {
        first_ = others.size();
        for (auto& constraint : lowered_) others.push_back(std::move(constraint));
        return others;
    }

    void solve_mesh(DeformResult& result, const EditState& last) {
        const Points edited = columns_of(result.edited);
        std::vector<std::unique_ptr<Constraint>> list;
        std::vector<int> used, moved;
        for (const Vertex v : space_.mesh.vertices()) {
            if (space_.mesh.is_isolated(v)) continue;
            const bool handle = (space_.cage == nullptr && last.touched[v]) || anchors_.count(v.idx()) > 0;
            (handle ? moved : used).push_back(static_cast<int>(v.idx()));
        }
        const auto closeness = [&](const std::vector<int>& ids, double weight) {
            if (ids.empty() || weight == 0) return;
            ConstraintParameters parameters;
            parameters.target.emplace(3, static_cast<Eigen::Index>(ids.size()));
            for (std::size_t i = 0; i < ids.size(); ++i)
                parameters.target->col(static_cast<Eigen::Index>(i)) = edited.col(ids[i]);
            list.push_back(make_constraint("Closeness", ids, weight, parameters, rest_));
        };
        closeness(used, options_.closeness);
        closeness(moved, options_.handles);
        if (options_.laplacian > 0)
            for (const Vertex v : space_.mesh.vertices()) {
                if (space_.mesh.is_isolated(v)) continue;
                std::vector<int> ids{static_cast<int>(v.idx())};
                for (const Vertex n : space_.mesh.vertices_around_target(space_.mesh.halfedge(v)))
                    ids.push_back(static_cast<int>(n.idx()));
                list.push_back(make_constraint("LaplacianDisplacement", ids, options_.laplacian, {},
                                               options_.details == "rest" ? rest_ : edited));
            }
        const bool any_hard = std::any_of(result.constraints.begin(), result.constraints.end(),
                                          [](const ConstraintReport& r) { return r.used && r.hard; });
        auto all = take(std::move(list));
        Points points = edited;
        if (any_hard) {
            std::vector<bool> hard(all.size(), false);
            for (std::size_t i = 0; i < owner_.size(); ++i) hard[first_ + i] = result.constraints[owner_[i]].hard;
            HardSolver solver(std::move(all), hard, rest_);
            HardOptions options;
            options.inner = options_.solve;
            options.rounds = options_.rounds;
            const HardSummary summary = solver.solve(points, options);
            result.summary = summary.last;
            result.rounds = summary.rounds;
            residuals(result, points, [&](std::size_t i) -> const Constraint& { return solver.constraint(i); });
        } else {
            MeshSpaceSolver solver(std::move(all), rest_);
            result.summary = solver.solve(points, options_.solve);
            residuals(result, points, [&](std::size_t i) -> const Constraint& { return solver.constraint(i); });
        }
        if (!result.summary.usable)
            throw Error(ErrorKind::failure, where_, "the constraints have no usable solution: " + result.summary.text(),
                        "look for constraints that contradict each other");
        result.points = list_of(points);
    }

    void solve_cage(DeformResult& result, const EditState& last) {
        // Rows for the cage's own points below those of the mesh, so that handles are constrained like any point.
        const WeightMatrix& weights = space_.coordinates->vertex;
        const Eigen::Index n = weights.rows(), c = weights.cols();
        CageWeights extended(n + c, c);
        extended.topRows(n) = weights;
        extended.bottomRows(c).setIdentity();
        const Points rest_cage = columns_of(*space_.cage), edited_cage = columns_of(last.handles);
        Points rest(3, n + c);
        rest << rest_, rest_cage;
        std::vector<std::unique_ptr<Constraint>> list;
        for (const bool touched : {true, false}) {
            std::vector<int> ids;
            for (Eigen::Index j = 0; j < c; ++j)
                if (last.touched[static_cast<std::size_t>(j)] == touched) ids.push_back(static_cast<int>(n + j));
            const double weight = touched ? options_.handles : options_.closeness;
            if (ids.empty() || weight == 0) continue;
            ConstraintParameters parameters;
            parameters.target.emplace(3, static_cast<Eigen::Index>(ids.size()));
            for (std::size_t i = 0; i < ids.size(); ++i)
                parameters.target->col(static_cast<Eigen::Index>(i)) = edited_cage.col(ids[i] - n);
            list.push_back(make_constraint("Closeness", ids, weight, parameters, rest));
        }
        CageSpaceSolver solver(take(std::move(list)), extended, rest_cage);
        // What must hold counts a thousandfold: a cage may not be able to do it.
        for (std::size_t i = 0; i < owner_.size(); ++i)
            if (result.constraints[owner_[i]].hard) solver.set_weight(first_ + i, 1e3 * solver.constraint(first_ + i).weight());
        Points cage = edited_cage;
        result.summary = solver.solve(cage, options_.solve);
        if (!result.summary.usable)
            throw Error(ErrorKind::failure, where_, "the constraints have no usable solution: " + result.summary.text(),
                        "look for constraints that contradict each other");
        const Points all = points_of(extended, cage);
        residuals(result, all, [&](std::size_t i) -> const Constraint& { return solver.constraint(i); });
        result.points = list_of(all.leftCols(n));
        result.cage = list_of(cage);
    }

    /// Of the low-level constraints of each, divided by their points (section 4.2.3).
    template <class Get>
    void residuals(DeformResult& result, const Points& points, Get&& get) const {
        std::vector<std::vector<double>> values(result.constraints.size());
        for (std::size_t i = 0; i < owner_.size(); ++i) values[owner_[i]].push_back(get(first_ + i).normalised_residual(points));
        for (std::size_t i = 0; i < values.size(); ++i) {
            auto& list = values[i];
            if (list.empty()) continue;
            std::sort(list.begin(), list.end());
            ConstraintReport& report = result.constraints[i];
            report.low_level = list.size();
            report.least = list.front();
            report.most = list.back();
            report.median = (list[(list.size() - 1) / 2] + list[list.size() / 2]) / 2;
            for (const double value : list) report.mean += value / static_cast<double>(list.size());
        }
    }

    void report(DeformResult& result) const {
        const semantic::Shape shape{space_.mesh, space_.set, rest_};
        if (result.constraints.empty()) return;
        const Mesh before = with_points(space_.mesh, result.edited), after = with_points(space_.mesh, result.points);
        for (std::size_t i = 0; i < result.constraints.size(); ++i) {
            ConstraintReport& report = result.constraints[i];
            if (!report.used) {
                result.acceptable = result.acceptable && report.weight == 0;
                continue;
            }
            auto states = semantic::measure(shape, {&before, &after}, *relationships_[i], tolerances_, where_);
            semantic::Measured &then = states[0], &now = states[1];
            report.before = then.verdict;
            report.verdict = now.verdict;
            for (const Deviation& deviation : then.deviations) report.before_values.push_back(deviation.value.value_or(0));
            report.deviations = std::move(now.deviations);
            report.text = now.text;
            result.acceptable = result.acceptable && now.verdict == Verdict::holds;
        }
    }

    const HandleSpace& space_;
    const RelationGraph& graph_;
    const DeformOptions& options_;
    const RelationOptions& tolerances_;
    std::string where_;
    Points rest_;
    std::vector<std::unique_ptr<Constraint>> lowered_;
    std::vector<std::size_t> owner_;  ///< of each lowered constraint, in the report
    std::size_t first_ = 0;           ///< its place in the solver's list
    std::vector<const Relationship*> relationships_;
    std::set<Index> anchors_;
};

}  // namespace

DeformResult deform(const HandleSpace& space, const RelationGraph& graph, const JsonValue& edit, const std::string& edit_name,
                    const DeformOptions& options, const RelationOptions& tolerances) {
    check_options(options, "deform");
    check_options(tolerances, "deform");
    if (options.space == "cage" && space.cage == nullptr)
        throw Error(ErrorKind::usage, "space", "is the cage's, and there is none",
                    "give --cage and --weights, or use --space mesh");
    return Deformer(space, graph, options, tolerances, edit_name).run(edit);
}

}  // namespace ostraka

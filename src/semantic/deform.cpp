#include "ostraka/semantic/deform.h"

#include "semantic/deformer.h"
#include "semantic/seating.h"

#include "ostraka/geom/eigen.h"

#include <functional>
#include <optional>

namespace ostraka {

using semantic::Deformer;
using semantic::list_of;

namespace {

using Space = DeformOptions::Space;

/// One way to solve for the constraints.
struct Way {
    const RelationGraph* graph;
    Space space;
    std::vector<int> seated;
};

/// Whether one result is nearer to acceptable than the other.
bool is_better(const DeformResult& one, const DeformResult& other) {
    const auto failing = [](const DeformResult& result) {
        return std::count_if(result.constraints.begin(), result.constraints.end(),
                             [](const ConstraintReport& report) { return report.used && report.verdict != Verdict::holds; });
    };
    return std::pair(failing(one), one.objections.size()) < std::pair(failing(other), other.objections.size());
}

/// Whether all constraints hold, but the surface crosses or folds: there may have been too little room around them.
bool spoils_surface_alone(const DeformResult& result) {
    const SurfaceChange& surface = result.surface;
    return result.solved && surface.crossings_new + surface.folds + surface.kinks > 0 &&
           std::none_of(result.constraints.begin(), result.constraints.end(),
                        [](const ConstraintReport& report) { return report.used && report.verdict != Verdict::holds; });
}

/// The first of the ways that gives an acceptable result, or the best of them.
DeformResult deform_automatically(const HandleSpace& space, const RelationGraph& graph, const DeformOptions& options,
                                  const std::function<DeformResult(const RelationGraph&, const DeformOptions&)>& solve) {
    const semantic::Seating seating = semantic::seat_ornaments(space, graph);
    std::vector<Way> ways;
    if (!seating.seated.empty()) ways.push_back({&seating.graph, Space::mesh, seating.seated});
    ways.push_back({&graph, Space::mesh, {}});
    if (space.cage != nullptr && !space.coordinates->has_normals()) ways.push_back({&graph, Space::cage, {}});
    const auto try_way = [&](const Way& way, int conflicts) {
        DeformOptions how = options;
        how.space = way.space;
        how.conflicts = conflicts;
        DeformResult result = solve(*way.graph, how);
        result.seated = way.seated;
        return result;
    };
    std::optional<DeformResult> best;
    const Way* best_way = nullptr;
    for (const Way& way : ways) {
        DeformResult result = try_way(way, 0);
        if (!best || is_better(result, *best)) best = std::move(result), best_way = &way;
        if (best->acceptable || !best->solved) return std::move(*best);
    }
    return options.conflicts > 0 ? try_way(*best_way, options.conflicts) : std::move(*best);
}

}  // namespace

std::vector<Point> shape_of_edit(const HandleSpace& space, const EditState& state, const DeformOptions& options) {
    if (space.cage != nullptr) return deformed(*space.coordinates, *space.cage, state.handles);
    std::vector<int> moved, others;
    for (const Vertex v : space.mesh.vertices())
        if (!space.mesh.is_isolated(v)) (state.touched[v] ? moved : others).push_back(static_cast<int>(v.idx()));
    if (moved.empty() || others.empty()) return state.handles;
    const Points rest = columns_of(space.mesh);
    Points targets = rest, points = rest;
    for (const int v : moved) targets.col(v) = eigen(state.handles[static_cast<std::size_t>(v)]);
    std::vector<std::unique_ptr<Constraint>> list;
    const double laplacian = std::max(options.laplacian, semantic::min_laplacian);
    semantic::add_closeness(moved, 1e5 * laplacian, targets, 0, rest, list);
    semantic::add_closeness(others, semantic::closeness(options, space.mesh, mean_edge_length(space.mesh)), targets, 0, rest,
                            list);
    semantic::add_displacements(space.mesh, laplacian, rest, {}, nullptr, list);
    MeshSpaceSolver solver(std::move(list), rest);
    solver.solve(points, {2, 0, 0, 0});
    std::vector<Point> shape = list_of(points);
    for (const int v : moved) shape[static_cast<std::size_t>(v)] = state.handles[static_cast<std::size_t>(v)];
    return shape;
}

DeformResult deform(const HandleSpace& space, const RelationGraph& graph, const Edit& edit, const std::string& edit_name,
                    const DeformOptions& options, const RelationOptions& tolerances, const std::string& graph_name) {
    check_options(options, "deform");
    check_options(tolerances, "deform");
    if (options.space == DeformOptions::Space::cage && space.cage == nullptr)
        throw Error(ErrorKind::usage, "space", "is the cage's, and there is none",
                    "give --cage and --weights, or use --space mesh");
    const auto solve = [&](const RelationGraph& constraints, const DeformOptions& how) {
        DeformResult result = Deformer(space, constraints, how, tolerances, edit_name, graph_name).follow(edit);
        if (how.space == Space::mesh && spoils_surface_alone(result)) {
            Deformer giving(space, constraints, how, tolerances, edit_name, graph_name);
            giving.fade_over_whole_spread();
            if (DeformResult other = giving.follow(edit); is_better(other, result)) result = std::move(other);
        }
        result.space = how.space;
        return result;
    };
    return options.space == Space::automatic ? deform_automatically(space, graph, options, solve) : solve(graph, options);
}

DeformResult restore_constraints(AnnotatedMeshView object, const RelationGraph& graph, const std::vector<Point>& points,
                                 const std::vector<bool>& held, const DeformOptions& options, const RelationOptions& tolerances,
                                 const std::string& graph_name) {
    check_options(options, "deform");
    check_options(tolerances, "deform");
    if (options.space != DeformOptions::Space::mesh)
        fail_usage("there is no cage here", "solve over the mesh's points: space mesh");
    if (points.size() != object.mesh.number_of_vertices() || held.size() != points.size())
        fail_usage("positions are given for " + std::to_string(points.size()) + " vertices and flags for " +
                       std::to_string(held.size()) + ", and the mesh has " + std::to_string(object.mesh.number_of_vertices()),
                   "give one of each for every vertex");
    const HandleSpace space{object};
    return Deformer(space, graph, options, tolerances, "the fitted shape", graph_name).restore(points, held);
}

void check_constraint(AnnotatedMeshView object, const Relationship& relationship, const std::string& where) {
    const Points rest = columns_of(object.mesh);
    const Mesh same = object.mesh;
    const semantic::State state(same);
    const auto statement = semantic::understand({object, rest}, relationship, {}, where);
    if (statement.unknown.empty()) static_cast<void>(statement.lower(state, state));
}

void DeformOptions::declare_options(OptionList& list) {
    list("space", space,
         "unknowns of the solve: mesh vertices (mesh), cage vertices (cage: fast, but constraints hold only as far as the cage "
         "permits), or auto (ornaments move rigidly, the rest is solved over the mesh; if that result is not acceptable, the "
         "best of these)",
         Choices{"mesh", "cage", "auto"});
    list("details", details,
         "shape whose Laplacian displacements the surface approaches: the edited shape (edited) or the shape before the edit "
         "(rest, as in the thesis)",
         Choices{"edited", "rest"});
    list("spread", spread, "distance over which the displacement caused by a constraint decreases to zero", Range{1e-4, 1e4},
         "share of the diagonal");
    list("laplacian", laplacian, "weight of the Laplacian displacement of each vertex", Range{0, 1e9});
    list("handles", handles,
         "weight of the positions of handles that the edit moves, and of joints of stretched parts; lower for handles that a "
         "constraint moves as well",
         Range{0, 1e9});
    list("followed", followed, "a result is acceptable only if it follows at least this share of the edit's displacement",
         Range{0, 1});
    list("distortion", distortion,
         "acceptable results: maximum root mean square distortion of a part that neither the edit nor a violated constraint "
         "changes",
         Range{0, 1}, "share of the diagonal");
    solve.declare_options(list);
    list("rounds", rounds, "maximum number of rounds in which hard constraints are enforced", Range{1, 1e6});
    list("passes", passes,
         "maximum number of passes that update constraints on axes and measures of other parts; up to four times as many passes "
         "while violated hard constraints improve",
         Range{1, 100});
    list("conflicts", conflicts, "maximum number of constraints omitted, one at a time, to find conflicts; 0: no search",
         Range{0, 1000});
}

}  // namespace ostraka

#include "ostraka/semantic/live.h"

#include "semantic/deformer.h"

#include <cmath>
#include <set>

namespace ostraka {

using semantic::CageSystem;
using semantic::Deformer;
using semantic::list_of;

struct LiveDeformation::State {
    State(const HandleSpace& given, const RelationGraph& relations, const DeformOptions& how, const RelationOptions& exactness)
        : space(given), options(how), tolerances(exactness), deformer(space, graph, options, tolerances, "the drag", "graph") {
        graph.relationships = relations.relationships;
    }
    HandleSpace space;
    RelationGraph graph;
    DeformOptions options;
    RelationOptions tolerances;
    Deformer deformer;
    std::vector<Index> handles;
    std::vector<int> held;  ///< cage vertices moved by steps, in the order of the constraint that fixes them
    std::vector<Point> cage;
    Points points;                    ///< same positions as `cage`
    Points asked;                     ///< of the mesh (arbitrary) and the cage, after moving only the handles
    Points displacement;              ///< target for one vertex
    std::vector<std::size_t> beside;  ///< indices of Laplacian displacement constraints that involve the handles
    CageSystem system;
};

LiveDeformation::LiveDeformation(const HandleSpace& space, const RelationGraph& graph, const Edit& edit,
                                 std::vector<Index> handles, const DeformOptions& options, const RelationOptions& tolerances) {
    if (space.cage == nullptr || space.coordinates == nullptr)
        throw Error(ErrorKind::usage, "the drag", "has no cage", "give a cage and its coordinates");
    for (const Index handle : handles)
        if (handle >= space.cage->number_of_vertices())
            throw Error(ErrorKind::usage, "the drag", "handle " + std::to_string(handle) + " is no vertex of the cage",
                        "the cage has " + std::to_string(space.cage->number_of_vertices()));
    DeformOptions live = options;
    live.space = DeformOptions::Space::cage;
    state_ = std::make_unique<State>(space, graph, live, tolerances);
    state_->handles = std::move(handles);
    state_->system = state_->deformer.begin(edit, state_->handles, state_->cage);
    state_->points = columns_of(with_points(*space.cage, state_->cage));
    if (state_->system.solver) {
        state_->asked.setZero(3, space.coordinates->vertex.rows() + state_->points.cols());
        state_->asked.rightCols(state_->points.cols()) = state_->points;
        const auto offset = static_cast<int>(space.coordinates->vertex.rows());
        for (const int id : state_->system.solver->constraint(0).ids()) state_->held.push_back(id - offset);
        const std::set<Index> dragged(state_->handles.begin(), state_->handles.end());
        for (std::size_t k = 0; k < state_->system.displacements; ++k) {
            const auto& ids = state_->system.solver->constraint(state_->system.first_displacement + k).ids();
            if (std::any_of(ids.begin(), ids.end(), [&](int id) { return dragged.contains(static_cast<Index>(id - offset)); }))
                state_->beside.push_back(state_->system.first_displacement + k);
        }
        state_->system.solver->initialize();
    }
}

LiveDeformation::~LiveDeformation() = default;

const std::vector<Point>& LiveDeformation::cage() const { return state_->cage; }
bool LiveDeformation::has_constraints() const { return state_->system.solver != nullptr; }

const std::vector<Point>& LiveDeformation::follow(const std::vector<Point>& places) {
    State& state = *state_;
    if (places.size() != state.handles.size())
        throw Error(ErrorKind::usage, "the drag",
                    "has " + counted(places.size(), "place") + " for " + counted(state.handles.size(), "handle"),
                    "give one for each");
    for (std::size_t i = 0; i < places.size(); ++i) {
        const Point& p = places[i];
        if (!std::isfinite(p.x()) || !std::isfinite(p.y()) || !std::isfinite(p.z()))
            throw Error(ErrorKind::usage, "the drag", "place " + std::to_string(i) + " is not finite", "give finite numbers");
    }
    for (std::size_t i = 0; i < places.size(); ++i) {
        state.cage[state.handles[i]] = places[i];
        state.points.col(state.handles[i]) = eigen(places[i]);
    }
    if (!state.system.solver) return state.cage;
    Points targets(3, static_cast<Eigen::Index>(state.held.size()));
    for (std::size_t i = 0; i < state.held.size(); ++i)
        targets.col(static_cast<Eigen::Index>(i)) = state.points.col(state.held[i]);
    state.system.solver->set_target(0, targets);
    if (state.options.details == DeformOptions::Details::edited) {
        const Eigen::Index offset = state.asked.cols() - state.points.cols();
        for (std::size_t i = 0; i < places.size(); ++i) state.asked.col(offset + state.handles[i]) = eigen(places[i]);
        for (const std::size_t place : state.beside) {
            state.system.solver->constraint(place).rows_of(state.asked, state.displacement);
            state.system.solver->set_target(place, state.displacement);
        }
    }
    constexpr SolveOptions few{4, 1e-5, 0, 2};
    state.system.solver->solve(state.points, few);
    state.cage = list_of(state.points);
    return state.cage;
}

}  // namespace ostraka

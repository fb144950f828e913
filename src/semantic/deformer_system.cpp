// The linear system of one pass: constraints, closeness of positions, and Laplacian displacements; over the mesh or the cage.
#include "semantic/deformer.h"

#include "ostraka/coords/nested.h"
#include "ostraka/core/error.h"
#include "ostraka/solver/hard.h"
#include "ostraka/solver/make_constraint.h"

#include <algorithm>

namespace ostraka::semantic {

void add_closeness(const std::vector<int>& ids, double weight, const Points& targets, int offset, const Points& rest,
                   std::vector<std::unique_ptr<Constraint>>& list) {
    if (ids.empty() || weight == 0) return;
    Points places(3, static_cast<Eigen::Index>(ids.size()));
    for (std::size_t i = 0; i < ids.size(); ++i) places.col(static_cast<Eigen::Index>(i)) = targets.col(ids[i] - offset);
    list.push_back(make_constraint(kinds::Closeness{std::move(places)}, ids, weight, rest));
}

void add_displacements(const Mesh& mesh, double weight, const Points& shape, const std::set<Index>& others, const Sizes* sizes,
                       std::vector<std::unique_ptr<Constraint>>& list) {
    if (weight == 0) return;
    for (const Vertex v : mesh.vertices()) {
        if (mesh.is_isolated(v) || others.count(v.idx()) > 0) continue;
        std::vector<int> star = semantic::vertex_star(mesh, v);
        kinds::LaplacianDisplacement kept;
        if (sizes != nullptr) {
            Eigen::Vector3d mean = Eigen::Vector3d::Zero();
            for (std::size_t i = 1; i < star.size(); ++i) mean += shape.col(star[i]) - shape.col(star[0]);
            kept.displacement = sizes->around(v.idx()) * mean / static_cast<double>(star.size() - 1);
        }
        list.push_back(make_constraint(kept, std::move(star), weight, shape));
    }
}

bool Deformer::is_sized(std::size_t i) const {
    return statements_[i].hard && !statements_[i].sized.empty() && options_.space == DeformOptions::Space::mesh;
}

void Deformer::begin_sizes(const std::vector<bool>& active) {
    std::vector<const semantic::Sized*> parts;
    for (std::size_t i = 0; i < statements_.size(); ++i)
        if (active[i] && is_sized(i))
            for (const semantic::Sized& part : statements_[i].sized) parts.push_back(&part);
    semantic::State edited(edited_mesh_);
    edited.asked = asked_;
    sizes_.emplace(std::move(parts), semantic::Shape{space_, rest_}, edited);
}

bool Deformer::lower(const std::vector<bool>& active, Outcome& outcome) {
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
    edited.is_dragging = is_under_way_;
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
        if (statements_[i].support && options_.space == DeformOptions::Space::mesh)  // a cage is stiff without it
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

void Deformer::add_sizes() {
    const std::vector<Index> anchors = sizes_->anchors();
    anchors_.insert(anchors.begin(), anchors.end());
    const double stiff = options_.handles, loose = 81 * closeness(options_, space_.mesh, mean_edge_length(space_.mesh));
    for (const semantic::Sizes::Copy& copy : sizes_->copies()) {
        support_.push_back(
            make_constraint(kinds::Rigid{copy.shape}, copy.ids, copy.contains_parts ? std::min(stiff, loose) : stiff, rest_));
    }
}

bool Deformer::solve_once(const std::vector<bool>& active, Outcome& outcome) {
    if (!lower(active, outcome)) return false;
    if (options_.space == DeformOptions::Space::mesh) solve_mesh(outcome);
    else solve_cage(outcome);
    if (!outcome.summary.usable)
        throw Error(ErrorKind::failure, where_, "the constraints have no usable solution: " + outcome.summary.text(),
                    "look for constraints that contradict each other");
    return true;
}

std::vector<std::unique_ptr<Constraint>> Deformer::take(std::vector<std::unique_ptr<Constraint>> others) {
    for (auto& constraint : support_) others.push_back(std::move(constraint));
    first_ = others.size();
    for (auto& constraint : lowered_) others.push_back(std::move(constraint));
    return others;
}

std::vector<bool> Deformer::handles_on_mesh() const {
    if (space_.cage == nullptr) return last_.touched;
    const auto named = static_cast<std::size_t>(std::count(last_.is_referenced.begin(), last_.is_referenced.end(), true));
    if (2 * named <= last_.is_referenced.size()) return last_.is_referenced;
    return std::vector<bool>(last_.is_referenced.size(), false);
}

void Deformer::solve_mesh(Outcome& outcome) {
    std::vector<std::unique_ptr<Constraint>> list;
    std::vector<bool> constrained(space_.mesh.number_of_vertices(), false);
    for (const auto& constraint : lowered_)
        for (const int v : constraint->ids()) constrained[static_cast<std::size_t>(v)] = true;
    for (const semantic::Sizes::Copy& copy : sizes_->copies())
        for (const int v : copy.ids) constrained[static_cast<std::size_t>(v)] = true;
    std::vector<bool> members(constrained.size(), false);
    for (const Relationship& relationship : graph_.relationships)
        if (relationship.is_constraint)
            for (const int id : relationship.annotations)
                for (const Index v : vertices_of(space_.mesh, *space_.annotations.find(id))) members[v] = true;
    const std::vector<bool> handles = handles_on_mesh();
    std::vector<int> free, beside, held, yielding;
    for (const Vertex v : space_.mesh.vertices()) {
        if (space_.mesh.is_isolated(v)) continue;
        const bool handle = handles[v], anchor = anchors_.count(v.idx()) > 0;
        const bool stands = handle || (referred_.count(v.idx()) > 0 && rotating_.count(v.idx()) == 0);
        const bool asked = constrained[v] || members[v] || asked_.empty() || asked_[v];
        (anchor || (stands && !constrained[v]) ? held
         : handle                              ? yielding
         : asked                               ? free
                                               : beside)
            .push_back(static_cast<int>(v.idx()));
    }
    const double edge = mean_edge_length(space_.mesh);
    add_closeness(free, closeness(options_, space_.mesh, edge), edited_, 0, rest_, list);
    DeformOptions near = options_;
    if (!fades_over_whole_spread_) near.spread /= 3;
    add_closeness(beside, closeness(near, space_.mesh, edge), edited_, 0, rest_, list);
    // The stiffness of moved parts relative to the surroundings of other parts does not depend on the weight of the latter.
    const double firmness = closeness(beside.empty() ? options_ : near, space_.mesh, edge);
    add_closeness(yielding, std::min(options_.handles, 81 * firmness), edited_, 0, rest_, list);
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

std::vector<bool> Deformer::movable_handles() const {
    const std::vector<CageLevel> levels = cage_levels(*space_.cage);
    std::vector<bool> asked(space_.cage->number_of_vertices(), levels.size() == 1);
    if (levels.size() == 1) return asked;
    const std::vector<WeightMatrix> carrying = carrying_weights(levels);
    for (const auto& constraint : lowered_) {
        const std::vector<Index> points(constraint->ids().begin(), constraint->ids().end());
        const std::size_t level = governing_level(space_.coordinates->vertex, points, levels, carrying);
        for (const Index v : levels[level].cage.vertices) asked[v] = true;
    }
    return asked;
}

CageSystem Deformer::cage_system() {
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
    // A point of the cage represents several points of the mesh.
    const double share = static_cast<double>(n) / static_cast<double>(c);
    const std::vector<bool> asked = movable_handles();
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
    // Regularisation of the cage between constraints; otherwise its points would move far for small gains.
    Points shape = rest;
    shape.rightCols(c) = options_.details == DeformOptions::Details::rest ? rest_cage : edited_cage;
    system.first_displacement = list.size();
    if (options_.laplacian > 0)
        for (const Vertex v : space_.cage->vertices()) {
            if (space_.cage->is_isolated(v)) continue;
            list.push_back(make_constraint(kinds::LaplacianDisplacement{},
                                           semantic::vertex_star(*space_.cage, v, static_cast<int>(n)),
                                           share * options_.laplacian, shape));
        }
    system.displacements = list.size() - system.first_displacement;
    system.solver = std::make_unique<CageSpaceSolver>(take(std::move(list)), *system.extended, rest_cage);
    for (std::size_t i = 0; i < owner_.size(); ++i) {
        const Constraint& constraint = system.solver->constraint(first_ + i);
        // Hard constraints have a thousandfold weight, since a cage may not be able to meet them. The level of a part weighs as
        // much as all of its points, since a cage preserves their shape only to a limited extent.
        double factor = statements_[owner_[i]].hard ? 1e3 : 1;
        if (constraint.kind() == kinds::MeansOnLevel::kind.name)
            factor *= static_cast<double>(constraint.ids().size()) / static_cast<double>(constraint.map().rows);
        if (factor != 1) system.solver->set_weight(first_ + i, factor * constraint.weight());
    }
    return system;
}

void Deformer::solve_cage(Outcome& outcome) {
    const CageSystem system = cage_system();
    outcome.cage = columns_of(last_.handles);
    outcome.summary = system.solver->solve(outcome.cage, options_.solve);
    outcome.points = points_of(*system.extended, outcome.cage).leftCols(space_.coordinates->vertex.rows());
}

}  // namespace ostraka::semantic

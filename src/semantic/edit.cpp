#include "ostraka/semantic/edit.h"

#include "ostraka/coords/influence.h"
#include "ostraka/coords/nested.h"
#include "ostraka/core/angles.h"
#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"
#include "ostraka/geom/eigen.h"

#include <fmt/core.h>

#include <algorithm>
#include <numeric>
#include <set>

namespace ostraka {

namespace {

class Follower {
public:
    Follower(const HandleSpace& space, const std::string& where) : space_(space), where_(where) {
        state_.handles = ostraka::points_of(space.cage != nullptr ? *space.cage : space.mesh);
        state_.touched.assign(state_.handles.size(), false);
        state_.is_referenced.assign(space.mesh.number_of_vertices(), false);
        if (space.cage == nullptr) return;
        levels_ = cage_levels(*space.cage);
        carrying_ = carrying_weights(levels_);
    }

    EditState follow(const EditStep& step, const std::string& at) {
        at_ = at;
        state_.threshold = 0;
        state_.selected = select(step);
        const std::vector<Point> before = state_.handles;
        std::visit([&](const auto& operation) { apply(operation); }, step.operation);
        for (const Index v : state_.selected) state_.touched[v] = true;
        carry(before);
        return state_;
    }

private:
    [[noreturn]] void fail(const std::string& what, const std::string& remedy) const {
        fail_input(where_ + ", " + at_, what, remedy);
    }

    /// Moves nested cages with the cages around them, except the vertices that the step moved itself.
    void carry(const std::vector<Point>& before) {
        if (levels_.size() < 2) return;
        std::vector<bool> own(state_.handles.size(), false);
        for (const Index v : state_.selected) own[v] = true;
        for (std::size_t l = 1; l < levels_.size(); ++l) {
            const std::vector<Index>&vertices = levels_[l].cage.vertices, &around = levels_[levels_[l].parent].cage.vertices;
            for (std::size_t i = 0; i < vertices.size(); ++i) {
                if (own[vertices[i]]) continue;
                Vector3d by = Vector3d::Zero();
                for (std::size_t j = 0; j < around.size(); ++j)
                    by += carrying_[l](static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) *
                          (eigen(state_.handles[around[j]]) - eigen(before[around[j]]));
                state_.handles[vertices[i]] = point_of(eigen(before[vertices[i]]) + by);
            }
        }
    }

    /// The level specified by a step, otherwise the innermost level that contains most of these vertices.
    [[nodiscard]] std::size_t level_for(const EditStep& step, const std::vector<Index>& vertices) const {
        if (!step.level) return governing_level(space_.coordinates->vertex, vertices, levels_, carrying_);
        if (*step.level >= levels_.size())
            fail(fmt::format("there is no level {}: the cage has {}", *step.level, counted(levels_.size(), "level")),
                 "levels count from 0, the outermost; leave it out where no cage is within another");
        return *step.level;
    }

    /// Weights of a level's vertices on these mesh vertices (all if none are given), one row each.
    [[nodiscard]] Coordinates weights_in(std::size_t level, const std::vector<Index>& vertices) const {
        const WeightMatrix& all = space_.coordinates->vertex;
        if (vertices.empty()) return {"", weights_of_level(all, levels_, carrying_, level), {}};
        WeightMatrix rows(static_cast<Eigen::Index>(vertices.size()), all.cols());
        for (std::size_t i = 0; i < vertices.size(); ++i) rows.row(static_cast<Eigen::Index>(i)) = all.row(vertices[i]);
        return {"", weights_of_level(rows, levels_, carrying_, level), {}};
    }

    [[nodiscard]] std::vector<Index> select(const EditStep& step) {
        if (step.level && space_.cage == nullptr)
            fail("has a level without a cage", "leave it out, or give --cage and --weights");
        std::set<Index> chosen;
        std::visit([&](const auto& selection) { choose(selection, step, chosen); }, step.select);
        if (chosen.empty()) fail("selects nothing", "choose another box");
        return {chosen.begin(), chosen.end()};
    }

    void choose(const EditStep::Annotations& selection, const EditStep& step, std::set<Index>& chosen) {
        for (const EditStep::AnnotationName& name : selection.names) {
            const Annotation& annotation = named(name);
            choose_at(vertices_of(space_.mesh, annotation), fmt::format("annotation {}", annotation.id), step, chosen);
        }
    }
    void choose(const EditStep::MeshVertices& selection, const EditStep& step, std::set<Index>& chosen) {
        check_indices(selection.indices, space_.mesh.number_of_vertices(), "mesh");
        choose_at(selection.indices, "these vertices", step, chosen);
    }
    void choose(const EditStep::CageVertices& selection, const EditStep& step, std::set<Index>& chosen) {
        if (step.level) fail("names cageVertices and a level", "leave the level out: each vertex is of one");
        if (space_.cage == nullptr) fail("cageVertices without a cage", "give --cage and --weights, or select otherwise");
        check_indices(selection.indices, space_.cage->number_of_vertices(), "cage");
        chosen.insert(selection.indices.begin(), selection.indices.end());
        state_.by_handles = true;
    }
    void choose(const EditStep::Box& box, const EditStep& step, std::set<Index>& chosen) {
        for (const Index v : handles_in(step)) {
            const Vector3d p = eigen(state_.handles[v]);
            if ((p.array() >= box.min.array()).all() && (p.array() <= box.max.array()).all()) chosen.insert(v);
        }
        state_.by_handles = state_.by_handles || space_.cage != nullptr;
    }
    void choose(const EditStep::All&, const EditStep& step, std::set<Index>& chosen) {
        for (const Index v : handles_in(step)) chosen.insert(v);
        state_.by_handles = state_.by_handles || space_.cage != nullptr;
    }

    /// Chooses these vertices of the mesh, through a cage the handles that influence them.
    void choose_at(const std::vector<Index>& vertices, const std::string& name, const EditStep& step, std::set<Index>& chosen) {
        for (const Index v : vertices) state_.is_referenced[v] = true;
        if (space_.cage == nullptr) {
            chosen.insert(vertices.begin(), vertices.end());
            return;
        }
        const std::size_t level = level_for(step, vertices);
        const Coordinates weights = weights_in(level, vertices);
        std::vector<Index> rows(vertices.size());
        std::iota(rows.begin(), rows.end(), Index{0});
        for (const Index j : influencing(weights, rows, name, step, level)) chosen.insert(levels_[level].cage.vertices[j]);
    }

    /// The vertices of a level that influence the rows by the step's threshold.
    std::vector<Index> influencing(const Coordinates& weights, const std::vector<Index>& rows, const std::string& name,
                                   const EditStep& step, std::size_t level) {
        const auto* rule = step.threshold ? std::get_if<EditStep::Rule>(&*step.threshold) : nullptr;
        if (rule != nullptr && *rule == EditStep::Rule::per_point) return strongest(weights, rows);
        // As in the thesis, figure 5.11, or lower if on a dense cage a vertex of the part would have no handle.
        if (!step.threshold) state_.threshold = std::min(0.4, influence_threshold(weights.vertex, "auto-mesh"));
        else if (rule == nullptr) state_.threshold = std::get<double>(*step.threshold);
        else
            state_.threshold = influence_threshold(step.rule_within_selection ? weights.vertex : weights_in(level, {}).vertex,
                                                   *rule == EditStep::Rule::cover_mesh ? "auto-mesh" : "auto-cage");
        std::vector<Index> list = influential(weights, rows, state_.threshold);
        if (list.empty())
            fail(fmt::format("no cage vertex has an influence of {} on {}; the largest is {}", std::to_string(state_.threshold),
                             name, std::to_string(weights.vertex.maxCoeff())),
                 "lower the threshold, use auto-mesh, or name cageVertices");
        return list;
    }

    /// All handles, or those of the specified level.
    [[nodiscard]] std::vector<Index> handles_in(const EditStep& step) const {
        if (step.level) return levels_[level_for(step, {})].cage.vertices;
        std::vector<Index> all(state_.handles.size());
        std::iota(all.begin(), all.end(), Index{0});
        return all;
    }

    void check_indices(const std::vector<Index>& list, std::size_t count, const char* name) const {
        for (const Index index : list)
            if (index >= count)
                fail(fmt::format("vertex {} is not one of the {} of the {}", index, count, name),
                     "give an index of the mesh, from 0");
    }

    [[nodiscard]] const Annotation& named(const EditStep::AnnotationName& name) const {
        const int* id = std::get_if<int>(&name);
        const std::string* tag = std::get_if<std::string>(&name);
        const Annotation* match = nullptr;
        for (const Annotation& annotation : space_.annotations.annotations) {
            if (id != nullptr ? annotation.id != *id : annotation.tag != *tag) continue;
            if (match != nullptr) fail(fmt::format("several annotations are tagged '{}'", annotation.tag), "use the id");
            match = &annotation;
        }
        if (match == nullptr)
            fail(id != nullptr ? fmt::format("there is no annotation {}", *id)
                               : fmt::format("there is no annotation tagged '{}'", *tag),
                 "see 'annotation list'");
        return *match;
    }

    [[nodiscard]] Vector3d middle() const {
        Vector3d sum = Vector3d::Zero();
        for (const Index v : state_.selected) sum += eigen(state_.handles[v]);
        return sum / static_cast<double>(state_.selected.size());
    }

    /// Moves each selected handle.
    template <class Move>
    void move_handles(const Move& move) {
        for (const Index v : state_.selected) {
            const Vector3d p = move(eigen(state_.handles[v]));
            if (!p.allFinite() || p.cwiseAbs().maxCoeff() > 1e60) fail("moves a handle beyond 1e60", "give smaller numbers");
            state_.handles[v] = point_of(p);
        }
    }

    void apply(const EditStep::Translate& step) {
        move_handles([&](const Vector3d& p) -> Vector3d { return p + step.by; });
    }
    void apply(const EditStep::Rotate& step) {
        const Eigen::Matrix3d rotation = Eigen::AngleAxisd(step.angle * pi / 180, step.axis).toRotationMatrix();
        const Vector3d c = step.centre ? *step.centre : middle();
        move_handles([&](const Vector3d& p) -> Vector3d { return c + rotation * (p - c); });
    }
    void apply(const EditStep::Scale& step) {
        const Vector3d c = step.centre ? *step.centre : middle();
        move_handles([&](const Vector3d& p) -> Vector3d { return c + step.factor * (p - c); });
    }
    void apply(const EditStep::Stretch& step) {
        const Vector3d& d = step.direction;
        double start = std::numeric_limits<double>::infinity();
        if (const auto* point = std::get_if<Vector3d>(&step.from)) start = d.dot(*point);
        else if (std::holds_alternative<EditStep::Stretch::Middle>(step.from)) start = d.dot(middle());
        else
            for (const Index v : state_.selected) start = std::min(start, d.dot(eigen(state_.handles[v])));
        move_handles([&](const Vector3d& p) -> Vector3d { return p + (step.factor - 1) * (d.dot(p) - start) * d; });
    }
    void apply(const EditStep::MoveTo& step) {
        if (step.places.size() != state_.selected.size())
            fail(fmt::format("moveTo has {} positions for {} selected vertices", step.places.size(), state_.selected.size()),
                 "give one for each, in the order of the vertices");
        for (std::size_t i = 0; i < step.places.size(); ++i) state_.handles[state_.selected[i]] = point_of(step.places[i]);
    }

    const HandleSpace& space_;
    const std::string& where_;
    std::string at_;
    EditState state_;
    std::vector<CageLevel> levels_;       ///< levels of the cage
    std::vector<WeightMatrix> carrying_;  ///< weights of each level in its parent
};

}  // namespace

double influence_threshold(const WeightMatrix& weights, const std::string& rule, const std::vector<Index>& rows) {
    if (rule != "auto-mesh" && rule != "auto-cage")
        throw Error(ErrorKind::usage, "threshold", "'" + rule + "' is no rule", "use auto-mesh or auto-cage");
    Eigen::VectorXd columns = Eigen::VectorXd::Constant(weights.cols(), -std::numeric_limits<double>::infinity());
    double minimum = std::numeric_limits<double>::infinity();
    const std::size_t count = rows.empty() ? static_cast<std::size_t>(weights.rows()) : rows.size();
    for (std::size_t i = 0; i < count; ++i) {
        const auto row = weights.row(static_cast<Eigen::Index>(rows.empty() ? i : rows[i]));
        minimum = std::min(minimum, row.maxCoeff());
        columns = columns.cwiseMax(row.transpose());
    }
    return rule == "auto-mesh" ? minimum : columns.minCoeff();
}

std::vector<Index> influential(const Coordinates& coordinates, const std::vector<Index>& rows, double threshold) {
    const std::vector<double> influence = influence_on(coordinates, rows);
    std::vector<Index> list;
    for (Index j = 0; j < influence.size(); ++j)
        if (influence[j] >= threshold) list.push_back(j);
    return list;
}

std::vector<Index> strongest(const Coordinates& coordinates, const std::vector<Index>& rows, double share) {
    const WeightMatrix& weights = coordinates.vertex;
    std::vector<bool> chosen(static_cast<std::size_t>(weights.cols()), false);
    for (const Index row : rows) {
        const auto of_row = weights.row(static_cast<Eigen::Index>(row));
        const double least = share * of_row.maxCoeff();
        for (Eigen::Index j = 0; j < weights.cols(); ++j)
            if (of_row[j] >= least && of_row[j] > 0) chosen[static_cast<std::size_t>(j)] = true;
    }
    return flagged(chosen);
}

bool is_whole(const Mesh& mesh, const Annotation& annotation) {
    return annotation.all || annotation.faces.size() == mesh.number_of_faces();
}

std::vector<Index> vertices_of(const Mesh& mesh, const Annotation& annotation) { return touched_vertices(mesh, annotation); }

std::vector<EditState> follow_edit(const Edit& edit, const HandleSpace& space, const std::string& where) {
    if ((space.cage == nullptr) != (space.coordinates == nullptr))
        throw Error(ErrorKind::usage, where, "a cage and its weights belong together", "give both or none");
    Follower follower(space, where);
    std::vector<EditState> states;
    for (std::size_t i = 0; i < edit.steps.size(); ++i)
        states.push_back(follower.follow(edit.steps[i], fmt::format("/steps/{}", i)));
    return states;
}

}  // namespace ostraka

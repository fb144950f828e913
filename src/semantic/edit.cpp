#include "ostraka/semantic/edit.h"

#include "ostraka/coords/influence.h"
#include "ostraka/coords/nested.h"
#include "ostraka/core/angles.h"
#include "ostraka/core/error.h"
#include "ostraka/geom/eigen.h"

#include <algorithm>
#include <set>

namespace ostraka {

namespace {

using Eigen::Vector3d;

class Follower {
public:
    Follower(const HandleSpace& space, const std::string& where) : space_(space), where_(where) {
        state_.handles = ostraka::points_of(space.cage != nullptr ? *space.cage : space.mesh);
        state_.touched.assign(state_.handles.size(), false);
        state_.named.assign(space.mesh.number_of_vertices(), false);
        if (space.cage == nullptr) return;
        levels_ = cage_levels(*space.cage);
        carrying_ = carrying_weights(levels_);
    }

    EditState step(const JsonValue& step, const std::string& at) {
        at_ = at;
        state_.threshold = 0;
        state_.selected = select(step["select"]);
        int operations = 0;
        const std::vector<Point> before = state_.handles;
        for (const char* name : {"translate", "rotate", "scale", "stretch", "moveTo"}) {
            const JsonValue* value = find_member(step, name);
            if (value == nullptr) continue;
            if (++operations > 1) fail("has more than one operation", "make a step of each");
            apply(name, *value);
        }
        if (operations == 0) fail("has no operation", "add translate, rotate, scale, stretch or moveTo");
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
    [[nodiscard]] std::size_t level_for(const JsonValue& select, const std::vector<Index>& vertices) const {
        if (const JsonValue* level = find_member(select, "level")) {
            if (level->GetUint64() >= levels_.size())
                fail("there is no level " + std::to_string(level->GetUint64()) + ": the cage has " +
                         std::to_string(levels_.size()) + (levels_.size() == 1 ? " level" : " levels"),
                     "levels count from 0, the outermost; leave it out where no cage is within another");
            return static_cast<std::size_t>(level->GetUint64());
        }
        return level_that_holds(space_.coordinates->vertex, vertices, levels_, carrying_);
    }

    /// Weights of a level's vertices on these mesh vertices (all if none are given), one row each.
    [[nodiscard]] Coordinates weights_in(std::size_t level, const std::vector<Index>& vertices) const {
        const WeightMatrix& all = space_.coordinates->vertex;
        if (vertices.empty()) return {"", weights_of_level(all, levels_, carrying_, level), {}};
        WeightMatrix rows(static_cast<Eigen::Index>(vertices.size()), all.cols());
        for (std::size_t i = 0; i < vertices.size(); ++i) rows.row(static_cast<Eigen::Index>(i)) = all.row(vertices[i]);
        return {"", weights_of_level(rows, levels_, carrying_, level), {}};
    }

    [[nodiscard]] Vector3d vector(const JsonValue& value, const char* name, bool direction = false) const {
        const Vector3d v(value[0].GetDouble(), value[1].GetDouble(), value[2].GetDouble());
        const double largest = v.cwiseAbs().maxCoeff();
        if (!v.allFinite() || largest > 1e60) fail(std::string(name) + " is beyond 1e60", "give numbers up to 1e60");
        if (direction && !(largest > 0)) fail(std::string(name) + " is zero", "give a direction");
        return direction ? Vector3d((v / largest).normalized()) : v;
    }

    [[nodiscard]] double factor(const JsonValue& value) const {
        const double f = value["factor"].GetDouble();
        if (!(f > 0 && f < 1e6)) fail("the factor is not between 0 and a million", "give a positive factor; 1 changes nothing");
        return f;
    }

    [[nodiscard]] std::vector<Index> select(const JsonValue& select) {
        std::set<Index> chosen;
        int ways = 0;
        if (find_member(select, "level") != nullptr && space_.cage == nullptr)
            fail("has a level without a cage", "leave it out, or give --cage and --weights");
        const auto add_mesh_vertices = [&](const std::vector<Index>& vertices, const std::string& what) {
            for (const Index v : vertices) state_.named[v] = true;
            if (space_.cage == nullptr) {
                chosen.insert(vertices.begin(), vertices.end());
                return;
            }
            const JsonValue* threshold = find_member(select, "threshold");
            const JsonValue* scope = find_member(select, "scope");
            const std::size_t level = level_for(select, vertices);
            const Coordinates weights = weights_in(level, vertices);
            std::vector<Index> rows(vertices.size());
            for (Index i = 0; i < rows.size(); ++i) rows[i] = i;
            const auto choose = [&](const std::vector<Index>& found) {
                for (const Index j : found) chosen.insert(levels_[level].cage.vertices[j]);
            };
            if (threshold != nullptr && threshold->IsString() && std::string(threshold->GetString()) == "per-point") {
                choose(strongest(weights, rows));
                return;
            }
            const bool here = scope != nullptr && std::string(scope->GetString()) == "selection";
            // As in the thesis, figure 5.11, or lower if on a dense cage a vertex of the part would have no handle.
            if (threshold == nullptr) state_.threshold = std::min(0.4, influence_threshold(weights.vertex, "auto-mesh"));
            else if (threshold->IsNumber()) state_.threshold = threshold->GetDouble();
            else
                state_.threshold =
                    influence_threshold(here ? weights.vertex : weights_in(level, {}).vertex, threshold->GetString());
            const auto found = influential(weights, rows, state_.threshold);
            if (found.empty())
                fail("no cage vertex has an influence of " + std::to_string(state_.threshold) + " on " + what +
                         "; the largest is " + std::to_string(weights.vertex.maxCoeff()),
                     "lower the threshold, use auto-mesh, or name cageVertices");
            choose(found);
        };
        if (const JsonValue* name = find_member(select, "annotation")) {
            ++ways;
            const Annotation& annotation = named(*name);
            add_mesh_vertices(vertices_of(space_.mesh, annotation), "annotation " + std::to_string(annotation.id));
        }
        if (const JsonValue* list = find_member(select, "annotations")) {
            ++ways;
            for (const JsonValue& name : list->GetArray()) {
                const Annotation& annotation = named(name);
                add_mesh_vertices(vertices_of(space_.mesh, annotation), "annotation " + std::to_string(annotation.id));
            }
        }
        if (const JsonValue* list = find_member(select, "vertices")) {
            ++ways;
            add_mesh_vertices(indices(*list, space_.mesh.number_of_vertices(), "mesh"), "these vertices");
        }
        if (const JsonValue* list = find_member(select, "cageVertices")) {
            ++ways;
            if (find_member(select, "level") != nullptr)
                fail("names cageVertices and a level", "leave the level out: each vertex is of one");
            if (space_.cage == nullptr) fail("cageVertices without a cage", "give --cage and --weights, or select otherwise");
            const auto found = indices(*list, space_.cage->number_of_vertices(), "cage");
            chosen.insert(found.begin(), found.end());
        }
        if (const JsonValue* box = find_member(select, "box")) {
            ++ways;
            const Vector3d low = vector((*box)["min"], "min"), high = vector((*box)["max"], "max");
            if ((low.array() > high.array()).any()) fail("the box has min > max", "exchange them");
            for (const Index v : handles_in(select)) {
                const Vector3d p = eigen(state_.handles[v]);
                if ((p.array() >= low.array()).all() && (p.array() <= high.array()).all()) chosen.insert(v);
            }
        }
        if (find_member(select, "all") != nullptr) {
            ++ways;
            for (const Index v : handles_in(select)) chosen.insert(v);
        }
        bool names = false;
        for (const char* way : {"annotation", "annotations", "vertices"}) names = names || find_member(select, way) != nullptr;
        state_.by_handles = state_.by_handles || (space_.cage != nullptr && !names);
        if (ways != 1)
            fail("selects in " + std::to_string(ways) + " ways",
                 "use one of annotation, annotations, vertices, cageVertices, box, all");
        if (chosen.empty()) fail("selects nothing", "choose another box");
        return {chosen.begin(), chosen.end()};
    }

    /// All handles, or those of the specified level.
    [[nodiscard]] std::vector<Index> handles_in(const JsonValue& select) const {
        if (find_member(select, "level") != nullptr) return levels_[level_for(select, {})].cage.vertices;
        std::vector<Index> all(state_.handles.size());
        for (Index v = 0; v < all.size(); ++v) all[v] = v;
        return all;
    }

    [[nodiscard]] std::vector<Index> indices(const JsonValue& list, std::size_t count, const std::string& of) const {
        std::vector<Index> result;
        for (const auto& value : list.GetArray()) {
            if (value.GetUint64() >= count)
                fail("vertex " + std::to_string(value.GetUint64()) + " is not one of the " + std::to_string(count) + " of the " +
                         of,
                     "give an index of the mesh, from 0");
            result.push_back(static_cast<Index>(value.GetUint64()));
        }
        return result;
    }

    [[nodiscard]] const Annotation& named(const JsonValue& name) const {
        const Annotation* found = nullptr;
        for (const Annotation& annotation : space_.set.annotations) {
            const bool here =
                name.IsInt() ? annotation.id == name.GetInt() : name.IsString() && annotation.tag == name.GetString();
            if (!here) continue;
            if (found != nullptr) fail("several annotations are tagged '" + annotation.tag + "'", "use the id");
            found = &annotation;
        }
        if (found == nullptr)
            fail("there is no annotation " + (name.IsString() ? "tagged '" + std::string(name.GetString()) + "'" : to_text(name)),
                 "see 'annotation list'");
        return *found;
    }

    void apply(const std::string& name, const JsonValue& value) {
        Vector3d middle = Vector3d::Zero();
        for (const Index v : state_.selected) middle += eigen(state_.handles[v]);
        middle /= static_cast<double>(state_.selected.size());
        const auto centre = [&] {
            const JsonValue* given = find_member(value, "centre");
            return given == nullptr ? middle : vector(*given, "centre");
        };
        const auto each = [&](auto&& move) {
            for (const Index v : state_.selected) {
                const Vector3d p = move(eigen(state_.handles[v]));
                if (!p.allFinite() || p.cwiseAbs().maxCoeff() > 1e60) fail("moves a handle beyond 1e60", "give smaller numbers");
                state_.handles[v] = point_of(p);
            }
        };
        if (name == "translate") {
            const Vector3d by = vector(value, "translate");
            each([&](const Vector3d& p) -> Vector3d { return p + by; });
        } else if (name == "rotate") {
            const double angle = value["angle"].GetDouble();
            if (!std::isfinite(angle)) fail("the angle is not finite", "give degrees");
            const Eigen::Matrix3d rotation =
                Eigen::AngleAxisd(angle * pi / 180, vector(value["axis"], "axis", true)).toRotationMatrix();
            const Vector3d c = centre();
            each([&](const Vector3d& p) -> Vector3d { return c + rotation * (p - c); });
        } else if (name == "scale") {
            const double f = factor(value);
            const Vector3d c = centre();
            each([&](const Vector3d& p) -> Vector3d { return c + f * (p - c); });
        } else if (name == "stretch") {
            const double f = factor(value);
            const Vector3d d = vector(value["direction"], "direction", true);
            const JsonValue* from = find_member(value, "from");
            double start = std::numeric_limits<double>::infinity();
            if (from != nullptr && from->IsArray()) start = d.dot(vector(*from, "from"));
            else if (from != nullptr && std::string(from->GetString()) == "middle") start = d.dot(middle);
            else
                for (const Index v : state_.selected) start = std::min(start, d.dot(eigen(state_.handles[v])));
            each([&](const Vector3d& p) -> Vector3d { return p + (f - 1) * (d.dot(p) - start) * d; });
        } else {
            if (value.Size() != state_.selected.size())
                fail("moveTo has " + std::to_string(value.Size()) + " positions for " + std::to_string(state_.selected.size()) +
                         " selected vertices",
                     "give one for each, in the order of the vertices");
            for (rapidjson::SizeType i = 0; i < value.Size(); ++i)
                state_.handles[state_.selected[i]] = point_of(vector(value[i], "moveTo"));
        }
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

std::vector<EditState> follow_edit(const JsonValue& edit, const HandleSpace& space, const std::string& where) {
    validate(edit, "edit", where);
    if ((space.cage == nullptr) != (space.coordinates == nullptr))
        throw Error(ErrorKind::usage, where, "a cage and its weights belong together", "give both or none");
    Follower follower(space, where);
    std::vector<EditState> states;
    const auto& steps = edit["steps"];
    for (rapidjson::SizeType i = 0; i < steps.Size(); ++i)
        states.push_back(follower.step(steps[i], "/steps/" + std::to_string(i)));
    return states;
}

}  // namespace ostraka

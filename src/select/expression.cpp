#include "select/expression.h"

#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"
#include "ostraka/mesh/limits.h"
#include "ostraka/select/selections.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace ostraka {

namespace {

using std::to_string;

bool is_volume(const std::string& kind) { return kind == "box" || kind == "sphere" || kind == "halfspace"; }

bool is_drawn(const std::string& kind) { return kind == "rectangle" || kind == "polygon"; }

bool is_reckoned(const std::string& kind) {
    return kind == "brush" || kind == "threshold" || kind == "segments" || kind == "grow" || kind == "shrink";
}

/// Hidden parts are excluded unless "visible" is false.
bool visible_only(const JsonValue& value) {
    const JsonValue* visible = find_member(value, "visible");
    return visible == nullptr || visible->GetBool();
}

}  // namespace

PathMetric metric_of(const JsonValue& value) {
    const std::string metric = text_in(value, "metric");
    return path_metric(metric.empty() ? "euclidean" : metric);
}

std::pair<std::string, const JsonValue*> kind_of(const JsonValue& expression) {
    for (const auto& member : expression.GetObject()) {
        const std::string name = text_of(member.name);
        if (name != "frame") return {name, &member.value};
    }
    return {"", nullptr};
}

ExpressionEvaluator::ExpressionEvaluator(AnnotatedMeshView object, const std::vector<std::int32_t>& face_labels,
                                         std::string where)
    : mesh_(object.mesh),
      face_labels_(face_labels),
      set_(object.annotations),
      where_(std::move(where)),
      bounds_(bounding_box(object.mesh)) {}

void ExpressionEvaluator::fail(const std::string& at, const std::string& what, const std::string& remedy) const {
    fail_input(where_, "at " + at + ": " + what, remedy);
}

std::pair<std::string, const JsonValue*> ExpressionEvaluator::only_kind(const JsonValue& expression,
                                                                        const std::string& at) const {
    auto found = kind_of(expression);
    for (const auto& member : expression.GetObject()) {
        const std::string name = text_of(member.name);
        if (name != "frame" && name != found.first)
            fail(at, "selects by two kinds, " + found.first + " and " + name, "join them by union, intersection or difference");
    }
    return found;
}

PlaceFrame ExpressionEvaluator::frame_of(const JsonValue& object, PlaceFrame around) {
    const std::string frame = text_in(object, "frame");
    return frame.empty() ? around : PlaceFrame{frame == "box"};
}

Point ExpressionEvaluator::point(const JsonValue& list, PlaceFrame frame, const std::string& at) const {
    const auto [x, y, z] = triple_of(list);
    const Point place = frame.box ? Point(bounds_.xmin() + x * (bounds_.xmax() - bounds_.xmin()),
                                          bounds_.ymin() + y * (bounds_.ymax() - bounds_.ymin()),
                                          bounds_.zmin() + z * (bounds_.zmax() - bounds_.zmin()))
                                  : Point(x, y, z);
    if (!is_place(place))
        fail(at, "a place beyond what can be computed with (coordinates up to 1e60)", "give one near the mesh, in its unit");
    return place;
}

Index ExpressionEvaluator::vertex(const JsonValue& pick, PlaceFrame frame, const std::string& at) const {
    if (whole_ != nullptr) return whole_->vertex(pick, frame, at);  // vertices of the uncut mesh keep their index
    if (pick.IsArray()) return nearest_vertex(mesh_, point(pick, frame, at));
    if (pick.IsObject()) {
        const SurfaceHit hit = seen(pick, frame, at);
        const auto corner = corners(mesh_, Face(hit.face));
        return *std::min_element(corner.begin(), corner.end(), [&](Vertex a, Vertex b) {
            return std::make_pair(CGAL::squared_distance(mesh_.point(a), hit.point), a) <
                   std::make_pair(CGAL::squared_distance(mesh_.point(b), hit.point), b);
        });
    }
    if (pick.GetUint() >= mesh_.number_of_vertices())
        fail(at, "vertex " + to_string(pick.GetUint()) + " of a mesh with " + to_string(mesh_.number_of_vertices()) + " vertices",
             "pick by coordinates, or another vertex");
    return pick.GetUint();
}

Index ExpressionEvaluator::face(const JsonValue& pick, PlaceFrame frame, const std::string& at) const {
    if (pick.IsArray()) return nearest_face(mesh_, point(pick, frame, at));
    if (pick.IsObject()) return seen(pick, frame, at).face;
    if (whole_ != nullptr) {
        const auto& origin = cut_->face_origin;
        return static_cast<Index>(std::lower_bound(origin.begin(), origin.end(), whole_->face(pick, frame, at)) - origin.begin());
    }
    if (pick.GetUint() >= mesh_.number_of_faces())
        fail(at, "face " + to_string(pick.GetUint()) + " of a mesh with " + to_string(mesh_.number_of_faces()) + " faces",
             "pick by coordinates, or another face");
    return pick.GetUint();
}

std::vector<Index> ExpressionEvaluator::picks(const JsonValue& list, PlaceFrame frame, const std::string& at) const {
    std::vector<Index> vertices;
    for (rapidjson::SizeType i = 0; i < list.Size(); ++i) vertices.push_back(vertex(list[i], frame, at + '/' + to_string(i)));
    return vertices;
}

std::function<bool(const Point&)> ExpressionEvaluator::volume(const std::string& kind, const JsonValue& value, PlaceFrame frame,
                                                              const std::string& at) const {
    if (kind == "box") {
        const Point min = point(value["min"], frame, at + "/box/min"), max = point(value["max"], frame, at + "/box/max");
        if (min.x() > max.x() || min.y() > max.y() || min.z() > max.z()) fail(at + "/box", "min exceeds max", "exchange the two");
        return box_volume(min, max);
    }
    if (kind == "sphere") {
        const double scale = frame.box ? std::hypot(bounds_.xmax() - bounds_.xmin(), bounds_.ymax() - bounds_.ymin(),
                                                    bounds_.zmax() - bounds_.zmin())
                                       : 1;
        return sphere_volume(point(value["centre"], frame, at + "/sphere/centre"), scale * value["radius"].GetDouble());
    }
    const auto [x, y, z] = triple_of(value["normal"]);
    const Vector normal(x, y, z);
    if (unit_vector(normal) == CGAL::NULL_VECTOR)
        fail(at + "/halfspace/normal", "the normal has no length", "give a vector that is not zero");
    return halfspace_volume(point(value["point"], frame, at + "/halfspace/point"), normal);
}

const Annotation& ExpressionEvaluator::earlier(const JsonValue& id, AnnotationType type, const std::string& at) const {
    const Annotation* found = set_.find(id.GetInt());
    if (found == nullptr)
        fail(at + "/annotation", "no earlier annotation has the id " + to_string(id.GetInt()), "define it before it is used");
    if (found->type != type)
        fail(at + "/annotation",
             "annotation " + to_string(found->id) + " is a " + to_string(found->type) + ", where a " + to_string(type) +
                 " is needed",
             "use one of that type");
    return *found;
}

std::vector<bool> ExpressionEvaluator::faces_in_lasso(const JsonValue& value, PlaceFrame frame, const std::string& at) const {
    const JsonValue& pick = value["seed"];
    const Index seed = face(pick, frame, at + "/seed");
    std::optional<Point> place;
    if (pick.IsObject()) place = seen(pick, frame, at + "/seed").point;
    if (pick.IsArray()) {
        const auto [a, b, c] = corners(mesh_, Face(seed));
        place =
            point_at(mesh_, seed, nearest_barycentric(mesh_.point(a), mesh_.point(b), mesh_.point(c), point(pick, frame, at)));
    }
    return lasso(mesh_, picks(value["points"], frame, at + "/points"), seed, metric_of(value), where_ + ", at " + at, place);
}

std::vector<bool> ExpressionEvaluator::painted_faces(const JsonValue& value, PlaceFrame frame, const std::string& at) const {
    if (whole_ == nullptr) return painted(value, frame, at).faces();
    const PaintedFigure& figure = whole_->painted(value, frame, at);
    std::vector<bool> selected(mesh_.number_of_faces());
    for (const Face face : mesh_.faces()) {
        const Face origin(cut_->face_origin[face]);
        const auto [a, b, c] = corners(whole_->mesh_, origin);
        selected[face] = figure.inside(origin, nearest_barycentric(whole_->mesh_.point(a), whole_->mesh_.point(b),
                                                                   whole_->mesh_.point(c), centroid(mesh_, face)));
    }
    return selected;
}

std::vector<bool> ExpressionEvaluator::labelled_faces(const JsonValue& labels, const std::string& at) const {
    if (face_labels_.empty())
        fail(at, "the mesh has no face labels", "give a mesh with labels, e.g. a PLY file with a face property \"label\"");
    std::set<std::int32_t> wanted;
    for (const auto& label : labels.GetArray()) wanted.insert(label.GetInt());
    std::vector<bool> result(mesh_.number_of_faces());
    for (std::size_t i = 0; i < face_labels_.size(); ++i) result[i] = wanted.contains(face_labels_[i]);
    return result;
}

std::vector<bool> ExpressionEvaluator::faces(const JsonValue& expression, PlaceFrame around, const std::string& at) const {
    check_cancelled();
    const PlaceFrame frame = frame_of(expression, around);
    const auto [kind, value] = only_kind(expression, at);
    if (is_volume(kind)) return faces_within(mesh_, volume(kind, *value, frame, at));
    if (is_drawn(kind)) {
        const ScreenCamera from = camera(*value, frame, at + '/' + kind);
        return faces_seen(mesh_, from.camera, screen_area(kind, *value, from, at + '/' + kind),
                          visible_only(*value) ? &search(at + '/' + kind) : nullptr);
    }
    if (whole_ != nullptr)
        if (const SelectionLevel* level = whole_->level_of(expression, around, at)) {
            const double infinite = std::numeric_limits<double>::infinity();
            return faces_between(mesh_, {cut_->vertex_values(whole_->mesh_, level->values), false},
                                 level->above ? ScalarRange{level->level, infinite} : ScalarRange{-infinite, level->level});
        }
    // Selections along the edges of the mesh are evaluated on the uncut mesh.
    if (whole_ != nullptr && (kind == "segments" || kind == "grow" || kind == "shrink" || kind == "faces" ||
                              (kind == "lasso" && whole_->keeps_to_edges(*value))))
        return faces_of_origin(whole_->faces(expression, around, at));
    if (is_reckoned(kind)) return field_selected_faces(kind, *value, frame, at + '/' + kind);
    if (kind == "painted") return painted_faces(*value, frame, at + "/painted");
    if (whole_ != nullptr && kind == "lasso") return lassoed(*value, frame, at + "/lasso");
    std::vector<bool> result(mesh_.number_of_faces(), false);
    if (kind == "all") {
        result.assign(mesh_.number_of_faces(), true);
    } else if (kind == "faces") {
        for (rapidjson::SizeType i = 0; i < value->Size(); ++i)
            result[face((*value)[i], frame, at + "/faces/" + to_string(i))] = true;
    } else if (kind == "lasso") {
        result = faces_in_lasso(*value, frame, at + "/lasso");
    } else if (kind == "component") {
        const Index seed = face((*value)["seed"], frame, at + "/component/seed");
        std::vector<bool> within;
        if (const JsonValue* of = find_member(*value, "of")) {
            within = faces(*of, frame, at + "/component/of");
            if (!within[seed])
                fail(at + "/component/seed", "face " + to_string(seed) + " does not belong to the selection",
                     "put the seed within it");
        }
        result = component_of(mesh_, seed, within);
    } else if (kind == "labels") {
        result = labelled_faces(*value, at + "/labels");
    } else if (kind == "annotation") {
        for (const Index i : earlier(*value, AnnotationType::region, at).faces) result[i] = true;
    } else if (kind == "invert") {
        result = faces(*value, frame, at + "/invert");
        result.flip();
    } else if (kind == "union" || kind == "intersection" || kind == "difference") {
        for (rapidjson::SizeType i = 0; i < value->Size(); ++i) {
            const std::vector<bool> part = faces((*value)[i], frame, at + '/' + kind + '/' + to_string(i));
            for (std::size_t f = 0; f < result.size(); ++f) {
                if (i == 0) result[f] = part[f];
                else if (kind == "union") result[f] = result[f] || part[f];
                else if (kind == "intersection") result[f] = result[f] && part[f];
                else result[f] = result[f] && !part[f];
            }
        }
    } else {
        fail(at + '/' + kind, "does not select faces, which a region is made of",
             "use it for a line or a point, or select faces");
    }
    return result;
}

std::vector<Index> ExpressionEvaluator::vertices(const JsonValue& expression, PlaceFrame around, const std::string& at) const {
    const PlaceFrame frame = frame_of(expression, around);
    const auto [kind, value] = only_kind(expression, at);
    if (is_volume(kind)) return vertices_within(mesh_, volume(kind, *value, frame, at));
    if (is_drawn(kind)) {
        const ScreenCamera from = camera(*value, frame, at + '/' + kind);
        return vertices_seen(mesh_, from.camera, screen_area(kind, *value, from, at + '/' + kind),
                             visible_only(*value) ? &search(at + '/' + kind) : nullptr);
    }
    if (is_reckoned(kind) && kind != "segments") return field_selected_vertices(kind, *value, frame, at + '/' + kind);
    std::vector<Index> result;
    if (kind == "vertices") {
        result = picks(*value, frame, at + "/vertices");
    } else if (kind == "invert") {
        const std::vector<Index> part = vertices(*value, frame, at + "/invert");
        const std::set<Index> members(part.begin(), part.end());
        for (const Vertex v : mesh_.vertices())
            if (!mesh_.is_isolated(v) && !members.contains(v)) result.push_back(v);
    } else if (kind == "nearest") {
        result = {vertex(*value, frame, at + "/nearest")};
    } else if (kind == "annotation") {
        result = earlier(*value, AnnotationType::point, at).points;
    } else if (kind == "union" || kind == "intersection" || kind == "difference") {
        for (rapidjson::SizeType i = 0; i < value->Size(); ++i) {
            const std::vector<Index> part = vertices((*value)[i], frame, at + '/' + kind + '/' + to_string(i));
            const std::set<Index> members(part.begin(), part.end());
            if (i == 0 || kind == "union") result.insert(result.end(), part.begin(), part.end());
            else std::erase_if(result, [&](Index v) { return members.contains(v) != (kind == "intersection"); });
        }
    } else {
        fail(at + '/' + kind, "does not select points",
             "use vertices, nearest, a volume, rectangle, brush or threshold, or a set operation of these");
    }
    std::set<Index> seen;  // keeps the order, drops repeats
    std::erase_if(result, [&](Index v) { return !seen.insert(v).second; });
    return result;
}

std::vector<std::vector<Index>> ExpressionEvaluator::polylines(const JsonValue& expression, PlaceFrame around,
                                                               const std::string& at) const {
    const PlaceFrame frame = frame_of(expression, around);
    const auto [kind, value] = only_kind(expression, at);
    if (kind == "path") {
        return {path_through(mesh_, picks((*value)["points"], frame, at + "/path/points"), flag_in(*value, "closed"),
                             metric_of(*value), where_ + ", at " + at + "/path")};
    }
    if (kind == "vertices") return {picks(*value, frame, at + "/vertices")};
    if (kind == "annotation") return earlier(*value, AnnotationType::line, at).polylines;
    if (kind != "union") fail(at + '/' + kind, "does not select poly-lines", "use path, vertices, or a union of these");
    std::vector<std::vector<Index>> result;
    for (rapidjson::SizeType i = 0; i < value->Size(); ++i)
        for (auto& polyline : polylines((*value)[i], frame, at + "/union/" + to_string(i))) result.push_back(std::move(polyline));
    return result;
}

}  // namespace ostraka

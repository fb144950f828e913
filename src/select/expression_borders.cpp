// Borders of selections through the faces, for free outlines.
#include "select/expression.h"

#include "ostraka/execution/parallel.h"
#include "ostraka/geom/geodesic.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/mesh/flood.h"
#include "ostraka/select/selections.h"
#include "select/growth.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

constexpr double at_vertex = 1e-9;  ///< a border closer to a vertex than this share of the edge runs through the vertex

/// Adds the border pieces in the faces that have corners on both sides. `inside`: one flag per vertex; `root(a, b)`: share of
/// the way from vertex a (outside) to vertex b (inside) at which the border crosses.
template <class Root>
void add_level(const Mesh& mesh, const std::vector<bool>& inside, const Root& root, std::vector<SurfaceCurve>& curves) {
    const auto node_on = [&](Halfedge h) {
        const Vertex v = mesh.source(h), w = mesh.target(h);
        const Vertex a = inside[v] ? w : v, b = inside[v] ? v : w;  // from outside to inside, the same order as seen from the
                                                                    // other face
        const double t = std::clamp(root(a, b), 0.0, 1.0);
        if (t < at_vertex || t > 1 - at_vertex) return vertex_point(t < 0.5 ? a : b);
        return ordered_edge_point(a, b, t);
    };
    for (const Face f : mesh.faces()) {
        SurfaceCurve curve;
        for (const Halfedge h : mesh.halfedges_around_face(mesh.halfedge(f)))
            if (inside[mesh.source(h)] != inside[mesh.target(h)]) curve.points.push_back(node_on(h));
        if (curve.points.size() != 2) continue;
        curve.faces.push_back(f);
        curves.push_back(std::move(curve));
    }
}

/// The share of a segment at which a test on points changes, by bisection.
double root_of(const std::function<bool(const Point&)>& inside, const Point& out, const Point& in) {
    double low = 0, high = 1;
    for (int i = 0; i < 60; ++i) {
        const double middle = (low + high) / 2;
        (inside(out + middle * (in - out)) ? high : low) = middle;
    }
    return high;
}

void add_level(const Mesh& mesh, const std::vector<double>& values, double level, bool above, std::vector<SurfaceCurve>& curves) {
    if (!std::isfinite(level)) return;
    std::vector<bool> inside(mesh.number_of_vertices());
    for (std::size_t v = 0; v < inside.size(); ++v) inside[v] = above ? values[v] >= level : values[v] <= level;
    add_level(
        mesh, inside,
        [&](Vertex a, Vertex b) {
            const double from = values[a], to = values[b];
            return std::isfinite(from) && std::isfinite(to) ? (level - from) / (to - from) : 1.0;
        },
        curves);
}

/// Projects the sides of a polygon in a picture onto the faces.
class DrawnSides {
public:
    DrawnSides(const Mesh& mesh, const PictureCamera& camera, const std::vector<Pixel>& corners)
        : mesh_(mesh), camera_(camera), corners_(corners), pixels_(mesh.number_of_vertices()) {
        parallel_for(pixels_.size(),
                     [&](std::size_t v) { pixels_[v] = camera.project(mesh.point(Vertex(static_cast<Index>(v)))); });
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const Pixel &p = corners[i], &q = corners[(i + 1) % corners.size()];
            const auto a = camera.ray(p[0], p[1]), b = camera.ray(q[0], q[1]);
            // The plane through the eye and the side of the polygon.
            const Vector along = camera.eye() ? b.direction : b.origin - a.origin;
            planes_.push_back({a.origin, CGAL::cross_product(a.direction, along)});
        }
    }

    std::vector<SurfaceCurve> pieces() const {
        std::vector<std::vector<SurfaceCurve>> parts((mesh_.number_of_faces() + block - 1) / block);
        parallel_blocks(mesh_.number_of_faces(), block, [&](std::size_t begin, std::size_t end) {
            for (std::size_t f = begin; f < end; ++f) add(Face(static_cast<Index>(f)), parts[begin / block]);
        });
        std::vector<SurfaceCurve> all;
        for (auto& part : parts) std::move(part.begin(), part.end(), std::back_inserter(all));
        return all;
    }

private:
    static constexpr std::size_t block = 4096;
    struct Plane {
        Point origin;
        Vector normal;
    };

    void add(Face f, std::vector<SurfaceCurve>& curves) const {
        const auto corner = ostraka::corners(mesh_, f);
        Pixel low{infinite, infinite}, high{-infinite, -infinite};
        for (const Vertex v : corner) {
            const auto& pixel = pixels_[v];
            if (!pixel) return;
            for (std::size_t k = 0; k < 2; ++k) low[k] = std::min(low[k], (*pixel)[k]), high[k] = std::max(high[k], (*pixel)[k]);
        }
        const Vector area = area_vector(mesh_, f);
        for (std::size_t i = 0; i < corners_.size(); ++i) {
            const Pixel &p = corners_[i], &q = corners_[(i + 1) % corners_.size()];
            if (std::min(p[0], q[0]) > high[0] || std::max(p[0], q[0]) < low[0] || std::min(p[1], q[1]) > high[1] ||
                std::max(p[1], q[1]) < low[1])
                continue;
            std::array<double, 3> side{};
            for (std::size_t k = 0; k < 3; ++k) side[k] = (mesh_.point(corner[k]) - planes_[i].origin) * planes_[i].normal;
            // Intersection of the plane with the face: a chord with its ends on edges.
            std::vector<std::pair<double, SurfacePoint>> ends;
            for (const Halfedge h : mesh_.halfedges_around_face(mesh_.halfedge(f))) {
                const Vertex v = std::min(mesh_.source(h), mesh_.target(h)), w = std::max(mesh_.source(h), mesh_.target(h));
                const auto at = [&](Vertex x) {
                    return side[static_cast<std::size_t>(std::find(corner.begin(), corner.end(), x) - corner.begin())];
                };
                const double a = at(v), b = at(w);
                if ((a > 0) == (b > 0)) continue;
                const double t = a / (a - b);
                const SurfacePoint end = t < at_vertex || t > 1 - at_vertex ? vertex_point(t < 0.5 ? v : w) : edge_point(v, w, t);
                const auto pixel = camera_.project(position(mesh_, end));
                if (!pixel) return;
                const double x = q[0] - p[0], y = q[1] - p[1];
                ends.emplace_back((((*pixel)[0] - p[0]) * x + ((*pixel)[1] - p[1]) * y) / (x * x + y * y), end);
            }
            if (ends.size() != 2) continue;
            if (ends[0].first > ends[1].first) std::swap(ends[0], ends[1]);
            if (ends[1].first <= 0 || ends[0].first >= 1) continue;
            if (ends[0].first < 0 && !move_to_corner(f, area, i, ends[0].second)) continue;
            if (ends[1].first > 1 && !move_to_corner(f, area, (i + 1) % corners_.size(), ends[1].second)) continue;
            SurfaceCurve curve;
            curve.points = {ends[0].second, ends[1].second};
            curve.faces = {f};
            curves.push_back(std::move(curve));
        }
    }

    /// Moves an end to the point of the face that is seen at a corner of the polygon.
    bool move_to_corner(Face f, const Vector& area, std::size_t i, SurfacePoint& end) const {
        const auto ray = camera_.ray(corners_[i][0], corners_[i][1]);
        const double slope = ray.direction * area;
        if (slope == 0) return false;
        const auto corner = ostraka::corners(mesh_, f);
        const Point place = ray.origin + ((mesh_.point(corner[0]) - ray.origin) * area / slope) * ray.direction;
        end = surface_point(mesh_, f,
                            nearest_barycentric(mesh_.point(corner[0]), mesh_.point(corner[1]), mesh_.point(corner[2]), place),
                            at_vertex);
        return true;
    }

    static constexpr double infinite = std::numeric_limits<double>::infinity();
    const Mesh& mesh_;
    const PictureCamera& camera_;
    const std::vector<Pixel>& corners_;
    std::vector<std::optional<Pixel>> pixels_;
    std::vector<Plane> planes_;
};

}  // namespace

void ExpressionEvaluator::add_borders(const JsonValue& expression, PlaceFrame around, const std::string& at,
                                      SelectionBorders& borders) const {
    const PlaceFrame frame = frame_of(expression, around);
    const auto [kind, value] = only_kind(expression, at);
    const std::string here = at + '/' + kind;
    if (const SelectionLevel* level = level_of(expression, around, at)) {
        add_level(mesh_, level->values, level->level, level->above, borders.curves);
    } else if (kind == "box" || kind == "sphere" || kind == "halfspace") {
        const auto inside = volume(kind, *value, frame, at);
        std::vector<bool> flags(mesh_.number_of_vertices());
        for (const Vertex v : mesh_.vertices()) flags[v] = inside(mesh_.point(v));
        add_level(
            mesh_, flags, [&](Vertex a, Vertex b) { return root_of(inside, mesh_.point(a), mesh_.point(b)); }, borders.curves);
    } else if (kind == "rectangle" || kind == "polygon") {
        const ScreenCamera from = camera(*value, frame, here);
        screen_area(kind, *value, from, here);  // validates the area
        std::vector<Pixel> points;
        const auto pixel = [](const JsonValue& list) { return Pixel{list[0].GetDouble(), list[1].GetDouble()}; };
        if (kind == "rectangle") {
            const Pixel a = pixel((*value)["from"]), b = pixel((*value)["to"]);
            points = {a, {b[0], a[1]}, b, {a[0], b[1]}};
        } else {
            for (const auto& one : (*value)["points"].GetArray())
                if (const Pixel p = pixel(one); points.empty() || points.back() != p) points.push_back(p);
            while (points.size() > 1 && points.front() == points.back()) points.pop_back();
        }
        std::vector<SurfaceCurve> pieces = DrawnSides(mesh_, from.camera, points).pieces();
        std::move(pieces.begin(), pieces.end(), std::back_inserter(borders.curves));
    } else if (kind == "threshold") {
        const ScalarMap map = scalar(*value, frame, here);
        if (map.on_faces) return;
        const ScalarRange range = interval(*value, map, here);
        add_level(mesh_, map.values, range.above, true, borders.curves);
        add_level(mesh_, map.values, range.below, false, borders.curves);
    } else if (kind == "painted") {
        std::vector<SurfaceCurve> pieces = painted(*value, frame, here).outline();
        std::move(pieces.begin(), pieces.end(), std::back_inserter(borders.curves));
    } else if (kind == "brush") {
        const double radius = length((*value)["radius"].GetDouble(), frame);
        add_level(mesh_, distances_within(mesh_, brush_centres(*value, frame, here), radius), radius, false, borders.curves);
    } else if (kind == "lasso" && !keeps_to_edges(*value)) {
        static_cast<void>(faces(expression, around, at));  // throws if the lasso crosses itself or has its seed on the outline
        const std::vector<Index> points = picks((*value)["points"], frame, here + "/points");
        auto& legs = borders.lassos[here];
        for (std::size_t i = 0; i < points.size(); ++i) {
            const Index a = points[i], b = points[(i + 1) % points.size()];
            if (a == b) continue;
            const auto leg = geodesic_curve(mesh_, vertex_point(a), vertex_point(b));
            if (!leg)
                fail(here, "no path along the surface joins vertices " + std::to_string(a) + " and " + std::to_string(b),
                     "they lie on separate parts of the mesh: pick points on one part");
            legs.push_back(borders.curves.size());
            borders.curves.push_back(*leg);
        }
    } else if (kind == "invert") {
        add_borders(*value, frame, here, borders);
    } else if (kind == "component") {
        if (const JsonValue* of = find_member(*value, "of")) add_borders(*of, frame, here + "/of", borders);
    } else if (kind == "union" || kind == "intersection" || kind == "difference") {
        for (rapidjson::SizeType i = 0; i < value->Size(); ++i)
            add_borders((*value)[i], frame, here + '/' + std::to_string(i), borders);
    }
    // Selections of the other kinds run along the edges of the mesh.
}

bool ExpressionEvaluator::ends_at_levels(const JsonValue& expression, PlaceFrame around, const std::string& at) const {
    const PlaceFrame frame = frame_of(expression, around);
    const auto [kind, value] = only_kind(expression, at);
    const std::string here = at + '/' + kind;
    if (kind == "box" || kind == "sphere" || kind == "halfspace" || kind == "rectangle" || kind == "polygon" || kind == "brush" ||
        kind == "painted")
        return true;
    if (kind == "threshold") return !on_faces(*value, frame, here);
    if (kind == "lasso") return metric_of(*value) == PathMetric::euclidean;
    if (kind == "grow" || kind == "shrink") return by_distance(*value, here);
    if (kind == "invert") return ends_at_levels(*value, frame, here);
    if (kind == "annotation") {
        const Annotation* found = set_.find(value->GetInt());
        return found != nullptr && is_free(*found);
    }
    if (kind == "component") {
        const JsonValue* of = find_member(*value, "of");
        return of != nullptr && ends_at_levels(*of, frame, here + "/of");
    }
    if (kind != "union" && kind != "intersection" && kind != "difference") return false;
    for (rapidjson::SizeType i = 0; i < value->Size(); ++i)
        if (ends_at_levels((*value)[i], frame, here + '/' + std::to_string(i))) return true;
    return false;
}

bool ExpressionEvaluator::keeps_to_edges(const JsonValue& lasso) const {
    return face_sets_along_edges_ && metric_of(lasso) != PathMetric::euclidean;
}

CutSelection ExpressionEvaluator::cut_selection(const JsonValue& expression, PlaceFrame frame, const std::string& at) const {
    SelectionBorders borders;
    add_borders(expression, frame, at, borders);
    CutSelection result{cut_along_curves({mesh_, set_}, borders.curves), {}};
    const std::vector<std::int32_t> labels =
        face_labels_.empty() ? std::vector<std::int32_t>() : result.cut.face_values(face_labels_);
    ExpressionEvaluator there(result.cut, labels, where_);
    there.set_surroundings(surroundings_);
    there.evaluate_on_cut(*this, result.cut, borders);
    result.faces = there.faces(expression, frame, at);
    return result;
}

bool ExpressionEvaluator::on_faces(const JsonValue& threshold, PlaceFrame frame, const std::string& at) const {
    // Other maps are on vertices, and expensive to compute.
    if (find_member(threshold, "thickness") == nullptr && find_member(threshold, "map") == nullptr &&
        find_member(threshold, "values") == nullptr)
        return false;
    return scalar(threshold, frame, at).on_faces;
}

const SelectionLevel* ExpressionEvaluator::level_of(const JsonValue& expression, PlaceFrame around, const std::string& at) const {
    const PlaceFrame frame = frame_of(expression, around);
    const auto [kind, value] = only_kind(expression, at);
    const std::string here = at + '/' + kind;
    const bool grows = kind == "grow" || kind == "shrink";
    if (!grows && kind != "segments" && kind != "labels" && (kind != "threshold" || !on_faces(*value, frame, here)))
        return nullptr;
    if (face_sets_along_edges_ && !(grows && by_distance(*value, here))) return nullptr;
    const auto [entry, fresh] = levels_.try_emplace(at);
    std::optional<SelectionLevel>& known = entry->second;
    if (fresh && grows && by_distance(*value, here)) {
        const double distance = length((*value)["distance"].GetDouble(), frame);
        const CutSelection inner = cut_selection((*value)["of"], frame, here + "/of");
        std::vector<bool> in(inner.cut.mesh.number_of_vertices(), false), out = in;
        for (const Face face : inner.cut.mesh.faces())
            for (const Vertex v : corners(inner.cut.mesh, face)) (inner.faces[face] ? in : out)[v] = true;
        std::vector<Index> border;
        for (std::size_t v = 0; v < in.size(); ++v)
            if (in[v] && out[v]) border.push_back(static_cast<Index>(v));
        if (border.empty()) return nullptr;  // all or nothing selected: there is no border to grow from
        known.emplace();
        known->values = distances_within(inner.cut.mesh, border, distance);
        known->values.resize(inner.cut.old_vertices);
        for (std::size_t v = 0; v < known->values.size(); ++v)
            if (in[v]) known->values[v] = -known->values[v];
        known->level = kind == "grow" ? distance : -distance;
        known->above = false;
    } else if (fresh) {
        const std::vector<bool> chosen = faces(expression, around, at);
        std::vector<double> area(mesh_.number_of_vertices(), 0), part = area;
        for (const Face face : mesh_.faces()) {
            const double size = face_area(mesh_, face);
            for (const Vertex v : corners(mesh_, face)) area[v] += size, part[v] += chosen[face] ? size : 0;
        }
        bool any = false;
        for (std::size_t v = 0; v < area.size(); ++v) {
            part[v] = area[v] > 0 ? part[v] / area[v] : 0;
            any = any || part[v] >= 0.5;
        }
        if (any) known = SelectionLevel{std::move(part), 0.5, true};
    }
    return known ? &*known : nullptr;
}

std::vector<bool> ExpressionEvaluator::faces_of_origin(const std::vector<bool>& whole) const {
    std::vector<bool> parts(cut_->face_origin.size());
    for (std::size_t f = 0; f < parts.size(); ++f) parts[f] = whole[cut_->face_origin[f]];
    return parts;
}

std::vector<bool> ExpressionEvaluator::lassoed(const JsonValue& value, PlaceFrame frame, const std::string& at) const {
    std::vector<bool> wall(mesh_.number_of_edges(), false);
    for (const std::size_t leg : borders_->lassos.at(at)) {
        const std::vector<Index>& path = cut_->more_paths[leg];
        for (std::size_t i = 0; i + 1 < path.size(); ++i)
            if (const Halfedge h = find_halfedge(mesh_, Vertex(path[i]), Vertex(path[i + 1])); h.is_valid())
                wall[mesh_.edge(h)] = true;
    }
    const Index seed = face(value["seed"], frame, at + "/seed");
    std::vector<bool> inside(mesh_.number_of_faces(), false), component = inside;
    flood_faces(mesh_, Face(seed), inside, [&](Halfedge h) -> bool { return !wall[mesh_.edge(h)]; });
    flood_faces(mesh_, Face(seed), component);
    if (inside == component)
        fail(at, "the lasso does not close off any part of the surface around the seed",
             "put the seed within it; a lasso that runs through a handle or along a border needs more points");
    return inside;
}

std::vector<std::vector<SurfacePoint>> ExpressionEvaluator::curves(const JsonValue& expression, PlaceFrame around,
                                                                   const std::string& at) const {
    const PlaceFrame frame = frame_of(expression, around);
    const auto [kind, value] = only_kind(expression, at);
    std::vector<std::vector<SurfacePoint>> result;
    if (kind == "union") {
        for (rapidjson::SizeType i = 0; i < value->Size(); ++i)
            for (auto& curve : curves((*value)[i], frame, at + "/union/" + std::to_string(i))) result.push_back(std::move(curve));
        return result;
    }
    if (kind != "path")
        fail(at + '/' + kind, "does not select free lines", "use path, or a union of these; or lines along edges");
    std::vector<Index> points = picks((*value)["points"], frame, at + "/path/points");
    points.erase(std::unique(points.begin(), points.end()), points.end());
    const bool closed = flag_in(*value, "closed");
    if (closed && points.size() > 2 && points.front() != points.back()) points.push_back(points.front());
    if (points.size() < 2)
        fail(at + "/path", "a path through fewer than two different vertices", "pick two or more, farther apart");
    std::vector<SurfacePoint> places;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        const auto leg = geodesic_curve(mesh_, vertex_point(points[i]), vertex_point(points[i + 1]));
        if (!leg)
            fail(at + "/path", "no path along the surface joins two of its points",
                 "they lie on separate parts of the mesh: pick points on one part");
        for (const SurfacePoint& p : leg->points)
            if (const SurfacePoint place = stored_point(mesh_, p); places.empty() || places.back() != place)
                places.push_back(place);
    }
    result.push_back(std::move(places));
    return result;
}

}  // namespace ostraka

// Borders of selections through the faces, for free outlines.
#include "select/evaluator.h"

#include "ostraka/core/overloaded.h"
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

/// The corners of a drawn shape, without repeats of one directly after the other.
std::vector<Pixel> corners_of(const selection::DrawnArea& drawn) {
    if (const auto* rectangle = std::get_if<selection::Rectangle>(&drawn.shape)) {
        const Pixel &a = rectangle->from, &b = rectangle->to;
        return {a, {b[0], a[1]}, b, {a[0], b[1]}};
    }
    std::vector<Pixel> points;
    for (const Pixel& p : std::get<selection::Polygon>(drawn.shape).points)
        if (points.empty() || points.back() != p) points.push_back(p);
    while (points.size() > 1 && points.front() == points.back()) points.pop_back();
    return points;
}

void append(std::vector<SurfaceCurve> pieces, std::vector<SurfaceCurve>& curves) {
    std::move(pieces.begin(), pieces.end(), std::back_inserter(curves));
}

}  // namespace

void ExpressionEvaluator::add_volume(const selection::Volume& body, const std::string& at, SelectionBorders& borders) const {
    const auto inside = volume(body, at);
    std::vector<bool> flags(mesh_.number_of_vertices());
    for (const Vertex v : mesh_.vertices()) flags[v] = inside(mesh_.point(v));
    add_level(
        mesh_, flags, [&](Vertex a, Vertex b) { return root_of(inside, mesh_.point(a), mesh_.point(b)); }, borders.curves);
}

void ExpressionEvaluator::add_drawn(const selection::DrawnArea& drawn, const std::string& at, SelectionBorders& borders) const {
    static_cast<void>(screen_area(drawn, at));  // validates the area
    const std::vector<Pixel> points = corners_of(drawn);
    append(DrawnSides(mesh_, camera(*drawn.camera).camera, points).pieces(), borders.curves);
}

void ExpressionEvaluator::add_threshold(const selection::Threshold& threshold, const std::string& at,
                                        SelectionBorders& borders) const {
    const ScalarMap map = scalar(threshold, at);
    if (map.on_faces) return;
    const ScalarRange range = interval(threshold, map, at);
    add_level(mesh_, map.values, range.above, true, borders.curves);
    add_level(mesh_, map.values, range.below, false, borders.curves);
}

void ExpressionEvaluator::add_lasso(const SelectionExpression& expression, const selection::Lasso& lasso,
                                    SelectionBorders& borders) const {
    static_cast<void>(faces(expression));  // throws if the lasso crosses itself or has its seed on the outline
    const std::vector<Index> points = picks(lasso.points);
    auto& legs = borders.lassos[expression.at];
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Index a = points[i], b = points[(i + 1) % points.size()];
        if (a == b) continue;
        const auto leg = geodesic_curve(mesh_, vertex_point(a), vertex_point(b));
        if (!leg)
            fail(expression.at, "no path along the surface joins vertices " + std::to_string(a) + " and " + std::to_string(b),
                 "they lie on separate parts of the mesh: pick points on one part");
        legs.push_back(borders.curves.size());
        borders.curves.push_back(*leg);
    }
}

void ExpressionEvaluator::add_borders(const SelectionExpression& expression, SelectionBorders& borders) const {
    if (const SelectionLevel* level = level_of(expression))
        return add_level(mesh_, level->values, level->level, level->above, borders.curves);
    const std::string& at = expression.at;
    std::visit(Overloaded{[&](const selection::Volume& body) { add_volume(body, at, borders); },
                          [&](const selection::DrawnArea& drawn) { add_drawn(drawn, at, borders); },
                          [&](const selection::Threshold& threshold) { add_threshold(threshold, at, borders); },
                          [&](const selection::Painted& figure) { append(painted(figure, at).outline(), borders.curves); },
                          [&](const selection::Brush& brush) {
                              const double radius = length(brush.radius);
                              add_level(mesh_, distances_within(mesh_, brush_centres(brush, at), radius), radius, false,
                                        borders.curves);
                          },
                          [&](const selection::Lasso& lasso) {
                              if (!keeps_to_edges(lasso)) add_lasso(expression, lasso, borders);
                          },
                          [&](const selection::Complement& complement) { add_borders(*complement.of, borders); },
                          [&](const selection::Component& component) {
                              if (component.of != nullptr) add_borders(*component.of, borders);
                          },
                          [&](const selection::Combination& combination) {
                              for (const SelectionExpression& operand : combination.operands) add_borders(operand, borders);
                          },
                          // Selections of the other kinds run along the edges of the mesh.
                          [](const auto&) {}},
               expression.kind);
}

bool ExpressionEvaluator::ends_at_levels(const SelectionExpression& expression) const {
    return std::visit(
        Overloaded{
            [](const selection::Volume&) { return true; }, [](const selection::DrawnArea&) { return true; },
            [](const selection::Brush&) { return true; }, [](const selection::Painted&) { return true; },
            [&](const selection::Threshold& threshold) { return !on_faces(threshold, expression.at); },
            [](const selection::Lasso& lasso) { return lasso.metric == PathMetric::euclidean; },
            [](const selection::Growth& growth) { return std::holds_alternative<selection::Length>(growth.extent); },
            [&](const selection::Complement& complement) { return ends_at_levels(*complement.of); },
            [&](const selection::EarlierAnnotation& annotation) {
                const Annotation* found = set_.find(annotation.id);
                return found != nullptr && is_free(*found);
            },
            [&](const selection::Component& component) { return component.of != nullptr && ends_at_levels(*component.of); },
            [&](const selection::Combination& combination) {
                return std::any_of(combination.operands.begin(), combination.operands.end(),
                                   [&](const SelectionExpression& operand) { return ends_at_levels(operand); });
            },
            [](const auto&) { return false; }},
        expression.kind);
}

bool ExpressionEvaluator::keeps_to_edges(const selection::Lasso& lasso) const {
    return face_sets_along_edges_ && lasso.metric != PathMetric::euclidean;
}

bool ExpressionEvaluator::keeps_to_edges(const SelectionExpression& expression) const {
    return std::visit(
        Overloaded{[](const selection::FaceList&) { return true; }, [](const selection::Segments&) { return true; },
                   [](const selection::Growth&) { return true; },
                   [&](const selection::Lasso& lasso) { return keeps_to_edges(lasso); }, [](const auto&) { return false; }},
        expression.kind);
}

CutSelection ExpressionEvaluator::cut_selection(const SelectionExpression& expression) const {
    SelectionBorders borders;
    add_borders(expression, borders);
    CutSelection result{cut_along_curves({mesh_, set_}, borders.curves), {}};
    const std::vector<std::int32_t> labels =
        face_labels_.empty() ? std::vector<std::int32_t>() : result.cut.face_values(face_labels_);
    result.faces = ExpressionEvaluator(*this, result.cut, labels, borders).faces(expression);
    return result;
}

std::optional<SelectionLevel> ExpressionEvaluator::distance_level(const selection::Growth& growth,
                                                                  const selection::Length& extent) const {
    const double distance = length(extent);
    const CutSelection inner = cut_selection(*growth.of);
    std::vector<bool> in(inner.cut.mesh.number_of_vertices(), false), out = in;
    for (const Face face : inner.cut.mesh.faces())
        for (const Vertex v : corners(inner.cut.mesh, face)) (inner.faces[face] ? in : out)[v] = true;
    std::vector<Index> border;
    for (std::size_t v = 0; v < in.size(); ++v)
        if (in[v] && out[v]) border.push_back(static_cast<Index>(v));
    if (border.empty()) return std::nullopt;  // all or nothing selected: there is no border to grow from
    SelectionLevel result{distances_within(inner.cut.mesh, border, distance), growth.larger ? distance : -distance, false};
    result.values.resize(inner.cut.old_vertices);
    for (std::size_t v = 0; v < result.values.size(); ++v)
        if (in[v]) result.values[v] = -result.values[v];
    return result;
}

std::optional<SelectionLevel> ExpressionEvaluator::share_level(const SelectionExpression& expression) const {
    const std::vector<bool> chosen = faces(expression);
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
    if (!any) return std::nullopt;
    return SelectionLevel{std::move(part), 0.5, true};
}

const SelectionLevel* ExpressionEvaluator::level_of(const SelectionExpression& expression) const {
    const auto* growth = std::get_if<selection::Growth>(&expression.kind);
    const auto* distance = growth == nullptr ? nullptr : std::get_if<selection::Length>(&growth->extent);
    const bool face_by_face =
        std::visit(Overloaded{[](const selection::Growth&) { return true; }, [](const selection::Segments&) { return true; },
                              [](const selection::LabelledFaces&) { return true; },
                              [&](const selection::Threshold& threshold) { return on_faces(threshold, expression.at); },
                              [](const auto&) { return false; }},
                   expression.kind);
    if (!face_by_face || (face_sets_along_edges_ && distance == nullptr)) return nullptr;
    const auto [entry, fresh] = levels_.try_emplace(expression.at);
    std::optional<SelectionLevel>& known = entry->second;
    if (fresh) known = distance != nullptr ? distance_level(*growth, *distance) : share_level(expression);
    return known ? &*known : nullptr;
}

std::vector<bool> ExpressionEvaluator::faces_at_level(const SelectionLevel& level) const {
    constexpr double infinite = std::numeric_limits<double>::infinity();
    return faces_between(mesh_, {cut_->vertex_values(whole_->mesh_, level.values), false},
                         level.above ? ScalarRange{level.level, infinite} : ScalarRange{-infinite, level.level});
}

std::vector<bool> ExpressionEvaluator::lassoed(const selection::Lasso& lasso, const std::string& at) const {
    std::vector<bool> wall(mesh_.number_of_edges(), false);
    for (const std::size_t leg : borders_->lassos.at(at)) {
        const std::vector<Index>& path = cut_->more_paths[leg];
        for (std::size_t i = 0; i + 1 < path.size(); ++i)
            if (const Halfedge h = find_halfedge(mesh_, Vertex(path[i]), Vertex(path[i + 1])); h.is_valid())
                wall[mesh_.edge(h)] = true;
    }
    const Index seed = face(lasso.seed);
    std::vector<bool> inside(mesh_.number_of_faces(), false), component = inside;
    flood_faces(mesh_, Face(seed), inside, [&](Halfedge h) -> bool { return !wall[mesh_.edge(h)]; });
    flood_faces(mesh_, Face(seed), component);
    if (inside == component)
        fail(at, "the lasso does not close off any part of the surface around the seed",
             "put the seed within it; a lasso that runs through a handle or along a border needs more points");
    return inside;
}

std::vector<std::vector<SurfacePoint>> ExpressionEvaluator::curves(const SelectionExpression& expression) const {
    std::vector<std::vector<SurfacePoint>> result;
    const auto* combination = std::get_if<selection::Combination>(&expression.kind);
    if (combination != nullptr && combination->combine == selection::SetOperator::unite) {
        for (const SelectionExpression& operand : combination->operands)
            for (auto& curve : curves(operand)) result.push_back(std::move(curve));
        return result;
    }
    const auto* path = std::get_if<selection::SurfacePath>(&expression.kind);
    if (path == nullptr) fail(expression.at, "does not select free lines", "use path, or a union of these; or lines along edges");
    std::vector<Index> points = picks(path->points);
    points.erase(std::unique(points.begin(), points.end()), points.end());
    if (path->closed && points.size() > 2 && points.front() != points.back()) points.push_back(points.front());
    if (points.size() < 2)
        fail(expression.at, "a path through fewer than two different vertices", "pick two or more, farther apart");
    std::vector<SurfacePoint> places;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        const auto leg = geodesic_curve(mesh_, vertex_point(points[i]), vertex_point(points[i + 1]));
        if (!leg)
            fail(expression.at, "no path along the surface joins two of its points",
                 "they lie on separate parts of the mesh: pick points on one part");
        for (const SurfacePoint& p : leg->points)
            if (const SurfacePoint place = stored_point(mesh_, p); places.empty() || places.back() != place)
                places.push_back(place);
    }
    result.push_back(std::move(places));
    return result;
}

}  // namespace ostraka

#include "texture/chart.h"

#include "ostraka/core/progress.h"
#include "ostraka/geom/planar.h"
#include "ostraka/mesh/limits.h"
#include "texture/face_clusters.h"
#include "texture/raster.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

namespace ostraka::texture {

namespace {

constexpr double wide_cone = 0.5;   ///< cosine of the angle to the mean normal above which a better axis is searched
constexpr double steep = 0.17;      ///< cosine of the angle between a normal and the axis below which a face is cut off
constexpr int axis_steps = 64;

/// A direction close to the axis of the smallest cone around the normals: the mean normal if all normals are near it, else the
/// direction of the centre of the smallest ball around the normals (Badoiu and Clarkson 2003).
Vector axis_of(const Vector& area, const std::vector<Vector>& normals) {
    Vector axis = unit_vector(area);
    if (normals.empty()) return axis == CGAL::NULL_VECTOR ? Vector(0, 0, 1) : axis;
    if (axis == CGAL::NULL_VECTOR) axis = normals.front();
    const auto farthest = [&](const Vector& direction) {
        const Vector* result = nullptr;
        double least = std::numeric_limits<double>::infinity();
        for (const Vector& normal : normals)
            if (normal * direction < least) least = normal * direction, result = &normal;
        return std::pair(*result, least);
    };
    double best = farthest(axis).second;
    if (best >= wide_cone) return axis;
    Vector result = axis;
    for (int step = 1; step <= axis_steps; ++step) {
        const auto [normal, cosine] = farthest(axis);
        if (cosine > best) best = cosine, result = unit_vector(axis);
        axis = axis + (normal - axis) / (step + 1.0);
    }
    return result;
}

/// Moves the corners into their smallest rectangle.
void fit_rectangle(Chart& chart) {
    const std::vector<Vector2d> hull = convex_hull(chart.corners);
    const Vector2d along = smallest_rectangle(hull).along, across(-along.y(), along.x());
    Vector2d low(std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()), high = -low;
    for (Vector2d& corner : chart.corners) {
        corner = {along.dot(corner), across.dot(corner)};
        low = low.cwiseMin(corner), high = high.cwiseMax(corner);
    }
    for (Vector2d& corner : chart.corners) corner -= low;
    chart.width = high.x() - low.x(), chart.height = high.y() - low.y();
    if (chart.width >= chart.height) return;
    for (Vector2d& corner : chart.corners) corner = {corner.y(), chart.width - corner.x()};
    std::swap(chart.width, chart.height);
}

/// Selects faces of a chart whose projections do not overlap: faces are added in breadth-first order unless a texel centre in
/// them is taken.
class OverlapFreePart {
public:
    OverlapFreePart(const Mesh& mesh, const Chart& chart)
        : mesh_(mesh), chart_(chart), width_(static_cast<std::int64_t>(chart.width) + 2),
          taken_(static_cast<std::size_t>(width_ * (static_cast<std::int64_t>(chart.height) + 2))), added_(chart.faces.size()) {
        for (std::size_t i = 0; i < chart.faces.size(); ++i) place_[chart.faces[i]] = i;
    }

    /// For each face of the chart, whether it was selected.
    const std::vector<bool>& select() {
        std::size_t first = 0;
        while (first + 1 < chart_.faces.size() && is_steep(first)) ++first;
        std::vector<std::size_t> order{first};
        std::vector<bool> reached(chart_.faces.size());
        reached[first] = true;
        CancelCheck check;
        for (std::size_t next = 0; next < order.size(); ++next) {
            check();
            if (next > 0 && (is_steep(order[next]) || overlaps(order[next]))) continue;
            take(order[next]);
            const Face face(chart_.faces[order[next]]);
            for (const Halfedge h : mesh_.halfedges_around_face(mesh_.halfedge(face))) {
                if (mesh_.is_border(mesh_.opposite(h))) continue;
                const auto neighbour = place_.find(mesh_.face(mesh_.opposite(h)));
                if (neighbour == place_.end() || reached[neighbour->second]) continue;
                reached[neighbour->second] = true;
                order.push_back(neighbour->second);
            }
        }
        return added_;
    }

private:
    [[nodiscard]] bool is_steep(std::size_t i) const { return !chart_.lies_too_steep.empty() && chart_.lies_too_steep[i]; }
    [[nodiscard]] GridTriangle triangle(std::size_t i) const {
        GridTriangle result{};
        for (std::size_t k = 0; k < 3; ++k) result[k] = grid_point(chart_.corners[3 * i + k].x(), chart_.corners[3 * i + k].y());
        return result;
    }
    template <class Action>
    void each_texel(std::size_t i, Action&& action) {
        const GridTriangle t = triangle(i);
        if (grid_area(t) < 0) return;  // turned round by rounding only
        for_each_span(t, width_, 0, static_cast<std::int64_t>(chart_.height) + 2,
                      [&](std::int64_t row, std::int64_t begin, std::int64_t end) {
                          for (std::int64_t column = begin; column < end; ++column)
                              action(static_cast<std::size_t>(row * width_ + column));
                      });
    }
    bool overlaps(std::size_t i) {
        bool result = false;
        each_texel(i, [&](std::size_t texel) { result = result || taken_[texel]; });
        return result;
    }
    void take(std::size_t i) {
        added_[i] = true;
        each_texel(i, [&](std::size_t texel) { taken_[texel] = true; });
    }

    const Mesh& mesh_;
    const Chart& chart_;
    std::int64_t width_;
    std::vector<bool> taken_;
    std::vector<bool> added_;
    std::unordered_map<Index, std::size_t> place_;
};

/// The connected pieces of a list of faces, each ascending, ordered by their first faces.
std::vector<std::vector<Index>> connected_pieces(const Mesh& mesh, const std::vector<Index>& faces) {
    std::unordered_map<Index, bool> reached;
    for (const Index face : faces) reached[face] = false;
    std::vector<std::vector<Index>> pieces;
    for (const Index first : faces) {
        if (reached[first]) continue;
        reached[first] = true;
        std::vector<Index> piece{first};
        for (std::size_t i = 0; i < piece.size(); ++i)
            for (const Halfedge h : mesh.halfedges_around_face(mesh.halfedge(Face(piece[i])))) {
                if (mesh.is_border(mesh.opposite(h))) continue;
                const auto neighbour = reached.find(mesh.face(mesh.opposite(h)));
                if (neighbour == reached.end() || neighbour->second) continue;
                neighbour->second = true;
                piece.push_back(neighbour->first);
            }
        std::sort(piece.begin(), piece.end());
        pieces.push_back(std::move(piece));
    }
    return pieces;
}

/// Keeps the selected faces of a chart with their projection.
Chart selected_part(const Chart& chart, const std::vector<bool>& selected) {
    Chart result;
    result.largest_stretch = chart.largest_stretch;
    for (std::size_t i = 0; i < chart.faces.size(); ++i) {
        if (!selected[i]) continue;
        result.faces.push_back(chart.faces[i]);
        for (std::size_t k = 0; k < 3; ++k) result.corners.push_back(chart.corners[3 * i + k]);
    }
    fit_rectangle(result);
    return result;
}

}  // namespace

Chart flattened(const Mesh& mesh, std::vector<Index> faces, double negligible_width) {
    Chart chart;
    Vector area = CGAL::NULL_VECTOR;
    std::vector<Vector> normals;
    std::vector<std::pair<std::size_t, Vector>> counted;  // place of the face, normal
    double surface = 0;
    for (std::size_t i = 0; i < faces.size(); ++i) {
        const Vector vector = area_vector(mesh, Face(faces[i]));
        area = area + vector;
        surface += std::sqrt(vector.squared_length());
        if (!(smallest_height(mesh, Face(faces[i])) > negligible_width)) continue;
        normals.push_back(unit_vector(vector));
        counted.emplace_back(i, normals.back());
    }
    const Vector axis = axis_of(area, normals);
    const Vector other = std::abs(axis.x()) < 0.6 ? Vector(1, 0, 0) : Vector(0, 1, 0);
    const Vector first = unit_vector(CGAL::cross_product(other, axis)), second = CGAL::cross_product(axis, first);
    const Point origin = mesh.point(corners(mesh, Face(faces.front()))[0]);
    chart.corners.reserve(3 * faces.size());
    for (const Index face : faces)
        for (const Vertex vertex : corners(mesh, Face(face))) {
            const Vector from_origin = mesh.point(vertex) - origin;
            chart.corners.emplace_back(from_origin * first, from_origin * second);
        }
    const double projected = area * axis;
    const double factor = projected > 0 ? std::sqrt(std::clamp(surface / projected, 1.0, 1 / steep)) : 1;
    double least = 1;
    for (const auto& [place, normal] : counted) {
        const double cosine = normal * axis;
        if (cosine < steep && faces.size() > 1) {
            chart.lies_too_steep.resize(faces.size());
            chart.lies_too_steep[place] = true;
        } else {
            least = std::min(least, cosine);
        }
    }
    chart.faces = std::move(faces);
    chart.largest_stretch = std::max(1.0, 1 / (factor * std::max(least, steep)));
    for (Vector2d& corner : chart.corners) corner *= factor;
    fit_rectangle(chart);
    return chart;
}

void scale(Chart& chart, double factor) {
    for (Vector2d& corner : chart.corners) corner *= factor;
    chart.width *= factor, chart.height *= factor;
}

std::vector<Chart> without_overlaps(const Mesh& mesh, Chart chart, double negligible_width, double texels_per_length) {
    std::vector<Chart> charts, open;
    open.push_back(std::move(chart));
    while (!open.empty()) {
        const Chart next = std::move(open.back());
        open.pop_back();
        const std::vector<bool> selected = OverlapFreePart(mesh, next).select();
        std::vector<Index> rest;
        for (std::size_t i = 0; i < next.faces.size(); ++i)
            if (!selected[i]) rest.push_back(next.faces[i]);
        if (rest.empty()) {
            charts.push_back(next);
            continue;
        }
        charts.push_back(selected_part(next, selected));
        std::vector<std::vector<Index>> pieces = connected_pieces(mesh, rest);
        for (std::size_t i = pieces.size(); i-- > 0;) {
            open.push_back(flattened(mesh, std::move(pieces[i]), negligible_width));
            scale(open.back(), texels_per_length);
        }
    }
    return charts;
}

}  // namespace ostraka::texture

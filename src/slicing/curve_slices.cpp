// Planes across a curve, and the component of each that belongs to the curve.
#include "slicing/curve_slices.h"

#include "slicing/contour_classification.h"
#include "slicing/joining.h"
#include "slicing/plane_search.h"

#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/mesh/limits.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

/// Point at an arc length along the curve, clamped to its ends.
class Walk {
public:
    explicit Walk(const std::vector<Point>& curve) : curve_(curve), lengths_{0} {
        for (std::size_t i = 1; i < curve.size(); ++i)
            lengths_.push_back(lengths_.back() + std::sqrt((curve[i] - curve[i - 1]).squared_length()));
    }
    [[nodiscard]] double length() const { return lengths_.back(); }
    [[nodiscard]] Point at(double length) const {
        if (length <= 0) return curve_.front();
        const auto next = std::upper_bound(lengths_.begin(), lengths_.end(), length);
        if (next == lengths_.end()) return curve_.back();
        const auto i = static_cast<std::size_t>(next - lengths_.begin());
        return curve_[i - 1] + (length - lengths_[i - 1]) / (lengths_[i] - lengths_[i - 1]) * (curve_[i] - curve_[i - 1]);
    }

private:
    const std::vector<Point>& curve_;
    std::vector<double> lengths_;
};

/// Distance of the origin from a contour; 0 inside a closed contour.
double distance_from(const Contour& contour) {
    double minimum = std::numeric_limits<double>::infinity();
    bool inside = false;
    for (std::size_t i = 0; i < contour.faces.size(); ++i) {
        const Vector2d &a = contour.points[i], &b = contour.points[(i + 1) % contour.points.size()], along = b - a;
        const double t = std::clamp(-along.dot(a) / along.squaredNorm(), 0.0, 1.0);
        minimum = std::min(minimum, (a + t * along).norm());
        if ((a.y() <= 0) != (b.y() <= 0) && a.x() - a.y() / along.y() * along.x() < 0) inside = !inside;
    }
    return contour.closed && inside ? 0 : minimum;
}

Slice nearest_part(const Slice& slice) {
    double minimum = std::numeric_limits<double>::infinity();
    Slice nearest{slice.height, {}, {}};
    for (const Slice& component : components(slice))
        // Components are sorted by decreasing size.
        if (const double d = distance_from(component.contours[0]); d <= minimum) minimum = d, nearest = component;
    for (const auto& contour : slice.contours) {
        if (contour.closed) continue;
        if (const double d = distance_from(contour); d < minimum) minimum = d, nearest.contours = {contour};
    }
    nearest.completeness = detail::completeness(nearest.contours);
    if (nearest.completeness.crossing > 0) nearest.completeness.doubtful = slice.completeness.doubtful;
    return nearest;
}

/// Like `slice_mesh` at height 0.
std::vector<Contour> cut(const Mesh& mesh, const detail::PlaneSearch& search, const SliceFrame& frame, double tolerance) {
    const auto height = [&](Vertex v) { return frame.height(mesh.point(v)); };
    std::vector<Index> faces = search.near(frame, 2 * tolerance);
    const auto reaches_below = [&](Index f) {
        const auto c = corners(mesh, Face(f));
        return std::any_of(c.begin(), c.end(), [&](Vertex v) { return height(v) < -tolerance; });
    };
    // On the lowest plane, ON counts as below.
    const bool base = std::none_of(faces.begin(), faces.end(), reaches_below) && !(search.lowest(frame) < -tolerance);
    const double threshold = base ? std::nextafter(tolerance, std::numeric_limits<double>::infinity()) : -tolerance;
    const auto above = [&](Vertex v) { return height(v) >= threshold; };
    std::erase_if(faces, [&](Index f) {
        const auto c = corners(mesh, Face(f));
        return above(c[0]) == above(c[1]) && above(c[1]) == above(c[2]);
    });
    return detail::join(mesh, faces.begin(), faces.end(), above,
                        [&](Halfedge h) { return detail::crossing(mesh, frame, h, 0, tolerance, height); });
}

}  // namespace

CurveSlices slice_along(const Mesh& mesh, const std::vector<Point>& curve, int count, const std::vector<Index>& faces) {
    detail::check_faces(mesh, faces);
    for (const Point& p : curve)
        if (!is_place(p)) fail_usage("a point of the curve to slice along is not finite or too large", "give finite coordinates");
    if (count < 1 || count > 1000000) fail_usage(fmt::format("the number of slices is {}", count), "use 1 to a million");
    if (curve.size() < 2) fail_usage("the curve to slice along has fewer than two points", "give a longer curve");
    const Walk walk(curve);
    CurveSlices result;
    result.length = walk.length();
    if (!(result.length > 0)) fail_usage("the curve to slice along has no length", "give a longer curve");
    const double piece = result.length / count;
    for (int i = 0; i < count; ++i) {
        const double arc_length = (i + 0.5) * piece;
        const Vector tangent = walk.at(arc_length + piece) - walk.at(arc_length - piece);
        SliceFrame frame =
            slice_frame(walk.at(arc_length), tangent == CGAL::NULL_VECTOR ? curve.back() - curve.front() : tangent);
        if (!result.frames.empty()) {
            const Vector previous_u = result.frames.back().u,
                         projected_u = previous_u - (previous_u * frame.normal) * frame.normal;
            if (projected_u.squared_length() > 1e-6) {
                frame.u = unit_vector(projected_u);
                frame.v = CGAL::cross_product(frame.normal, frame.u);
            }
        }
        result.frames.push_back(frame);
        result.slices.push_back({arc_length, {}, {}});
    }
    const detail::PlaneSearch search(mesh, faces);
    const double tolerance = on_plane_share * box_diagonal(mesh);
    parallel_for(result.slices.size(), 1,
                 [&](std::size_t i) { result.slices[i].contours = cut(mesh, search, result.frames[i], tolerance); });
    result.reversed = detail::classify_contours(result.slices, mesh, faces.empty());
    parallel_for(result.slices.size(), 1, [&](std::size_t i) { result.slices[i] = nearest_part(result.slices[i]); });
    return result;
}

}  // namespace ostraka

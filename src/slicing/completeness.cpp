// Completeness of the outline of a slice.
#include "slicing/contour_classification.h"

#include "ostraka/core/angles.h"
#include "ostraka/geom/point_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ostraka::detail {

void add_pieces(PlaneSegments& segments, const Contour& contour) {
    for (std::size_t i = 0; i < contour.faces.size(); ++i)
        segments.emplace_back(contour.points[i], contour.points[(i + 1) % contour.points.size()]);
}

namespace {

/// Lower bound of the length that joins the ends of open contours: from each end to the nearest start.
double min_gap_length(const std::vector<Contour>& contours) {
    std::vector<Point> starts;
    for (const Contour& contour : contours)
        if (!contour.closed) starts.emplace_back(contour.points.front().x(), contour.points.front().y(), 0);
    if (starts.empty()) return 0;
    const PointTree tree(starts);
    double sum = 0;
    for (const Contour& contour : contours)
        if (!contour.closed) sum += std::sqrt(tree.nearest({contour.points.back().x(), contour.points.back().y(), 0}).squared);
    return sum;
}

}  // namespace

OpenArc open_arc(const std::vector<Contour>& contours) {
    PlaneSegments outer, inner;
    double closed = 0, length_outer = 0, length_inner = 0;
    for (const Contour& contour : contours) {
        if (contour.closed) {
            if (!contour.hole) closed = std::max(closed, contour.length);
            continue;
        }
        PlaneSegments pieces;
        add_pieces(pieces, contour);
        const Circle circle = fit_circle(pieces);
        if (!(circle.radius > 0)) continue;
        double winding = 0;
        for (const auto& [a, b] : pieces) {
            const Vector2d p = a - circle.centre, q = b - circle.centre;
            winding += p.x() * q.y() - p.y() * q.x();
        }
        PlaneSegments& side = winding > 0 ? outer : inner;
        (winding > 0 ? length_outer : length_inner) += contour.length;
        side.insert(side.end(), pieces.begin(), pieces.end());
    }
    const bool outside = !outer.empty();
    if (!((outside ? length_outer : length_inner) > closed)) return {};
    return {fit_arc(outside ? outer : inner), outside};
}

Completeness completeness(const std::vector<Contour>& contours) {
    Completeness result;
    double length = 0, closed = 0;
    for (const auto& contour : contours) {
        length += contour.length;
        if (contour.closed) closed += contour.length;
        result.crossing += contour.crosses ? 1 : 0, result.reversed_contours += contour.reversed ? 1 : 0;
    }
    if (contours.empty() || contours.back().closed) return result;
    result.closed_share = closed / length;
    result.share_at_most = length / (length + min_gap_length(contours));
    result.share = result.share_low = result.share_high = std::numeric_limits<double>::quiet_NaN();
    const ArcFit arc = open_arc(contours).fit;
    if (!arc.is_round()) return result;
    constexpr double turn = 2 * pi;
    result.share = arc.angle / turn;
    result.share_low = arc.angles().first / turn, result.share_high = arc.angles().second / turn;
    return result;
}

}  // namespace ostraka::detail

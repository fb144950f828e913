// Joins face segments to contours.
#include "slicing/joining.h"

#include <algorithm>

namespace ostraka::detail {

namespace {

/// Removes segments without length and segments traversed back and forth. Returns false if nothing is left.
bool clean(Contour& contour) {
    const std::vector<Vector2d> raw = std::move(contour.points);
    const std::vector<Index> faces = std::move(contour.faces);
    std::vector<Vector2d> points{raw.front()};
    std::vector<Index> kept_faces;
    for (std::size_t i = 0; i < faces.size(); ++i) {
        const Vector2d& next = raw[(i + 1) % raw.size()];
        if (next == points.back()) continue;
        if (points.size() >= 2 && points[points.size() - 2] == next) {
            points.pop_back(), kept_faces.pop_back();
            continue;
        }
        points.push_back(next), kept_faces.push_back(faces[i]);
    }
    std::size_t begin = 0, end = points.size();
    if (contour.closed) {
        // The last point repeats the first: it represents the segment that closes the contour.
        --end;
        while (end - begin >= 3 && points[begin + 1] == points[end - 1]) ++begin, --end;
        if (end - begin < 3) return false;
    }
    if (end - begin < 2) return false;
    contour.points.assign(points.begin() + static_cast<long>(begin), points.begin() + static_cast<long>(end));
    contour.faces.assign(kept_faces.begin() + static_cast<long>(begin),
                         kept_faces.begin() + static_cast<long>(contour.closed ? end : end - 1));
    return true;
}

void measure(Contour& contour) {
    const auto& points = contour.points;
    double twice = 0;
    for (std::size_t i = 0; i < contour.faces.size(); ++i) {
        const Vector2d a = points[i] - points[0], b = points[(i + 1) % points.size()] - points[0];
        contour.length += (b - a).norm();
        twice += a.x() * b.y() - a.y() * b.x();
    }
    if (contour.closed) contour.area = twice / 2, contour.hole = contour.area < 0;
    else contour.gap = (points.back() - points.front()).norm();
}

}  // namespace

void add_contour(std::vector<Contour>& contours, Contour contour) {
    if (!clean(contour)) return;
    measure(contour);
    contours.push_back(std::move(contour));
}

void turn_around(Contour& contour) {
    std::reverse(contour.points.begin(), contour.points.end());
    std::reverse(contour.faces.begin(), contour.faces.end());
    if (contour.closed) std::rotate(contour.faces.begin(), contour.faces.begin() + 1, contour.faces.end());
    contour.area = -contour.area;
    contour.hole = contour.closed && contour.area < 0;
}

}  // namespace ostraka::detail

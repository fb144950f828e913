#include "transfer/curve_thinning.h"

#include "ostraka/core/progress.h"
#include "ostraka/geom/shortest_path.h"

#include <algorithm>
#include <map>
#include <set>

namespace ostraka {

namespace {

using Places = std::vector<SurfacePoint>;

/// Appends the places strictly between two places of a curve that cannot be dropped (Ramer 1972, Douglas and Peucker 1973).
void keep_needed(const Mesh& mesh, double tolerance, const Places& curve, std::size_t first, std::size_t last, Places& kept) {
    Places run(curve.begin() + static_cast<std::ptrdiff_t>(first), curve.begin() + static_cast<std::ptrdiff_t>(last) + 1);
    const bool turned = run.back() < run.front();
    if (turned) std::reverse(run.begin(), run.end());
    const std::vector<Point> points = positions(mesh, run);
    std::vector<bool> keep(run.size(), false);
    std::vector<std::pair<std::size_t, std::size_t>> stack{{0, run.size() - 1}};
    CancelCheck check;
    while (!stack.empty()) {
        check();
        const auto [a, b] = stack.back();
        stack.pop_back();
        std::size_t farthest = a;
        double most = tolerance;
        for (std::size_t k = a + 1; k < b; ++k)
            if (const double off = distance_to_segment(points[k], points[a], points[b]); off > most) most = off, farthest = k;
        if (farthest == a) continue;
        keep[farthest] = true;
        stack.emplace_back(a, farthest);
        stack.emplace_back(farthest, b);
    }
    Places between;
    for (std::size_t k = 1; k + 1 < run.size(); ++k)
        if (keep[k]) between.push_back(run[k]);
    if (turned) std::reverse(between.begin(), between.end());
    kept.insert(kept.end(), between.begin(), between.end());
}

}  // namespace

void thin_out(const Mesh& mesh, double tolerance, std::vector<ProjectedAnnotation>& projected) {
    std::map<SurfacePoint, std::set<SurfacePoint>> neighbours;
    for (const ProjectedAnnotation& one : projected)
        for (const Places& curve : one.annotation.curves) {
            for (std::size_t i = 1; i < curve.size(); ++i) {
                if (curve[i].is_in_face()) neighbours[curve[i]].insert(curve[i - 1]);
                if (curve[i - 1].is_in_face()) neighbours[curve[i - 1]].insert(curve[i]);
            }
        }
    const auto may_go = [&](const SurfacePoint& place) { return place.is_in_face() && neighbours.at(place).size() == 2; };
    for (ProjectedAnnotation& one : projected)
        for (Places& curve : one.annotation.curves) {
            Places kept;
            for (std::size_t i = 0; i < curve.size();) {
                kept.push_back(curve[i]);
                std::size_t end = i + 1;
                while (end + 1 < curve.size() && may_go(curve[end])) ++end;
                if (end < curve.size() && end > i + 1) keep_needed(mesh, tolerance, curve, i, end, kept);
                i = end;
            }
            if (kept.size() >= 4 || kept.size() == curve.size() || kept.front() != kept.back()) curve = std::move(kept);
        }
}

}  // namespace ostraka

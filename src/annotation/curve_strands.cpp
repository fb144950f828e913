#include "ostraka/annotation/curve_strands.h"

#include <algorithm>
#include <map>
#include <set>

namespace ostraka {

namespace {

using Places = std::vector<SurfacePoint>;

std::set<SurfacePoint> find_junctions(const Mesh& mesh, const std::vector<std::vector<Places>>& curves,
                                      const std::vector<bool>& chosen) {
    std::map<SurfacePoint, std::set<SurfacePoint>> neighbours;
    std::set<SurfacePoint> junctions;
    for (std::size_t a = 0; a < curves.size(); ++a) {
        if (!chosen[a]) continue;
        for (const Places& curve : curves[a]) {
            for (std::size_t i = 1; i < curve.size(); ++i) {
                neighbours[curve[i - 1]].insert(curve[i]);
                neighbours[curve[i]].insert(curve[i - 1]);
            }
            if (!curve.empty() && curve.front() != curve.back()) junctions.insert({curve.front(), curve.back()});
        }
    }
    for (const auto& [place, others] : neighbours) {
        const bool border = place.is_vertex() && mesh.is_border(place.vertex());
        if (others.size() != 2 || border) junctions.insert(place);
    }
    return junctions;
}

/// Rotates a closed curve to start at its first junction; without junctions, at its smallest place, so that the start does not
/// depend on the annotation.
Places turned_to_junction(const Places& curve, const std::set<SurfacePoint>& junctions) {
    if (curve.front() != curve.back()) return curve;
    Places turned(curve.begin(), curve.end() - 1);
    auto start = std::find_if(turned.begin(), turned.end(), [&](const SurfacePoint& p) { return junctions.contains(p); });
    if (start == turned.end()) start = std::min_element(turned.begin(), turned.end());
    std::rotate(turned.begin(), start, turned.end());
    turned.push_back(turned.front());
    return turned;
}

}  // namespace

std::vector<std::vector<std::vector<StrandUse>>> separate_nonmanifold(const Mesh& mesh,
                                                                      const std::vector<std::vector<Places>>& curves,
                                                                      const std::vector<bool>& chosen,
                                                                      std::vector<CurveStrand>& strands) {
    const std::set<SurfacePoint> junctions = find_junctions(mesh, curves, chosen);
    std::map<Places, std::size_t> known;
    const auto use_of = [&](Places piece) {
        Places back(piece.rbegin(), piece.rend());
        const bool backwards = back < piece;
        if (backwards) piece.swap(back);
        const auto [entry, fresh] = known.try_emplace(std::move(piece), strands.size());
        if (fresh) {
            const Places& places = entry->first;
            strands.push_back({places, places.front() == places.back() && !junctions.contains(places.front())});
        }
        return StrandUse{entry->second, backwards};
    };
    std::vector<std::vector<std::vector<StrandUse>>> uses(curves.size());
    for (std::size_t a = 0; a < curves.size(); ++a) {
        if (!chosen[a]) continue;
        for (const Places& curve : curves[a]) {
            auto& own = uses[a].emplace_back();
            if (curve.size() < 2) continue;
            const Places turned = turned_to_junction(curve, junctions);
            Places piece{turned.front()};
            for (std::size_t i = 1; i < turned.size(); ++i) {
                piece.push_back(turned[i]);
                if (i + 1 < turned.size() && !junctions.contains(turned[i])) continue;
                own.push_back(use_of(std::move(piece)));
                piece = {turned[i]};
            }
        }
    }
    return uses;
}

}  // namespace ostraka

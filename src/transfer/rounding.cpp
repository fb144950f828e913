#include "rounding.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace ostraka {

namespace {

double edge_length(const Mesh& mesh, Halfedge h) {
    return std::sqrt(CGAL::squared_distance(mesh.point(mesh.source(h)), mesh.point(mesh.target(h))));
}

bool is_selected(const Mesh& mesh, const std::vector<bool>& selected, Halfedge h) {
    return !mesh.is_border(h) && selected[mesh.face(h)];
}

/// The change of perimeter if the face changed sides, or nothing if that would change the topology of the region or of the rest:
/// the face must have one or two outline edges; with one, the corner opposite must lie off the outline. Faces on the border stay.
bool can_flip(const Mesh& mesh, const std::vector<bool>& selected, Face f, double& perimeter_change) {
    int outline_edges = 0;
    perimeter_change = 0;
    Halfedge single = Mesh::null_halfedge();
    for (const Halfedge h : CGAL::halfedges_around_face(mesh.halfedge(f), mesh)) {
        if (mesh.is_border(mesh.opposite(h))) return false;
        const bool outline = is_selected(mesh, selected, mesh.opposite(h)) != selected[f];
        perimeter_change += outline ? -edge_length(mesh, h) : edge_length(mesh, h);
        outline_edges += outline ? 1 : 0;
        if (outline) single = h;
    }
    if (outline_edges == 0 || outline_edges == 3) return false;
    Vertex corner;
    if (outline_edges == 1) {
        corner = mesh.target(mesh.next(single));
    } else {
        // The corner between the two outline edges must not touch the outline elsewhere.
        for (const Halfedge h : CGAL::halfedges_around_face(mesh.halfedge(f), mesh))
            if (is_selected(mesh, selected, mesh.opposite(h)) == selected[f]) corner = mesh.target(mesh.next(h));
    }
    int changes = 0;
    for (const Halfedge h : CGAL::halfedges_around_target(corner, mesh))
        changes += is_selected(mesh, selected, h) != is_selected(mesh, selected, mesh.opposite(h)) ? 1 : 0;
    return outline_edges == 1 ? changes == 0 : changes == 2;
}

}  // namespace

void round_region(const Mesh& mesh, std::vector<bool>& selected, const std::vector<std::pair<Index, double>>& shares,
                  const RoundingGoal& goal, bool balance) {
    double change = 0;
    if (!balance || !(goal.area > 0) || !(goal.perimeter > 0)) {
        // A flip may open the way for its neighbours.
        for (int pass = 0; pass < 8; ++pass) {
            bool any = false;
            for (const auto& [f, share] : shares)
                if (selected[f] != (share > 0.5) && share != 0.5 && can_flip(mesh, selected, Face(f), change)) {
                    selected[f] = !selected[f];
                    any = true;
                }
            if (!any) break;
        }
        return;
    }
    double area = 0, perimeter = 0;
    for (const Face f : mesh.faces()) {
        if (!selected[f]) continue;
        area += face_area(mesh, f);
        for (const Halfedge h : CGAL::halfedges_around_face(mesh.halfedge(f), mesh))
            if (!is_selected(mesh, selected, mesh.opposite(h))) perimeter += edge_length(mesh, h);
    }
    const double wanted = goal.coarser ? std::min(goal.perimeter, perimeter) : goal.perimeter;
    // What a flip of each face would change; only faces around the last flip need to be asked again.
    struct Move {
        Index face;
        double area, wrong, perimeter;
        bool possible;
    };
    std::vector<Move> moves;
    std::unordered_map<Index, std::size_t> position;
    const auto update = [&](Move& move, double share) {
        const double face = face_area(mesh, Face(move.face));
        move.area = selected[move.face] ? -face : face;
        move.wrong = face * (selected[move.face] ? 2 * share - 1 : 1 - 2 * share);
        move.possible = can_flip(mesh, selected, Face(move.face), move.perimeter);
    };
    for (const auto& [f, share] : shares) {
        position[f] = moves.size();
        moves.push_back({f, 0, 0, 0, false});
        update(moves.back(), share);
    }
    const auto misfit = [&](double a, double p) {
        return 20 * std::abs(a / goal.area - 1) + std::abs(p - wanted) / goal.perimeter;
    };
    for (std::size_t step = 0; step < 2 * moves.size(); ++step) {
        const double now = misfit(area, perimeter);
        double best_gain = 1e-12;
        const Move* best = nullptr;
        for (const Move& move : moves) {
            if (!move.possible) continue;
            const double gain =
                now - misfit(area + move.area, perimeter + move.perimeter) - 6 * move.wrong / (goal.edge * goal.perimeter);
            if (gain > best_gain) {
                best_gain = gain;
                best = &move;
            }
        }
        if (best == nullptr) break;
        const Index f = best->face;
        area += best->area;
        perimeter += best->perimeter;
        selected[f] = !selected[f];
        for (const Vertex v : corners(mesh, Face(f)))
            for (const Halfedge h : CGAL::halfedges_around_target(v, mesh)) {
                if (mesh.is_border(h)) continue;
                if (const auto found = position.find(mesh.face(h)); found != position.end())
                    update(moves[found->second], shares[found->second].second);
            }
    }
}

void round_shared(const Mesh& mesh, std::vector<std::vector<bool>>& selected, std::vector<SharedFace> faces) {
    std::sort(faces.begin(), faces.end(), [](const SharedFace& a, const SharedFace& b) {
        return std::make_pair(a.face, a.region) < std::make_pair(b.face, b.region);
    });
    double change = 0;
    for (int pass = 0; pass < 8; ++pass) {
        bool any = false;
        for (auto first = faces.begin(); first != faces.end();) {
            const auto last = std::find_if(first, faces.end(), [&](const SharedFace& x) { return x.face != first->face; });
            const Index f = first->face;
            const auto taker = std::find_if(first, last, [](const SharedFace& x) { return x.share > 0.5; });
            std::vector<std::size_t> owners;
            for (auto x = first; x != last; ++x)
                if (x->share < 0.5 && selected[x->region][f]) owners.push_back(x->region);
            first = last;
            if (taker == last || selected[taker->region][f] || owners.size() > 1) continue;
            if (!can_flip(mesh, selected[taker->region], Face(f), change)) continue;
            if (!owners.empty() && !can_flip(mesh, selected[owners.front()], Face(f), change)) continue;
            selected[taker->region][f] = true;
            if (!owners.empty()) selected[owners.front()][f] = false;
            any = true;
        }
        if (!any) break;
    }
}

}  // namespace ostraka

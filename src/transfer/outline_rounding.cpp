#include "outline_rounding.h"

#include "scores.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <unordered_map>

namespace ostraka {

namespace {

/// What the rounding aims at.
struct RoundingGoal {
    double area = 0;       ///< of the source region
    double perimeter = 0;  ///< of the source region's outline
    double edge = 0;       ///< typical edge length of the target
    bool coarser = false;  ///< the target cannot show the outline's detail: a shorter outline is as good, and no teeth are added
};

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

/// Moves single faces across the outline of `selected`, never changing the topology of the region. `shares` tells of the faces
/// near the true outline which share of them lies inside; only those move. `balance` off: each goes to the side that holds most
/// of it. On: one face at a time, that one changes sides which lowers
///     20 |A / A_source - 1| + |P / P_source - 1| + 6 W / (h P_source)
/// most, until none does. W is the area on the wrong side: faces cut in halves may change sides at no cost, and they are enough
/// to meet area A and perimeter P. O(k m) for k faces and m moves, both small beside the mesh.
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

/// The same along outlines that regions share: a face goes over to the region that holds most of it, and the one that had it
/// gives it up in the same move, so that regions that partition the surface still do. Topologies stay. `faces` need not be
/// sorted.
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

}  // namespace

OutlineRounding::OutlineRounding(const Mesh& source, const AnnotationSet& set, const Mesh& target,
                                 const std::vector<std::vector<SourcePath>>& vertex_paths, PathTracer& tracer)
    : source_(source),
      set_(set),
      target_(target),
      tracer_(tracer),
      source_edge_(mean_edge_length(source)),
      steps_(vertex_paths.size()) {
    for (std::size_t i = 0; i < vertex_paths.size(); ++i) {
        if (set.annotations[i].type != AnnotationType::region) continue;
        TransferScore ignored;  // the same places were settled, and counted, for the paths
        for (const SourcePath& vertex_path : vertex_paths[i])
            for (const PathTracer::Step& step : tracer.trace_curves(vertex_path, ignored)) steps_[i].push_back(step);
    }
    users_.assign(tracer.curves().size(), 0);
    for (const auto& steps : steps_)
        for (const PathTracer::Step& step : steps) ++users_[step.curve];
}

void OutlineRounding::round(std::size_t region, std::vector<bool>& selected, double edge, bool balance) {
    if (steps_[region].empty()) return;
    std::vector<SurfaceCurve> curves;
    std::set<Index> shared;  // vertices along outlines that other regions have in common with this one
    for (const PathTracer::Step& step : steps_[region]) {
        const SurfaceCurve& curve = tracer_.curves()[step.curve];
        if (users_[step.curve] > 1)
            for (const Index f : curve.faces)
                for (const Vertex v : corners(target_, Face(f))) shared.insert(v);
        curves.push_back(curve);
        if (step.backwards) {
            std::reverse(curves.back().nodes.begin(), curves.back().nodes.end());
            std::reverse(curves.back().faces.begin(), curves.back().faces.end());
        }
    }
    std::vector<std::pair<Index, double>> shares = left_shares(target_, curves, 2);
    const auto is_shared = [&](const std::pair<Index, double>& entry) {
        const auto vertices = corners(target_, Face(entry.first));
        return std::any_of(vertices.begin(), vertices.end(), [&](Vertex v) { return shared.count(v) > 0; });
    };
    for (const auto& entry : shares)
        if (is_shared(entry)) put_aside_.push_back({entry.first, region, entry.second});
    shares.erase(std::remove_if(shares.begin(), shares.end(), is_shared), shares.end());
    const Annotation& annotation = set_.annotations[region];
    RoundingGoal goal;
    goal.area = area_of(source_, annotation.faces);
    goal.perimeter = length_of(segments_of(source_, annotation));
    goal.edge = edge;
    goal.coarser = edge > 1.5 * source_edge_;
    round_region(target_, selected, shares, goal, balance);
}

void OutlineRounding::round_shared_outlines(std::vector<std::vector<bool>>& selected) {
    round_shared(target_, selected, std::move(put_aside_));
}

}  // namespace ostraka

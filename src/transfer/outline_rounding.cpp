#include "transfer/outline_rounding.h"

#include "ostraka/core/progress.h"
#include "transfer/scores.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <unordered_map>

namespace ostraka {

namespace {

/// Target values of the rounding.
struct RoundingGoal {
    double area = 0;       ///< of the source region
    double perimeter = 0;  ///< of the source region's outline
    double edge = 0;       ///< typical edge length of the target
    bool coarser = false;  ///< the target cannot resolve the detail: a shorter outline is accepted, no teeth are added
};

bool is_selected(const Mesh& mesh, const std::vector<bool>& selected, Halfedge h) {
    return !mesh.is_border(h) && selected[mesh.face(h)];
}

/// Whether a face can change sides without changing the topology of the region or its complement: the face must have one or two
/// outline edges; with one, the opposite corner must not lie on the outline. Faces on the border cannot. `perimeter_change`
/// receives the change of perimeter.
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

/// The changes caused by flipping each face near the exact outline. Flips that preserve the topology are stored contiguously
/// for a fast search for the best one.
class Moves {
public:
    Moves(const Mesh& mesh, const std::vector<bool>& selected, const std::vector<std::pair<Index, double>>& shares)
        : mesh_(mesh), selected_(selected), shares_(shares), slot_(shares.size(), none) {
        for (std::size_t i = 0; i < shares.size(); ++i) {
            position_[shares[i].first] = i;
            update(i);
        }
    }

    struct Move {
        Index face;
        double area, perimeter;
    };
    /// The flip that lowers 20 |A / A_goal - 1| + |P - P_wanted| / P_goal + 6 W / (h P_goal) most, the first of equal ones;
    /// nullopt if none does.
    [[nodiscard]] std::optional<Move> best(double area, double perimeter, double wanted, const RoundingGoal& goal) const {
        const double by_area = 20 / goal.area, by_perimeter = 1 / goal.perimeter, by_wrong = 6 / (goal.edge * goal.perimeter);
        const double too_large = area - goal.area, too_long = perimeter - wanted;
        const double now = by_area * std::abs(too_large) + by_perimeter * std::abs(too_long);
        double most = 1e-12;
        std::size_t best = none;
        for (std::size_t k = 0; k < owner_.size(); ++k) {
            const double gain = now - by_area * std::abs(too_large + area_[k]) -
                                by_perimeter * std::abs(too_long + perimeter_[k]) - by_wrong * wrong_[k];
            if (gain < most || (gain == most && (best == none || owner_[k] > owner_[best]))) continue;
            most = gain;
            best = k;
        }
        if (best == none) return {};
        return Move{shares_[owner_[best]].first, area_[best], perimeter_[best]};
    }

    /// Updates the changes of the faces around a face that has been flipped.
    void update_around(Index face) {
        for (const Vertex v : corners(mesh_, Face(face)))
            for (const Halfedge h : CGAL::halfedges_around_target(v, mesh_)) {
                if (mesh_.is_border(h)) continue;
                if (const auto found = position_.find(mesh_.face(h)); found != position_.end()) update(found->second);
            }
    }

    [[nodiscard]] std::size_t size() const { return shares_.size(); }

private:
    static constexpr std::size_t none = static_cast<std::size_t>(-1);

    void update(std::size_t i) {
        const auto& [face, share] = shares_[i];
        double perimeter = 0;
        if (!can_flip(mesh_, selected_, Face(face), perimeter)) {
            remove(i);
            return;
        }
        if (slot_[i] == none) {
            slot_[i] = owner_.size();
            owner_.push_back(i);
            for (auto* list : {&area_, &perimeter_, &wrong_}) list->push_back(0);
        }
        const double area = face_area(mesh_, Face(face));
        area_[slot_[i]] = selected_[face] ? -area : area;
        perimeter_[slot_[i]] = perimeter;
        wrong_[slot_[i]] = area * (selected_[face] ? 2 * share - 1 : 1 - 2 * share);
    }

    void remove(std::size_t i) {
        const std::size_t slot = slot_[i];
        if (slot == none) return;
        slot_[owner_.back()] = slot;
        slot_[i] = none;
        owner_[slot] = owner_.back();
        owner_.pop_back();
        for (auto* list : {&area_, &perimeter_, &wrong_}) {
            (*list)[slot] = list->back();
            list->pop_back();
        }
    }

    const Mesh& mesh_;
    const std::vector<bool>& selected_;
    const std::vector<std::pair<Index, double>>& shares_;
    std::unordered_map<Index, std::size_t> position_;  ///< index in `shares` of a face
    std::vector<std::size_t> slot_;                    ///< slot of each entry of `shares` in the lists below, or none
    std::vector<std::size_t> owner_;                   ///< by slot: index in `shares`
    std::vector<double> area_, perimeter_, wrong_;     ///< by slot: the changes
};

/// Without a goal: assigns each face to the side that covers most of it.
void round_by_share(const Mesh& mesh, std::vector<bool>& selected, const std::vector<std::pair<Index, double>>& shares) {
    // A flip may make flips of neighbours possible.
    double change = 0;
    for (int pass = 0; pass < 8; ++pass) {
        check_cancelled();
        bool any = false;
        for (const auto& [f, share] : shares)
            if (selected[f] != (share > 0.5) && share != 0.5 && can_flip(mesh, selected, Face(f), change)) {
                selected[f] = !selected[f];
                any = true;
            }
        if (!any) break;
    }
}

/// Flips single faces across the outline of `selected` without changing the topology of the region. `shares`: fraction inside
/// of each face near the exact outline; only these are flipped. Each step flips the face that lowers
///     20 |A / A_source - 1| + |P / P_source - 1| + 6 W / (h P_source)
/// most, until none does. W is the area on the wrong side: faces cut in halves can be flipped at no cost, and suffice to match
/// area A and perimeter P. O(k m) for k faces along the outline and m flips, both small compared to the mesh.
void round_region(const Mesh& mesh, FilledRegion& region, const std::vector<std::pair<Index, double>>& shares,
                  const RoundingGoal& goal) {
    const double wanted = goal.coarser ? std::min(goal.perimeter, region.perimeter) : goal.perimeter;
    Moves moves(mesh, region.selected, shares);
    for (std::size_t step = 0; step < 2 * moves.size(); ++step) {
        const auto move = moves.best(region.area, region.perimeter, wanted, goal);
        if (!move) break;
        region.area += move->area;
        region.perimeter += move->perimeter;
        region.selected[move->face] = !region.selected[move->face];
        moves.update_around(move->face);
    }
}

/// The same along shared outlines: a face moves to the region that covers most of it, and is removed from its previous region
/// in the same step, so that a partition of the surface is preserved. Topologies are unchanged. `faces` need not be sorted.
void round_shared(const Mesh& mesh, std::vector<FilledRegion>& regions, std::vector<SharedFace> faces) {
    std::sort(faces.begin(), faces.end(), [](const SharedFace& a, const SharedFace& b) {
        return std::make_pair(a.face, a.region) < std::make_pair(b.face, b.region);
    });
    double change = 0;
    for (int pass = 0; pass < 8; ++pass) {
        check_cancelled();
        bool any = false;
        for (auto first = faces.begin(); first != faces.end();) {
            const auto last = std::find_if(first, faces.end(), [&](const SharedFace& x) { return x.face != first->face; });
            const Index f = first->face;
            const auto taker = std::find_if(first, last, [](const SharedFace& x) { return x.share > 0.5; });
            std::vector<std::size_t> owners;
            for (auto x = first; x != last; ++x)
                if (x->share < 0.5 && regions[x->region].selected[f]) owners.push_back(x->region);
            first = last;
            if (taker == last || regions[taker->region].selected[f] || owners.size() > 1) continue;
            if (!can_flip(mesh, regions[taker->region].selected, Face(f), change)) continue;
            if (!owners.empty() && !can_flip(mesh, regions[owners.front()].selected, Face(f), change)) continue;
            regions[taker->region].selected[f] = true;
            if (!owners.empty()) regions[owners.front()].selected[f] = false;
            any = true;
        }
        if (!any) break;
    }
}

}  // namespace

OutlineRounding::OutlineRounding(AnnotatedMeshView source, const Mesh& target,
                                 const std::vector<std::vector<SourcePath>>& vertex_paths, PathTracer& tracer)
    : source_(source),
      target_(target),
      tracer_(tracer),
      source_edge_(mean_edge_length(source.mesh)),
      steps_(vertex_paths.size()),
      put_aside_(vertex_paths.size()) {
    for (std::size_t i = 0; i < vertex_paths.size(); ++i) {
        if (source.annotations.annotations[i].type != AnnotationType::region) continue;
        TransferScore ignored;  // these correspondences were already counted for the paths
        for (const SourcePath& vertex_path : vertex_paths[i])
            for (const PathTracer::Step& step : tracer.trace_curves(vertex_path, ignored)) steps_[i].push_back(step);
    }
    users_.assign(tracer.curves().size(), 0);
    for (const auto& steps : steps_)
        for (const PathTracer::Step& step : steps) ++users_[step.curve];
}

void OutlineRounding::round(std::size_t region, FilledRegion& filled, double edge, bool balance) {
    if (steps_[region].empty()) return;
    std::vector<SurfaceCurve> curves;
    std::set<Index> shared;  // vertices along outlines shared with other regions
    for (const PathTracer::Step& step : steps_[region]) {
        const SurfaceCurve& curve = tracer_.curves()[step.curve];
        if (users_[step.curve] > 1)
            for (const Index f : curve.faces)
                for (const Vertex v : corners(target_, Face(f))) shared.insert(v);
        curves.push_back(curve);
        if (step.backwards) {
            std::reverse(curves.back().points.begin(), curves.back().points.end());
            std::reverse(curves.back().faces.begin(), curves.back().faces.end());
        }
    }
    std::vector<std::pair<Index, double>> shares = left_area_fractions(target_, curves, 2);
    const auto is_shared = [&](const std::pair<Index, double>& entry) {
        const auto vertices = corners(target_, Face(entry.first));
        return std::any_of(vertices.begin(), vertices.end(), [&](Vertex v) { return shared.count(v) > 0; });
    };
    for (const auto& entry : shares)
        if (is_shared(entry)) put_aside_[region].push_back({entry.first, region, entry.second});
    shares.erase(std::remove_if(shares.begin(), shares.end(), is_shared), shares.end());
    const Annotation& annotation = source_.annotations.annotations[region];
    RoundingGoal goal;
    goal.area = area_of(source_.mesh, annotation.faces);
    goal.perimeter = length_of(segments_of(source_.mesh, annotation));
    goal.edge = edge;
    goal.coarser = edge > 1.5 * source_edge_;
    if (balance && goal.area > 0 && goal.perimeter > 0) round_region(target_, filled, shares, goal);
    else round_by_share(target_, filled.selected, shares);
}

void OutlineRounding::round_shared_outlines(std::vector<FilledRegion>& regions) {
    std::vector<SharedFace> faces;
    for (const auto& part : put_aside_) faces.insert(faces.end(), part.begin(), part.end());
    round_shared(target_, regions, std::move(faces));
}

}  // namespace ostraka

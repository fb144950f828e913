#include "transfer/region_transfer.h"

#include "ostraka/annotation/outline.h"
#include "ostraka/core/progress.h"
#include "ostraka/mesh/flood.h"
#include "transfer/scores.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>

namespace ostraka {

std::vector<Index> diameter_path(const std::vector<Index>& walk) {
    if (walk.empty()) return {};
    std::map<Index, std::vector<Index>> neighbours;
    neighbours[walk.front()];
    for (std::size_t i = 0; i + 1 < walk.size(); ++i) {
        if (walk[i] == walk[i + 1]) continue;
        neighbours[walk[i]].push_back(walk[i + 1]);
        neighbours[walk[i + 1]].push_back(walk[i]);
    }
    const auto sweep = [&](Index from) {  // breadth first; the last vertex reached is a farthest one
        std::map<Index, Index> previous{{from, no_index}};
        std::deque<Index> queue{from};
        Index last = from;
        CancelCheck check;
        while (!queue.empty()) {
            check();
            last = queue.front();
            queue.pop_front();
            for (const Index w : neighbours[last])
                if (previous.emplace(w, last).second) queue.push_back(w);
        }
        std::vector<Index> path;
        for (Index v = last; v != no_index; v = previous.at(v)) path.push_back(v);
        return path;
    };
    const std::vector<Index> first = sweep(walk.front());
    return sweep(first.front());
}

RegionTransfer::RegionTransfer(AnnotatedMeshView source, const SurfaceSearch& target, const TransferOptions& options)
    : source_(source), search_(target), options_(options), target_edge_(target.typical_edge()) {}

const SurfaceSearch& RegionTransfer::source_search() {
    std::call_once(source_search_once_, [this] { source_search_.emplace(source_.mesh); });
    return *source_search_;
}

namespace {

/// Area and perimeter of the selected faces.
FilledRegion measured(const Mesh& mesh, std::vector<bool> selected) {
    check_cancelled();
    FilledRegion region;
    for (const Face f : mesh.faces()) {
        if (!selected[f]) continue;
        region.area += face_area(mesh, f);
        for (const Halfedge h : CGAL::halfedges_around_face(mesh.halfedge(f), mesh)) {
            const Halfedge across = mesh.opposite(h);
            if (mesh.is_border(across) || !selected[mesh.face(across)]) region.perimeter += edge_length(mesh, h);
        }
    }
    region.selected = std::move(selected);
    return region;
}

/// Connected patch of a set of faces: one of its faces, and whether any of its edges separates it from a face outside the set.
struct Patch {
    Index face;
    bool bounded = false;
};
std::vector<Patch> patches_of(const Mesh& mesh, const std::vector<Index>& faces) {
    check_cancelled();
    const std::vector<bool> selected = face_flags(mesh, faces);
    std::vector<bool> seen(selected.size(), false);
    std::vector<Patch> patches;
    for (const Index start : faces) {
        if (seen[start]) continue;
        Patch& patch = patches.emplace_back(Patch{start});
        flood_faces(mesh, Face(start), seen, [&](Halfedge h) {
            const bool stays = mesh.is_border(mesh.opposite(h)) || selected[mesh.face(mesh.opposite(h))];
            patch.bounded = patch.bounded || !stays;
            return stays;
        });
    }
    return patches;
}

/// If all outlines vanished, a patch that covers most of its component has lost only its holes: it counts as unbounded.
void free_large_patches(const Mesh& mesh, const std::vector<Index>& region, std::vector<Patch>& patches) {
    const std::vector<bool> selected = face_flags(mesh, region);
    std::vector<bool> seen(selected.size(), false);
    for (Patch& patch : patches) {
        if (seen[patch.face] || !patch.bounded) continue;
        double inside = 0, all = 0;
        for (const Face face : flood_faces(mesh, Face(patch.face), seen)) {
            const double area = face_area(mesh, face);
            all += area;
            if (selected[face]) inside += area;
        }
        if (inside > all / 2) patch.bounded = false;
    }
}

}  // namespace

RegionTransfer::Traced RegionTransfer::edges_of(const std::vector<TracedPath>& paths) const {
    Traced traced;
    traced.pieces = paths.size();
    for (const TracedPath& vertex_path : paths) {
        const std::vector<Index>& path = vertex_path.path;
        if (path.size() < 2) {
            ++traced.vanished;
            continue;
        }
        for (std::size_t i = 0; i < (vertex_path.closed ? path.size() : path.size() - 1); ++i) {
            const Halfedge h = find_halfedge(*mesh_, Vertex(path[i]), Vertex(path[(i + 1) % path.size()]));
            if (h == Mesh::null_halfedge()) continue;  // a gap between two components
            traced.edges.push_back(h);
            traced.length += edge_length(*mesh_, h);
        }
    }
    return traced;
}

void RegionTransfer::set_outlines(const std::vector<std::vector<TracedPath>>& traced, const Mesh& mesh,
                                  const std::vector<Index>* origin) {
    mesh_ = &mesh;
    origin_ = origin;
    traced_.resize(source_.annotations.annotations.size());
    std::vector<Edge> walls;
    bool any = false;
    for (std::size_t i = 0; i < traced.size(); ++i) {
        if (source_.annotations.annotations[i].type != AnnotationType::region || source_.annotations.annotations[i].all) continue;
        any = true;
        traced_[i] = edges_of(traced[i]);
        for (const Halfedge h : traced_[i].edges) walls.push_back(mesh.edge(h));
    }
    if (any) parts_.emplace(mesh, std::move(walls));
}

FilledRegion RegionTransfer::fill(std::size_t region, TransferScore& score) {
    const std::vector<Index>& faces = source_.annotations.annotations[region].faces;
    const Traced& traced = traced_[region];
    const double source_area = area_of(source_.mesh, faces);
    std::vector<Patch> patches = patches_of(source_.mesh, faces);
    if (traced.edges.empty()) free_large_patches(source_.mesh, faces, patches);
    const auto is_bounded = [](const Patch& patch) { return patch.bounded; };
    if (traced.vanished > 0 && traced.vanished < traced.pieces)
        score.note += (score.note.empty() ? "" : "; ") + std::to_string(traced.vanished) + " of " +
                      std::to_string(traced.pieces) + " pieces of its outline vanished";
    // All outlines vanished: the region is not larger than the target's faces, unless a patch never had an outline.
    const bool bounded = std::all_of(patches.begin(), patches.end(), is_bounded);
    if (traced.edges.empty() && bounded) return {};

    const FaceParts::Choice choice = parts_->left_of(traced.edges);
    FilledRegion filled{parts_->faces(choice), choice.area, choice.perimeter};
    if (!bounded) {
        // Patches without outlines cover their component, which is found from a point inside.
        for (const Patch& patch : patches) {
            if (patch.bounded) continue;
            const Face face(patch.face);
            const auto hit = search_.closest_compatible(centroid(source_.mesh, face), area_vector(source_.mesh, face), 0,
                                                        options_.correspondence.max_distance * search_.diagonal());
            if (!hit) continue;
            Index start = hit->face;
            if (origin_ != nullptr)
                start = static_cast<Index>(std::lower_bound(origin_->begin(), origin_->end(), hit->face) - origin_->begin());
            flood_faces(*mesh_, Face(start), filled.selected);
        }
        return measured(*mesh_, std::move(filled.selected));
    }
    const auto plausible = [&](double area) {
        return std::abs(area - source_area) <= 0.5 * source_area + target_edge_ * traced.length;
    };
    if (!choice.crossing && plausible(filled.area)) return filled;
    score.crossings_resolved = true;
    if (auto wound = fill_by_winding(*mesh_, traced.edges, source_area)) filled = measured(*mesh_, std::move(*wound));
    else score.voted = true;
    score.voted = score.voted || !plausible(filled.area);
    return filled;
}

std::vector<bool> RegionTransfer::vote(std::size_t region) {
    return region_by_vote(source_.mesh, source_search(), source_.annotations.annotations[region].faces, *mesh_,
                          options_.correspondence);
}

void RegionTransfer::cover(std::vector<bool>& selected, const std::vector<SourcePath>& vertex_paths, TransferScore& score) const {
    // The faces crossed by the outline, which is traced exactly.
    TransferScore ignored;
    PathTracer tracer(source_.mesh, search_, options_);
    std::vector<Index> vertices;
    for (const SourcePath& vertex_path : vertex_paths)
        vertices.insert(vertices.end(), vertex_path.vertices.begin(), vertex_path.vertices.end());
    tracer.match(std::move(vertices));
    for (const SourcePath& vertex_path : vertex_paths) tracer.trace_curves(vertex_path, ignored);
    score.detours += ignored.detours;
    const Mesh& mesh = search_.mesh();
    // The crossed faces and the edges that the outline follows divide the others into pieces, each of which is on one side.
    std::vector<bool> crossed(mesh.number_of_faces(), false), wall(mesh.number_of_edges(), false);
    for (const SurfaceCurve& curve : tracer.curves())
        for (std::size_t i = 0; i < curve.faces.size(); ++i) {
            const SurfacePoint &a = curve.points[i], &b = curve.points[i + 1];
            if (a.is_vertex() && b.is_vertex()) {
                const Halfedge h = find_halfedge(mesh, a.vertex(), b.vertex());
                if (h != Mesh::null_halfedge()) wall[mesh.edge(h)] = true;
            } else {
                crossed[curve.faces[i]] = true;
            }
        }
    std::vector<bool> seen = crossed;
    for (const Face start : mesh.faces()) {
        if (seen[start]) continue;
        const std::vector<Face> piece = flood_faces(mesh, start, seen, [&](Halfedge h) { return !wall[mesh.edge(h)]; });
        double inside = 0, outside = 0;
        for (const Face f : piece) (selected[f] ? inside : outside) += face_area(mesh, f);
        for (const Face f : piece) selected[f] = inside > outside;
    }
    for (std::size_t f = 0; f < crossed.size(); ++f)
        if (crossed[f]) selected[f] = options_.cover == TransferOptions::Cover::enclosing;
}

std::function<bool(const SurfaceHit&)> RegionTransfer::membership(const std::vector<Index>& faces) const {
    const auto selected = std::make_shared<std::vector<bool>>(face_flags(*mesh_, faces));
    if (origin_ == nullptr) return [selected](const SurfaceHit& hit) { return static_cast<bool>((*selected)[hit.face]); };
    return [selected, origin = origin_, &mesh = *mesh_](const SurfaceHit& hit) {
        // New faces have the order of their old faces.
        const auto [first, last] = std::equal_range(origin->begin(), origin->end(), hit.face);
        double best = std::numeric_limits<double>::infinity();
        bool inside = false;
        for (auto i = first; i != last; ++i) {
            const auto f = static_cast<Index>(i - origin->begin());
            const auto [a, b, c] = corners(mesh, Face(f));
            const auto weights = nearest_barycentric(mesh.point(a), mesh.point(b), mesh.point(c), hit.point);
            const double distance = CGAL::squared_distance(point_at(mesh, f, weights), hit.point);
            if (distance < best) {
                best = distance;
                inside = (*selected)[f];
            }
        }
        return inside;
    };
}

}  // namespace ostraka

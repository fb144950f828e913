#include "reconstruction/seam.h"

#include "ostraka/core/error.h"
#include "ostraka/geom/distance.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/insert_curves.h"
#include "ostraka/geom/submesh.h"
#include "ostraka/io/diagnose.h"
#include "ostraka/mesh/flood.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace ostraka {

namespace {

/// A patch's border traced on the surface, loop by loop.
struct Drawing {
    std::vector<SurfaceCurve> curves;             ///< the first node is repeated at the end
    std::vector<std::vector<std::size_t>> first;  ///< per loop: the node at each vertex, and the last node
    std::vector<Vertex> failed;                   ///< vertices without a path to the next one
};

Drawing draw(const Mesh& surface, const Patch& patch, const std::vector<std::optional<SurfaceHit>>& places) {
    Drawing drawing;
    for (const std::vector<Vertex>& loop : patch.loops()) {
        SurfaceCurve curve;
        std::vector<std::size_t> first;
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const SurfaceHit &a = *places[loop[i]], &b = *places[loop[(i + 1) % loop.size()]];
            const SurfacePoint from = surface_point(surface, a.face, a.barycentric),
                               to = surface_point(surface, b.face, b.barycentric);
            Vector up = area_vector(surface, Face(a.face));
            up = up / std::sqrt(up.squared_length());
            Vector other = area_vector(surface, Face(b.face));
            up = up + other / std::sqrt(other.squared_length());
            const double length = distance(position(surface, from), position(surface, to));
            const auto piece = length > 0 ? trace_line(surface, from, to, up, 3 * length) : std::nullopt;
            first.push_back(curve.points.empty() ? 0 : curve.points.size() - 1);
            if (!piece || piece->points.size() < 2) {
                drawing.failed.push_back(loop[i]);
                drawing.failed.push_back(loop[(i + 1) % loop.size()]);
                curve.points.assign(1, to);
                curve.faces.clear();
                continue;
            }
            curve.points.insert(curve.points.end(), piece->points.begin() + (curve.points.empty() ? 0 : 1), piece->points.end());
            curve.faces.insert(curve.faces.end(), piece->faces.begin(), piece->faces.end());
        }
        first.push_back(curve.points.size() - 1);
        drawing.curves.push_back(std::move(curve));
        drawing.first.push_back(std::move(first));
    }
    return drawing;
}

/// Border vertices at segments that meet other segments, or are no edges of the cut surface.
std::vector<Vertex> crossed(const InsertedCurves& cut, const Patch& patch, const Drawing& drawing) {
    std::vector<Vertex> failed;
    std::vector<int> uses(cut.mesh.number_of_vertices(), 0);
    for (const auto& nodes : cut.node_vertex)
        for (std::size_t i = 0; i + 1 < nodes.size(); ++i) ++uses[nodes[i]];
    for (std::size_t l = 0; l < patch.loops().size(); ++l) {
        const auto& loop = patch.loops()[l];
        const auto& nodes = cut.node_vertex[l];
        for (std::size_t i = 0; i < loop.size(); ++i)
            for (std::size_t n = drawing.first[l][i]; n < drawing.first[l][i + 1]; ++n)
                if (uses[nodes[n]] > 1 || nodes[n] == nodes[n + 1] ||
                    find_halfedge(cut.mesh, Vertex(nodes[n]), Vertex(nodes[n + 1])) == Mesh::null_halfedge()) {
                    failed.push_back(loop[i]);
                    failed.push_back(loop[(i + 1) % loop.size()]);
                    break;
                }
    }
    return failed;
}

/// Partition of the surface by the curves: faces to their left and to their right.
struct Sides {
    std::vector<bool> left;      ///< marks of faces, including whole components of the surface under pieces without a border
    std::vector<Vertex> failed;  ///< of borders with a region on a different side than the longest border of that region
};

/// The halfedge of a segment of an inserted curve.
Halfedge curve_halfedge(const InsertedCurves& cut, std::size_t curve, std::size_t i) {
    const auto& nodes = cut.node_vertex[curve];
    return find_halfedge(cut.mesh, Vertex(nodes[i]), Vertex(nodes[i + 1]));
}

/// Connected regions of faces, separated by the curves.
FacePieces regions_between(const InsertedCurves& cut) {
    const Mesh& mesh = cut.mesh;
    std::vector<bool> fence(mesh.number_of_edges(), false);
    for (std::size_t l = 0; l < cut.node_vertex.size(); ++l)
        for (std::size_t i = 0; i + 1 < cut.node_vertex[l].size(); ++i) fence[mesh.edge(curve_halfedge(cut, l, i))] = true;
    return face_pieces(
        mesh, [](Face) { return true; }, [&](Halfedge h) { return !fence[mesh.edge(h)]; });
}

Sides partition_surface(const InsertedCurves& cut, const Patch& patch, const std::vector<std::optional<SurfaceHit>>& places) {
    constexpr auto no_loop = static_cast<std::size_t>(-1);
    const Mesh& mesh = cut.mesh;
    const auto [region, count] = regions_between(cut);
    std::vector<bool> left(count, false);
    std::vector<std::size_t> longest(count, no_loop);                    // loop beside each region
    std::vector<std::pair<std::size_t, std::size_t>> on_left, on_right;  // region and loop
    for (std::size_t l = 0; l < cut.node_vertex.size(); ++l)
        for (std::size_t i = 0; i + 1 < cut.node_vertex[l].size(); ++i) {
            const Halfedge h = curve_halfedge(cut, l, i);
            for (const Halfedge half : {h, mesh.opposite(h)}) {
                if (mesh.is_border(half)) continue;
                const std::size_t r = region[mesh.face(half)];
                auto& side = half == h ? on_left : on_right;
                if (side.empty() || side.back() != std::pair(r, l)) side.emplace_back(r, l);
                if (longest[r] == no_loop || patch.loops()[l].size() > patch.loops()[longest[r]].size()) longest[r] = l;
            }
        }
    for (const Face face : patch.closed()) {
        const Index old = places[corners(patch.mesh(), face)[0]]->face;
        const auto first_face = std::find(cut.face_origin.begin(), cut.face_origin.end(), old);
        left[region[static_cast<std::size_t>(first_face - cut.face_origin.begin())]] = true;
    }
    for (const auto& [r, l] : on_left) left[r] = left[r] || l == longest[r];
    std::vector<bool> wrong(patch.loops().size(), false);
    for (const auto& [r, l] : on_left) wrong[l] = wrong[l] || !left[r];
    for (const auto& [r, l] : on_right) wrong[l] = wrong[l] || left[r];
    Sides sides;
    for (std::size_t l = 0; l < wrong.size(); ++l)
        if (wrong[l]) sides.failed.insert(sides.failed.end(), patch.loops()[l].begin(), patch.loops()[l].end());
    sides.left.resize(region.size());
    for (std::size_t f = 0; f < region.size(); ++f) sides.left[f] = left[region[f]];
    return sides;
}

/// A surface cut along the seam, without the faces that are `gone`.
struct CutSurface {
    const Mesh& mesh;
    const std::vector<bool>& gone;
    /// Whether a face beside the edge remains.
    [[nodiscard]] bool has(Halfedge h) const { return is_left(h) || is_left(mesh.opposite(h)); }

private:
    [[nodiscard]] bool is_left(Halfedge h) const { return !mesh.is_border(h) && !gone[mesh.face(h)]; }
};

/// Marks in `near` the vertices within `rings` rings of those of `front`, including these, over edges for which
/// `joins(halfedge)` holds; returns those that were not in `front`.
template <class Joins>
std::vector<Vertex> rings_around(const Mesh& mesh, std::vector<Vertex> front, int rings, std::vector<bool>& near, Joins&& joins) {
    std::vector<Vertex> added;
    for (const Vertex v : front) near[v] = true;
    for (int r = 0; r < rings; ++r) {
        std::vector<Vertex> next;
        for (const Vertex v : front)
            for (const Halfedge h : mesh.halfedges_around_target(mesh.halfedge(v))) {
                const Vertex other = mesh.source(h);
                if (near[other] || !joins(h)) continue;
                near[other] = true;
                next.push_back(other);
            }
        added.insert(added.end(), next.begin(), next.end());
        front = std::move(next);
    }
    return added;
}

/// Moves the vertices of the surface near the seam by displacements that are harmonic between the seam and the `fixed`
/// vertices. Returns marks of those vertices.
std::vector<bool> follow(const CutSurface& surface, const std::map<Index, Vector3d>& seam, double width,
                         const std::vector<bool>& frozen, std::vector<Vector3d>& points) {
    const Mesh& mesh = surface.mesh;
    const double edge = mean_edge_length(mesh);
    const int rings = edge > 0 ? static_cast<int>(std::clamp(std::ceil(width / edge), 1.0, 40.0)) : 1;
    std::vector<bool> near(points.size(), false);
    std::vector<Vertex> front;
    for (const auto& [v, place] : seam) front.emplace_back(v);
    std::vector<Vertex> band = rings_around(mesh, front, rings, near, [&](Halfedge h) { return surface.has(h); });
    std::erase_if(band, [&](Vertex v) { return static_cast<std::size_t>(v) < frozen.size() && frozen[v]; });
    std::vector<Vector3d> shift(mesh.number_of_vertices(), Vector3d::Zero()), next(band.size());
    for (const auto& [v, place] : seam) shift[v] = place - points[v];
    std::vector<std::vector<Vertex>> around;
    for (const Vertex v : band) {
        around.emplace_back();
        for (const Halfedge h : mesh.halfedges_around_target(mesh.halfedge(v)))
            if (surface.has(h)) around.back().push_back(mesh.source(h));
    }
    for (int step = 0; step < 4 * rings; ++step) {
        for (std::size_t i = 0; i < band.size(); ++i) {
            next[i] = Vector3d::Zero();
            for (const Vertex other : around[i]) next[i] += shift[other];
            next[i] /= static_cast<double>(std::max<std::size_t>(1, around[i].size()));
        }
        for (std::size_t i = 0; i < band.size(); ++i) shift[band[i]] = next[i];
    }
    for (std::size_t v = 0; v < points.size(); ++v) points[v] += shift[v];
    return near;
}

using Splits = std::map<std::pair<Index, Index>, std::vector<Index>>;

/// Triangulates the triangle with the additional vertices on its edges.
void cut_triangle(std::array<Index, 3> t, const Splits& splits, std::vector<std::array<Index, 3>>& out) {
    for (int k = 0; k < 3; ++k) {
        const auto split = splits.find({t[0], t[1]});
        if (split == splits.end() || split->second.empty()) {
            t = {t[1], t[2], t[0]};
            continue;
        }
        std::vector<Index> vertex_path{t[0]};
        vertex_path.insert(vertex_path.end(), split->second.begin(), split->second.end());
        vertex_path.push_back(t[1]);
        for (std::size_t i = 0; i + 1 < vertex_path.size(); ++i)
            cut_triangle({vertex_path[i], vertex_path[i + 1], t[2]}, splits, out);
        return;
    }
    out.push_back(t);
}

/// Vertices of the patch within a few edges of its border.
std::vector<bool> near_border(const Patch& patch) {
    constexpr int rings = 4;
    std::vector<bool> near(patch.mesh().number_of_vertices(), false);
    std::vector<Vertex> border;
    for (const auto& loop : patch.loops()) border.insert(border.end(), loop.begin(), loop.end());
    static_cast<void>(rings_around(patch.mesh(), border, rings, near, [](Halfedge) { return true; }));
    return near;
}

/// Two surfaces joined along a seam.
struct Stitched {
    Joint joint;
    std::vector<bool> near;  ///< marks of the faces near the seam
    /// Border vertices at edges that both patch and surface have, on either side of the seam: these prevent a joint.
    std::vector<Vertex> failed;
};

/// The border vertices nearest to new intersections of faces near the seam, i.e. those that neither the patch nor the surface
/// had.
std::vector<Vertex> crossings_at_seam(const Mesh& surface, const Stitched& stitched, const Patch& patch) {
    const Joint& joint = stitched.joint;
    const SubMesh near = keep_faces(joint.mesh, stitched.near);
    const auto pairs = self_intersections(to_soup(near.mesh)).pairs;
    if (pairs.empty()) return {};
    // Finds the earlier intersections among the surface's own faces.
    std::vector<bool> is_near(surface.number_of_faces(), false);
    for (const Index face : near.faces)
        if (joint.old_face[face] != no_index) is_near[joint.old_face[face]] = true;
    const SubMesh before = keep_faces(surface, is_near);
    std::vector<std::pair<Index, Index>> earlier;
    for (const auto& [a, b] : self_intersections(to_soup(before.mesh)).pairs)
        earlier.emplace_back(std::min(before.faces[a], before.faces[b]), std::max(before.faces[a], before.faces[b]));
    std::sort(earlier.begin(), earlier.end());
    std::vector<Vertex> vertices;
    for (const auto& [a, b] : pairs) {
        const Index f = joint.old_face[near.faces[a]], g = joint.old_face[near.faces[b]];
        if (f == no_index && g == no_index) continue;
        if (f != no_index && g != no_index &&
            std::binary_search(earlier.begin(), earlier.end(), std::pair(std::min(f, g), std::max(f, g))))
            continue;
        const Point place = centroid(near.mesh, Face(f == no_index ? b : a));
        Vertex nearest = patch.loops().front().front();
        for (const auto& loop : patch.loops())
            for (const Vertex v : loop)
                if (CGAL::has_smaller_distance_to_point(place, patch.mesh().point(v), patch.mesh().point(nearest))) nearest = v;
        vertices.push_back(nearest);
    }
    return vertices;
}

/// Joins the patch and the rest of the surface along the patch's border.
class Stitching {
public:
    Stitching(const Patch& patch, const InsertedCurves& cut, const Drawing& drawing)
        : patch_(patch),
          cut_(cut),
          drawing_(drawing),
          patch_vertex_(patch.mesh().number_of_vertices(), no_index),
          surface_vertex_(cut.mesh.number_of_vertices(), no_index) {
        for (const Face face : patch.mesh().faces())
            if (patch.has(face))
                for (const Vertex v : corners(patch.mesh(), face))
                    if (patch_vertex_[v] == no_index) patch_vertex_[v] = add(eigen(patch.mesh().point(v)));
    }

    Stitched stitch(const std::vector<bool>& gone, double width, const std::vector<bool>& frozen) && {
        for (std::size_t l = 0; l < patch_.loops().size(); ++l)
            for (std::size_t i = 0; i < patch_.loops()[l].size(); ++i) place_seam(l, i);
        result_.joint.patch_faces = patch_.size();
        add_surface(gone, width, frozen);
        add_patch();
        find_doubled_edges();
        if (result_.failed.empty()) result_.joint.mesh = build_mesh(soup_);
        return std::move(result_);
    }

private:
    Index add(const Vector3d& p) {
        soup_.points.push_back({p.x(), p.y(), p.z()});
        return static_cast<Index>(soup_.points.size() - 1);
    }

    /// Moves the nodes of the curve between the ends of a border edge of the patch onto that edge.
    void place_seam(std::size_t l, std::size_t i) {
        const Mesh& surface = cut_.mesh;
        const auto& loop = patch_.loops()[l];
        const auto& nodes = cut_.node_vertex[l];
        const Vertex a = loop[i], b = loop[(i + 1) % loop.size()];
        const std::size_t begin = drawing_.first[l][i], end = drawing_.first[l][i + 1];
        surface_vertex_[nodes[begin]] = patch_vertex_[a];
        border_.emplace(patch_vertex_[a], a);
        seam_.emplace(nodes[begin], eigen(patch_.mesh().point(a)));
        double length = 0;
        std::vector<double> lengths{0};
        for (std::size_t n = begin; n < end; ++n) {
            length += std::sqrt(CGAL::squared_distance(surface.point(Vertex(nodes[n])), surface.point(Vertex(nodes[n + 1]))));
            lengths.push_back(length);
        }
        std::vector<Index>& split = splits_[{patch_vertex_[a], patch_vertex_[b]}];
        for (std::size_t n = begin + 1; n < end; ++n) {
            const double t = lengths[n - begin] / length;
            const Vector3d place = (1 - t) * eigen(patch_.mesh().point(a)) + t * eigen(patch_.mesh().point(b));
            surface_vertex_[nodes[n]] = add(place);
            border_.emplace(surface_vertex_[nodes[n]], a);
            seam_.emplace(nodes[n], place);
            split.push_back(surface_vertex_[nodes[n]]);
        }
    }

    void add_surface(const std::vector<bool>& gone, double width, const std::vector<bool>& frozen) {
        const Mesh& surface = cut_.mesh;
        std::vector<Vector3d> points;
        for (const Vertex v : surface.vertices()) points.push_back(eigen(surface.point(v)));
        const std::vector<bool> near = follow({surface, gone}, seam_, width, frozen, points);
        for (const Face face : surface.faces()) {
            if (gone[face]) continue;
            std::array<Index, 3> triangle{};
            const auto c = corners(surface, face);
            for (std::size_t k = 0; k < 3; ++k) {
                if (surface_vertex_[c[k]] == no_index) surface_vertex_[c[k]] = add(points[c[k]]);
                triangle[k] = surface_vertex_[c[k]];
            }
            soup_.triangles.push_back(triangle);
            result_.joint.old_face.push_back(cut_.face_origin[face]);
            result_.joint.patch_face.push_back(no_index);
            result_.near.push_back(std::any_of(c.begin(), c.end(), [&](Vertex v) { return near[v]; }));
        }
    }

    void add_patch() {
        const std::vector<bool> near = near_border(patch_);
        for (const Face face : patch_.mesh().faces()) {
            if (!patch_.has(face)) continue;
            const auto c = corners(patch_.mesh(), face);
            cut_triangle({patch_vertex_[c[0]], patch_vertex_[c[1]], patch_vertex_[c[2]]}, splits_, soup_.triangles);
            const std::size_t count = soup_.triangles.size();
            result_.joint.old_face.resize(count, no_index);
            result_.joint.patch_face.resize(count, face);
            result_.near.resize(count, std::any_of(c.begin(), c.end(), [&](Vertex v) { return near[v]; }));
        }
    }

    void find_doubled_edges() {
        std::vector<std::pair<Index, Index>> edges;
        for (const auto& t : soup_.triangles)
            for (std::size_t k = 0; k < 3; ++k)
                if (border_.contains(t[k]) && border_.contains(t[(k + 1) % 3])) edges.emplace_back(t[k], t[(k + 1) % 3]);
        std::sort(edges.begin(), edges.end());
        for (auto twice = std::adjacent_find(edges.begin(), edges.end()); twice != edges.end();
             twice = std::adjacent_find(twice + 1, edges.end())) {
            result_.failed.push_back(border_.at(twice->first));
            result_.failed.push_back(border_.at(twice->second));
        }
    }

    const Patch& patch_;
    const InsertedCurves& cut_;
    const Drawing& drawing_;
    TriangleSoup soup_;
    std::vector<Index> patch_vertex_, surface_vertex_;  ///< from their vertices to the new ones
    Splits splits_;
    std::map<Index, Vector3d> seam_;
    std::map<Index, Vertex> border_;  ///< from a new vertex to the border vertex of the patch that it is, or that precedes it
    Stitched result_;
};

/// Without a joint if any border vertices `failed`.
Stitched attempt_seam(const Mesh& surface, const Patch& patch, const std::vector<std::optional<SurfaceHit>>& places, double width,
                      const std::vector<bool>& frozen) {
    Stitched failure;
    const Drawing drawing = draw(surface, patch, places);
    failure.failed = drawing.failed;
    if (!failure.failed.empty()) return failure;
    const InsertedCurves cut = insert_curves(surface, drawing.curves);
    failure.failed = crossed(cut, patch, drawing);
    if (!failure.failed.empty()) return failure;
    const Sides sides = partition_surface(cut, patch, places);
    failure.failed = sides.failed;
    if (!failure.failed.empty()) return failure;
    return Stitching(patch, cut, drawing).stitch(sides.left, width, frozen);
}

}  // namespace

Joint join_patch(const Mesh& surface, Patch patch, const std::vector<std::optional<SurfaceHit>>& places, double width,
                 const std::vector<bool>& frozen) {
    constexpr int max_attempts = 40, max_crossed = 12;
    Joint failure, best;
    std::size_t fewest = 0;
    int crossed_attempts = 0;
    for (int attempt = 0; attempt < max_attempts; ++attempt) {
        if (patch.size() == 0) {
            if (crossed_attempts > 0) return best;
            failure.problem = attempt == 0 ? "no part of it lies on the fitted template" : "its border is simple nowhere";
            return failure;
        }
        Stitched stitched = attempt_seam(surface, patch, places, width, frozen);
        std::vector<Vertex> failed = std::move(stitched.failed);
        if (failed.empty()) {
            if (!patch.loops().empty()) failed = crossings_at_seam(surface, stitched, patch);
            if (crossed_attempts == 0 || failed.size() < fewest) {
                fewest = failed.size();
                best = std::move(stitched.joint);
            }
            if (failed.empty() || ++crossed_attempts == max_crossed) return best;
        }
        // If small steps do not help, larger ones are taken: a ring of a fine mesh is almost nothing.
        patch.erode(std::move(failed), 1 << (attempt / 8));
    }
    if (crossed_attempts > 0) return best;
    failure.problem = "its border crosses itself on the template";
    return failure;
}

}  // namespace ostraka

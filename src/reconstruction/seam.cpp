#include "seam.h"

#include "ostraka/core/error.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/io/diagnose.h"
#include "ostraka/remesh/insert_curves.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace ostraka {

using Eigen::Vector3d;

Patch::Patch(const Mesh& mesh, std::vector<bool> keep, double least) : mesh_(mesh), keep_(std::move(keep)), least_(least) {
    regularise({mesh.vertices().begin(), mesh.vertices().end()});
}

std::size_t Patch::size() const { return static_cast<std::size_t>(std::count(keep_.begin(), keep_.end(), true)); }

void Patch::erode(std::vector<Vertex> vertices, int rings) {
    std::vector<Vertex> touched;
    for (; rings > 0; --rings) {
        std::vector<Vertex> next;
        for (const Vertex v : vertices)
            for (const Face face : mesh_.faces_around_target(mesh_.halfedge(v))) {
                if (face == Mesh::null_face() || !keep_[face]) continue;
                keep_[face] = false;
                for (const Vertex corner : corners(mesh_, face)) next.push_back(corner);
            }
        touched.insert(touched.end(), next.begin(), next.end());
        vertices = std::move(next);
    }
    regularise(std::move(touched));
}

void Patch::regularise(std::vector<Vertex> stack) {
    const auto kept = [&](Halfedge h) { return !mesh_.is_border(h) && keep_[mesh_.face(h)]; };
    // Vertices at which the patch has several fans lose their faces, which may make others such.
    while (!stack.empty()) {
        const Vertex v = stack.back();
        stack.pop_back();
        if (mesh_.is_isolated(v)) continue;
        int ends = 0;
        for (const Halfedge h : mesh_.halfedges_around_target(mesh_.halfedge(v)))
            ends += kept(h) && !kept(mesh_.opposite(h)) ? 1 : 0;
        if (ends < 2) continue;
        for (const Halfedge h : mesh_.halfedges_around_target(mesh_.halfedge(v))) {
            if (!kept(h)) continue;
            keep_[mesh_.face(h)] = false;
            for (const Vertex other : corners(mesh_, mesh_.face(h)))
                if (other != v) stack.push_back(other);
        }
    }
    // Pieces that are too small.
    std::vector<int> piece(keep_.size(), -1);
    std::vector<double> area;
    double whole = 0;
    for (const Face seed : mesh_.faces()) {
        whole += face_area(mesh_, seed);
        if (!keep_[seed] || piece[seed] >= 0) continue;
        const int number = static_cast<int>(area.size());
        area.push_back(0);
        std::vector<Face> todo{seed};
        piece[seed] = number;
        while (!todo.empty()) {
            const Face face = todo.back();
            todo.pop_back();
            area.back() += face_area(mesh_, face);
            for (const Halfedge h : mesh_.halfedges_around_face(mesh_.halfedge(face))) {
                const Halfedge other = mesh_.opposite(h);
                if (!kept(other) || piece[mesh_.face(other)] >= 0) continue;
                piece[mesh_.face(other)] = number;
                todo.push_back(mesh_.face(other));
            }
        }
    }
    for (const Face face : mesh_.faces())
        if (keep_[face] && !(area[static_cast<std::size_t>(piece[face])] >= least_ * whole)) keep_[face] = false;

    loops_.clear();
    std::vector<bool> bordered(area.size(), false);
    for (const Halfedge h : mesh_.halfedges())
        if (kept(h) && !kept(mesh_.opposite(h))) bordered[static_cast<std::size_t>(piece[mesh_.face(h)])] = true;
    closed_.clear();
    for (const Face face : mesh_.faces()) {
        if (!keep_[face] || bordered[static_cast<std::size_t>(piece[face])]) continue;
        bordered[static_cast<std::size_t>(piece[face])] = true;
        closed_.push_back(face);
    }
    std::vector<Vertex> next(mesh_.number_of_vertices(), Mesh::null_vertex());
    for (const Halfedge h : mesh_.halfedges())
        if (kept(h) && !kept(mesh_.opposite(h))) next[mesh_.source(h)] = mesh_.target(h);
    for (const Vertex start : mesh_.vertices()) {
        if (next[start] == Mesh::null_vertex()) continue;
        loops_.emplace_back();
        for (Vertex v = start; next[v] != Mesh::null_vertex();) {
            loops_.back().push_back(v);
            const Vertex then = next[v];
            next[v] = Mesh::null_vertex();
            v = then;
        }
    }
}

namespace {

/// A patch's border drawn on the surface, loop by loop.
struct Drawing {
    std::vector<SurfaceCurve> curves;             ///< the first node comes once more at the end
    std::vector<std::vector<std::size_t>> first;  ///< of each loop: the node at each vertex, and the last node
    std::vector<Vertex> failed;                   ///< vertices from which there is no way to the next
};

Drawing draw(const Mesh& surface, const Patch& patch, const std::vector<std::optional<SurfaceHit>>& places) {
    Drawing drawing;
    for (const std::vector<Vertex>& loop : patch.loops()) {
        SurfaceCurve curve;
        std::vector<std::size_t> first;
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const SurfaceHit &a = *places[loop[i]], &b = *places[loop[(i + 1) % loop.size()]];
            const SurfaceNode from = surface_node(surface, a.face, a.barycentric),
                              to = surface_node(surface, b.face, b.barycentric);
            Vector up = area_vector(surface, Face(a.face));
            up = up / std::sqrt(up.squared_length());
            Vector other = area_vector(surface, Face(b.face));
            up = up + other / std::sqrt(other.squared_length());
            const double straight = std::sqrt(CGAL::squared_distance(from.point, to.point));
            const auto piece = straight > 0 ? trace_line(surface, from, to, up, 3 * straight) : std::nullopt;
            first.push_back(curve.nodes.empty() ? 0 : curve.nodes.size() - 1);
            if (!piece || piece->nodes.size() < 2) {
                drawing.failed.push_back(loop[i]);
                drawing.failed.push_back(loop[(i + 1) % loop.size()]);
                curve.nodes.assign(1, to);
                curve.faces.clear();
                continue;
            }
            curve.nodes.insert(curve.nodes.end(), piece->nodes.begin() + (curve.nodes.empty() ? 0 : 1), piece->nodes.end());
            curve.faces.insert(curve.faces.end(), piece->faces.begin(), piece->faces.end());
        }
        first.push_back(curve.nodes.size() - 1);
        drawing.curves.push_back(std::move(curve));
        drawing.first.push_back(std::move(first));
    }
    return drawing;
}

/// Vertices of the border beside pieces that meet other pieces, or are no edges of the cut surface.
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

/// The surface parted by the curves: faces to their left and to their right.
struct Sides {
    std::vector<bool> left;      ///< marks of faces, among them the whole pieces of the surface under pieces without a border
    std::vector<Vertex> failed;  ///< of borders that have a region on another side than its longest border has it
};

Sides part(const InsertedCurves& cut, const Patch& patch, const std::vector<std::optional<SurfaceHit>>& places) {
    const Mesh& mesh = cut.mesh;
    constexpr std::size_t none = static_cast<std::size_t>(-1);
    std::vector<bool> fence(mesh.number_of_edges(), false);
    const auto along = [&](std::size_t l, std::size_t i) {
        return find_halfedge(mesh, Vertex(cut.node_vertex[l][i]), Vertex(cut.node_vertex[l][i + 1]));
    };
    for (std::size_t l = 0; l < cut.node_vertex.size(); ++l)
        for (std::size_t i = 0; i + 1 < cut.node_vertex[l].size(); ++i) fence[mesh.edge(along(l, i))] = true;
    std::vector<std::size_t> region(mesh.number_of_faces(), none);
    std::size_t count = 0;
    for (const Face seed : mesh.faces()) {
        if (region[seed] != none) continue;
        std::vector<Face> stack{seed};
        region[seed] = count;
        while (!stack.empty()) {
            const Face face = stack.back();
            stack.pop_back();
            for (const Halfedge h : mesh.halfedges_around_face(mesh.halfedge(face))) {
                const Halfedge other = mesh.opposite(h);
                if (fence[mesh.edge(h)] || mesh.is_border(other) || region[mesh.face(other)] != none) continue;
                region[mesh.face(other)] = count;
                stack.push_back(mesh.face(other));
            }
        }
        ++count;
    }
    std::vector<bool> left(count, false);
    std::vector<std::size_t> longest(count, none);
    std::vector<std::pair<std::size_t, std::size_t>> on_left, on_right;  // region and loop
    for (std::size_t l = 0; l < cut.node_vertex.size(); ++l)
        for (std::size_t i = 0; i + 1 < cut.node_vertex[l].size(); ++i) {
            const Halfedge h = along(l, i);
            for (const Halfedge half : {h, mesh.opposite(h)}) {
                if (mesh.is_border(half)) continue;
                const std::size_t r = region[mesh.face(half)];
                auto& side = half == h ? on_left : on_right;
                if (side.empty() || side.back() != std::pair(r, l)) side.emplace_back(r, l);
                if (longest[r] == none || patch.loops()[l].size() > patch.loops()[longest[r]].size()) longest[r] = l;
            }
        }
    for (const Face face : patch.closed()) {
        const Index old = places[corners(patch.mesh(), face)[0]]->face;
        const auto found = std::find(cut.face_origin.begin(), cut.face_origin.end(), old);
        left[region[static_cast<std::size_t>(found - cut.face_origin.begin())]] = true;
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

/// Vertices of the surface near the seam shifted by displacements that are harmonic between the seam and those `fixed`.
/// Gives marks of those vertices.
std::vector<bool> follow(const Mesh& mesh, const std::vector<bool>& gone, const std::map<Index, Vector3d>& seam, double width,
                         const std::vector<bool>& frozen, std::vector<Vector3d>& points) {
    const double edge = mean_edge_length(mesh);
    const int rings = edge > 0 ? static_cast<int>(std::clamp(std::ceil(width / edge), 1.0, 40.0)) : 1;
    std::vector<int> ring(mesh.number_of_vertices(), -1);
    std::vector<Vertex> front, band;
    for (const auto& [v, place] : seam) {
        ring[v] = 0;
        front.emplace_back(v);
    }
    const auto stays = [&](Halfedge h) { return !mesh.is_border(h) && !gone[mesh.face(h)]; };
    std::vector<std::vector<Vertex>> around;
    for (int r = 1; r <= rings; ++r) {
        std::vector<Vertex> then;
        for (const Vertex v : front)
            for (const Halfedge h : mesh.halfedges_around_target(mesh.halfedge(v))) {
                const Vertex other = mesh.source(h);
                if (ring[other] >= 0 || !(stays(h) || stays(mesh.opposite(h)))) continue;
                ring[other] = r;
                then.push_back(other);
                if (!(static_cast<std::size_t>(other) < frozen.size() && frozen[other])) band.push_back(other);
            }
        front = std::move(then);
    }
    std::vector<Vector3d> shift(mesh.number_of_vertices(), Vector3d::Zero()), next;
    for (const auto& [v, place] : seam) shift[v] = place - points[v];
    for (const Vertex v : band) {
        around.emplace_back();
        for (const Halfedge h : mesh.halfedges_around_target(mesh.halfedge(v)))
            if (stays(h) || stays(mesh.opposite(h))) around.back().push_back(mesh.source(h));
    }
    next.resize(band.size());
    for (int step = 0; step < 4 * rings; ++step) {
        for (std::size_t i = 0; i < band.size(); ++i) {
            next[i] = Vector3d::Zero();
            for (const Vertex other : around[i]) next[i] += shift[other];
            next[i] /= static_cast<double>(std::max<std::size_t>(1, around[i].size()));
        }
        for (std::size_t i = 0; i < band.size(); ++i) shift[band[i]] = next[i];
    }
    std::vector<bool> near(points.size(), false);
    for (std::size_t v = 0; v < points.size(); ++v) {
        points[v] += shift[v];
        near[v] = ring[v] >= 0;
    }
    return near;
}

using Splits = std::map<std::pair<Index, Index>, std::vector<Index>>;

/// The triangle cut so that the further vertices on its edges are corners.
void cut_triangle(std::array<Index, 3> t, const Splits& splits, std::vector<std::array<Index, 3>>& out) {
    for (int k = 0; k < 3; ++k) {
        const auto found = splits.find({t[0], t[1]});
        if (found == splits.end() || found->second.empty()) {
            t = {t[1], t[2], t[0]};
            continue;
        }
        std::vector<Index> chain{t[0]};
        chain.insert(chain.end(), found->second.begin(), found->second.end());
        chain.push_back(t[1]);
        for (std::size_t i = 0; i + 1 < chain.size(); ++i) cut_triangle({chain[i], chain[i + 1], t[2]}, splits, out);
        return;
    }
    out.push_back(t);
}

/// Vertices of the patch that few edges part from its border.
std::vector<bool> near_border(const Patch& patch) {
    constexpr int rings = 4;
    const Mesh& mesh = patch.mesh();
    std::vector<bool> near(mesh.number_of_vertices(), false);
    std::vector<Vertex> front;
    for (const auto& loop : patch.loops()) front.insert(front.end(), loop.begin(), loop.end());
    for (const Vertex v : front) near[v] = true;
    for (int r = 0; r < rings; ++r) {
        std::vector<Vertex> then;
        for (const Vertex v : front)
            for (const Halfedge h : mesh.halfedges_around_target(mesh.halfedge(v))) {
                const Vertex other = mesh.source(h);
                if (near[other]) continue;
                near[other] = true;
                then.push_back(other);
            }
        front = std::move(then);
    }
    return near;
}

/// Two surfaces with a seam, and what they are near it.
struct Stitched {
    Joint joint;
    std::vector<bool> near;  ///< marks of the faces near the seam
    /// Border vertices at edges that patch and surface both have, on either side of the seam: there is no joint.
    std::vector<Vertex> failed;
};

/// Crossings of faces near the seam that neither the patch nor the surface had by itself: the border vertices nearest to them.
std::vector<Vertex> crossings_at_seam(const Mesh& surface, const Stitched& stitched, const Patch& patch) {
    const Joint& joint = stitched.joint;
    const SubMesh near = keep_faces(joint.mesh, stitched.near);
    const auto pairs = self_intersections(to_soup(near.mesh)).pairs;
    if (pairs.empty()) return {};
    // Which of the surface's own faces crossed before.
    std::vector<bool> old(surface.number_of_faces(), false);
    for (const Index face : near.faces)
        if (joint.old_face[face] != no_index) old[joint.old_face[face]] = true;
    const SubMesh before = keep_faces(surface, old);
    std::vector<std::pair<Index, Index>> known;
    for (const auto& [a, b] : self_intersections(to_soup(before.mesh)).pairs)
        known.emplace_back(std::min(before.faces[a], before.faces[b]), std::max(before.faces[a], before.faces[b]));
    std::sort(known.begin(), known.end());
    std::vector<Vertex> found;
    for (const auto& [a, b] : pairs) {
        const Index f = joint.old_face[near.faces[a]], g = joint.old_face[near.faces[b]];
        if (f == no_index && g == no_index) continue;
        if (f != no_index && g != no_index &&
            std::binary_search(known.begin(), known.end(), std::pair(std::min(f, g), std::max(f, g))))
            continue;
        const Point place = centroid(near.mesh, Face(f == no_index ? b : a));
        Vertex nearest = patch.loops().front().front();
        for (const auto& loop : patch.loops())
            for (const Vertex v : loop)
                if (CGAL::has_smaller_distance_to_point(place, patch.mesh().point(v), patch.mesh().point(nearest))) nearest = v;
        found.push_back(nearest);
    }
    return found;
}

Stitched stitch(const Patch& patch, const InsertedCurves& cut, const Drawing& drawing, const std::vector<bool>& gone,
                double width, const std::vector<bool>& frozen) {
    const Mesh& surface = cut.mesh;
    constexpr Index none = no_index;
    TriangleSoup soup;
    const auto add = [&](const Vector3d& p) {
        soup.points.push_back({p.x(), p.y(), p.z()});
        return static_cast<Index>(soup.points.size() - 1);
    };
    std::vector<Index> of_patch(patch.mesh().number_of_vertices(), none), of_surface(surface.number_of_vertices(), none);
    for (const Face face : patch.mesh().faces())
        if (patch.has(face))
            for (const Vertex v : corners(patch.mesh(), face))
                if (of_patch[v] == none) of_patch[v] = add(eigen(patch.mesh().point(v)));

    Splits splits;
    std::map<Index, Vector3d> seam;
    std::map<Index, Vertex> border;  // new vertex -> border vertex of the patch that it is, or after which it comes
    for (std::size_t l = 0; l < patch.loops().size(); ++l) {
        const auto& loop = patch.loops()[l];
        const auto& nodes = cut.node_vertex[l];
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const Vertex a = loop[i], b = loop[(i + 1) % loop.size()];
            const std::size_t begin = drawing.first[l][i], end = drawing.first[l][i + 1];
            of_surface[nodes[begin]] = of_patch[a];
            border.emplace(of_patch[a], a);
            seam.emplace(nodes[begin], eigen(patch.mesh().point(a)));
            double length = 0;
            std::vector<double> along{0};
            for (std::size_t n = begin; n < end; ++n) {
                length += std::sqrt(CGAL::squared_distance(surface.point(Vertex(nodes[n])), surface.point(Vertex(nodes[n + 1]))));
                along.push_back(length);
            }
            std::vector<Index>& split = splits[{of_patch[a], of_patch[b]}];
            for (std::size_t n = begin + 1; n < end; ++n) {
                const double t = along[n - begin] / length;
                const Vector3d place = (1 - t) * eigen(patch.mesh().point(a)) + t * eigen(patch.mesh().point(b));
                of_surface[nodes[n]] = add(place);
                border.emplace(of_surface[nodes[n]], a);
                seam.emplace(nodes[n], place);
                split.push_back(of_surface[nodes[n]]);
            }
        }
    }
    std::vector<Vector3d> points;
    for (const Vertex v : surface.vertices()) points.push_back(eigen(surface.point(v)));
    const std::vector<bool> surface_near = follow(surface, gone, seam, width, frozen, points), patch_near = near_border(patch);

    Stitched result;
    Joint& joint = result.joint;
    joint.patch_faces = patch.size();
    for (const Face face : surface.faces()) {
        if (gone[face]) continue;
        std::array<Index, 3> triangle{};
        const auto c = corners(surface, face);
        for (std::size_t k = 0; k < 3; ++k) {
            if (of_surface[c[k]] == none) of_surface[c[k]] = add(points[c[k]]);
            triangle[k] = of_surface[c[k]];
        }
        soup.triangles.push_back(triangle);
        joint.old_face.push_back(cut.face_origin[face]);
        joint.patch_face.push_back(none);
        result.near.push_back(std::any_of(c.begin(), c.end(), [&](Vertex v) { return surface_near[v]; }));
    }
    for (const Face face : patch.mesh().faces()) {
        if (!patch.has(face)) continue;
        const auto c = corners(patch.mesh(), face);
        const std::size_t before = soup.triangles.size();
        cut_triangle({of_patch[c[0]], of_patch[c[1]], of_patch[c[2]]}, splits, soup.triangles);
        joint.old_face.resize(joint.old_face.size() + soup.triangles.size() - before, none);
        joint.patch_face.resize(joint.patch_face.size() + soup.triangles.size() - before, face);
        result.near.resize(soup.triangles.size(), std::any_of(c.begin(), c.end(), [&](Vertex v) { return patch_near[v]; }));
    }
    std::vector<std::pair<Index, Index>> edges;
    for (const auto& t : soup.triangles)
        for (std::size_t k = 0; k < 3; ++k)
            if (border.contains(t[k]) && border.contains(t[(k + 1) % 3])) edges.emplace_back(t[k], t[(k + 1) % 3]);
    std::sort(edges.begin(), edges.end());
    for (auto twice = std::adjacent_find(edges.begin(), edges.end()); twice != edges.end();
         twice = std::adjacent_find(twice + 1, edges.end())) {
        result.failed.push_back(border.at(twice->first));
        result.failed.push_back(border.at(twice->second));
    }
    if (result.failed.empty()) joint.mesh = build_mesh(soup);
    return result;
}

}  // namespace

Joint join_patch(const Mesh& surface, Patch patch, const std::vector<std::optional<SurfaceHit>>& places, double width,
                 const std::vector<bool>& frozen) {
    constexpr int most_attempts = 40, most_crossed = 12;
    Joint none, best;
    std::size_t fewest = 0;
    int crossed_attempts = 0;
    for (int attempt = 0; attempt < most_attempts; ++attempt) {
        // Where little does not help, more is taken: a ring of a fine mesh is next to nothing.
        const int rings = 1 << (attempt / 8);
        if (patch.size() == 0) {
            if (crossed_attempts > 0) return best;
            none.problem = attempt == 0 ? "nothing of it lies on the fitted template" : "its border is not simple anywhere";
            return none;
        }
        const Drawing drawing = draw(surface, patch, places);
        if (!drawing.failed.empty()) {
            patch.erode(drawing.failed, rings);
            continue;
        }
        const InsertedCurves cut = insert_curves(surface, drawing.curves);
        if (const std::vector<Vertex> failed = crossed(cut, patch, drawing); !failed.empty()) {
            patch.erode(failed, rings);
            continue;
        }
        const Sides sides = part(cut, patch, places);
        if (!sides.failed.empty()) {
            patch.erode(sides.failed, rings);
            continue;
        }
        Stitched stitched = stitch(patch, cut, drawing, sides.left, width, frozen);
        if (!stitched.failed.empty()) {
            patch.erode(stitched.failed, rings);
            continue;
        }
        const std::vector<Vertex> at =
            patch.loops().empty() ? std::vector<Vertex>() : crossings_at_seam(surface, stitched, patch);
        if (crossed_attempts == 0 || at.size() < fewest) {
            fewest = at.size();
            best = std::move(stitched.joint);
        }
        if (at.empty() || ++crossed_attempts == most_crossed) return best;
        patch.erode(at, rings);
    }
    if (crossed_attempts > 0) return best;
    none.problem = "its border crosses itself on the template";
    return none;
}

}  // namespace ostraka

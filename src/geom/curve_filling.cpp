#include "ostraka/geom/curve_filling.h"

#include "geom/face_verdict.h"

#include "ostraka/core/progress.h"
#include "ostraka/geom/distance.h"
#include "ostraka/geom/surface_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace ostraka {

double CurveFilling::area(const Mesh& mesh) const {
    double sum = 0;
    for (std::size_t f = 0; f < sides.size(); ++f)
        if (sides[f] == FaceSide::in) sum += face_area(mesh, Face(static_cast<Index>(f)));
    for (const auto& [face, share] : cut) sum += share * face_area(mesh, Face(face));
    return sum;
}

std::vector<Index> CurveFilling::majority() const {
    std::vector<Index> faces;
    auto next = cut.begin();
    for (std::size_t f = 0; f < sides.size(); ++f) {
        if (sides[f] == FaceSide::in) faces.push_back(static_cast<Index>(f));
        if (sides[f] != FaceSide::cut) continue;
        if (next->second >= 0.5) faces.push_back(static_cast<Index>(f));
        ++next;
    }
    return faces;
}

namespace {

/// Consecutive pieces of a curve in one face.
struct Stretch {
    Index face;
    std::size_t curve, first, count;  ///< pieces; in a closed curve, they may continue at its start
};

/// Stretches sorted by face. A piece along an edge is a stretch of both adjacent faces.
std::vector<Stretch> stretches_of(const Mesh& mesh, const std::vector<SurfaceCurve>& curves) {
    std::vector<Stretch> list;
    for (std::size_t c = 0; c < curves.size(); ++c) {
        const std::vector<Index>& faces = curves[c].faces;
        const std::vector<SurfacePoint>& points = curves[c].points;
        const std::size_t n = faces.size(), begin = list.size();
        bool runs_on = false, first_runs = false, last_runs = false;
        for (std::size_t i = 0; i < n; ++i) {
            if (const Index edge = shared_edge(mesh, points[i], points[i + 1]); edge != no_index) {
                for (const unsigned k : {0U, 1U})
                    if (const Halfedge h = mesh.halfedge(Edge(edge), k); !mesh.is_border(h))
                        list.push_back({static_cast<Index>(mesh.face(h)), c, i, 1});
                runs_on = last_runs = false;
                continue;
            }
            if (runs_on && list.back().face == faces[i]) ++list.back().count;
            else list.push_back({faces[i], c, i, 1});
            runs_on = last_runs = true;
            if (i == 0) first_runs = true;
        }
        // A closed curve that starts in the middle of a stretch.
        const bool closed = n > 0 && same_point(mesh, points.front(), points.back());
        if (closed && first_runs && last_runs && list.size() > begin + 1 && list.back().face == list[begin].face) {
            list.back().count += list[begin].count;
            list.erase(list.begin() + static_cast<std::ptrdiff_t>(begin));
        }
    }
    std::stable_sort(list.begin(), list.end(), [](const Stretch& a, const Stretch& b) { return a.face < b.face; });
    return list;
}

class Filler {
public:
    Filler(const Mesh& mesh, const std::vector<SurfaceCurve>& curves) : mesh_(mesh), curves_(curves) {}

    /// Geometric solution for one stretch that enters and leaves the face at its boundary; returns false for other cases.
    bool simple(const Stretch& stretch, FaceClassification& verdict) {
        const Halfedge rim[3] = {mesh_.next(mesh_.halfedge(Face(stretch.face))),
                                 mesh_.next(mesh_.next(mesh_.halfedge(Face(stretch.face)))), mesh_.halfedge(Face(stretch.face))};
        const SurfaceCurve& curve = curves_[stretch.curve];
        const std::size_t n = curve.faces.size();
        const auto chain = [&](std::size_t i) -> const SurfacePoint& {
            const std::size_t at = stretch.first + i;
            return curve.points[at <= n ? at : at - n];
        };
        const double from = around(rim, chain(0)), to = around(rim, chain(stretch.count));
        if (from < 0 || to < 0 || from == to) return false;
        for (std::size_t i = 1; i < stretch.count; ++i)
            if (!chain(i).is_in_face()) return false;  // the stretch touches the boundary in between
        const Vector normal = area_vector(mesh_, Face(stretch.face));
        const double whole = std::sqrt(normal.squared_length());
        if (!(whole > 0)) return false;
        polygon_.clear();
        for (std::size_t i = 0; i <= stretch.count; ++i) polygon_.push_back(position(mesh_, chain(i)));
        if (polygon_.size() > 3 && crosses_itself(polygon_, normal / whole)) return false;
        // Follows the boundary counter-clockwise from the exit to the entry: this closes the polygon to the left of the curve.
        const double turn = from > to ? from - to : from + 3 - to;
        double last = to;
        const auto walk = [&](double next, const Point& place) {
            const auto edge = static_cast<std::size_t>(std::floor(last)) % 3;
            if (mesh_.is_border(mesh_.opposite(rim[edge]))) verdict.border += distance(polygon_.back(), place);
            last = next;
        };
        const int first_corner = static_cast<int>(std::floor(to)) + 1;
        for (int k = first_corner; k < to + turn; ++k) {
            const Point& corner = mesh_.point(mesh_.source(rim[k % 3]));
            walk(k, corner);
            polygon_.push_back(corner);
        }
        walk(to + turn, polygon_.front());
        Vector sum(0, 0, 0);
        for (std::size_t i = 1; i + 1 < polygon_.size(); ++i)
            sum += CGAL::cross_product(polygon_[i] - polygon_[0], polygon_[i + 1] - polygon_[0]);
        verdict.share = std::clamp(0.5 * (sum * normal) / (whole * whole), 0.0, 1.0);
        for (int k = 0; k < 3; ++k) {
            if (within(from, k) || within(to, k)) continue;
            // The edge bounds the left side if its midpoint comes before `from` on the way from `to`.
            double middle = k + 0.5 - to;
            if (middle < 0) middle += 3;
            verdict.beyond[static_cast<std::size_t>(k)] = middle < turn ? 1 : 0;
        }
        return true;
    }

    /// General solution by a triangulation of the face along all its pieces; `parts`, if given, receives the triangles and
    /// whether they are inside.
    FaceClassification general(const std::vector<Stretch>& stretches,
                               std::vector<std::pair<std::array<Point, 3>, bool>>* parts = nullptr) {
        const Index face = stretches.front().face;
        std::vector<SurfaceCurve> pieces;
        for (const Stretch& stretch : stretches) {
            const SurfaceCurve& curve = curves_[stretch.curve];
            const std::size_t n = curve.faces.size();
            SurfaceCurve& piece = pieces.emplace_back();
            for (std::size_t i = 0; i <= stretch.count; ++i) {
                const std::size_t at = stretch.first + i;
                piece.points.push_back(curve.points[at <= n ? at : at - n]);
            }
            piece.faces.assign(stretch.count, face);
        }
        FaceCutter cutter(mesh_, pieces);
        const auto triangles = cutter.cut(face);
        std::map<std::pair<Index, Index>, int> net;
        for (std::size_t c = 0; c < pieces.size(); ++c) {
            const std::vector<Index> path = cutter.path(c);
            for (std::size_t i = 0; i + 1 < path.size(); ++i)
                if (path[i] != path[i + 1]) net[std::minmax(path[i], path[i + 1])] += path[i] < path[i + 1] ? 1 : -1;
        }
        return classify_face(mesh_, face, cutter, triangles, net, parts);
    }

private:
    /// Where a point lies on the boundary of the face: corner number plus fraction along the edge; negative in the interior.
    double around(const Halfedge (&rim)[3], const SurfacePoint& p) const {
        if (p.is_in_face()) return -1;
        const Edge edge = p.is_on_edge() ? edge_of(mesh_, p) : Mesh::null_edge();
        for (int k = 0; k < 3; ++k) {
            if (p.is_vertex() && p.vertex() == mesh_.source(rim[k])) return k;
            if (p.is_on_edge() && edge == mesh_.edge(rim[k])) {
                const double fraction = fraction_along(mesh_, edge, p);
                return k + (mesh_.halfedge(edge, 0) == rim[k] ? fraction : 1 - fraction);
            }
        }
        return -1;
    }

    static bool within(double place, int edge) { return place > edge && place < edge + 1; }

    static bool crosses_itself(const std::vector<Point>& chain, const Vector& normal) {
        const auto side = [&](const Point& a, const Point& b, const Point& c) {
            return CGAL::cross_product(b - a, c - a) * normal;
        };
        for (std::size_t i = 0; i + 1 < chain.size(); ++i)
            for (std::size_t j = i + 2; j + 1 < chain.size(); ++j) {
                const Point &a = chain[i], &b = chain[i + 1], &c = chain[j], &d = chain[j + 1];
                if (side(a, b, c) * side(a, b, d) <= 0 && side(c, d, a) * side(c, d, b) <= 0) return true;
            }
        return false;
    }

    const Mesh& mesh_;
    const std::vector<SurfaceCurve>& curves_;
    std::vector<Point> polygon_;
};

}  // namespace

FaceClassification classify_face(const Mesh& mesh, Index face, const FaceCutter& cutter,
                                 const std::vector<std::array<Index, 3>>& triangles,
                                 const std::map<std::pair<Index, Index>, int>& net,
                                 std::vector<std::pair<std::array<Point, 3>, bool>>* parts) {
    FaceClassification verdict;
    enum { unknown, left, right };
    std::vector<int> side(triangles.size(), unknown);
    std::map<std::pair<Index, Index>, std::size_t> owner;  // directed edge -> triangle on its left
    for (std::size_t t = 0; t < triangles.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) owner[{triangles[t][k], triangles[t][(k + 1) % 3]}] = t;
    const auto weight = [&](Index a, Index b) {
        const auto found = net.find(std::minmax(a, b));
        return found == net.end() ? 0 : a < b ? found->second : -found->second;
    };
    std::vector<std::size_t> stack;
    const auto claim = [&](std::size_t t, int as) {
        if (side[t] == unknown) {
            side[t] = as;
            stack.push_back(t);
        } else if (side[t] != as) {
            ++verdict.conflicts;
        }
    };
    for (const auto& [edge, t] : owner)
        if (const int w = weight(edge.first, edge.second); w != 0) claim(t, w > 0 ? left : right);
    verdict.known = !stack.empty();
    while (!stack.empty()) {
        const std::size_t t = stack.back();
        stack.pop_back();
        for (std::size_t k = 0; k < 3; ++k) {
            const Index a = triangles[t][k], b = triangles[t][(k + 1) % 3];
            if (const auto other = owner.find({b, a}); other != owner.end() && weight(a, b) == 0) claim(other->second, side[t]);
        }
    }
    if (!verdict.known) return verdict;
    double sum = 0, inside = 0;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        const Point &a = cutter.point(triangles[t][0]), &b = cutter.point(triangles[t][1]), &c = cutter.point(triangles[t][2]);
        const double area = std::sqrt(CGAL::cross_product(b - a, c - a).squared_length());
        sum += area;
        if (side[t] == left) inside += area;
        if (parts != nullptr) parts->emplace_back(std::array<Point, 3>{a, b, c}, side[t] == left);
    }
    verdict.area = sum / 2;
    verdict.share = sum > 0 ? inside / sum : side.front() == left ? 1 : 0;
    const auto old_corners = corners(mesh, Face(face));
    for (std::size_t k = 0; k < 3; ++k) {
        const Vertex a = old_corners[k], b = old_corners[(k + 1) % 3];
        const Halfedge h = find_halfedge(mesh, a, b);
        if (mesh.is_border(mesh.opposite(h))) {
            // The part of the edge that borders on triangles inside.
            const Edge e = mesh.edge(h);
            std::vector<Index> rim{a};
            if (const auto on = cutter.on_edge().find(e); on != cutter.on_edge().end()) {
                for (const auto& [parameter, v] : on->second) rim.push_back(v);
                if (mesh.halfedge(e, 0) != h) std::reverse(rim.begin() + 1, rim.end());
            }
            rim.push_back(b);
            for (std::size_t i = 0; i + 1 < rim.size(); ++i)
                if (const auto found = owner.find({rim[i], rim[i + 1]}); found != owner.end() && side[found->second] == left)
                    verdict.border += std::sqrt(CGAL::squared_distance(cutter.point(rim[i]), cutter.point(rim[i + 1])));
            continue;
        }
        const auto found = owner.find({a, b});
        if (found == owner.end()) continue;
        const bool turned = weight(a, b) != 0;  // a curve follows the edge: the adjacent face lies on the other side
        verdict.beyond[k] = (side[found->second] == left) != turned ? 1 : 0;
    }
    return verdict;
}

CurveFilling fill_curves(const Mesh& mesh, const std::vector<SurfaceCurve>& curves, const std::vector<Index>& seeds) {
    check_cancelled();
    CurveFilling filling;
    filling.sides.assign(mesh.number_of_faces(), FaceSide::out);
    std::vector<bool> known(mesh.number_of_faces(), false);
    const std::vector<Stretch> stretches = stretches_of(mesh, curves);
    Filler filler(mesh, curves);
    std::vector<std::pair<Index, bool>> beyond;  // faces without curves next to faces with curves
    for (std::size_t i = 0; i < stretches.size();) {
        std::size_t end = i;
        while (end < stretches.size() && stretches[end].face == stretches[i].face) ++end;
        const Index face = stretches[i].face;
        FaceClassification verdict;
        if (end - i > 1 || !filler.simple(stretches[i], verdict))
            verdict = filler.general(
                {stretches.begin() + static_cast<std::ptrdiff_t>(i), stretches.begin() + static_cast<std::ptrdiff_t>(end)});
        i = end;
        if (!verdict.known) continue;  // pieces that cancel are not a boundary
        known[face] = true;
        filling.conflicts += verdict.conflicts;
        filling.border += verdict.border;
        constexpr double nothing = 1e-12;  // fractions up to this size are due to rounding
        if (verdict.share > nothing && verdict.share < 1 - nothing) {
            filling.sides[face] = FaceSide::cut;
            filling.cut.emplace_back(face, verdict.share);
        } else {
            filling.sides[face] = verdict.share > 0.5 ? FaceSide::in : FaceSide::out;
        }
        const Halfedge last = mesh.halfedge(Face(face));
        const Halfedge rim[3] = {mesh.next(last), mesh.next(mesh.next(last)), last};
        for (std::size_t k = 0; k < 3; ++k)
            if (verdict.beyond[k] >= 0 && !mesh.is_border(mesh.opposite(rim[k])))
                beyond.emplace_back(mesh.face(mesh.opposite(rim[k])), verdict.beyond[k] == 1);
    }
    // Faces with curves are already classified. Of the others, first those adjacent to them are classified, then all faces that
    // can be reached.
    std::vector<Face> stack;
    const auto claim = [&](Face f, bool inside) {
        const FaceSide as = inside ? FaceSide::in : FaceSide::out;
        if (known[f]) {
            if (filling.sides[f] != as && filling.sides[f] != FaceSide::cut) ++filling.conflicts;
            return;
        }
        known[f] = true;
        filling.sides[f] = as;
        if (inside) stack.push_back(f);
    };
    for (const auto& [face, inside] : beyond) claim(Face(face), inside);
    const std::vector<bool> seen = known;
    for (const Index seed : seeds)
        if (!known[seed]) claim(Face(seed), true);
    while (!stack.empty()) {
        const Face f = stack.back();
        stack.pop_back();
        for (const Halfedge h : mesh.halfedges_around_face(mesh.halfedge(f))) {
            if (mesh.is_border(mesh.opposite(h))) {
                filling.border += std::sqrt(CGAL::squared_distance(mesh.point(mesh.source(h)), mesh.point(mesh.target(h))));
                continue;
            }
            const Face g = mesh.face(mesh.opposite(h));
            // A conflict: inside next to outside without a curve along the common edge (faces traversed by curves are already
            // known).
            if (!known[g]) claim(g, true);
            else if (seen[g] && !seen[f] && filling.sides[g] == FaceSide::out) ++filling.conflicts;
        }
    }
    return filling;
}

CutFaces::CutFaces(const Mesh& mesh, const std::vector<SurfaceCurve>& curves, const CurveFilling& filling) {
    const std::vector<Stretch> stretches = stretches_of(mesh, curves);
    Filler filler(mesh, curves);
    first_.push_back(0);
    std::vector<std::pair<std::array<Point, 3>, bool>> parts;
    for (std::size_t i = 0; i < stretches.size();) {
        std::size_t end = i;
        while (end < stretches.size() && stretches[end].face == stretches[i].face) ++end;
        const Index face = stretches[i].face;
        if (filling.sides[face] == FaceSide::cut) {
            parts.clear();
            filler.general(
                {stretches.begin() + static_cast<std::ptrdiff_t>(i), stretches.begin() + static_cast<std::ptrdiff_t>(end)},
                &parts);
            for (const auto& [corners, inside] : parts) pieces_.push_back({corners, inside});
            faces_.push_back(face);
            first_.push_back(pieces_.size());
        }
        i = end;
    }
}

bool CutFaces::inside(Index face, const Point& place) const {
    const auto found = std::lower_bound(faces_.begin(), faces_.end(), face);
    if (found == faces_.end() || *found != face) return false;
    const auto at = static_cast<std::size_t>(found - faces_.begin());
    double best = std::numeric_limits<double>::infinity();
    bool inside = false;
    for (std::size_t i = first_[at]; i < first_[at + 1]; ++i) {
        const auto& [a, b, c] = pieces_[i].corners;
        const double distance = CGAL::squared_distance(point_at(a, b, c, nearest_barycentric(a, b, c, place)), place);
        if (distance < best) best = distance, inside = pieces_[i].inside;
    }
    return inside;
}

}  // namespace ostraka

// Orientation, and splitting of non-manifold edges and vertices.
#include "io/repair_steps.h"
#include "io/soup_geometry.h"
#include "ostraka/core/angles.h"

#include <cmath>

namespace ostraka::detail {

Counts orient_patches(RepairSoup& work) {
    auto& soup = work.soup;
    const SoupEdges edges = group_edges(soup);
    // Only edges with exactly two triangles determine the relative orientation of their triangles.
    std::vector<Index> partner(3 * soup.triangles.size(), no_index);
    for (std::size_t e = 0; e < edges.count(); ++e) {
        if (edges.valence(e) != 2) continue;
        const Index* h = edges.first(e);
        partner[h[0]] = h[1];
        partner[h[1]] = h[0];
    }
    constexpr std::uint8_t unknown = 2;
    std::vector<std::uint8_t> flip_state(soup.triangles.size(), unknown);
    std::vector<Index> patch;
    std::size_t flipped = 0, conflicts = 0;
    for (Index seed = 0; seed < work.triangle_count(); ++seed) {
        if (flip_state[seed] != unknown) continue;
        patch.assign(1, seed);
        flip_state[seed] = 0;
        std::size_t flipped_count = 0;
        for (std::size_t i = 0; i < patch.size(); ++i) {  // breadth first, so that conflicts occur far from the seed
            const Index t = patch[i];
            for (Index h = 3 * t; h < 3 * t + 3; ++h) {
                if (partner[h] == no_index) continue;
                const Index neighbour = partner[h] / 3;
                const std::uint8_t expected_state = flip_state[t] ^ (origin(soup, h) == origin(soup, partner[h]) ? 1 : 0);
                if (flip_state[neighbour] == unknown) {
                    flip_state[neighbour] = expected_state;
                    flipped_count += expected_state;
                    patch.push_back(neighbour);
                } else if (flip_state[neighbour] != expected_state && h < partner[h]) {
                    ++conflicts;
                }
            }
        }
        // The orientation of the majority is kept.
        const std::uint8_t minority = 2 * flipped_count <= patch.size() ? 1 : 0;
        for (const Index t : patch) flip_state[t] = flip_state[t] == minority ? 1 : 0;
    }
    for (Index t = 0; t < work.triangle_count(); ++t)
        if (flip_state[t] == 1) work.flip(t), ++flipped;
    return {{"flipped triangles", flipped}, {"edges cut because the surface has one side only", conflicts}};
}

namespace {

void join_halfedges(std::vector<Index>& opposite, Index h, Index o) {
    opposite[h] = o;
    if (o != no_index) opposite[o] = h;
}

/// A triangle soup with explicit adjacency, not derived from the vertex indices.
struct Joints {
    RepairSoup& work;
    std::vector<Index> opposite;

    void join(Index h, Index o) { join_halfedges(opposite, h, o); }

    /// Inserts vertex m into halfedge h = a -> b of triangle (a, b, c), which becomes (m, b, c), and adds (a, m, c). Returns
    /// the added triangle; its halfedges are a -> m, m -> c, c -> a.
    Index halve_triangle(Index h, Index m) {
        auto& soup = work.soup;
        const Index t = h / 3, p = previous_halfedge(h), a = origin(soup, h), c = apex(soup, h);
        const auto like = work.corner_like[t];
        const auto added = static_cast<Index>(soup.triangles.size());
        work.add_triangle({a, m, c}, work.face_source[t], work.face_like[t], {like[h % 3], like[h % 3], like[p % 3]},
                          work.flipped[t] != 0);
        soup.triangles[t][h % 3] = m;
        opposite.resize(opposite.size() + 3, no_index);
        join(3 * added + 2, opposite[p]);
        join(3 * added + 1, p);
        return added;
    }

    void split_edge(Index h) {
        auto& soup = work.soup;
        const Index a = origin(soup, h), b = target(soup, h), o = opposite[h];
        std::array<double, 3> middle;
        for (std::size_t k = 0; k < 3; ++k) middle[k] = soup.points[a][k] / 2 + soup.points[b][k] / 2;
        const Index m = work.add_vertex(middle, no_index, work.vertex_like[a], (work.touched[a] & work.touched[b]) != 0);
        const Index near_a = halve_triangle(h, m);
        opposite[h] = no_index;
        opposite[3 * near_a] = no_index;
        if (o == no_index) return;
        const Index near_b = halve_triangle(o, m);
        join(3 * near_a, o);  // a -> m and m -> a
        join(h, 3 * near_b);  // m -> b and b -> m
    }
};

/// Joins the triangles around one edge in pairs so that no two pairs cross: sorted by angle, each triangle with the solid on
/// its far side (at larger angles) is joined to the next triangle with the solid on its near side.
std::size_t pair_around(const TriangleSoup& soup, const Index* halfedges, Index valence, std::vector<Index>& opposite) {
    const Index low = std::min(origin(soup, halfedges[0]), target(soup, halfedges[0]));
    const Index high = std::max(origin(soup, halfedges[0]), target(soup, halfedges[0]));
    const Point start = point(soup, low);
    Vector axis = point(soup, high) - start;
    axis = axis / std::sqrt(std::max(axis.squared_length(), 1e-300));
    Vector zero(0, 0, 0), side(0, 0, 0);
    struct Leaf {
        double angle;
        bool opens;  ///< the solid lies at larger angles
        Index halfedge;
    };
    std::vector<Leaf> leaves;
    for (Index i = 0; i < valence; ++i) {
        Vector direction = point(soup, apex(soup, halfedges[i])) - start;
        direction = direction - (direction * axis) * axis;
        const double length = std::sqrt(direction.squared_length());
        if (length > 0) direction = direction / length;
        if (i == 0) zero = direction, side = CGAL::cross_product(axis, direction);
        double angle = std::atan2(direction * side, direction * zero);
        if (i > 0 && apex(soup, halfedges[i]) == apex(soup, halfedges[0])) angle = 0;
        if (angle < 0) angle += 2 * pi;
        leaves.push_back({angle, origin(soup, halfedges[i]) == high, halfedges[i]});
    }
    // At equal angles (a wall between two solids), the end of a solid comes before the beginning of the next.
    std::sort(leaves.begin(), leaves.end(), [](const Leaf& a, const Leaf& b) {
        return a.angle != b.angle ? a.angle < b.angle : a.opens != b.opens ? b.opens : a.halfedge < b.halfedge;
    });
    // Matched like brackets; two rounds, since a circle has no beginning.
    std::vector<Index> waiting;
    std::size_t joined = 0;
    for (int round = 0; round < 2; ++round)
        for (const Leaf& leaf : leaves) {
            if (opposite[leaf.halfedge] != no_index) continue;
            if (leaf.opens) {
                if (round == 0) waiting.push_back(leaf.halfedge);
            } else if (!waiting.empty()) {
                opposite[leaf.halfedge] = waiting.back();
                opposite[waiting.back()] = leaf.halfedge;
                waiting.pop_back();
                ++joined;
            }
        }
    return joined;
}

/// One vertex per fan; the first fan keeps the vertex, the others get copies.
std::size_t separate_fans(Joints& joints) {
    RepairSoup& work = joints.work;
    auto& soup = work.soup;
    const auto corners = static_cast<Index>(3 * soup.triangles.size());
    DisjointSets fans(corners);
    for (Index h = 0; h < corners; ++h) {
        const Index o = joints.opposite[h];
        if (o == no_index || o < h) continue;
        fans.unite(h, next_halfedge(o));
        fans.unite(next_halfedge(h), o);
    }
    std::vector<std::uint8_t> taken(soup.points.size(), 0);
    std::vector<Index> vertex_of_fan(corners, no_index);
    std::size_t copies = 0;
    for (Index c = 0; c < corners; ++c) {
        if (fans.find(c) != c) continue;
        const Index v = soup.triangles[c / 3][c % 3];
        if (taken[v] == 0) {
            taken[v] = 1;
            vertex_of_fan[c] = v;
        } else {
            vertex_of_fan[c] = work.add_vertex(soup.points[v], work.vertex_source[v], work.vertex_like[v], work.touched[v] != 0);
            ++copies;
        }
    }
    for (Index c = 0; c < corners; ++c) soup.triangles[c / 3][c % 3] = vertex_of_fan[fans.find(c)];
    return copies;
}

/// Splits distinct edges between the same two vertices: all but the first get a vertex at their midpoint.
std::size_t separate_edges(Joints& joints) {
    const SoupEdges edges = group_edges(joints.work.soup);
    std::vector<std::uint8_t> halved(joints.work.soup.triangles.size(), 0);
    std::size_t split = 0;
    for (std::size_t e = 0; e < edges.count(); ++e) {
        const Index* h = edges.first(e);
        const Index valence = edges.valence(e);
        if (valence < 2 || (valence == 2 && joints.opposite[h[0]] == h[1])) continue;
        // The listed sides of a split triangle are outdated: its edges are handled in the next call.
        if (std::any_of(h, h + valence, [&](Index g) { return halved[g / 3] != 0; })) continue;
        bool first = true;
        for (Index i = 0; i < valence; ++i) {
            const Index o = joints.opposite[h[i]];
            if (o != no_index && std::find(h, h + i, o) != h + i) continue;  // each adjacency is met from both sides
            if (!first) {
                joints.split_edge(h[i]);
                halved.resize(joints.work.soup.triangles.size(), 1);
                halved[h[i] / 3] = 1;
                if (o != no_index) halved[o / 3] = 1;
                ++split;
            }
            first = false;
        }
    }
    return split;
}

/// What was done at edges when triangles were joined in pairs.
struct EdgeCounts {
    std::size_t nonmanifold = 0;  ///< edges with more than two triangles
    std::size_t cut = 0;          ///< sides of triangles that were left unjoined
};

/// Joins triangles at edges in pairs; triangles whose flag in `detached` is set are joined to none.
EdgeCounts join_in_pairs(Joints& joints, const std::vector<std::uint8_t>& detached = {}) {
    const TriangleSoup& soup = joints.work.soup;
    const SoupEdges edges = group_edges(soup);
    EdgeCounts counts;
    std::vector<Index> sides;
    for (std::size_t e = 0; e < edges.count(); ++e) {
        sides.assign(edges.first(e), edges.first(e) + edges.valence(e));
        if (!detached.empty()) std::erase_if(sides, [&](Index h) { return detached[h / 3] != 0; });
        const auto valence = static_cast<Index>(sides.size());
        if (valence == 2) {
            if (origin(soup, sides[0]) != origin(soup, sides[1])) joints.join(sides[0], sides[1]);
            else ++counts.cut;
        } else if (valence > 2) {
            ++counts.nonmanifold;
            counts.cut += valence - 2 * pair_around(soup, sides.data(), valence, joints.opposite);
        }
    }
    return counts;
}

/// Flags the triangles with a side between the same two vertices as another side that is not joined to it, except those of the
/// first side. Returns their number.
std::size_t detach_parallel(const Joints& joints, std::vector<std::uint8_t>& detached) {
    const SoupEdges edges = group_edges(joints.work.soup);
    std::size_t count = 0;
    for (std::size_t e = 0; e < edges.count(); ++e) {
        const Index* h = edges.first(e);
        for (Index i = 1; i < edges.valence(e); ++i) {
            if (joints.opposite[h[0]] == h[i] || detached[h[i] / 3] != 0) continue;
            detached[h[i] / 3] = 1;
            ++count;
        }
    }
    return count;
}

}  // namespace

std::size_t cut_apart(RepairSoup& work) {
    std::vector<std::uint8_t> detached(work.soup.triangles.size(), 0);
    for (;;) {  // rarely more than once; a detached triangle has no parallel sides
        RepairSoup trial = work;
        Joints joints{trial, std::vector<Index>(3 * trial.soup.triangles.size(), no_index)};
        join_in_pairs(joints, detached);
        const std::size_t copies = separate_fans(joints);
        if (detach_parallel(joints, detached) > 0) continue;
        work = std::move(trial);
        return copies;
    }
}

Counts separate_nonmanifold(RepairSoup& work) {
    Joints joints{work, std::vector<Index>(3 * work.soup.triangles.size(), no_index)};
    const auto [nonmanifold, cut] = join_in_pairs(joints);
    const std::size_t copies = separate_fans(joints);
    std::size_t split = 0;
    while (const std::size_t newly_split = separate_edges(joints)) split += newly_split;
    return {{"non-manifold edges taken apart", nonmanifold},
            {"triangle sides left unjoined there", cut},
            {"copies of vertices made", copies},
            {"edges split", split}};
}

Counts orient_outwards(RepairSoup& work) {
    auto& soup = work.soup;
    const std::vector<Index> opposite = opposite_halfedges(soup);
    DisjointSets sets = joined_vertices(soup);
    std::vector<Index> number(soup.points.size(), no_index), component(soup.triangles.size());
    std::vector<bool> closed;
    std::vector<std::uint8_t> as_read;
    std::vector<double> volume;
    std::vector<Point> apex_of;
    for (Index t = 0; t < work.triangle_count(); ++t) {
        const Index root = sets.find(soup.triangles[t][0]);
        if (number[root] == no_index) {
            number[root] = static_cast<Index>(closed.size());
            closed.push_back(true);
            as_read.push_back(1);
            volume.push_back(0);
            apex_of.push_back(point(soup, soup.triangles[t][0]));
        }
        const Index c = component[t] = number[root];
        for (Index h = 3 * t; h < 3 * t + 3; ++h)
            if (opposite[h] == no_index) closed[c] = false;
        if (work.flipped[t] != 0) as_read[c] = 0;
        volume[c] += sixfold_volume(soup, soup.triangles[t], apex_of[c]);
    }
    // The wall of a cavity is correctly oriented inwards: it is kept if it was read with this orientation and lies inside
    // another component.
    std::vector<Index> inward, unturned;
    for (Index c = 0; c < closed.size(); ++c) {
        if (!closed[c] || !(volume[c] < 0)) continue;
        inward.push_back(c);
        if (as_read[c] != 0) unturned.push_back(c);
    }
    const auto enclosed = enclosed_components(soup, component, closed, unturned);
    std::vector<std::uint8_t> turn(closed.size(), 0);
    std::size_t turned = 0, cavities = 0;
    for (const Index c : inward) {
        if (enclosed[c] != 0) ++cavities;
        else turn[c] = 1, ++turned;
    }
    for (Index t = 0; t < work.triangle_count(); ++t)
        if (turn[component[t]] != 0) work.flip(t);
    return {{"components turned outwards", turned}, {"cavities left", cavities}};
}

namespace {
bool joined_by_edge(const TriangleSoup& soup, const std::vector<Index>& opposite, Index leaving, Index other) {
    // Around the start of `leaving`, in both directions if there is a border.
    for (Index h = leaving;;) {
        if (target(soup, h) == other || origin(soup, previous_halfedge(h)) == other) return true;
        h = opposite[previous_halfedge(h)];
        if (h == leaving) return false;
        if (h == no_index) break;
    }
    for (Index h = leaving; opposite[h] != no_index;) {
        h = next_halfedge(opposite[h]);
        if (target(soup, h) == other) return true;
    }
    return false;
}
}  // namespace

Counts flip_degenerate(RepairSoup& work) {
    auto& soup = work.soup;
    std::vector<Index> opposite = opposite_halfedges(soup);
    std::vector<Index> queue;
    const auto without_area = triangles_without_area(soup);
    for (Index t = 0; t < work.triangle_count(); ++t)
        if (without_area[t] != 0) queue.push_back(t);
    std::vector<std::uint8_t> keep(soup.triangles.size(), 1);
    std::size_t flipped = 0, dropped = 0;
    const std::size_t maximum = 20 * queue.size();
    const auto join = [&](Index h, Index o) { join_halfedges(opposite, h, o); };
    for (std::size_t i = 0; i < queue.size() && i < maximum; ++i) {
        const Index t = queue[i];
        if (keep[t] == 0 || !has_no_area(soup, soup.triangles[t])) continue;
        // The middle corner lies on the longest side, which is opposite to it.
        Index h = 3 * t;
        double longest = -1;
        for (Index g = 3 * t; g < 3 * t + 3; ++g) {
            const double length = CGAL::squared_distance(point(soup, origin(soup, g)), point(soup, target(soup, g)));
            if (length > longest) longest = length, h = g;
        }
        const Index o = opposite[h];
        if (o == no_index) {  // on the border, the triangle can be removed
            keep[t] = 0;
            ++dropped;
            for (Index g = 3 * t; g < 3 * t + 3; ++g) {
                if (opposite[g] != no_index) opposite[opposite[g]] = no_index;
                opposite[g] = no_index;
            }
            continue;
        }
        // (a, b, m) and (b, a, c) become (m, a, c) and (m, c, b).
        const Index other = o / 3, a = origin(soup, h), b = target(soup, h), m = apex(soup, h), c = apex(soup, o);
        if (m == c || joined_by_edge(soup, opposite, previous_halfedge(h), c)) continue;
        const Index b_to_m = opposite[next_halfedge(h)], m_to_a = opposite[previous_halfedge(h)];
        const Index a_to_c = opposite[next_halfedge(o)], c_to_b = opposite[previous_halfedge(o)];
        const auto like_t = work.corner_like[t], like_o = work.corner_like[other];
        const Index like_m = like_t[previous_halfedge(h) % 3], like_a = like_o[next_halfedge(o) % 3], like_b = like_o[o % 3],
                    like_c = like_o[previous_halfedge(o) % 3];
        soup.triangles[t] = {m, a, c};
        soup.triangles[other] = {m, c, b};
        work.corner_like[t] = {like_m, like_a, like_c};
        work.corner_like[other] = {like_m, like_c, like_b};
        work.face_source[t] = work.face_source[other];  // both are parts of the triangle with non-zero area
        work.face_like[t] = work.face_like[other];
        work.flipped[t] = work.flipped[other];
        join(3 * t, m_to_a);
        join(3 * t + 1, a_to_c);
        join(3 * t + 2, 3 * other);
        join(3 * other + 1, c_to_b);
        join(3 * other + 2, b_to_m);
        ++flipped;
        queue.push_back(t);
        queue.push_back(other);
    }
    work.keep_triangles(keep);
    return {{"edges flipped", flipped}, {"border triangles dropped", dropped}};
}

}  // namespace ostraka::detail

#include "synthetic/uniform_remesher.h"

#include <algorithm>

namespace ostraka::shapes {

HalfedgeTable::HalfedgeTable(const Triangles& mesh)
    : origin_(3 * mesh.faces.size()),
      opposite_(3 * mesh.faces.size(), no_index),
      outgoing_(mesh.points.size(), no_index),
      living_vertices_(mesh.points.size()) {
    // Halfedges sorted by origin; each finds its opposite among those of its target.
    std::vector<Index> begin(mesh.points.size() + 1, 0);
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        for (int k = 0; k < 3; ++k) {
            origin_[3 * f + k] = mesh.faces[f][k];
            ++begin[mesh.faces[f][k] + 1];
        }
    }
    for (std::size_t v = 0; v + 1 < begin.size(); ++v) begin[v + 1] += begin[v];
    std::vector<Index> by_origin(origin_.size()), cursor(begin.begin(), begin.end() - 1);
    for (Index h = 0; h < origin_.size(); ++h) by_origin[cursor[origin_[h]]++] = h;
    for (Index h = 0; h < origin_.size(); ++h) {
        outgoing_[origin_[h]] = h;
        if (opposite_[h] != no_index) continue;
        const Index from = origin_[h], to = target(h);
        for (Index i = begin[to]; i < begin[to + 1]; ++i) {
            if (target(by_origin[i]) == from) glue(h, by_origin[i]);
        }
    }
}

bool HalfedgeTable::can_collapse(Index h) const {
    const Index a = origin(h), b = target(h);
    const Index c = target(next(h)), d = target(next(opposite(h)));
    // Link condition (Dey et al., Topology preserving edge contraction, 1999): the only common neighbours are the opposite
    // corners.
    int valence_a = 0, valence_b = 0, valence_c = 0, valence_d = 0, common = 0;
    Index ring[32];
    bool too_many = false;
    around(a, [&](Index g) {
        if (valence_a == 32) too_many = true;
        else ring[valence_a++] = target(g);
    });
    if (too_many) return false;
    around(b, [&](Index g) {
        ++valence_b;
        common += static_cast<int>(std::find(ring, ring + valence_a, target(g)) != ring + valence_a);
    });
    around(c, [&](Index) { ++valence_c; });
    around(d, [&](Index) { ++valence_d; });
    return common == 2 && c != d && valence_c > 3 && valence_d > 3 && valence_a + valence_b > 7 && valence_a + valence_b < 16;
}

void HalfedgeTable::collapse(Index h) {
    const Index o = opposite(h), a = origin(h), b = target(h);
    const Index c = target(next(h)), d = target(next(o));
    around(b, [&](Index g) { origin_[g] = a; });
    const Index to_c = opposite(previous(h)), from_c = opposite(next(h));  // edges a -> c and c -> b of the neighbouring faces
    const Index to_d = opposite(previous(o)), from_d = opposite(next(o));  // edges b -> d and d -> a
    glue(to_c, from_c);
    glue(to_d, from_d);
    outgoing_[a] = to_c;
    outgoing_[c] = from_c;
    outgoing_[d] = from_d;
    outgoing_[b] = no_index;
    for (const Index face : {h / 3, o / 3}) {
        for (Index k = 0; k < 3; ++k) origin_[3 * face + k] = no_index;
    }
    --living_vertices_;
}

bool HalfedgeTable::can_flip(Index h) const {
    const Index c = target(next(h)), d = target(next(opposite(h)));
    if (c == d) return false;
    bool joined = false;
    int valence_a = 0, valence_b = 0;
    around(c, [&](Index g) { joined = joined || target(g) == d; });
    around(origin(h), [&](Index) { ++valence_a; });
    around(target(h), [&](Index) { ++valence_b; });
    return !joined && valence_a > 3 && valence_b > 3;
}

void HalfedgeTable::flip(Index h) {
    // Faces (a, b, c) and (b, a, d) become (c, d, b) and (d, c, a).
    const Index o = opposite(h), a = origin(h), b = target(h);
    const Index hn = next(h), hp = previous(h), on = next(o), op = previous(o);
    const Index c = origin(hp), d = origin(op);
    const Index bc = opposite(hn), ca = opposite(hp), ad = opposite(on), db = opposite(op);
    origin_[h] = c, origin_[hn] = d, origin_[hp] = b;  // c -> d -> b -> c
    origin_[o] = d, origin_[on] = c, origin_[op] = a;  // d -> c -> a -> d
    glue(hn, db);
    glue(hp, bc);
    glue(on, ca);
    glue(op, ad);
    outgoing_[a] = op, outgoing_[b] = hp, outgoing_[c] = h, outgoing_[d] = o;
}

}  // namespace ostraka::shapes

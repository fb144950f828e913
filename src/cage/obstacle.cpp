#include "cage/shrink.h"
#include "ostraka/geom/watched_tree.h"
#include "ostraka/mesh/disjoint_sets.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>

namespace ostraka::cage {

namespace {
using Triangle3 = Kernel::Triangle_3;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, std::vector<Triangle3>::const_iterator>;
}  // namespace

struct Obstacle::Tree {
    std::vector<Triangle3> triangles;
    CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>> search;
};

Obstacle::Obstacle(const TriangleSoup& soup) : tree_(new Tree) {
    const auto point = [&](Index v) { return Point(soup.points[v][0], soup.points[v][1], soup.points[v][2]); };
    DisjointSets sets(soup.points.size());
    std::vector<bool> used(soup.points.size(), false);
    for (const auto& [a, b, c] : soup.triangles) {
        sets.unite_into(a, b);
        sets.unite_into(a, c);
        used[a] = used[b] = used[c] = true;
        // A triangle without area is part of its neighbours' edges, or a separate piece that is represented by its point.
        if (!CGAL::collinear(point(a), point(b), point(c))) tree_->triangles.emplace_back(point(a), point(b), point(c));
    }
    for (Index v = 0; v < sets.size(); ++v)
        if (used[v] && sets.find(v) == v) pieces_.push_back(point(v));
    tree_->search.insert(tree_->triangles.begin(), tree_->triangles.end());
    build_watched(tree_->search);
}
Obstacle::~Obstacle() = default;

bool Obstacle::meets(const Point& a, const Point& b, const Point& c) const {
    return tree_->search.do_intersect(Triangle3(a, b, c));
}

}  // namespace ostraka::cage

#include "coords/cage_arrays.h"

#include "ostraka/core/error.h"

#include <algorithm>

namespace ostraka::coords {

CageArrays::CageArrays(const Mesh& cage) {
    Vector3 low{INFINITY, INFINITY, INFINITY}, high{-INFINITY, -INFINITY, -INFINITY};
    for (const Vertex v : cage.vertices()) {
        points.push_back(vector3(cage.point(v)));
        for (std::size_t k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], points.back()[k]);
            high[k] = std::max(high[k], points.back()[k]);
        }
    }
    const Vector3 extent = high - low;
    const double largest = *std::max_element(extent.begin(), extent.end());
    if (!(largest > 0) || !std::isfinite(largest))
        fail_input("cage", "has no extent", "its points must be finite and not all the same");
    int exponent = 0;
    (void)std::frexp(largest, &exponent);
    scale = std::ldexp(1.0, -std::clamp(exponent, -1000, 1000));
    diagonal = length(scale * extent);

    std::vector<Index> edge_index(cage.number_of_edges());
    for (const Edge e : cage.edges()) {
        edge_index[e] = static_cast<Index>(edges.size());
        const Halfedge h = cage.halfedge(e, 0);
        const Index a = cage.source(h), b = cage.target(h);
        const Vector3 along = scale * (points[b] - points[a]);
        edges.push_back({a, b, along, length(along)});
    }
    for (const Face f : cage.faces()) {
        CageFace face{};
        Halfedge h = cage.halfedge(f);
        for (std::size_t k = 0; k < 3; ++k, h = cage.next(h)) {
            // The halfedge from corner k + 1 to corner k + 2.
            face.corner[(k + 1) % 3] = cage.source(h);
            face.edge[k] = edge_index[cage.edge(h)];
            face.sign[k] = edges[face.edge[k]].from == face.corner[(k + 1) % 3] ? 1 : -1;
        }
        const auto side = [&](std::size_t k) { return face.sign[k] * edges[face.edge[k]].along; };
        // The cross product of the two shortest sides has the smallest rounding error.
        std::size_t longest = 0;
        for (std::size_t k = 1; k < 3; ++k)
            if (edges[face.edge[k]].length > edges[face.edge[longest]].length) longest = k;
        face.normal = cross(side((longest + 1) % 3), side((longest + 2) % 3));
        face.double_area = length(face.normal);
        faces.push_back(face);
    }
}

}  // namespace ostraka::coords

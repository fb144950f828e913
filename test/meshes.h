// Small meshes of all topologies.
#pragma once

#include "ostraka/mesh/mesh.h"

#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <utility>

namespace ostraka::test {

/// A triangulated grid of quads, periodic in neither, one or both directions.
inline TriangleSoup grid(Index columns, Index rows, bool wrap_columns, bool wrap_rows,
                         const std::function<std::array<double, 3>(double, double)>& point) {
    TriangleSoup soup;
    const Index nu = wrap_columns ? columns : columns + 1, nv = wrap_rows ? rows : rows + 1;
    for (Index j = 0; j < nv; ++j)
        for (Index i = 0; i < nu; ++i) soup.points.push_back(point(double(i) / columns, double(j) / rows));
    for (Index j = 0; j < rows; ++j)
        for (Index i = 0; i < columns; ++i) {
            const Index i1 = (i + 1) % nu, j1 = (j + 1) % nv;
            const Index a = j * nu + i, b = j * nu + i1, c = j1 * nu + i1, d = j1 * nu + i;
            soup.triangles.push_back({a, b, c});
            soup.triangles.push_back({a, c, d});
        }
    return soup;
}

inline TriangleSoup octahedron_sphere(int levels) {
    TriangleSoup soup;
    soup.points = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    soup.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    for (int level = 0; level < levels; ++level) {
        std::map<std::pair<Index, Index>, Index> middle;
        const auto between = [&](Index a, Index b) {
            const auto [it, added] = middle.try_emplace(std::minmax(a, b), static_cast<Index>(soup.points.size()));
            if (added) {
                const auto &p = soup.points[a], &q = soup.points[b];
                const std::array<double, 3> m{p[0] + q[0], p[1] + q[1], p[2] + q[2]};
                const double length = std::hypot(m[0], m[1], m[2]);
                soup.points.push_back({m[0] / length, m[1] / length, m[2] / length});
            }
            return it->second;
        };
        std::vector<std::array<Index, 3>> finer;
        for (const auto& [a, b, c] : soup.triangles) {
            const Index ab = between(a, b), bc = between(b, c), ca = between(c, a);
            for (const std::array<Index, 3>& t : {std::array<Index, 3>{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}})
                finer.push_back(t);
        }
        soup.triangles = std::move(finer);
    }
    return soup;
}

inline TriangleSoup torus(Index columns, Index rows) {
    return grid(columns, rows, true, true, [](double u, double v) {
        const double a = 2 * M_PI * u, b = 2 * M_PI * v;
        return std::array<double, 3>{(2 + std::cos(b)) * std::cos(a), (2 + std::cos(b)) * std::sin(a), std::sin(b)};
    });
}

inline TriangleSoup patch(Index columns, Index rows) {
    return grid(columns, rows, false, false, [](double u, double v) {
        return std::array<double, 3>{u, v, 0.2 * std::sin(3 * u) * v};
    });
}

inline TriangleSoup tube(Index columns, Index rows) {
    return grid(columns, rows, true, false, [](double u, double v) {
        return std::array<double, 3>{std::cos(2 * M_PI * u), std::sin(2 * M_PI * u), 3 * v};
    });
}

/// A cube with n x n quads per side, welded.
inline TriangleSoup box(int n) {
    TriangleSoup soup;
    std::map<std::array<int, 3>, Index> index_of;
    const auto vertex = [&](const std::array<int, 3>& p) {
        const auto [it, added] = index_of.try_emplace(p, static_cast<Index>(soup.points.size()));
        if (added) soup.points.push_back({double(p[0]) / n, double(p[1]) / n, double(p[2]) / n});
        return it->second;
    };
    for (int axis = 0; axis < 3; ++axis)
        for (const int side : {0, n})
            for (int i = 0; i < n; ++i)
                for (int j = 0; j < n; ++j) {
                    const auto corner = [&](int a, int b) {
                        std::array<int, 3> p{};
                        p[axis] = side, p[(axis + 1) % 3] = i + a, p[(axis + 2) % 3] = j + b;
                        return vertex(p);
                    };
                    std::array<Index, 4> q{corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)};
                    if (side == 0) std::swap(q[1], q[3]);
                    soup.triangles.push_back({q[0], q[1], q[2]});
                    soup.triangles.push_back({q[0], q[2], q[3]});
                }
    return soup;
}

inline TriangleSoup moved(TriangleSoup soup, double scale, const std::array<double, 3>& by) {
    for (auto& p : soup.points)
        for (int k = 0; k < 3; ++k) p[k] = p[k] * scale + by[k];
    return soup;
}

inline TriangleSoup joined(TriangleSoup a, const TriangleSoup& b) {
    const auto shift = static_cast<Index>(a.points.size());
    a.points.insert(a.points.end(), b.points.begin(), b.points.end());
    for (const auto& [i, j, k] : b.triangles) a.triangles.push_back({i + shift, j + shift, k + shift});
    return a;
}

struct Named {
    std::string name;
    TriangleSoup soup;
};

/// One mesh of each kind, with about a thousand vertices.
inline std::vector<Named> group() {
    return {{"sphere", octahedron_sphere(4)},
            {"torus", torus(48, 24)},
            {"box", box(12)},
            {"patch", patch(30, 30)},
            {"tube", tube(40, 30)},
            {"two components", joined(octahedron_sphere(3), moved(torus(30, 20), 1, {10, 0, 0}))},
            {"tiny", moved(octahedron_sphere(4), 1e-9, {0, 0, 0})},
            {"huge", moved(octahedron_sphere(4), 1e9, {0, 0, 0})},
            {"far away", moved(torus(48, 24), 1, {1e6, -2e6, 3e6})}};
}

inline long euler_number(const Mesh& mesh) {
    return long(mesh.number_of_vertices()) - long(mesh.number_of_edges()) + long(mesh.number_of_faces());
}

inline std::size_t border_edges(const Mesh& mesh) {
    std::size_t count = 0;
    for (const Edge e : mesh.edges()) count += mesh.is_border(e);
    return count;
}

/// Closed loops of border halfedges.
inline std::size_t border_loops(const Mesh& mesh) {
    std::vector<bool> seen(mesh.number_of_halfedges(), false);
    std::size_t loops = 0;
    for (const Halfedge first : mesh.halfedges()) {
        if (!mesh.is_border(first) || seen[first]) continue;
        ++loops;
        for (Halfedge h = first; !seen[h]; h = mesh.next(h)) seen[h] = true;
    }
    return loops;
}

/// Number of edge-connected components of the selected faces (of all faces by default).
inline std::size_t components(
    const Mesh& mesh, const std::function<bool(Face)>& chosen = [](Face) { return true; }) {
    std::vector<bool> seen(mesh.number_of_faces(), false);
    std::size_t count = 0;
    for (const Face f : mesh.faces()) {
        if (seen[f] || !chosen(f)) continue;
        ++count;
        std::vector<Face> stack{f};
        seen[f] = true;
        while (!stack.empty()) {
            const Face g = stack.back();
            stack.pop_back();
            for (const Halfedge h : CGAL::halfedges_around_face(mesh.halfedge(g), mesh)) {
                const Face next = mesh.face(mesh.opposite(h));
                if (!next.is_valid() || seen[next] || !chosen(next)) continue;
                seen[next] = true;
                stack.push_back(next);
            }
        }
    }
    return count;
}

/// Signed volume, computed relative to the box's centre.
inline double volume(const Mesh& mesh) {
    const CGAL::Bbox_3 box = bounding_box(mesh);
    const Point o((box.xmin() + box.xmax()) / 2, (box.ymin() + box.ymax()) / 2, (box.zmin() + box.zmax()) / 2);
    double sum = 0;
    for (const Face f : mesh.faces()) {
        const auto [a, b, c] = corners(mesh, f);
        sum += CGAL::cross_product(mesh.point(a) - o, mesh.point(b) - o) * (mesh.point(c) - o) / 6;
    }
    return sum;
}

/// Whether the mesh equals the one rebuilt from its triangles: manifold, with valid connectivity.
inline bool is_sound(const Mesh& mesh) {
    if (mesh.has_garbage() || !mesh.is_valid(false)) return false;
    Mesh again;
    if (try_build_mesh(to_soup(mesh), again).any()) return false;
    for (const Vertex v : mesh.vertices())
        if (mesh.is_border(v, true) != mesh.is_border(v, false)) return false;
    return again.number_of_edges() == mesh.number_of_edges();
}

}  // namespace ostraka::test

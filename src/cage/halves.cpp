// Mirror-symmetric surfaces: cutting off one half, and joining a half with its image.
#include "cage/shrink.h"

#include <map>

namespace ostraka::cage {

Point image(const Point& p, const MirrorPlane& plane) {
    return p - 2 * ((p - plane.point) * plane.normal) / plane.normal.squared_length() * plane.normal;
}

Mesh upper_half(const Mesh& surface, const MirrorPlane& plane) {
    const double tiny = 1e-6 * box_diagonal(surface), length = std::sqrt(plane.normal.squared_length());
    const Vector unit = plane.normal / length;
    std::vector<double> height(surface.number_of_vertices());
    TriangleSoup soup;
    std::vector<Index> number(surface.number_of_vertices(), no_index);
    const auto add = [&](const Point& p) {
        soup.points.push_back({p.x(), p.y(), p.z()});
        return static_cast<Index>(soup.points.size() - 1);
    };
    for (const Vertex v : surface.vertices()) {
        height[v] = (surface.point(v) - plane.point) * unit;
        if (std::abs(height[v]) < tiny) height[v] = 0;
        if (height[v] >= 0)
            number[v] = add(surface.point(v) - (height[v] == 0 ? (surface.point(v) - plane.point) * unit : 0) * unit);
    }
    std::map<std::pair<Index, Index>, Index> cuts;
    const auto cut = [&](Vertex above, Vertex below) {
        const auto [entry, inserted] = cuts.try_emplace(std::minmax(above.idx(), below.idx()), 0);
        if (inserted) {
            const double weight = height[above] / (height[above] - height[below]);
            entry->second = add(surface.point(above) + weight * (surface.point(below) - surface.point(above)));
        }
        return entry->second;
    };
    for (const Face face : surface.faces()) {
        const auto corner = corners(surface, face);
        std::vector<Index> polygon;
        bool above = false;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vertex v = corner[k], next = corner[(k + 1) % 3];
            above = above || height[v] > 0;
            if (height[v] >= 0) polygon.push_back(number[v]);
            if (height[v] > 0 && height[next] < 0) polygon.push_back(cut(v, next));
            if (height[v] < 0 && height[next] > 0) polygon.push_back(cut(next, v));
        }
        for (std::size_t k = 2; above && k < polygon.size(); ++k)
            soup.triangles.push_back({polygon[0], polygon[k - 1], polygon[k]});
    }
    // Drops points that no triangle above the plane uses.
    std::vector<Index> new_index(soup.points.size(), no_index);
    TriangleSoup half;
    for (auto& triangle : soup.triangles) {
        for (Index& v : triangle) {
            if (new_index[v] == no_index) {
                new_index[v] = static_cast<Index>(half.points.size());
                half.points.push_back(soup.points[v]);
            }
            v = new_index[v];
        }
        half.triangles.push_back(triangle);
    }
    Mesh mesh;
    if (try_build_mesh(half, mesh).any()) mesh.clear();
    return mesh;
}

std::size_t whole_size(const Mesh& half) {
    std::size_t border = 0;
    for (const Vertex v : half.vertices()) border += half.is_border(v);
    return 2 * half.number_of_vertices() - border;
}

Mesh mirrored_whole(const Mesh& half, const MirrorPlane& plane) {
    TriangleSoup soup = to_soup(half);
    std::vector<Index> partner(soup.points.size());
    for (Index v = 0; v < partner.size(); ++v) {
        partner[v] = v;
        if (half.is_border(Vertex(v))) continue;
        partner[v] = static_cast<Index>(soup.points.size());
        const Point p = image(half.point(Vertex(v)), plane);
        soup.points.push_back({p.x(), p.y(), p.z()});
    }
    const std::size_t count = soup.triangles.size();
    for (std::size_t t = 0; t < count; ++t) {
        const auto [a, b, c] = soup.triangles[t];
        soup.triangles.push_back({partner[a], partner[c], partner[b]});
    }
    Mesh mesh;
    if (try_build_mesh(soup, mesh).any()) mesh.clear();
    return mesh;
}

}  // namespace ostraka::cage

namespace ostraka {

Mesh mirror_image(const Mesh& mesh, const MirrorPlane& plane) {
    TriangleSoup soup = to_soup(mesh);
    for (auto& p : soup.points) {
        const Point q = cage::image(Point(p[0], p[1], p[2]), plane);
        p = {q.x(), q.y(), q.z()};
    }
    for (auto& triangle : soup.triangles) std::swap(triangle[1], triangle[2]);
    return build_mesh(soup);
}

}  // namespace ostraka

#include "ostraka/mesh/mesh.h"

#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"
#include "ostraka/files/file.h"

#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <cmath>

static_assert(std::endian::native == std::endian::little, "checksums and arrays are written little-endian");

namespace ostraka {

namespace {

/// Halfedge 3 t + k runs from corner k to corner k + 1 of triangle t.
struct Pairing {
    std::vector<Index> opposite;  ///< the opposite halfedge, no_index on the border
    ManifoldDefects defects;
};

Index origin(const TriangleSoup& soup, std::size_t h) { return soup.triangles[h / 3][h % 3]; }
Index target(const TriangleSoup& soup, std::size_t h) { return soup.triangles[h / 3][(h + 1) % 3]; }

/// Halfedges are put into one bucket per smaller end point; within a bucket, they are matched by sorting by the larger end
/// point. Linear time except for the sorting of the buckets, which hold about three halfedges each.
Pairing pair_halfedges(const TriangleSoup& soup) {
    const std::size_t count = 3 * soup.triangles.size();
    Pairing result;
    result.opposite.assign(count, no_index);
    std::vector<Index> begin(soup.points.size() + 1, 0);
    for (std::size_t h = 0; h < count; ++h) ++begin[std::min(origin(soup, h), target(soup, h)) + 1];
    for (std::size_t v = 0; v + 1 < begin.size(); ++v) begin[v + 1] += begin[v];
    std::vector<std::pair<Index, Index>> bucket(count);  // larger end point, halfedge
    {
        std::vector<Index> next(begin.begin(), begin.end() - (begin.size() > 1 ? 1 : 0));
        for (std::size_t h = 0; h < count; ++h) {
            const auto [low, high] = std::minmax({origin(soup, h), target(soup, h)});
            bucket[next[low]++] = {high, static_cast<Index>(h)};
        }
    }
    auto& defects = result.defects;
    const auto note = [&](std::size_t& counter, Index h) {
        ++counter;
        if (defects.example_triangle == no_index) defects.example_triangle = h / 3;
    };
    for (std::size_t v = 0; v + 1 < begin.size(); ++v) {
        const auto first = bucket.begin() + begin[v], last = bucket.begin() + begin[v + 1];
        std::sort(first, last);
        for (auto i = first; i != last;) {
            auto j = i;
            while (j != last && j->first == i->first) ++j;
            if (i->first != v) {  // a repeated corner is counted with its triangle
                if (j - i > 2) note(defects.nonmanifold_edges, i->second);
                else if (j - i == 2) {
                    const Index a = i->second, b = (i + 1)->second;
                    if (origin(soup, a) == origin(soup, b)) note(defects.misoriented_edges, a);
                    else {
                        result.opposite[a] = b;
                        result.opposite[b] = a;
                    }
                }
            }
            i = j;
        }
    }
    return result;
}

/// Counts vertices whose triangles form more than one fan. The halfedges must be paired without conflicts.
void count_fans(const TriangleSoup& soup, Pairing& pairing) {
    const std::size_t count = 3 * soup.triangles.size();
    std::vector<bool> visited(count, false);
    std::vector<std::uint8_t> fans(soup.points.size(), 0);
    const auto& opposite = pairing.opposite;
    const auto previous = [](std::size_t h) { return h % 3 == 0 ? h + 2 : h - 1; };
    const auto next = [](std::size_t h) { return h % 3 == 2 ? h - 2 : h + 1; };
    for (std::size_t h = 0; h < count; ++h) {
        if (visited[h]) continue;
        const Index v = origin(soup, h);
        if (fans[v] < 255) ++fans[v];
        if (fans[v] == 2) {
            ++pairing.defects.nonmanifold_vertices;
            if (pairing.defects.example_triangle == no_index) pairing.defects.example_triangle = static_cast<Index>(h / 3);
        }
        for (std::size_t g = h;;) {  // counter-clockwise over outgoing halfedges
            visited[g] = true;
            const Index o = opposite[previous(g)];
            if (o == no_index || o == h) break;
            g = o;
        }
        for (std::size_t g = h;;) {  // clockwise, if the first walk reached the border
            const Index o = opposite[g];
            if (o == no_index) break;
            g = next(o);
            if (visited[g]) break;
            visited[g] = true;
        }
    }
}

}  // namespace

ManifoldDefects try_build_mesh(const TriangleSoup& soup, Mesh& mesh) {
    mesh.clear();
    check_cancelled();
    const std::size_t vertex_count = soup.points.size(), face_count = soup.triangles.size();
    if (vertex_count >= no_index / 8 || face_count >= no_index / 8)
        fail_work("mesh", "has more than 536 million vertices or triangles", "split it");
    ManifoldDefects repeated;
    for (std::size_t t = 0; t < face_count; ++t) {
        const auto& [a, b, c] = soup.triangles[t];
        if (a >= vertex_count || b >= vertex_count || c >= vertex_count)
            fail_input("triangle " + std::to_string(t), fmt::format("names vertex {} of {}", std::max({a, b, c}), vertex_count));
        if (a == b || b == c || c == a) {
            ++repeated.repeated_corners;
            if (repeated.example_triangle == no_index) repeated.example_triangle = static_cast<Index>(t);
        }
    }
    Pairing pairing = pair_halfedges(soup);
    pairing.defects.repeated_corners = repeated.repeated_corners;
    if (pairing.defects.example_triangle == no_index) pairing.defects.example_triangle = repeated.example_triangle;
    if (pairing.defects.any()) return pairing.defects;
    check_cancelled();
    count_fans(soup, pairing);
    if (pairing.defects.any()) return pairing.defects;
    check_cancelled();

    const auto& opposite = pairing.opposite;
    const std::size_t count = 3 * face_count;
    std::size_t border = 0;
    for (const Index o : opposite) border += o == no_index;
    mesh.reserve(static_cast<Index>(vertex_count), static_cast<Index>((count + border) / 2), static_cast<Index>(face_count));
    for (const auto& p : soup.points) mesh.add_vertex(Point(p[0], p[1], p[2]));
    std::vector<Halfedge> halfedge(count);
    for (std::size_t h = 0; h < count; ++h) {
        if (opposite[h] != no_index && opposite[h] < h) {
            halfedge[h] = mesh.opposite(halfedge[opposite[h]]);
        } else {
            halfedge[h] = mesh.add_edge(Vertex(origin(soup, h)), Vertex(target(soup, h)));
        }
    }
    for (std::size_t t = 0; t < face_count; ++t) {
        const Face face = mesh.add_face();
        for (std::size_t k = 0; k < 3; ++k) {
            const Halfedge h = halfedge[3 * t + k];
            mesh.set_face(h, face);
            mesh.set_next(h, halfedge[3 * t + (k + 1) % 3]);
            if (!mesh.halfedge(mesh.target(h)).is_valid()) mesh.set_halfedge(mesh.target(h), h);
        }
        mesh.set_halfedge(face, halfedge[3 * t + 2]);
    }
    if (border > 0) {
        // Each border vertex has exactly one outgoing border halfedge, since every vertex has one fan.
        std::vector<Index> leaving(vertex_count, no_index);
        for (std::size_t h = 0; h < count; ++h)
            if (opposite[h] == no_index) leaving[target(soup, h)] = static_cast<Index>(h);
        for (std::size_t h = 0; h < count; ++h) {
            if (opposite[h] != no_index) continue;
            const Halfedge outer = mesh.opposite(halfedge[h]);
            mesh.set_next(outer, mesh.opposite(halfedge[leaving[origin(soup, h)]]));
            mesh.set_halfedge(mesh.target(outer), outer);  // Surface_mesh requires a border halfedge at border vertices
        }
    }
    return pairing.defects;
}

Mesh build_mesh(const TriangleSoup& soup) {
    Mesh mesh;
    const ManifoldDefects defects = try_build_mesh(soup, mesh);
    if (defects.any()) {
        std::string text = "is not an oriented manifold:";
        const auto add = [&](std::size_t n, const char* description) {
            if (n > 0) text += fmt::format(" {} {},", n, description);
        };
        add(defects.repeated_corners, "triangles that repeat a vertex");
        add(defects.nonmanifold_edges, "edges with more than two triangles");
        add(defects.misoriented_edges, "edges with inconsistent orientation");
        add(defects.nonmanifold_vertices, "non-manifold vertices");
        text.back() = ';';
        fail_input("mesh", fmt::format("{} the first at triangle {}", text, defects.example_triangle),
                   "run: ostraka mesh repair");
    }
    return mesh;
}

TriangleSoup to_soup(const Mesh& mesh) {
    if (mesh.has_garbage()) throw std::logic_error("to_soup: collect the garbage first");
    check_cancelled();
    TriangleSoup soup;
    soup.points.reserve(mesh.number_of_vertices());
    soup.triangles.reserve(mesh.number_of_faces());
    for (const Vertex v : mesh.vertices()) soup.points.push_back({mesh.point(v).x(), mesh.point(v).y(), mesh.point(v).z()});
    for (const Face f : mesh.faces()) {
        const auto [a, b, c] = corners(mesh, f);
        soup.triangles.push_back({static_cast<Index>(a), static_cast<Index>(b), static_cast<Index>(c)});
    }
    return soup;
}

std::array<Vertex, 3> corners(const Mesh& mesh, Face face) {
    const Halfedge h = mesh.halfedge(face);
    return {mesh.target(h), mesh.target(mesh.next(h)), mesh.source(h)};
}

Vector area_vector(const Mesh& mesh, Face face) {
    const auto [a, b, c] = corners(mesh, face);
    return 0.5 * CGAL::cross_product(mesh.point(b) - mesh.point(a), mesh.point(c) - mesh.point(a));
}

double face_area(const Mesh& mesh, Face face) { return std::sqrt(area_vector(mesh, face).squared_length()); }

double surface_area(const Mesh& mesh) {
    check_cancelled();
    double sum = 0;
    for (const Face f : mesh.faces()) sum += face_area(mesh, f);
    return sum;
}

Point centroid(const Mesh& mesh, Face face) {
    const auto [a, b, c] = corners(mesh, face);
    return CGAL::centroid(mesh.point(a), mesh.point(b), mesh.point(c));
}

Vector vertex_normal(const Mesh& mesh, Vertex vertex) {
    Vector sum(0, 0, 0);
    if (mesh.is_isolated(vertex)) return sum;
    const Point& p = mesh.point(vertex);
    for (const Halfedge h : CGAL::halfedges_around_target(vertex, mesh)) {
        if (mesh.is_border(h)) continue;
        const Vector u = mesh.point(mesh.target(mesh.next(h))) - p, w = mesh.point(mesh.source(h)) - p;
        const Vector n = CGAL::cross_product(u, w);
        const double length = std::sqrt(n.squared_length());
        if (length > 0) sum += (std::atan2(length, u * w) / length) * n;
    }
    const double length = std::sqrt(sum.squared_length());
    return length > 0 ? sum / length : Vector(0, 0, 0);
}

CGAL::Bbox_3 bounding_box(const Mesh& mesh) {
    CGAL::Bbox_3 box;
    const bool include_isolated = mesh.number_of_faces() == 0;
    for (const Vertex v : mesh.vertices())
        if (include_isolated || !mesh.is_isolated(v)) box += mesh.point(v).bbox();
    return box;
}

double box_diagonal(const Mesh& mesh) {
    if (mesh.number_of_vertices() == 0) return 0;
    const CGAL::Bbox_3 box = bounding_box(mesh);
    return std::hypot(box.xmax() - box.xmin(), box.ymax() - box.ymin(), box.zmax() - box.zmin());
}

double mean_edge_length(const Mesh& mesh) {
    if (mesh.number_of_edges() == 0) return 0;
    double sum = 0;
    for (const Edge e : mesh.edges())
        sum += std::sqrt(CGAL::squared_distance(mesh.point(mesh.vertex(e, 0)), mesh.point(mesh.vertex(e, 1))));
    return sum / static_cast<double>(mesh.number_of_edges());
}

Halfedge find_halfedge(const Mesh& mesh, Vertex a, Vertex b) {
    if (mesh.is_isolated(a)) return Mesh::null_halfedge();
    for (const Halfedge h : CGAL::halfedges_around_source(a, mesh))
        if (mesh.target(h) == b) return h;
    return Mesh::null_halfedge();
}

std::string mesh_checksum(const Mesh& mesh) {
    check_cancelled();
    Sha256 hash;
    const std::uint64_t counts[2] = {mesh.number_of_vertices(), mesh.number_of_faces()};
    hash.update(counts, sizeof counts);
    std::vector<double> coordinates;
    std::vector<std::uint32_t> indices;
    constexpr std::size_t block = 1 << 16;
    for (const Vertex v : mesh.vertices()) {
        const Point& p = mesh.point(v);
        for (const double x : {p.x(), p.y(), p.z()}) coordinates.push_back(x + 0.0);  // -0 becomes 0
        if (coordinates.size() >= block)
            hash.update(coordinates.data(), coordinates.size() * sizeof(double)), coordinates.clear();
    }
    hash.update(coordinates.data(), coordinates.size() * sizeof(double));
    for (const Face f : mesh.faces()) {
        for (const Vertex v : corners(mesh, f)) indices.push_back(v);
        if (indices.size() >= block) hash.update(indices.data(), indices.size() * sizeof(std::uint32_t)), indices.clear();
    }
    hash.update(indices.data(), indices.size() * sizeof(std::uint32_t));
    return hash.hexadecimal();
}

}  // namespace ostraka

template CGAL::Surface_mesh<ostraka::Point>::Surface_mesh();
template CGAL::Surface_mesh<ostraka::Point>::Surface_mesh(const CGAL::Surface_mesh<ostraka::Point>&);
template CGAL::Surface_mesh<ostraka::Point>::Surface_mesh(CGAL::Surface_mesh<ostraka::Point>&&);
template CGAL::Surface_mesh<ostraka::Point>& CGAL::Surface_mesh<ostraka::Point>::operator=(
    const CGAL::Surface_mesh<ostraka::Point>&);
template class CGAL::Properties::Property_container<ostraka::Mesh, ostraka::Vertex>;
template class CGAL::Properties::Property_container<ostraka::Mesh, ostraka::Halfedge>;
template class CGAL::Properties::Property_container<ostraka::Mesh, ostraka::Edge>;
template class CGAL::Properties::Property_container<ostraka::Mesh, ostraka::Face>;
template class CGAL::Properties::Property_array<ostraka::Mesh::Vertex_connectivity>;
template class CGAL::Properties::Property_array<ostraka::Mesh::Halfedge_connectivity>;
template class CGAL::Properties::Property_array<ostraka::Mesh::Face_connectivity>;
template class CGAL::Properties::Property_array<ostraka::Point>;
template class std::vector<ostraka::Point>;
template class std::vector<ostraka::Vertex>;
template class std::vector<ostraka::Halfedge>;
template class std::vector<ostraka::Face>;

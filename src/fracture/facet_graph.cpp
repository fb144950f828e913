#include "ostraka/fracture/facet_graph.h"

#include "fracture/filtered_normals.h"
#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/mesh/flood.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <unordered_map>

namespace ostraka {

namespace {

/// Groups faces in one cell of a grid with similar normals, numbered by their first face.
std::vector<Index> grouped_faces(const Mesh& mesh, const std::vector<Vector>& areas, double cell, std::size_t& count) {
    struct Group {
        Vector area;
        Index number;
    };
    const CGAL::Bbox_3 box = bounding_box(mesh);
    std::unordered_map<std::uint64_t, std::vector<Group>> cells;
    std::vector<Index> groups(areas.size());
    count = 0;
    for (const Face f : mesh.faces()) {
        const Point c = centroid(mesh, f);
        const auto step = [&](double x, double low) { return static_cast<std::uint64_t>((x - low) / cell) & 0x1fffffU; };
        const std::uint64_t key = step(c.x(), box.xmin()) << 42 | step(c.y(), box.ymin()) << 21 | step(c.z(), box.zmin());
        auto& cell_groups = cells[key];
        const Vector& a = areas[f];
        constexpr double min_cosine = 0.4;
        const auto fits = [&](const Group& g) {
            return g.area * a >= min_cosine * std::sqrt(g.area.squared_length() * a.squared_length());
        };
        const auto match = std::find_if(cell_groups.begin(), cell_groups.end(), fits);
        if (match == cell_groups.end()) {
            groups[f] = static_cast<Index>(count++);
            cell_groups.push_back({a, groups[f]});
        } else {
            groups[f] = match->number;
            match->area = match->area + a;
        }
    }
    return groups;
}

void join_contacts(const Mesh& mesh, FacetGraph& graph) {
    std::vector<FacetGraph::Contact> edge_contacts;
    for (const Edge e : mesh.edges()) {
        const Halfedge h = mesh.halfedge(e);
        const Face f = mesh.face(h), g = mesh.face(mesh.opposite(h));
        const Point &p = mesh.point(mesh.source(h)), &q = mesh.point(mesh.target(h));
        const double length = std::sqrt(CGAL::squared_distance(p, q));
        if (f == Mesh::null_face() || g == Mesh::null_face()) continue;
        const auto [a, b] = std::minmax(graph.patch_of_face[f], graph.patch_of_face[g]);
        if (a != b) edge_contacts.push_back({a, b, length, 0, CGAL::midpoint(p, q)});
    }
    std::stable_sort(edge_contacts.begin(), edge_contacts.end(),
                     [](const auto& x, const auto& y) { return std::tie(x.a, x.b) < std::tie(y.a, y.b); });
    for (const auto& contact : edge_contacts) {
        if (graph.contacts.empty() || graph.contacts.back().a != contact.a || graph.contacts.back().b != contact.b) {
            graph.contacts.push_back(contact);
            continue;
        }
        auto& merged = graph.contacts.back();
        const double sum = merged.length + contact.length;
        if (sum > 0) merged.middle = merged.middle + (contact.length / sum) * (contact.middle - merged.middle);
        merged.length = sum;
    }
}

}  // namespace

bool has_opening(const Mesh& mesh) {
    const FacePieces pieces = face_pieces(mesh);
    std::vector<double> areas(pieces.count, 0);
    double total = 0, border = 0;
    for (const Face f : mesh.faces()) areas[pieces.of_face[f]] += face_area(mesh, f);
    for (const double area : areas) total += area;
    constexpr double scrap = 0.001, pinhole = 0.2;
    for (const Edge e : mesh.edges()) {
        const Halfedge h = mesh.halfedge(e), o = mesh.opposite(h);
        if (!mesh.is_border(e) || areas[pieces.of_face[mesh.face(mesh.is_border(h) ? o : h)]] < scrap * total) continue;
        border += std::sqrt(CGAL::squared_distance(mesh.point(mesh.source(h)), mesh.point(mesh.target(h))));
    }
    return !(border < pinhole * std::sqrt(total));
}

FacetGraph facet_graph(const Mesh& mesh, std::size_t max_patches) {
    FacetGraph graph;
    const std::size_t faces = mesh.number_of_faces();
    std::vector<Vector> areas(faces);
    parallel_for(faces, [&](std::size_t f) { areas[f] = area_vector(mesh, Face(static_cast<Index>(f))); });
    for (const Vector& a : areas) graph.area += std::sqrt(a.squared_length());
    if (!(graph.area > 0)) fail_input("fragment", "has no area, so its facets cannot be classified", "check its faces");
    graph.size = std::sqrt(graph.area);
    graph.edge = mean_edge_length(mesh);
    std::size_t count = faces;
    if (faces <= max_patches) {
        graph.patch_of_face.resize(faces);
        std::iota(graph.patch_of_face.begin(), graph.patch_of_face.end(), Index{0});
    } else {
        // A smooth surface crosses about 1.5 cells per area of a cell's side.
        graph.patch_of_face = grouped_faces(mesh, areas, std::sqrt(2 * graph.area / static_cast<double>(max_patches)), count);
    }
    std::vector<Vector> sum(count, Vector(0, 0, 0)), place(count, Vector(0, 0, 0));
    std::vector<Point> some_centroid(count);
    graph.areas.assign(count, 0);
    for (const Face f : mesh.faces()) {
        const Index p = graph.patch_of_face[f];
        const double a = std::sqrt(areas[f].squared_length());
        some_centroid[p] = centroid(mesh, f);
        sum[p] = sum[p] + areas[f];
        place[p] = place[p] + a * (some_centroid[p] - CGAL::ORIGIN);
        graph.areas[p] += a;
    }
    for (std::size_t p = 0; p < count; ++p)
        graph.places.push_back(faces > max_patches && graph.areas[p] > 0 ? CGAL::ORIGIN + place[p] / graph.areas[p]
                                                                         : some_centroid[p]);
    join_contacts(mesh, graph);
    graph.closed = !has_opening(mesh);
    std::vector<std::pair<Index, Index>> neighbours;
    for (const auto& c : graph.contacts) neighbours.emplace_back(c.a, c.b);
    const double spacing = 1.5 * graph.size / std::sqrt(static_cast<double>(count));
    graph.normals = filtered_normals(sum, neighbours, filter_steps(0.02 * graph.size, spacing));
    for (std::size_t p = 0; p < count; ++p)
        graph.normal_deviation.push_back(graph.areas[p] > 0 ? std::max(0.0, 1 - sum[p] * graph.normals[p] / graph.areas[p]) : 0);
    for (auto& c : graph.contacts) {
        const Vector &m = graph.normals[c.a], &n = graph.normals[c.b];
        const double angle = std::atan2(std::sqrt(CGAL::cross_product(m, n).squared_length()), m * n);
        c.dihedral_angle = (n - m) * (graph.places[c.b] - graph.places[c.a]) >= 0 ? angle : -angle;
    }
    return graph;
}

}  // namespace ostraka

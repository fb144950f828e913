#include "select/growth.h"

#include "ostraka/geom/geodesic.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

std::vector<bool> inverted(std::vector<bool> flags) {
    flags.flip();
    return flags;
}

std::vector<bool> flags_of(const Mesh& mesh, const std::vector<Index>& vertices) {
    std::vector<bool> flags(mesh.number_of_vertices(), false);
    for (const Index v : vertices) flags[v] = true;
    return flags;
}

/// The flagged vertices that have a face, ascending.
std::vector<Index> listed(const Mesh& mesh, const std::vector<bool>& flags) {
    std::vector<Index> list;
    for (const Vertex v : mesh.vertices())
        if (flags[v] && !mesh.is_isolated(v)) list.push_back(v);
    return list;
}

std::vector<bool> grown(const Mesh& mesh, std::vector<bool> vertices, int rings) {
    std::vector<Index> front = listed(mesh, vertices);
    for (int ring = 0; ring < rings && !front.empty(); ++ring) {
        std::vector<Index> next;
        for (const Index v : front)
            for (const Vertex w : mesh.vertices_around_target(mesh.halfedge(Vertex(v))))
                if (!vertices[w]) {
                    vertices[w] = true;
                    next.push_back(w);
                }
        front = std::move(next);
    }
    return vertices;
}

/// Adds the faces whose corners have an average distance of at most `limit`.
void add_near(const Mesh& mesh, const std::vector<double>& distance, double limit, std::vector<bool>& faces) {
    for (const Face face : mesh.faces()) {
        const auto [a, b, c] = corners(mesh, face);
        if ((distance[a] + distance[b] + distance[c]) / 3 <= limit) faces[face] = true;
    }
}

}  // namespace

std::vector<double> distances_within(const Mesh& mesh, const std::vector<Index>& sources, double limit) {
    double longest = 0;
    for (const Edge e : mesh.edges())
        longest = std::max(longest, CGAL::squared_distance(mesh.point(mesh.vertex(e, 0)), mesh.point(mesh.vertex(e, 1))));
    return geodesic_distances(mesh, sources, limit + std::sqrt(longest));
}

std::vector<bool> grow(const Mesh& mesh, std::vector<bool> faces, int rings) {
    std::vector<Index> front;
    for (const Face face : mesh.faces())
        if (faces[face]) front.push_back(face);
    for (int ring = 0; ring < rings && !front.empty(); ++ring) {
        std::vector<Index> next;
        for (const Index face : front)
            for (const Vertex v : corners(mesh, Face(face)))
                for (const Face around : mesh.faces_around_target(mesh.halfedge(v)))
                    if (around != Mesh::null_face() && !faces[around]) {
                        faces[around] = true;
                        next.push_back(around);
                    }
        front = std::move(next);
    }
    return faces;
}

std::vector<bool> shrink(const Mesh& mesh, std::vector<bool> faces, int rings) {
    return inverted(grow(mesh, inverted(std::move(faces)), rings));
}

std::vector<bool> grow_by(const Mesh& mesh, std::vector<bool> faces, double distance) {
    std::vector<bool> inside(mesh.number_of_vertices(), false), outside(mesh.number_of_vertices(), false);
    for (const Face face : mesh.faces())
        for (const Vertex v : corners(mesh, face)) (faces[face] ? inside : outside)[v] = true;
    std::vector<Index> edge;
    for (const Vertex v : mesh.vertices())
        if (inside[v] && outside[v]) edge.push_back(v);
    if (!edge.empty()) add_near(mesh, distances_within(mesh, edge, distance), distance, faces);
    return faces;
}

std::vector<bool> shrink_by(const Mesh& mesh, std::vector<bool> faces, double distance) {
    return inverted(grow_by(mesh, inverted(std::move(faces)), distance));
}

std::vector<Index> grow_vertices(const Mesh& mesh, const std::vector<Index>& vertices, int rings) {
    return listed(mesh, grown(mesh, flags_of(mesh, vertices), rings));
}

std::vector<Index> shrink_vertices(const Mesh& mesh, const std::vector<Index>& vertices, int rings) {
    return listed(mesh, inverted(grown(mesh, inverted(flags_of(mesh, vertices)), rings)));
}

std::vector<bool> brushed_faces(const Mesh& mesh, const std::vector<Index>& centres, double radius) {
    std::vector<bool> faces(mesh.number_of_faces(), false);
    add_near(mesh, distances_within(mesh, centres, radius), radius, faces);
    return faces;
}

std::vector<Index> brushed_vertices(const Mesh& mesh, const std::vector<Index>& centres, double radius) {
    const std::vector<double> distance = geodesic_distances(mesh, centres, radius);
    std::vector<bool> flags(mesh.number_of_vertices(), false);
    for (const Vertex v : mesh.vertices()) flags[v] = distance[v] <= radius;
    return listed(mesh, flags);
}

}  // namespace ostraka

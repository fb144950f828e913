// Scan of a statuette: noise, a partly scanned cavity, holes; and its landmarks.
#include "ostraka/core/angles.h"
#include "ostraka/synthetic/statuettes.h"

#include "synthetic/statuette_build.h"

#include "ostraka/execution/parallel.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/mesh/flood.h"
#include "ostraka/stats/random.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

constexpr std::uint64_t noise_numbers = std::uint64_t{1} << 40, hole_numbers = std::uint64_t{1} << 50;

/// Standard normal random number of a vertex (Box and Muller 1958).
double normal_number(std::uint64_t seed, std::uint64_t vertex) {
    const double a = random_share(seed, noise_numbers + 2 * vertex), b = random_share(seed, noise_numbers + 2 * vertex + 1);
    return std::sqrt(-2 * std::log(1 - a)) * std::cos(2 * pi * b);
}

void add_noise(Mesh& mesh, double deviation, std::uint64_t seed) {
    if (deviation == 0) return;
    std::vector<Point> moved(mesh.number_of_vertices());
    parallel_for(moved.size(), [&](std::size_t i) {
        const Vertex v(static_cast<Index>(i));
        moved[i] = mesh.point(v) + deviation * normal_number(seed, i) * vertex_normal(mesh, v);
    });
    for (std::size_t i = 0; i < moved.size(); ++i) mesh.point(Vertex(static_cast<Index>(i))) = moved[i];
}

/// Marks the faces of the cavity above a wavy line as missing.
void mark_missing_interior(std::vector<bool>& missing, const Mesh& mesh, const std::vector<std::int32_t>& labels,
                           std::int32_t inside, const shapes::StatuetteBody& body) {
    const double edge = mean_edge_length(mesh);
    for (const Face f : mesh.faces()) {
        if (labels[f.idx()] != inside) continue;
        const Point c = centroid(mesh, f);
        const double wave = 1 + std::cos(3 * std::atan2(c.y(), c.x()) + body.cavity_end_phase);
        if (c.z() > body.frame.cavity_depth - (1 + wave) * edge) missing[f.idx()] = true;
    }
}

/// Marks faces on the outer side of the body around random points as missing.
void mark_missing_patches(std::vector<bool>& missing, const Mesh& mesh, const std::vector<std::int32_t>& labels,
                          const StatuetteParameters& p, double highest) {
    std::vector<Face> body;
    for (const Face f : mesh.faces())
        if (labels[f.idx()] <= 1 && centroid(mesh, f).z() < highest && centroid(mesh, f).z() > 0.02 * highest) body.push_back(f);
    if (body.empty()) return;
    for (int hole = 0; hole < p.holes; ++hole) {
        const double share = random_share(p.seed, hole_numbers + static_cast<std::uint64_t>(hole));
        const Face middle = body[std::min(static_cast<std::size_t>(share * static_cast<double>(body.size())), body.size() - 1)];
        const Point centre = centroid(mesh, middle);
        const Vector outward = area_vector(mesh, middle);
        for (const Face f : body) {
            if (CGAL::squared_distance(centroid(mesh, f), centre) < p.hole_radius * p.hole_radius &&
                area_vector(mesh, f) * outward > 0)
                missing[f.idx()] = true;
        }
    }
}

/// Marks more faces as missing until no vertex joins two fans, so that the rest is a manifold.
void open_pinches(std::vector<bool>& missing, const Mesh& mesh) {
    for (bool changed = true; changed;) {
        changed = false;
        for (const Vertex v : mesh.vertices()) {
            int fans = 0;
            for (const Halfedge h : mesh.halfedges_around_target(mesh.halfedge(v))) {
                const Face face = mesh.face(h), next = mesh.face(mesh.opposite(h));
                if (!missing[face.idx()] && missing[next.idx()]) ++fans;
            }
            if (fans < 2) continue;
            for (const Face f : mesh.faces_around_target(mesh.halfedge(v))) missing[f.idx()] = true;
            changed = true;
        }
    }
}

/// Keeps the largest connected piece of the remaining faces, with its labels.
void remove_missing_faces(Statuette& statuette, const std::vector<bool>& missing) {
    const Mesh& mesh = statuette.mesh;
    const auto [piece, pieces] = face_pieces(mesh, [&](Face f) { return !missing[f]; });
    std::vector<std::size_t> sizes(pieces, 0);
    for (const Index number : piece)
        if (number != no_index) ++sizes[number];
    const auto largest = static_cast<Index>(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
    TriangleSoup soup;
    std::vector<Index> new_index(mesh.number_of_vertices(), no_index);
    std::vector<std::int32_t> labels;
    for (const Face f : mesh.faces()) {
        if (piece[f.idx()] != largest) continue;
        std::array<Index, 3> triangle{};
        std::size_t corner = 0;
        for (const Vertex v : corners(mesh, f)) {
            Index& index = new_index[v.idx()];
            if (index == no_index) {
                index = static_cast<Index>(soup.points.size());
                const Point& q = mesh.point(v);
                soup.points.push_back({q.x(), q.y(), q.z()});
            }
            triangle[corner++] = index;
        }
        soup.triangles.push_back(triangle);
        labels.push_back(statuette.face_labels[f.idx()]);
    }
    statuette.mesh = build_mesh(soup);
    statuette.face_labels = std::move(labels);
}

std::vector<std::pair<std::string, Vector3d>> landmark_positions(const SyntheticObject& object, const StatuetteParameters& p,
                                                                 const shapes::StatuetteBody& body) {
    std::vector<std::pair<std::string, Vector3d>> positions;
    const auto add = [&](const std::string& name, const Vector3d& approximate) {
        positions.emplace_back(name, object.project(approximate));
    };
    // Ends of the longest diameter of the rim; for a round base, the lateral ones.
    const double rim = body.frame.outline.front().y();
    const Vector2d foot = body.outside->centre(rim);
    const double turn = p.ovality > 0 ? body.direction + p.ovality_drift * pi / 180 * rim / body.frame.joint_height : 0.5 * pi;
    for (const double side : {-1.0, 1.0}) {
        const Vector2d direction = (std::sin(turn) < 0 ? -side : side) * Vector2d(std::cos(turn), std::sin(turn));
        const double angle = std::atan2(direction.y(), direction.x());
        const double radius = body.frame.outline.front().x() + body.outside->displacement(angle, rim);
        add(side < 0 ? "base right" : "base left", {foot.x() + radius * direction.x(), foot.y() + radius * direction.y(), rim});
    }
    if (p.wall == 0) add("base centre", {foot.x(), foot.y(), 0});
    const Vector2d neck = body.outside->centre(body.frame.joint_height);
    add("top of the head", {neck.x(), neck.y(), p.height});
    add("head joint", {neck.x() - body.frame.neck_radius, neck.y(), body.frame.joint_height});
    for (const shapes::Arm& arm : shapes::body_arms(p, body)) {
        const std::string side = arm.side() < 0 ? " right" : " left";
        const std::vector<Vector3d> outside = arm.outside(6);
        add("arm joint" + side, outside[0]);
        for (std::size_t i = 1; i <= 5; ++i) add(fmt::format("arm outside {}{}", i, side), outside[i]);
        add("hand end" + side, outside.back());
    }
    return positions;
}

}  // namespace

Statuette generate_statuette(const StatuetteParameters& parameters) {
    shapes::check_parameters(parameters);
    const shapes::StatuetteBody body(parameters);
    const auto object = shapes::build_statuette(parameters, body);
    MakeOptions options;
    options.vertices = parameters.vertices;
    options.seed = parameters.seed;
    SyntheticMesh mesh_with_labels = make_mesh(*object, options);
    Statuette statuette{parameters,
                        object->parts,
                        object->part_colours,
                        std::move(mesh_with_labels.mesh),
                        std::move(mesh_with_labels.face_labels),
                        {}};
    add_noise(statuette.mesh, parameters.scan_noise, parameters.seed);

    std::vector<bool> missing(statuette.mesh.number_of_faces(), false);
    if (parameters.wall > 0 && parameters.interior == StatuetteParameters::Interior::open) {
        const auto inside = static_cast<std::int32_t>(object->parts.size()) - 1;
        mark_missing_interior(missing, statuette.mesh, statuette.face_labels, inside, body);
    }
    mark_missing_patches(missing, statuette.mesh, statuette.face_labels, parameters, 0.75 * body.frame.joint_height);
    if (std::find(missing.begin(), missing.end(), true) != missing.end()) {
        open_pinches(missing, statuette.mesh);
        remove_missing_faces(statuette, missing);
    }

    const SurfaceSearch search(statuette.mesh);
    const double max_distance = 2 * mean_edge_length(statuette.mesh);
    for (const auto& [name, position] : landmark_positions(*object, parameters, body)) {
        const Point p(position.x(), position.y(), position.z());
        const SurfaceHit hit = search.closest(p);
        if (hit.distance > max_distance) continue;
        const auto face_corners = corners(statuette.mesh, Face(hit.face));
        const auto closer = [&](Vertex a, Vertex b) {
            return CGAL::squared_distance(statuette.mesh.point(a), p) < CGAL::squared_distance(statuette.mesh.point(b), p);
        };
        const Vertex vertex = *std::min_element(face_corners.begin(), face_corners.end(), closer);
        statuette.landmarks.push_back({name, static_cast<Index>(vertex.idx()), face_point(hit.face, hit.barycentric)});
    }
    return statuette;
}

}  // namespace ostraka

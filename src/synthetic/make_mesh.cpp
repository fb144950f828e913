#include "ostraka/synthetic/make_mesh.h"

#include "synthetic/lattice.h"
#include "synthetic/uniform_remesher.h"

#include "ostraka/core/memory.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/mesh/disjoint_sets.h"
#include "ostraka/mesh/flood.h"
#include "ostraka/stats/random.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>

namespace ostraka {

namespace {

/// Lattice vertices per wanted vertex: with fewer, thin triangles remain; with more, time is wasted.
constexpr double surplus = 1.6;

/// Closed surfaces have 3/2 edges per face, so V - E + F = V - F / 2.
bool has_genus(const shapes::Triangles& mesh, int genus) {
    return static_cast<long long>(mesh.points.size()) - static_cast<long long>(mesh.faces.size() / 2) == 2 - 2 * genus;
}

bool is_connected(const shapes::Triangles& mesh) {
    DisjointSets sets(mesh.points.size());
    std::size_t pieces = mesh.points.size();
    for (const auto& [a, b, c] : mesh.faces)
        for (const Index v : {b, c})
            if (sets.unite(a, v)) --pieces;
    return pieces == 1;
}

[[noreturn]] void refuse(const SyntheticObject& object, std::uint64_t vertices) {
    fail_usage(fmt::format("the {} cannot be represented by {} vertices", object.name, vertices),
               "ask for at least " + std::to_string(object.minimum_vertices));
}

/// The marched surface with about `vertices` vertices, or more if the shape needs them.
shapes::Triangles marched(const SyntheticObject& object, double vertices, std::uint64_t seed) {
    // The area is estimated from a coarse surface.
    const double coarse = object.box().diagonal().norm() / 40;
    const double pilot_area = shapes::area(shapes::march(object, shapes::seeded_lattice(object, coarse, seed)));
    double cube = std::min(std::sqrt(shapes::lattice_vertices_per_area * pilot_area / vertices), 0.9 * object.thinnest);
    for (int attempt = 0; attempt < 4; ++attempt, cube /= 1.4) {
        shapes::Triangles mesh = shapes::march(object, shapes::seeded_lattice(object, cube, seed));
        if (has_genus(mesh, object.genus) && is_connected(mesh)) return mesh;
    }
    throw Error(ErrorKind::failure, object.name,
                "the marched surface does not have the object's genus " + std::to_string(object.genus),
                "ask for more vertices or use another seed");
}

/// Where parts meet in a narrow strip, labelling by centroids can separate a few faces from their part: patches of fewer than
/// four faces take the most common label around them (ties: the smallest), unless the patch is the whole part.
void merge_small_patches(const Mesh& mesh, std::vector<std::int32_t>& labels, std::size_t parts) {
    constexpr std::size_t min_faces = 4;
    const std::vector<std::int32_t> old_labels = labels;
    std::vector<bool> visited(labels.size(), false), has_patch(parts, false);
    std::vector<std::vector<Face>> small_patches;
    for (const Face start : mesh.faces()) {
        if (visited[start.idx()]) continue;
        const std::int32_t label = old_labels[start.idx()];
        std::vector<Face> patch =
            flood_faces(mesh, start, visited, [&](Halfedge h) { return old_labels[mesh.face(mesh.opposite(h)).idx()] == label; });
        if (patch.size() < min_faces) small_patches.push_back(std::move(patch));
        else has_patch[static_cast<std::size_t>(label)] = true;
    }
    for (const auto& patch : small_patches) {
        const std::int32_t label = old_labels[patch.front().idx()];
        if (!has_patch[static_cast<std::size_t>(label)]) continue;
        std::map<std::int32_t, int> neighbour_counts;
        for (const Face face : patch) {
            for (const Halfedge h : mesh.halfedges_around_face(mesh.halfedge(face))) {
                const std::int32_t neighbour_label = old_labels[mesh.face(mesh.opposite(h)).idx()];
                if (neighbour_label != label) ++neighbour_counts[neighbour_label];
            }
        }
        const auto maximum = std::max_element(neighbour_counts.begin(), neighbour_counts.end(),
                                              [](const auto& a, const auto& b) { return a.second < b.second; });
        for (const Face face : patch) labels[face.idx()] = maximum->first;
    }
}

}  // namespace

SyntheticMesh make_mesh(const SyntheticObject& object, const MakeOptions& options) {
    check_options(options, "mesh make");
    if (options.vertices < object.minimum_vertices) refuse(object, options.vertices);
    const auto target_vertices = static_cast<std::size_t>(options.vertices);
    constexpr double bytes_of_vertex = 600;  // lattice, remeshed points and mesh
    require_memory(bytes_of_vertex * static_cast<double>(target_vertices), fmt::format("a mesh of {} vertices", target_vertices),
                   "ask for fewer (--vertices)");
    shapes::Triangles uniform = shapes::remesh_uniformly(
        object, marched(object, surplus * static_cast<double>(target_vertices), options.seed), target_vertices);
    if (static_cast<double>(uniform.points.size()) > 1.01 * static_cast<double>(target_vertices))
        refuse(object, options.vertices);

    SyntheticMesh result;
    result.vertex_labels.resize(uniform.points.size());
    result.face_labels.resize(uniform.faces.size());
    parallel_for(uniform.points.size(), [&](std::size_t v) { result.vertex_labels[v] = object.part(uniform.points[v]); });
    parallel_for(uniform.faces.size(), [&](std::size_t f) {
        const auto& [a, b, c] = uniform.faces[f];
        result.face_labels[f] =
            object.part(object.project(Vector3d((uniform.points[a] + uniform.points[b] + uniform.points[c]) / 3)));
    });
    if (options.noise > 0) {
        const double edge = std::sqrt(shapes::area(uniform) / static_cast<double>(uniform.points.size()) * 2 / std::sqrt(3.0));
        parallel_for(uniform.points.size(), [&](std::size_t v) {
            const Vector3d normal = object.sample(uniform.points[v]).gradient.normalized();
            uniform.points[v] += options.noise * edge * (2 * random_share(options.seed, 1000 + v) - 1) * normal;
        });
    }
    TriangleSoup soup;
    soup.points.reserve(uniform.points.size());
    for (const Vector3d& p : uniform.points) soup.points.push_back({p.x(), p.y(), p.z()});
    soup.triangles = std::move(uniform.faces);
    uniform = {};
    result.mesh = build_mesh(soup);
    merge_small_patches(result.mesh, result.face_labels, object.parts.size());
    return result;
}

void MakeOptions::declare_options(OptionList& list) {
    list("vertices", vertices, "target number of vertices (reached to 1 %)", Range{4, 5e7});
    list("seed", seed, "random seed of mesh and noise: another seed gives another mesh of the same object",
         Range{0, 9007199254740992.0});
    list("noise", noise, "maximum displacement of a vertex along its normal, as a share of the mean edge length", Range{0, 0.25});
}

}  // namespace ostraka

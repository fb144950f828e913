#include "ostraka/remesh/refine.h"

#include "ostraka/core/error.h"
#include "ostraka/core/memory.h"
#include "remesh/subdivide.h"

#include <fmt/core.h>

#include <numeric>

namespace ostraka {

namespace {

/// Memory for a vertex of a fine mesh, including its edges, faces and origins.
void require_for(double vertices) {
    constexpr double bytes_of_vertex = 600;
    require_memory(bytes_of_vertex * vertices, fmt::format("a mesh of {} vertices", static_cast<long long>(vertices)),
                   "request fewer vertices or levels");
}

constexpr std::uint64_t max_edges = (std::uint64_t{1} << 31) - 2;  ///< two halfedges per edge must fit 32 bits

void check_size(std::uint64_t edges) {
    if (edges > max_edges)
        fail_usage(
            fmt::format("the refined mesh would have {} edges, more than the {} that 32-bit indices allow", edges, max_edges),
            "request fewer vertices or levels");
}

void check_request(const Mesh& mesh, const RefineOptions& options) {
    check_options(options, "refine");
    if (mesh.has_garbage()) throw std::logic_error("refine: collect the garbage first");
    if ((options.vertices > 0) == (options.levels > 0))
        fail_usage("refine needs either a number of vertices or a number of levels", "give one of --vertices and --levels");
    if (mesh.number_of_faces() == 0) fail_input("mesh", "has no faces to refine", "choose a mesh with faces");
    for (const Face f : mesh.faces())
        if (mesh.next(mesh.next(mesh.next(mesh.halfedge(f)))) != mesh.halfedge(f))
            fail_input("face " + std::to_string(Index(f)), "is not a triangle");
    if (options.levels > 0) {
        if (options.scheme == RefineOptions::Scheme::longest_edge)
            fail_usage("the scheme longest-edge does not support levels", "give --vertices, or use the scheme midpoint or loop");
        std::uint64_t edges = mesh.number_of_edges(), faces = mesh.number_of_faces();
        for (int level = 0; level < options.levels; ++level) {
            edges = 2 * edges + 3 * faces;
            faces *= 4;
            check_size(edges);
        }
        require_for(static_cast<double>(edges) / 3);
    } else {
        if (options.vertices < mesh.number_of_vertices())
            fail_usage(
                fmt::format("the mesh has {} vertices, more than the {} requested", mesh.number_of_vertices(), options.vertices),
                "use: ostraka mesh simplify");
        check_size(mesh.number_of_edges() + 3 * (options.vertices - mesh.number_of_vertices()));
        require_for(static_cast<double>(options.vertices - mesh.number_of_vertices()));
    }
}

}  // namespace

RefineResult refine(Mesh& mesh, const RefineOptions& options) {
    check_request(mesh, options);
    RefineResult result;
    result.old_vertices = mesh.number_of_vertices();
    result.face_origin.resize(mesh.number_of_faces());
    result.edge_origin.resize(mesh.number_of_edges());
    std::iota(result.face_origin.begin(), result.face_origin.end(), Index{0});
    std::iota(result.edge_origin.begin(), result.edge_origin.end(), Index{0});
    const bool smooth = options.scheme == RefineOptions::Scheme::loop;
    for (int level = 0; level < options.levels; ++level) cut_into_four(mesh, smooth, result);
    if (options.vertices > 0) {
        if (options.scheme != RefineOptions::Scheme::longest_edge)
            while (mesh.number_of_vertices() + mesh.number_of_edges() <= options.vertices) cut_into_four(mesh, smooth, result);
        halve_longest_edges(mesh, options.vertices, result);
    }
    return result;
}

void RefineOptions::declare_options(OptionList& list) {
    list("vertices", vertices, "target number of vertices (reached exactly); 0: determined by --levels", Range{0, 5e8});
    list("levels", levels, "number of times each triangle is split into four", Range{0, 12});
    list("scheme", scheme,
         "midpoint (each triangle is split into four without a change of shape; halving the longest edges gives the rest of the "
         "target number), loop (the same with Loop's smoothing) or longest-edge (edges are halved in the order of their length "
         "without a change of shape)",
         Choices{"midpoint", "loop", "longest-edge"});
}

}  // namespace ostraka

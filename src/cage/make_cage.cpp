#include "ostraka/cage/cage.h"
#include "ostraka/core/error.h"
#include "ostraka/io/wrap.h"

#include "shrink.h"

#include <algorithm>

namespace ostraka {

namespace {

/// Triangles, and with a plane their images.
TriangleSoup obstacle_of(const Mesh& mesh, const std::optional<MirrorPlane>& mirror) {
    TriangleSoup soup = to_soup(mesh);
    if (!mirror) return soup;
    const auto points = static_cast<Index>(soup.points.size());
    const std::size_t count = soup.triangles.size();
    for (const Vertex v : mesh.vertices()) {
        const Point p = cage::image(mesh.point(v), *mirror);
        soup.points.push_back({p.x(), p.y(), p.z()});
    }
    for (std::size_t t = 0; t < count; ++t) {
        const auto [a, b, c] = soup.triangles[t];
        soup.triangles.push_back({a + points, c + points, b + points});
    }
    return soup;
}

}  // namespace

CageResult make_cage(const Mesh& mesh, const CageOptions& options, const CageDensity& density,
                     const std::optional<MirrorPlane>& mirror) {
    check_options(options, "cage");
    const double diagonal = box_diagonal(mesh);
    if (mesh.number_of_faces() == 0) fail_input("mesh", "has no faces", "give a mesh with faces");
    if (!(diagonal > 0)) fail_input("mesh", "has no extent", "give a mesh whose vertices are not all in one place");
    if (mirror && !(mirror->normal.squared_length() > 0))
        throw Error(ErrorKind::usage, "mirror plane", "its normal is zero", "give a direction");
    const TriangleSoup soup = obstacle_of(mesh, mirror);
    const cage::Obstacle obstacle(soup);

    CageResult best;
    double alpha = options.alpha > 0 ? options.alpha : 1.0 / 40;
    bool finer = options.alpha == 0;  // until the wrap has vertices enough
    while (alpha <= 4) {
        Mesh surface = build_mesh(wrap_soup(soup, alpha * diagonal, options.offset * diagonal));
        finer = finer && surface.number_of_vertices() < options.vertices && alpha > 1e-3;
        if (finer) {
            alpha /= 2;
            continue;
        }
        const double tried = alpha;
        alpha *= 2;
        if (options.genus == "fill" && check_cage(surface, Mesh()).genus > 0) continue;
        const std::size_t size = surface.number_of_vertices();
        if (mirror) surface = cage::upper_half(surface, *mirror);
        if (surface.number_of_faces() == 0) continue;
        const std::size_t reached =
            cage::shrink(surface, obstacle, options.vertices, 0.1 * options.offset * diagonal, density, mirror);
        if (mirror) surface = cage::mirrored_whole(surface, *mirror);
        // The guards leave nothing to be found here but what rounding does on the mirror plane.
        if (surface.number_of_faces() == 0 || !check_cage(surface, mesh).valid()) continue;
        if (best.cage.number_of_faces() == 0 || reached < best.cage.number_of_vertices()) {
            best.cage = std::move(surface);
            best.alpha = tried;
            best.wrap_vertices = size;
            best.reached = reached <= options.vertices;
        }
        if (best.reached || options.alpha > 0) break;
    }
    if (best.cage.number_of_faces() == 0)
        throw Error(ErrorKind::failure, "cage", "no wrap of the mesh gives a cage that passes its check",
                    options.alpha > 0 ? "leave --alpha out, or raise it" : "raise --offset");
    return best;
}

std::vector<CageResult> make_nested_cages(const Mesh& mesh, std::vector<std::uint64_t> levels, const CageOptions& options,
                                          const CageDensity& density, const std::optional<MirrorPlane>& mirror) {
    if (levels.empty()) throw Error(ErrorKind::usage, "levels", "there are none", "give numbers of vertices");
    std::sort(levels.rbegin(), levels.rend());
    std::vector<CageResult> results;
    for (const std::uint64_t level : levels) {
        CageOptions here = options;
        here.vertices = level;
        results.push_back(make_cage(results.empty() ? mesh : results.back().cage, here, density, mirror));
    }
    return results;
}

}  // namespace ostraka

// Whole objects to break, with many kinds of surfaces.
#include "facet_cases.h"
#include "scenes.h"
#include "shatter.h"

#include "ostraka/core/error.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/io/repair.h"
#include "ostraka/remesh/remesh.h"
#include "ostraka/synthetic/heads.h"
#include "ostraka/synthetic/make_mesh.h"

#include <CGAL/Polygon_mesh_processing/clip.h>
#include <CGAL/boost/graph/helpers.h>

#include <array>
#include <cmath>

namespace ostraka::experiments {

using Eigen::Vector3d;

Mesh rounded(const Mesh& mesh, int steps) {
    Mesh result = mesh;
    std::vector<Point> next(mesh.number_of_vertices());
    for (int step = 0; step < steps; ++step) {
        for (const Vertex v : result.vertices()) {
            Vector3d mean = Vector3d::Zero();
            double count = 0;
            for (const Halfedge h : result.halfedges_around_target(result.halfedge(v)))
                mean += eigen(result.point(result.source(h))), ++count;
            next[v] = point_of(0.5 * eigen(result.point(v)) + 0.5 * mean / count);
        }
        result = with_points(result, next);
    }
    return result;
}

namespace {

Mesh stretched(const Mesh& mesh, const Vector3d& factors) {
    return warped(mesh, [&](const Vector3d& p) { return p.cwiseProduct(factors); });
}

/// Varies the surface: carved or worn at large scale, grainy at small scale, or unchanged.
Mesh skinned(const Mesh& mesh, Random& random, double most) {
    Mesh result = mesh;
    const double coarse = random.uniform(0.1, 1) * most, fine = 0.15 * random.uniform(0.1, 1) * most;
    const double far = random.uniform(0.25, 0.7), near = random.uniform(0.04, 0.12);
    if (random.uniform() < 0.4) result = with_relief(result, coarse, far, random.bits() >> 12);
    if (random.uniform() < 0.4) result = with_relief(result, fine, near, random.bits() >> 12);
    return result;
}

/// Adds a flat base, as on standing objects; remeshed, since the base has few faces.
Mesh based(const Mesh& mesh, Random& random) {
    namespace PMP = CGAL::Polygon_mesh_processing;
    const Vector3d up = normal_vector(random).normalized();
    double low = 1e300, high = -1e300;
    for (const Vertex v : mesh.vertices()) {
        low = std::min(low, up.dot(eigen(mesh.point(v))));
        high = std::max(high, up.dot(eigen(mesh.point(v))));
    }
    const Vector3d at = (low + random.uniform(0.03, 0.3) * (high - low)) * up;
    Mesh result = mesh;
    PMP::clip(result, Kernel::Plane_3(point_of(at), vector_of(-up)), CGAL::parameters::clip_volume(true));
    PMP::keep_largest_connected_components(result, 1);
    result.collect_garbage();
    RemeshOptions how;
    how.vertices = mesh.number_of_vertices();
    how.feature_angle = 50;
    return remesh(result, how).mesh;
}

Mesh object_of_file(const std::string& file, std::uint64_t seed, bool bare) {
    Random random(seed, 180);
    RepairOptions mending;
    mending.keep_largest = true;
    mending.fill_holes_size = 1;
    Mesh mesh = repair(triangulate(read_polygons(file)).soup, {}, mending).mesh;
    if (!CGAL::is_closed(mesh)) fail_input(file, "is open", "leave it out");
    mesh = simplified(std::move(mesh), static_cast<std::uint64_t>(std::lround(3000 * std::pow(8, random.uniform()))));
    if (random.uniform() < 0.5)
        mesh = stretched(mesh, {random.uniform(0.6, 1.2), random.uniform(0.6, 1.2), random.uniform(0.6, 1.2)});
    if (random.uniform() < 0.3) mesh = rounded(mesh, 1 + static_cast<int>(random.below(10)));
    if (random.uniform() < 0.3) mesh = based(mesh, random);
    return bare ? mesh : skinned(mesh, random, 0.005);
}

}  // namespace

Mesh whole_object(const std::string& kind, const std::string& name, std::uint64_t seed, bool bare) {
    if (kind == "mesh") return object_of_file(name, seed, bare);
    Random random(seed, 177);
    if (kind == "pot" || kind == "thin") {
        PotOptions options;
        options.shape = seed;
        options.height = random.uniform(8, 25);
        options.radius = random.uniform(4, 10);
        options.wall = kind == "thin" ? random.uniform(0.1, 0.35) : random.uniform(0.3, 1.2);
        options.edge = random.uniform(0.25, 0.45);
        const Mesh pot = make_pot(options);
        return bare ? pot : skinned(pot, random, 0.1 * options.wall / options.height);
    }
    MakeOptions options;
    options.vertices = 4000 + random.below(16000);
    options.seed = 1 + random.below(1000);
    if (kind == "made") {
        Mesh mesh = made_mesh(name, options.vertices, options.seed);
        if (random.uniform() < 0.5) mesh = rounded(mesh, 1 + static_cast<int>(random.below(12)));
        return bare ? mesh : skinned(mesh, random, 0.002);
    }
    if (kind != "stone") fail_usage("'" + kind + "' is no source of fragments", "write pot, thin, stone, made or mesh");
    const std::array<const char*, 8> bodies{"box", "cylinder", "sphere", "capsule", "statuette", "box", "head", "head"};
    const std::string body = bodies[random.below(bodies.size())];
    ArchetypeOptions head;
    head.long_hair = random.uniform() < 0.5;
    head.seed = seed;
    const Mesh mesh = body == "head" ? make_mesh(*head_object(head_archetype(head)), options).mesh
                                     : made_mesh(body, options.vertices, options.seed);
    const Vector3d factors(random.uniform(0.4, 1), random.uniform(0.5, 1.2), random.uniform(0.6, 1.5));
    const int steps = static_cast<int>(random.uniform() < 0.6 ? 1 + random.below(25) : 0);
    return skinned(rounded(stretched(mesh, factors), steps), random, 0.01);
}

}  // namespace ostraka::experiments

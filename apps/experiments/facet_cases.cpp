#include "facet_cases.h"

#include "boxes.h"
#include "scenes.h"

#include "ostraka/core/error.h"
#include "ostraka/core/text.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/io/repair.h"
#include "ostraka/point_cloud/point_cloud.h"
#include "ostraka/remesh/remesh.h"
#include "ostraka/synthetic/heads.h"
#include "ostraka/synthetic/make_mesh.h"

#include <CGAL/Polygon_mesh_processing/clip.h>
#include <CGAL/boost/graph/helpers.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <map>

namespace ostraka::experiments {

using Eigen::Vector3d;

namespace {

/// Rounds all edges, as by long use or by the filter of a scan.
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
    for (const Point& p : mesh.points()) low = std::min(low, up.dot(eigen(p))), high = std::max(high, up.dot(eigen(p)));
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

/// `bare`: the surface is not altered.
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

/// Replaces the mesh by a reconstruction from a simulated scan: points of about even spacing with small errors.
void as_cloud(FacetCase& sherd, Random& random) {
    PointCloud cloud;
    const double wanted = std::round(300 * std::pow(23, random.uniform()));
    const double spacing = std::sqrt(surface_area(sherd.mesh) / wanted), off = 0.06 * spacing;
    const SurfaceSearch skin(sherd.mesh);
    std::vector<double> areas;
    double sum = 0;
    for (const Face f : sherd.mesh.faces()) areas.push_back(sum += face_area(sherd.mesh, f));
    // One point per cell, as in thinned scans.
    std::map<std::array<long, 3>, std::size_t> first;
    std::vector<Point> points;
    std::vector<Vector> normals;
    for (std::size_t k = 0; k < static_cast<std::size_t>(8 * wanted); ++k) {
        const auto at = std::lower_bound(areas.begin(), areas.end(), sum * random.uniform());
        const Face f(static_cast<Index>(std::min<std::ptrdiff_t>(at - areas.begin(), std::ssize(areas) - 1)));
        double u = random.uniform(), v = random.uniform();
        if (u + v > 1) u = 1 - u, v = 1 - v;
        const Vector normal = skin.normal(f.idx());
        const Point p = point_at(sherd.mesh, f.idx(), {1 - u - v, u, v}) + random.normal() * off * normal;
        first.emplace(std::array{std::lround(p.x() / spacing), std::lround(p.y() / spacing), std::lround(p.z() / spacing)},
                      points.size());
        points.push_back(p);
        const Vector3d tilted = eigen(normal) + 0.08 * normal_vector(random);
        normals.push_back(vector_of(tilted.normalized()));
    }
    for (const auto& [cell, k] : first) cloud.points.push_back(points[k]), cloud.normals.push_back(normals[k]);
    Mesh surface = reconstruct_surface(cloud).mesh;
    sherd.broken = broken_of_nearest(surface, sherd);
    sherd.mesh = std::move(surface);
}

/// Simplifies the scan, like small scans in archives.
void as_simplified(FacetCase& sherd, Random& random) {
    static_cast<Sherd&>(sherd) =
        ostraka::simplified(sherd, static_cast<std::uint64_t>(std::lround(400 * std::pow(10, random.uniform()))));
}

/// Chooses the kind of fracture: rough, grainy, smooth and curved like flint or glass, or faceted like coarse simulations.
void choose_break(ShatterOptions& breaking, bool shell, Random& random) {
    const double kind = random.uniform();
    // Shells show fractures by the wall, solids only by roughness.
    breaking.roughness = shell ? 0.04 * std::pow(0.025, random.uniform()) : random.uniform(0.006, 0.04);
    breaking.hurst = random.uniform(0.3, 1);
    breaking.finest = random.uniform(0.02, 0.08);
    if (kind < 0.15) {
        breaking.hurst = random.uniform(0, 0.3);
        breaking.finest = random.uniform(0.015, 0.04);
        breaking.roughness *= 0.5;
    } else if (kind < 0.35) {
        breaking.hurst = random.uniform(0.9, 1.6);
        breaking.roughness *= 0.4;
        breaking.bow = random.uniform(0.05, 0.35);
    } else if (kind < 0.6) {
        breaking.sheet = random.uniform(0.05, 0.2);
        breaking.hurst = random.uniform(0, 0.8);
        if (!shell) breaking.roughness = random.uniform(0.01, 0.08);
    }
    if (random.uniform() < 0.35) breaking.streak = random.uniform(0.6, 0.95);
    if (kind > 0.35 && random.uniform() < 0.3) breaking.bow = random.uniform(0, 0.2);
}

struct Source {
    std::string kind, name;
    std::uint64_t seed = 0;
    bool whole = false;
};

Source read_source(const std::string& source) {
    const std::vector<std::string_view> split = split_words(source, ":");
    std::vector<std::string> words(split.begin(), split.end());
    Source result;
    result.whole = words.back() == "whole";
    if (result.whole) words.pop_back();
    if (words.size() < 2 || (words[0] == "made" || words[0] == "mesh") != (words.size() == 3))
        fail_usage("'" + source + "' is no source of fragments",
                   "write pot:SEED, thin:SEED, stone:SEED, made:NAME:SEED or mesh:FILE:SEED");
    result.kind = words[0];
    result.name = words[1];
    result.seed = std::stoull(words.back());
    return result;
}

std::vector<FacetCase> made_cases(const std::string& source) {
    const auto [kind, name, seed, whole] = read_source(source);
    const Mesh object = whole_object(kind, name, seed, whole && seed % 2 == 0);
    Random random(seed, 178);
    ShatterOptions breaking;
    breaking.pieces = 2 + static_cast<int>(random.below(11));
    breaking.seed = seed;
    // As shares of a piece's extent and of the diagonal.
    const double piece = std::sqrt(surface_area(object) / breaking.pieces) / box_diagonal(object);
    choose_break(breaking, kind == "pot" || kind == "thin", random);
    const bool worn = random.uniform() < 0.5, noisy = random.uniform() < 0.5, anew = random.uniform() < 0.5;
    if (worn) breaking.erosion = piece * random.uniform(0.001, 0.015);
    if (worn && random.uniform() < 0.5) breaking.patchiness = random.uniform();
    if (noisy) breaking.noise = piece * random.uniform(0.0002, 0.003);
    if (anew) breaking.edge = piece * random.uniform(0.012, 0.06);
    const int filtered = random.uniform() < 0.3 ? 1 + static_cast<int>(random.below(3)) : 0;
    if (whole) breaking.pieces = 1;
    std::vector<FacetCase> cases;
    for (Sherd& sherd : shatter(object, breaking))
        cases.push_back({std::move(sherd), source, whole ? "whole" : std::to_string(cases.size()), false, {}});
    for (FacetCase& sherd : cases) {
        if (filtered > 0) sherd.mesh = rounded(sherd.mesh, filtered);
        const double sampling = random.uniform();
        if (sampling > 0.65) as_simplified(sherd, random);
        if (sampling < 0.25) {
            sherd.name += " cloud";
            try {
                as_cloud(sherd, random);
            } catch (const Error&) {
                // The points are too sparse for the piece: keep its mesh.
            }
        }
    }
    return cases;
}

/// Scanned fragments in assembled layout: fracture is what lies close to and faces another fragment.
std::vector<FacetCase> scanned_cases(const std::string& folder) {
    FragmentLayout layout = read_layout(folder, FacetChoice::known);
    std::vector<FacetCase> cases;
    std::vector<SurfaceSearch> searches;
    for (Fragment& fragment : layout.fragments)
        cases.push_back({{std::move(fragment.mesh), {}}, layout.name, fragment.name, true, {}});
    for (const FacetCase& fragment : cases) searches.emplace_back(fragment.mesh);
    // Simulated pieces coincide, scanned ones have gaps, and those of the scanned vessel large ones.
    const bool vessel = layout.name.find("vessel") != std::string::npos;
    const double diagonal = layout.diagonal;
    const auto [max_gap, max_overlap] = layout.copied ? std::pair(1e-4 * diagonal, 1e-4 * diagonal)
                                        : vessel      ? std::pair(0.05 * diagonal, 0.0)
                                                      : std::pair(std::max(2 * layout.edge, 0.015 * diagonal), 0.015 * diagonal);
    for (std::size_t k = 0; k < cases.size(); ++k) {
        // In front of a face of another fragment, or slightly behind it where scans overlap.
        const auto broken_within = [&, gap = max_gap, overlap = max_overlap](double factor) {
            const double far = factor * gap, behind = factor * overlap;
            return facing(cases[k].mesh, others_than(k, searches), std::max(far, behind),
                          [&](const SurfaceHit& hit, const Point& place, const Vector& normal) {
                              const double front = (hit.point - place) * normal;
                              if (front > far || front < -behind) return false;
                              return std::abs(front) >= 0.6 * hit.distance || hit.distance < 0.15 * far;
                          });
        };
        cases[k].broken = broken_within(1);
        if (layout.copied || vessel) continue;
        // Layouts of scans are approximate: a face near another fragment, but not within the gap, may still be fracture.
        const std::vector<bool> perhaps = broken_within(3);
        for (std::size_t f = 0; f < perhaps.size(); ++f) cases[k].known.push_back(cases[k].broken[f] || !perhaps[f]);
    }
    // Coinciding vertices do not matter here, but unrealistically sharp edges do.
    for (std::size_t k = 0; layout.copied && k < cases.size(); ++k) {
        Random random(k, 179);
        const double noise = 0.03 * mean_edge_length(cases[k].mesh);
        cases[k].mesh = warped(cases[k].mesh, [&](const Vector3d& p) { return Vector3d(p + noise * normal_vector(random)); });
    }
    return cases;
}

}  // namespace

std::string object_of_source(const std::string& source) {
    const Path path(source);
    std::string name = path.filename().string();
    if (std::filesystem::is_directory(source)) return name.rfind("tuw_", 0) == 0 ? name.substr(4) : name;
    const Source what = read_source(source);
    if (what.kind == "made") return what.name;
    // Vessels of one seed have one profile. Numbered files are variants of the object named by their folder.
    if (what.kind != "mesh") return (what.kind == "stone" ? "stone " : "vessel ") + std::to_string(what.seed);
    const Path file(what.name);
    name = file.stem().string();
    return std::isdigit(static_cast<unsigned char>(name[0])) ? file.parent_path().filename().string() : name;
}

std::vector<FacetCase> facet_cases(const std::string& source) {
    return std::filesystem::is_directory(source) ? scanned_cases(source) : made_cases(source);
}

}  // namespace ostraka::experiments

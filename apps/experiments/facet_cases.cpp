#include "facet_cases.h"

#include "ostraka/core/error.h"
#include "ostraka/core/file.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/point_cloud/point_cloud.h"
#include "ostraka/reconstruction/fragment_file.h"
#include "ostraka/remesh/simplify.h"
#include "ostraka/stats/random.h"
#include "ostraka/synthetic/heads.h"
#include "ostraka/synthetic/make_mesh.h"
#include "shatter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

namespace ostraka::experiments {

using Eigen::Vector3d;

namespace {

Mesh stretched(const Mesh& mesh, const Vector3d& factors) {
    Mesh result = mesh;
    for (const Vertex v : result.vertices()) result.point(v) = point_of(eigen(mesh.point(v)).cwiseProduct(factors));
    return result;
}

/// A skin that is not smooth: carved or worn in the large, grainy in the small, or left as it is.
Mesh skinned(const Mesh& mesh, Random& random, double most) {
    Mesh result = mesh;
    const double coarse = random.uniform(0.1, 1) * most, fine = 0.15 * random.uniform(0.1, 1) * most;
    const double far = random.uniform(0.25, 0.7), near = random.uniform(0.04, 0.12);
    if (random.uniform() < 0.4) result = with_relief(result, coarse, far, random.bits() >> 12);
    if (random.uniform() < 0.4) result = with_relief(result, fine, near, random.bits() >> 12);
    return result;
}

/// Edges rounded all over, as by long use.
Mesh rounded(const Mesh& mesh, int steps) {
    Mesh result = mesh;
    std::vector<Vector3d> next(mesh.number_of_vertices());
    for (int step = 0; step < steps; ++step) {
        for (const Vertex v : result.vertices()) {
            Vector3d mean = Vector3d::Zero();
            double count = 0;
            for (const Halfedge h : result.halfedges_around_target(result.halfedge(v)))
                mean += eigen(result.point(result.source(h))), ++count;
            next[v] = 0.5 * eigen(result.point(v)) + 0.5 * mean / count;
        }
        for (const Vertex v : result.vertices()) result.point(v) = point_of(next[v]);
    }
    return result;
}

Mesh whole_object(const std::string& kind, const std::string& name, std::uint64_t seed, bool bare) {
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
        Mesh mesh = make_mesh(synthetic_object(name), options).mesh;
        if (random.uniform() < 0.5) mesh = rounded(mesh, 1 + static_cast<int>(random.below(12)));
        return bare ? mesh : skinned(mesh, random, 0.002);
    }
    if (kind != "stone") fail_usage("'" + kind + "' is no source of fragments", "write pot, thin, stone or made");
    const std::array<const char*, 8> bodies{"box", "cylinder", "sphere", "capsule", "statuette", "box", "head", "head"};
    const std::string body = bodies[random.below(bodies.size())];
    ArchetypeOptions head;
    head.long_hair = random.uniform() < 0.5;
    head.seed = seed;
    const Mesh mesh = body == "head" ? make_mesh(*head_object(head_archetype(head)), options).mesh
                                     : make_mesh(synthetic_object(body), options).mesh;
    const Vector3d factors(random.uniform(0.4, 1), random.uniform(0.5, 1.2), random.uniform(0.6, 1.5));
    const int steps = static_cast<int>(random.uniform() < 0.6 ? 1 + random.below(25) : 0);
    return skinned(rounded(stretched(mesh, factors), steps), random, 0.01);
}

/// What a scanner's cloud of it gives: a surface through points of about even spacing, a little off.
void as_cloud(FacetCase& sherd, Random& random) {
    PointCloud cloud;
    const auto wanted = static_cast<double>(800 + random.below(6000));
    const double spacing = std::sqrt(surface_area(sherd.mesh) / wanted), off = 0.06 * spacing;
    const SurfaceSearch skin(sherd.mesh);
    std::vector<double> areas;
    double sum = 0;
    for (const Face f : sherd.mesh.faces()) areas.push_back(sum += face_area(sherd.mesh, f));
    // One point a cell, as where scans are thinned.
    std::vector<std::array<long, 3>> cells;
    std::vector<std::pair<std::array<long, 3>, std::size_t>> order;
    std::vector<Point> points;
    std::vector<Vector> normals;
    for (std::size_t k = 0; k < static_cast<std::size_t>(8 * wanted); ++k) {
        const auto at = std::lower_bound(areas.begin(), areas.end(), sum * random.uniform());
        const Face f(static_cast<Index>(std::min<std::ptrdiff_t>(at - areas.begin(), std::ssize(areas) - 1)));
        double u = random.uniform(), v = random.uniform();
        if (u + v > 1) u = 1 - u, v = 1 - v;
        const Vector normal = skin.normal(f.idx());
        const Point p = point_at(sherd.mesh, f.idx(), {1 - u - v, u, v}) + random.normal() * off * normal;
        order.emplace_back(std::array{std::lround(p.x() / spacing), std::lround(p.y() / spacing), std::lround(p.z() / spacing)},
                           points.size());
        points.push_back(p);
        const Vector3d tilted = eigen(normal) + 0.08 * Vector3d(random.normal(), random.normal(), random.normal());
        normals.push_back(vector_of(tilted.normalized()));
    }
    std::stable_sort(order.begin(), order.end());
    for (std::size_t k = 0; k < order.size(); ++k)
        if (k == 0 || order[k].first != order[k - 1].first) {
            cloud.points.push_back(points[order[k].second]);
            cloud.normals.push_back(normals[order[k].second]);
        }
    const Mesh surface = reconstruct_surface(cloud).mesh;
    std::vector<bool> broken;
    for (const Face f : surface.faces()) broken.push_back(sherd.broken[skin.closest(centroid(surface, f)).face]);
    sherd.mesh = surface;
    sherd.broken = std::move(broken);
}

/// What is left of a scan where its archive wants it small.
void as_simplified(FacetCase& sherd, Random& random) {
    SimplifyOptions how;
    how.vertices = static_cast<std::uint64_t>(std::lround(400 * std::pow(10, random.uniform())));
    if (how.vertices >= sherd.mesh.number_of_vertices()) return;
    const SurfaceSearch skin(sherd.mesh);
    Mesh small = sherd.mesh;
    simplify(small, how);
    std::vector<bool> broken;
    for (const Face f : small.faces()) broken.push_back(sherd.broken[skin.closest(centroid(small, f)).face]);
    sherd.mesh = std::move(small);
    sherd.broken = std::move(broken);
}

std::vector<FacetCase> made_cases(const std::string& source) {
    std::vector<std::string> words;
    for (std::size_t from = 0; from <= source.size();) {
        const std::size_t to = std::min(source.find(':', from), source.size());
        words.push_back(source.substr(from, to - from));
        from = to + 1;
    }
    const bool whole = words.back() == "whole";
    if (whole) words.pop_back();
    if (words.size() < 2 || (words[0] == "made") != (words.size() == 3))
        fail_usage("'" + source + "' is no source of fragments", "write pot:SEED, thin:SEED, stone:SEED or made:NAME:SEED");
    const std::uint64_t seed = std::stoull(words.back());
    const Mesh object = whole_object(words[0], words[1], seed, whole);
    Random random(seed, 178);
    ShatterOptions breaking;
    breaking.pieces = 2 + static_cast<int>(random.below(9));
    breaking.seed = seed;
    // Shares of a piece's extent and of the diagonal.
    const double piece = std::sqrt(surface_area(object) / breaking.pieces) / box_diagonal(object);
    // Shells show their breaks by the wall, solids by roughness only.
    breaking.roughness = words[0] == "stone" ? random.uniform(0.006, 0.04) : 0.04 * std::pow(0.025, random.uniform());
    breaking.hurst = random.uniform(0.3, 1);
    breaking.finest = random.uniform(0.02, 0.08);
    if (words[0] == "made" && random.uniform() < 0.4) breaking.sheet = random.uniform(0.05, 0.25);
    const bool worn = random.uniform() < 0.5, noisy = random.uniform() < 0.5, anew = random.uniform() < 0.5;
    if (worn) breaking.erosion = piece * random.uniform(0.001, 0.015);
    if (noisy) breaking.noise = piece * random.uniform(0.0002, 0.003);
    if (anew) breaking.edge = piece * random.uniform(0.012, 0.06);
    std::vector<FacetCase> cases;
    if (whole) {
        cases.push_back({source, "whole", object, std::vector<bool>(object.number_of_faces(), false), false, {}});
    } else {
        for (Sherd& sherd : shatter(object, breaking))
            cases.push_back({source, std::to_string(cases.size()), std::move(sherd.mesh), std::move(sherd.broken), false, {}});
    }
    for (FacetCase& one : cases) {
        const double kind = random.uniform();
        if (kind > 0.65) as_simplified(one, random);
        if (kind < 0.25) {
            one.name += " cloud";
            try {
                as_cloud(one, random);
            } catch (const Error&) {
                // Points too far apart for the piece: it stays the mesh that it was.
            }
        }
    }
    return cases;
}

/// What lies close to another fragment, faces it and has it in front, or a little behind where scans overlap.
std::vector<bool> facing(const Mesh& mesh, const std::vector<const SurfaceSearch*>& others, double gap, double overlap) {
    std::vector<bool> result(mesh.number_of_faces(), false);
    for (const Face f : mesh.faces()) {
        const Vector area = area_vector(mesh, f);
        const double length = std::sqrt(area.squared_length());
        if (!(length > 0)) continue;
        const Vector normal = area / length;
        const Point place = centroid(mesh, f);
        for (const SurfaceSearch* other : others) {
            const auto hit = other->closest_compatible(place, -normal, 0.5, std::max(gap, overlap));
            if (!hit) continue;
            const double front = (hit->point - place) * normal;
            if (front > gap || front < -overlap) continue;
            if (std::abs(front) >= 0.6 * hit->distance || hit->distance < 0.15 * gap) result[f] = true;
        }
    }
    return result;
}

std::vector<FacetCase> scanned_cases(const std::string& folder) {
    std::vector<Path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        const std::string ending = entry.path().extension().string(), stem = entry.path().stem().string();
        // The vessel's folder holds two clouds of other vessels too.
        if ((ending == ".obj" || ending == ".ply") && stem.rfind("AL_", 0) != 0 && stem.rfind("CC_", 0) != 0)
            files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    FragmentFileOptions reading;
    reading.facets = FragmentFileOptions::FacetSource::none;
    const std::string name = Path(folder).filename().string();
    std::vector<FacetCase> cases;
    CGAL::Bbox_3 bounds;
    double edge = 0;
    for (const Path& file : files) {
        cases.push_back({name, file.stem().string(), read_fragment(file, reading).fragment.mesh, {}, true, {}});
        const Mesh& mesh = cases.back().mesh;
        bounds += bounding_box(mesh);
        edge = std::max(edge, mean_edge_length(mesh));
    }
    const double diagonal = std::sqrt(std::pow(bounds.xmax() - bounds.xmin(), 2) + std::pow(bounds.ymax() - bounds.ymin(), 2) +
                                      std::pow(bounds.zmax() - bounds.zmin(), 2));
    // Simulated pieces coincide, scanned ones lie apart, and the scanned vessel's far apart.
    const bool copied = name.rfind("bb_", 0) == 0, vessel = name.find("vessel") != std::string::npos;
    const double gap = copied   ? 1e-4 * diagonal
                       : vessel ? 0.05 * diagonal
                                : std::max(2 * edge, 0.015 * diagonal),
                 overlap = copied   ? gap
                           : vessel ? 0
                                    : 0.015 * diagonal;
    std::vector<SurfaceSearch> searches;
    for (const FacetCase& one : cases) searches.emplace_back(one.mesh);
    for (std::size_t k = 0; k < cases.size(); ++k) {
        std::vector<const SurfaceSearch*> others;
        for (std::size_t q = 0; q < cases.size(); ++q)
            if (q != k) others.push_back(&searches[q]);
        cases[k].broken = facing(cases[k].mesh, others, gap, overlap);
        if (copied || vessel) continue;
        // Layouts of scans are about right: what is near another fragment, but not as near as breaks are, may be of one.
        const std::vector<bool> perhaps = facing(cases[k].mesh, others, 3 * gap, 3 * overlap);
        for (std::size_t f = 0; f < perhaps.size(); ++f) cases[k].known.push_back(cases[k].broken[f] || !perhaps[f]);
    }
    if (!copied) return cases;
    // Coinciding vertices give nothing away here, but edges that are too sharp would.
    for (std::size_t k = 0; k < cases.size(); ++k) {
        Random random(k, 179);
        const double noise = 0.03 * mean_edge_length(cases[k].mesh);
        for (const Vertex v : cases[k].mesh.vertices())
            cases[k].mesh.point(v) = cases[k].mesh.point(v) + noise * Vector(random.normal(), random.normal(), random.normal());
    }
    return cases;
}

}  // namespace

std::vector<FacetCase> facet_cases(const std::string& source) {
    return std::filesystem::is_directory(source) ? scanned_cases(source) : made_cases(source);
}

}  // namespace ostraka::experiments

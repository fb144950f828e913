#include "facet_cases.h"

#include "boxes.h"
#include "scenes.h"
#include "shatter.h"

#include "ostraka/core/error.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/point_cloud/point_cloud.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>

namespace ostraka::experiments {

using Eigen::Vector3d;

namespace {

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
        const Vector3d tilted = eigen(normal) + 0.08 * normal_vector(random);
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

/// Simplifies the scan, like small scans in archives.
void as_simplified(FacetCase& sherd, Random& random) {
    const auto vertices = static_cast<std::uint64_t>(std::lround(400 * std::pow(10, random.uniform())));
    Sherd small = ostraka::simplified({std::move(sherd.mesh), std::move(sherd.broken)}, vertices);
    sherd.mesh = std::move(small.mesh);
    sherd.broken = std::move(small.broken);
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
    std::vector<std::string> words;
    for (std::size_t from = 0; from <= source.size();) {
        const std::size_t to = std::min(source.find(':', from), source.size());
        words.push_back(source.substr(from, to - from));
        from = to + 1;
    }
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
        cases.push_back(
            {source, whole ? "whole" : std::to_string(cases.size()), std::move(sherd.mesh), std::move(sherd.broken), false, {}});
    for (FacetCase& one : cases) {
        if (filtered > 0) one.mesh = rounded(one.mesh, filtered);
        const double sampling = random.uniform();
        if (sampling > 0.65) as_simplified(one, random);
        if (sampling < 0.25) {
            one.name += " cloud";
            try {
                as_cloud(one, random);
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
        cases.push_back({layout.name, fragment.name, std::move(fragment.mesh), {}, true, {}});
    for (const FacetCase& one : cases) searches.emplace_back(one.mesh);
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

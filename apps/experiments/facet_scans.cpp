// Scanned fragments in assembled layout: fracture is what lies close to and faces another fragment.
#include "boxes.h"
#include "facet_cases.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/reconstruction/fragment_file.h"
#include "ostraka/stats/random.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace ostraka::experiments {

namespace {

/// Whether each face is close to another fragment, faces it, and lies in front of it or slightly behind where scans overlap.
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

}  // namespace

std::vector<FacetCase> scanned_cases(const std::string& folder) {
    const std::vector<Path> files = fragment_files(folder);
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
    // Simulated pieces coincide, scanned ones have gaps, and those of the scanned vessel large ones.
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
        // Layouts of scans are approximate: a face near another fragment, but not within the gap, may still be fracture.
        const std::vector<bool> perhaps = facing(cases[k].mesh, others, 3 * gap, 3 * overlap);
        for (std::size_t f = 0; f < perhaps.size(); ++f) cases[k].known.push_back(cases[k].broken[f] || !perhaps[f]);
    }
    if (!copied) return cases;
    // Coinciding vertices do not matter here, but unrealistically sharp edges do.
    for (std::size_t k = 0; k < cases.size(); ++k) {
        Random random(k, 179);
        const double noise = 0.03 * mean_edge_length(cases[k].mesh);
        for (const Vertex v : cases[k].mesh.vertices())
            cases[k].mesh.point(v) = cases[k].mesh.point(v) + noise * Vector(random.normal(), random.normal(), random.normal());
    }
    return cases;
}

}  // namespace ostraka::experiments

#include "fracture/facet_columns.h"
#include "ostraka/core/angles.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/geom/point_tree.h"

namespace ostraka {

PatchSamples patch_samples(const Mesh& mesh, const FacetGraph& graph) {
    constexpr std::size_t count = 12000;
    PatchSamples samples;
    const double step = graph.area / count;
    double sum = 0;
    std::size_t k = 0;
    for (const Face f : mesh.faces()) {
        sum += face_area(mesh, f);
        for (; k < count && (static_cast<double>(k) + 0.5) * step < sum; ++k) {
            // The R2 sequence (Roberts 2018), folded into the triangle.
            const auto fraction = [&](double rate) { return std::fmod(0.5 + rate * static_cast<double>(k + 1), 1.0); };
            double u = fraction(0.7548776662466927), v = fraction(0.5698402909980532);
            if (u + v > 1) u = 1 - u, v = 1 - v;
            const auto [a, b, c] = corners(mesh, f);
            const Point &p = mesh.point(a), &q = mesh.point(b), &r = mesh.point(c);
            samples.points.push_back(p + u * (q - p) + v * (r - p));
            samples.patch.push_back(graph.patch_of_face[f]);
        }
    }
    return samples;
}

Neighbourhoods neighbourhoods(const FacetGraph& graph, const PatchSamples& samples, double radius) {
    const double expected_count = static_cast<double>(samples.points.size()) * pi * radius * radius / graph.area;
    const auto stride = static_cast<std::size_t>(std::clamp(expected_count / 80, 1.0, 40.0));
    std::vector<Point> points;
    for (std::size_t k = stride / 2; k < samples.points.size(); k += stride) points.push_back(samples.points[k]);
    const PointTree tree(points);
    std::vector<std::vector<Index>> neighbour_lists(graph.count());
    parallel_for(neighbour_lists.size(), 64, [&](std::size_t p) { tree.within(graph.places[p], radius, neighbour_lists[p]); });
    Neighbourhoods result;
    result.radius = radius;
    for (const auto& neighbour_list : neighbour_lists) {
        result.first.push_back(result.samples.size());
        for (const Index k : neighbour_list) result.samples.push_back(static_cast<Index>(stride / 2 + k * stride));
    }
    result.first.push_back(result.samples.size());
    return result;
}

std::array<Neighbourhoods, scale_count> neighbourhoods(const FacetGraph& graph, const PatchSamples& samples) {
    std::array<Neighbourhoods, scale_count> result;
    double share = 0.025;
    for (std::size_t s = 0; s < scale_count; ++s, share *= 2) {
        const double resolved = (1.5 + static_cast<double>(s)) * graph.edge;
        result[s] = neighbourhoods(graph, samples, std::min(std::max(share * graph.size, resolved), 0.4 * graph.size));
    }
    return result;
}

std::vector<double> neighbourhood_means(const FacetEvidence& evidence, std::size_t scale, const std::vector<double>& values) {
    const FacetGraph& graph = evidence.graph;
    const Neighbourhoods& around = evidence.around[scale];
    std::vector<double> result(values.size());
    parallel_for(values.size(), 64, [&](std::size_t p) {
        double sum = 1e-3 * values[p], count = 1e-3;
        for (std::size_t k = around.first[p]; k < around.first[p + 1]; ++k) {
            const Index q = evidence.samples.patch[around.samples[k]];
            if (graph.normals[q] * graph.normals[p] < 0.5) continue;
            sum += values[q];
            ++count;
        }
        result[p] = sum / count;
    });
    return result;
}

}  // namespace ostraka

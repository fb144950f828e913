#include "facet_columns.h"
#include "ostraka/core/angles.h"
#include "ostraka/core/parallel.h"

namespace ostraka {

std::array<double, scale_count> facet_scales(const FacetGraph& graph) {
    std::array<double, scale_count> radii{0.025, 0.05, 0.1, 0.2};
    for (std::size_t s = 0; s < scale_count; ++s)
        radii[s] = std::min(std::max(radii[s] * graph.size, (1.5 + static_cast<double>(s)) * graph.edge), 0.4 * graph.size);
    return radii;
}

SurfaceSamples surface_samples(const Mesh& mesh, const FacetGraph& graph) {
    constexpr std::size_t count = 12000;
    SurfaceSamples samples;
    const double step = graph.area / count;
    double sum = 0;
    std::size_t k = 0;
    for (const Face f : mesh.faces()) {
        sum += face_area(mesh, f);
        for (; k < count && (static_cast<double>(k) + 0.5) * step < sum; ++k) {
            // The R2 sequence (Roberts 2018), folded into the triangle.
            const auto share = [&](double rate) { return std::fmod(0.5 + rate * static_cast<double>(k + 1), 1.0); };
            double u = share(0.7548776662466927), v = share(0.5698402909980532);
            if (u + v > 1) u = 1 - u, v = 1 - v;
            const auto [a, b, c] = corners(mesh, f);
            const Point &p = mesh.point(a), &q = mesh.point(b), &r = mesh.point(c);
            samples.points.push_back(p + u * (q - p) + v * (r - p));
            samples.patch.push_back(graph.patch_of_face[f]);
        }
    }
    return samples;
}

SampleTree::SampleTree(const SurfaceSamples& samples, std::size_t stride) : stride_(stride) {
    std::vector<Point> points;
    for (std::size_t k = stride / 2; k < samples.points.size(); k += stride) points.push_back(samples.points[k]);
    tree_ = PointTree(points);
}

SampleTree SampleTree::for_radius(const FacetGraph& graph, const SurfaceSamples& samples, double radius) {
    const double held = static_cast<double>(samples.points.size()) * pi * radius * radius / graph.area;
    return {samples, static_cast<std::size_t>(std::clamp(held / 100, 1.0, 32.0))};
}

void SampleTree::within(const Point& place, double radius, std::vector<Index>& found) const {
    tree_.within(place, radius, found);
    for (Index& k : found) k = static_cast<Index>(stride_ / 2 + k * stride_);
}

std::vector<double> mean_about(const FacetEvidence& evidence, const SampleTree& tree, double radius,
                               const std::vector<double>& values) {
    const FacetGraph& graph = evidence.graph;
    std::vector<double> result(values.size());
    parallel_for(
        values.size(),
        [&](std::size_t p) {
            std::vector<Index> found;
            tree.within(graph.places[p], radius, found);
            double sum = 1e-3 * values[p], count = 1e-3;
            for (const Index k : found) {
                const Index q = evidence.samples.patch[k];
                if (graph.normals[q] * graph.normals[p] < 0.5) continue;
                sum += values[q];
                ++count;
            }
            result[p] = sum / count;
        },
        64);
    return result;
}

}  // namespace ostraka

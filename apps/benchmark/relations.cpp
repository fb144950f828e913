// Containment and adjacency of 200 annotations on 500,000 vertices.
#include "benchmarks.h"

#include "ostraka/relation/topology.h"

namespace ostraka::bench {

namespace {

/// Balls around 200 vertices, with nested and overlapping radii: at most 10 million faces in total.
AnnotationSet overlapping_regions(const Mesh& mesh) {
    constexpr int count = 200;
    constexpr std::size_t max_faces = 10'000'000;
    const double diagonal = box_diagonal(mesh);
    AnnotationSet set;
    std::size_t faces = 0;
    for (int i = 0; i < count; ++i) {
        const Point centre = mesh.point(Vertex(static_cast<Index>(mesh.number_of_vertices() * (i / 4) / (count / 4))));
        const double radius = diagonal * (0.05 + 0.06 * (i % 4));
        Annotation annotation;
        annotation.id = i;
        for (const Face f : mesh.faces())
            if (CGAL::squared_distance(centroid(mesh, f), centre) < radius * radius) annotation.faces.push_back(f);
        faces += annotation.faces.size();
        set.annotations.push_back(std::move(annotation));
    }
    if (faces > max_faces)  // shrink them in proportion
        for (auto& annotation : set.annotations) annotation.faces.resize(annotation.faces.size() * max_faces / faces);
    return set;
}

void find_topology(benchmark::State& state) {
    const Mesh& mesh = target(500'000);
    const AnnotationSet set = overlapping_regions(mesh);
    std::size_t faces = 0, pairs = 0;
    for (const Annotation& annotation : set.annotations) faces += annotation.faces.size();
    for ([[maybe_unused]] const auto lap : state) {
        const AnnotationTopology result = topology({mesh, set});
        pairs = 0;
        for (const auto& containers : result.order.containers) pairs += containers.size();
    }
    if (pairs == 0) state.SkipWithError("no region contains another");
    state.counters["faces_by_depth"] = static_cast<double>(faces);
    state.counters["containments"] = static_cast<double>(pairs);
}

}  // namespace

void register_relation_benchmarks() {
    with_both_times(benchmark::RegisterBenchmark("relation/topology/500000", find_topology));
    set_aim("relation/topology/500000", "seconds", 1);
}

}  // namespace ostraka::bench

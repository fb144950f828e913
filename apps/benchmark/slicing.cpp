// Slices of a million vertices, two million faces, and their descriptors.
#include "benchmarks.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/remesh/refine.h"
#include "ostraka/slicing/slice_descriptors.h"
#include "ostraka/synthetic/make_mesh.h"

#include <string>

namespace ostraka::bench {

namespace {

constexpr int planes = 200;

/// A hollow vase, so that walls have a thickness: a synthetic mesh with each triangle subdivided into sixteen.
const Mesh& vase() {
    static const Mesh vase_mesh = [] {
        MakeOptions options;
        options.vertices = 62'500;
        Mesh mesh = make_mesh(synthetic_object("vase"), options).mesh;
        RefineOptions finer;
        finer.levels = 2;
        refine(mesh, finer);
        return mesh;
    }();
    return vase_mesh;
}

SliceStack cut(const Mesh& mesh) {
    const SliceFrame frame = slice_frame({0, 0, 0}, {0, 0, 1});
    const auto [lowest, highest] = height_range(mesh, frame);
    return slice_mesh(mesh, frame, slice_heights(lowest, highest, planes));
}

void run(benchmark::State& state, bool describe, int thread_count) {
    const Mesh& mesh = vase();
    set_threads(thread_count);
    const SliceStack stack = cut(mesh);
    std::vector<SliceDescriptors> descriptors;
    for ([[maybe_unused]] const auto lap : state) {
        if (describe) descriptors = describe_slices(stack.slices);
        else benchmark::DoNotOptimize(cut(mesh));
    }
    set_threads(0);
    double pieces = 0;
    for (const auto& slice : stack.slices)
        for (const auto& contour : slice.contours) pieces += static_cast<double>(contour.faces.size());
    state.counters["faces"] = static_cast<double>(mesh.number_of_faces());
    state.counters["pieces"] = pieces;
    for (const auto& d : descriptors)
        if (!(d.area > 0)) state.SkipWithError("a slice without area");
}

}  // namespace

void register_slicing_benchmarks() {
    for (const bool describe : {false, true})
        for (const int thread_count : {1, 2})
            with_both_times(benchmark::RegisterBenchmark(
                (std::string("slicing/") + (describe ? "descriptors" : "cut") + "/threads:" + std::to_string(thread_count))
                    .c_str(),
                [=](benchmark::State& state) { run(state, describe, thread_count); }));
}

}  // namespace ostraka::bench

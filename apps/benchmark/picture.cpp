// Renders a million vertices.
#include "benchmarks.h"
#include "ostraka/render/render.h"

namespace ostraka::bench {

namespace {

void draw(benchmark::State& state) {
    Scene scene;
    scene.mesh = to_soup(target(1'000'000));
    scene.unit = "mm";
    for ([[maybe_unused]] const auto lap : state) {
        const Rendering rendering = render({scene});
        state.counters["s_tree"] = rendering.build_seconds;
        state.counters["s_drawing"] = rendering.draw_seconds;
        if (rendering.picture.width != 1200 || rendering.picture.height != 900) state.SkipWithError("wrong size");
    }
}

}  // namespace

void register_picture_benchmarks() { with_both_times(benchmark::RegisterBenchmark("render/1000000", draw)); }

}  // namespace ostraka::bench

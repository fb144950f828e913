// The benchmarks, a file a subject; what they work on.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/core/file.h"
#include "ostraka/geom/surface_search.h"

#include <benchmark/benchmark.h>

namespace ostraka::bench {

/// Runs the built command, so it must come first: what this process holds counts as the command's memory as long as the
/// command has not started (see run_command).
void register_command_benchmarks();
void register_transfer_benchmarks();
void register_query_benchmarks();
void register_reading_benchmarks();
void register_bandwidth_benchmarks();
void register_picture_benchmarks();
void register_relation_benchmarks();
void register_solver_benchmarks();
void register_coordinate_benchmarks();
void register_slicing_benchmarks();
void register_fitting_benchmarks();

/// Wall time decides; processor time of all threads stands beside it, since the machine may be busy.
inline void with_both_times(benchmark::internal::Benchmark* run) {
    run->UseRealTime()->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);
}

/// A teapot of 50,000 vertices; ten of its parts (body, base, spout, handle, knob, flowers ...) are regions.
struct Source {
    Mesh mesh;
    AnnotationSet regions;
};
const Source& source();

/// Up to 500,000 vertices the target is the same teapot meshed independently; above, such a mesh of a quarter or a sixteenth
/// of the vertices with each triangle cut into four, which is faster to make. The number of vertices is met to 0.1 %.
struct Making {
    std::size_t vertices = 0;
    int levels = 0;
};
Making making_of(std::size_t vertices);

/// One target is kept: asking for another number of vertices frees it with its search tree.
const Mesh& target(std::size_t vertices);
const SurfaceSearch& target_search(std::size_t vertices);

/// A folder that goes with the program.
const Path& scratch_folder();

}  // namespace ostraka::bench

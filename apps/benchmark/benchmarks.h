// The benchmarks, a file a subject; what they work on.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/core/file.h"
#include "ostraka/geom/surface_search.h"

#include <benchmark/benchmark.h>

#include <string>
#include <vector>

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

/// What a figure is meant to be at most: a counter of a benchmark, or "seconds", its wall time. The page shows it.
void set_aim(const std::string& benchmark, const std::string& figure, double at_most);

/// What is measured goes to the console and, at the end, into a page: for each group (the first word of a name) that was measured
/// and that the page has a place for, between the lines "<!-- measured: group -->" and "<!-- end of group -->".
class PageReporter : public benchmark::ConsoleReporter {
public:
    PageReporter() : ConsoleReporter(OO_Tabular) {}
    void ReportRuns(const std::vector<Run>& runs) override;
    /// Throws Error if the page cannot be read or written.
    void write(const Path& page) const;

private:
    std::vector<Run> runs_;
};

/// What a transfer cannot do without, as a program of its own: reads a mesh, its annotations and another mesh, named by the three
/// arguments after this one, and builds CGAL's tree over the latter. Returns the exit code.
inline constexpr const char* read_and_build_tree = "--read-and-build-tree";
int run_read_and_build_tree(const std::vector<std::string>& files);

/// Reading alone, as a program of its own: reads the mesh named by the argument after this one. Returns the exit code.
inline constexpr const char* read_mesh_only = "--read-mesh";
int run_read_mesh(const std::string& file);

/// How long operations on a million faces take to stop when they are cancelled, as a program of its own: works in the folder
/// named by the argument after this one, on the operations whose names contain the next one, and prints a table. Returns the exit
/// code.
inline constexpr const char* measure_cancelling = "--cancelling";
int run_cancelling(const std::string& folder, const std::string& only);

/// Bytes a second that loops read from memory at best.
double memory_bandwidth(int thread_count);

/// The time to build CGAL's AABB tree over a mesh, on one thread. Freeing it is not counted.
double seconds_of_cgal_tree(const Mesh& mesh);

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

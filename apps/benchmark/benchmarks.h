// The benchmarks, one file per subject, and their shared data.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/files/file.h"
#include "ostraka/geom/surface_search.h"

#include <benchmark/benchmark.h>

#include <string>
#include <vector>

namespace ostraka::bench {

/// Runs the built command. Must be registered first: until the child process starts its program, memory of this process counts
/// as memory of the child (see run_command).
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

/// Reports wall time, and processor time of all threads in addition, since the machine may be busy.
inline void with_both_times(benchmark::internal::Benchmark* run) {
    run->UseRealTime()->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);
}

/// Sets the target maximum of a figure: a counter of a benchmark, or "seconds" for its wall time. The page shows it.
void set_aim(const std::string& benchmark, const std::string& figure, double at_most);

/// Prints results to the console and finally inserts them into a page: each measured group (first word of the name) between the
/// lines "<!-- measured: group -->" and "<!-- end of group -->", if the page has them.
class PageReporter : public benchmark::ConsoleReporter {
public:
    PageReporter() : ConsoleReporter(OO_Tabular) {}
    void ReportRuns(const std::vector<Run>& runs) override;
    /// Throws Error if the page cannot be read or written.
    void write(const Path& page) const;

private:
    std::vector<Run> runs_;
};

/// Runs the unavoidable part of a transfer as a separate process: reads a mesh, its annotations and another mesh (the three
/// following arguments), and builds CGAL's tree over the latter. Returns the exit code.
inline constexpr const char* read_and_build_tree = "--read-and-build-tree";
int run_read_and_build_tree(const std::vector<std::string>& files);

/// Reads the mesh named by the following argument, as a separate process. Returns the exit code.
inline constexpr const char* read_mesh_only = "--read-mesh";
int run_read_mesh(const std::string& file);

/// Measures, as a separate process, how long operations on a million faces take to stop when cancelled. Works in the folder
/// named by the following argument, on the operations whose names contain the next one, and prints a table. Returns the exit
/// code.
inline constexpr const char* measure_cancelling = "--cancelling";
int run_cancelling(const std::string& folder, const std::string& only);

/// Maximal memory read bandwidth of a loop, in bytes per second.
double memory_bandwidth(int thread_count);

/// Seconds to build CGAL's AABB tree over a mesh with one thread, without freeing it.
double seconds_of_cgal_tree(const Mesh& mesh);

/// A teapot of 50,000 vertices with ten of its parts (body, base, spout, handle, knob, flowers ...) as regions.
const AnnotatedMesh& source();

/// Up to 500,000 vertices the target is the same teapot, meshed independently; above, a mesh with a quarter or a sixteenth of
/// the vertices whose triangles are subdivided into four, which is faster to make. The number of vertices is met within 0.1 %.
struct TargetMeshing {
    std::size_t vertices = 0;
    int levels = 0;
};
TargetMeshing meshing_of(std::size_t vertices);

/// One target is cached: requesting another number of vertices frees it and its search tree.
const Mesh& target(std::size_t vertices);
const SurfaceSearch& target_search(std::size_t vertices);

/// A folder that is removed when the program ends.
const Path& scratch_folder();

}  // namespace ostraka::bench

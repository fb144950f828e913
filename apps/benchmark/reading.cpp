// Reads a binary PLY of a million vertices: reading compared with checking ('mesh info'), and conversion to a halfedge mesh.
#include "benchmarks.h"
#include "ostraka/io/diagnose.h"
#include "ostraka/io/mesh_file.h"

#include <algorithm>
#include <chrono>

namespace ostraka::bench {

namespace {

constexpr std::size_t vertices = 1'000'000;

const Path& million() {
    static const Path file = [] {
        Path path = scratch_folder() / "million.ply";
        write_mesh(path, target(vertices));
        return path;
    }();
    return file;
}

void add_rate(benchmark::State& state, std::size_t bytes) {
    state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations() * bytes));
}

void read_bytes(benchmark::State& state) {
    std::size_t size = 0;
    for ([[maybe_unused]] const auto lap : state) size = read_file(million()).size();
    add_rate(state, size);
}

void parse(benchmark::State& state) {
    std::size_t triangles = 0;
    for ([[maybe_unused]] const auto lap : state) triangles = triangulate(read_polygons(million())).soup.triangles.size();
    if (triangles != target(vertices).number_of_faces()) state.SkipWithError("triangles were lost");
    add_rate(state, std::filesystem::file_size(million()));
}

void build(benchmark::State& state) {
    const TriangleSoup soup = triangulate(read_polygons(million())).soup;
    for ([[maybe_unused]] const auto lap : state) {
        Mesh mesh;
        if (try_build_mesh(soup, mesh).any()) state.SkipWithError("the mesh was not recognised as a manifold");
        state.PauseTiming();
        mesh = Mesh();
        state.ResumeTiming();
    }
    // Minimal traffic: reads points and triangles; writes points, halfedges, faces and edges.
    add_rate(state, soup.points.size() * (24 + 28) + soup.triangles.size() * (12 + 3 * 16 + 4));
}

/// The work of 'mesh info' between opening the file and printing. Counters: seconds per part, and the ratio of reading to
/// checks.
void mesh_info(benchmark::State& state, bool intersections) {
    for ([[maybe_unused]] const auto lap : state) {
        const auto start = std::chrono::steady_clock::now();
        const TriangulatedSoup triangles = triangulate(read_polygons(million()));
        const double reading = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        DiagnoseOptions options;
        options.skip_self_intersections = !intersections;
        const MeshDiagnosis diagnosis = diagnose(triangles.soup, options);
        if (!diagnosis.defects().empty()) state.SkipWithError(("found " + diagnosis.defects().front()).c_str());
        double checks = 0;
        state.counters["s_reading"] = reading;
        for (const auto& [part, seconds] : diagnosis.seconds) {
            std::string name = "s_" + part;
            std::replace(name.begin(), name.end(), ' ', '_');
            state.counters[name] = seconds;
            checks += seconds;
        }
        state.counters["reading_by_checks"] = reading / checks;
    }
}

}  // namespace

void register_reading_benchmarks() {
    with_both_times(benchmark::RegisterBenchmark("ply/bytes", read_bytes));
    with_both_times(benchmark::RegisterBenchmark("ply/triangles", parse));
    with_both_times(benchmark::RegisterBenchmark("ply/halfedges_of_triangles", build));
    with_both_times(benchmark::RegisterBenchmark("info/all_checks", [](benchmark::State& state) { mesh_info(state, true); }));
    with_both_times(benchmark::RegisterBenchmark("info/without_self_intersections",
                                                 [](benchmark::State& state) { mesh_info(state, false); }));
    for (const char* name : {"info/all_checks", "info/without_self_intersections"}) set_aim(name, "reading_by_checks", 1);
}

}  // namespace ostraka::bench

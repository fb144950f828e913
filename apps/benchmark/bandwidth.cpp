// Memory bandwidth: the maximum, and the share that loops over a mesh achieve.
#include "benchmarks.h"
#include "ostraka/execution/parallel.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <numeric>
#include <string>

namespace ostraka::bench {

namespace {

constexpr std::size_t array_bytes = std::size_t{512} << 20;  // much larger than any cache
constexpr std::size_t block_words = std::size_t{1} << 15;
constexpr std::size_t mesh_vertices = 1'000'000;

/// Runs `body(begin, end)` over `count` elements on one or both cores.
template <class Body>
void measure(benchmark::State& state, int thread_count, std::size_t count, std::size_t block, std::size_t bytes, Body body) {
    set_threads(thread_count);
    for ([[maybe_unused]] const auto lap : state) parallel_blocks(count, block, body);
    set_threads(0);
    state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations() * bytes));
}

/// Sums words with eight independent accumulators, so that loads do not wait for additions.
std::uint64_t sum_of(const std::vector<std::uint64_t>& words) {
    std::vector<std::uint64_t> sums(words.size() / block_words);
    parallel_blocks(words.size(), block_words, [&](std::size_t begin, std::size_t end) {
        std::uint64_t part[8] = {};
        for (std::size_t i = begin; i + 8 <= end; i += 8)
            for (std::size_t k = 0; k < 8; ++k) part[k] += words[i + k];
        sums[begin / block_words] = std::accumulate(std::begin(part), std::end(part), std::uint64_t{0});
    });
    return std::accumulate(sums.begin(), sums.end(), std::uint64_t{0});
}

std::vector<std::uint64_t> numbered_words() {
    std::vector<std::uint64_t> words(array_bytes / 8);
    std::iota(words.begin(), words.end(), 0);
    return words;
}

void read_memory(benchmark::State& state, int thread_count) {
    const std::vector<std::uint64_t> words = numbered_words();
    const std::uint64_t n = words.size();
    set_threads(thread_count);
    for ([[maybe_unused]] const auto lap : state)
        if (sum_of(words) != n * (n - 1) / 2) state.SkipWithError("wrong sum");
    set_threads(0);
    state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations() * array_bytes));
}

void copy_memory(benchmark::State& state, int thread_count) {
    const std::vector<std::uint64_t> source_array(array_bytes / 16, 7);
    std::vector<std::uint64_t> target_array(source_array.size());
    measure(state, thread_count, source_array.size(), block_words, array_bytes, [&](std::size_t begin, std::size_t end) {
        std::memcpy(target_array.data() + begin, source_array.data() + begin, 8 * (end - begin));
    });
    if (target_array != source_array) state.SkipWithError("wrong copy");
}

/// Minimal traffic of a loop over all vertices and their one-rings: reads points and halfedges, writes normals.
void vertex_normals(benchmark::State& state, int thread_count) {
    const Mesh& mesh = target(mesh_vertices);
    std::vector<Vector> normals(mesh.number_of_vertices(), Vector(0, 0, 0));
    const std::size_t bytes = mesh.number_of_vertices() * (24 + 4 + 24) + mesh.number_of_halfedges() * 16;
    measure(state, thread_count, normals.size(), 1024, bytes, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) normals[i] = vertex_normal(mesh, Vertex(static_cast<Index>(i)));
    });
    state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * normals.size()));
    for (const Vector& normal : normals)
        if (std::abs(normal.squared_length() - 1) > 1e-12) state.SkipWithError("a normal is not a unit vector");
}

/// The same for area vectors: reads faces, their halfedges and points, writes vectors.
void area_vectors(benchmark::State& state, int thread_count) {
    const Mesh& mesh = target(mesh_vertices);
    std::vector<Vector> areas(mesh.number_of_faces(), Vector(0, 0, 0));
    const std::size_t bytes =
        mesh.number_of_vertices() * 24 + mesh.number_of_halfedges() * 16 + mesh.number_of_faces() * (4 + 24);
    measure(state, thread_count, areas.size(), 1024, bytes, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) areas[i] = area_vector(mesh, Face(static_cast<Index>(i)));
    });
    state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * areas.size()));
    Vector sum(0, 0, 0);
    for (const Vector& area : areas) sum += area;
    if (sum.squared_length() > 1e-12 * surface_area(mesh) * surface_area(mesh))
        state.SkipWithError("the area vectors of a closed surface do not add up to nothing");
}

}  // namespace

double memory_bandwidth(int thread_count) {
    const std::vector<std::uint64_t> words = numbered_words();
    double fastest = 1e9;
    set_threads(thread_count);
    for (int lap = 0; lap < 5; ++lap) {
        const auto start = std::chrono::steady_clock::now();
        benchmark::DoNotOptimize(sum_of(words));
        fastest = std::min(fastest, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    }
    set_threads(0);
    return static_cast<double>(array_bytes) / fastest;
}

void register_bandwidth_benchmarks() {
    const std::pair<const char*, void (*)(benchmark::State&, int)> loops[] = {{"memory/read", read_memory},
                                                                              {"memory/copy", copy_memory},
                                                                              {"loop/vertex_normals", vertex_normals},
                                                                              {"loop/area_vectors", area_vectors}};
    for (const auto& [name, run] : loops)
        for (const int thread_count : {1, 2})
            with_both_times(
                benchmark::RegisterBenchmark((std::string(name) + "/threads:" + std::to_string(thread_count)).c_str(),
                                             [run = run, thread_count](benchmark::State& state) { run(state, thread_count); }));
}

}  // namespace ostraka::bench

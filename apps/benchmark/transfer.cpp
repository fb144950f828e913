// Ten regions from 50,000 vertices to 100,000 ... 8 million: the search tree, and the transfer once it stands.
#include "ostraka/transfer/transfer.h"

#include "benchmarks.h"

#include <chrono>
#include <map>
#include <string>

namespace ostraka::bench {

namespace {

/// Fastest construction so far, in seconds, by target vertices and by whether closest points were prepared.
std::map<std::pair<std::size_t, bool>, double> tree_seconds;

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void add_time_per_vertex(benchmark::State& state, std::size_t vertices) {
    state.counters["per_vertex"] = benchmark::Counter(
        static_cast<double>(vertices), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void build_tree(benchmark::State& state, std::size_t vertices, bool closest) {
    const Mesh& mesh = target(vertices);
    double& fastest = tree_seconds.try_emplace({vertices, closest}, 1e9).first->second;
    for ([[maybe_unused]] const auto lap : state) {
        const auto start = std::chrono::steady_clock::now();
        std::optional<SurfaceSearch> search(std::in_place, mesh, closest);
        fastest = std::min(fastest, seconds_since(start));
        state.PauseTiming();
        search.reset();
        state.ResumeTiming();
    }
    add_time_per_vertex(state, vertices);
}

/// Empty if every region arrived; on a target at least as fine as the source, in its place and size as well.
std::string what_is_wrong(const TransferResult& result, bool overlap) {
    for (const TransferScore& score : result.scores) {
        const std::string region = "region " + std::to_string(score.id);
        if (score.outcome != "kept") return region + " " + score.outcome;
        if (distortions(score).area > 0.05) return region + " changed its area by more than 5 %";
        if (overlap && !(score.overlap.value_or(0) > 0.9)) return region + " overlaps its source by less than 0.9";
    }
    return {};
}

void transfer_regions(benchmark::State& state, std::size_t vertices, bool overlap) {
    const Source& from = source();
    const SurfaceSearch& search = target_search(vertices);
    TransferOptions options;
    options.overlap = overlap;
    TransferTimes times;
    double fastest = 1e9;
    for ([[maybe_unused]] const auto lap : state) {
        const auto start = std::chrono::steady_clock::now();
        const TransferResult result = transfer(from.mesh, from.regions, search, options);
        fastest = std::min(fastest, seconds_since(start));
        times = result.times;
        if (const std::string wrong = what_is_wrong(result, overlap); !wrong.empty()) {
            state.SkipWithError(wrong.c_str());
            return;
        }
    }
    add_time_per_vertex(state, vertices);
    const auto share_of_tree = [&](const char* name, bool closest) {
        const auto tree = tree_seconds.find({vertices, closest});
        if (tree != tree_seconds.end()) state.counters[name] = fastest / tree->second;
    };
    share_of_tree("of_tree", true);
    share_of_tree("of_ray_tree", false);
    state.counters["s_places"] = times.correspondence;
    state.counters["s_paths"] = times.paths;
    state.counters["s_regions"] = times.regions;
    state.counters["s_scores"] = times.scores;
}

}  // namespace

void register_transfer_benchmarks() {
    for (const std::size_t vertices : {100'000, 200'000, 500'000, 1'000'000, 2'000'000, 4'000'000, 8'000'000}) {
        const auto add = [&](const std::string& name, auto run, bool flag) {
            with_both_times(
                benchmark::RegisterBenchmark((name + "/" + std::to_string(vertices)).c_str(),
                                             [run, vertices, flag](benchmark::State& state) { run(state, vertices, flag); }));
        };
        add("tree/rays_only", build_tree, false);
        add("tree/complete", build_tree, true);
        add("transfer/without_overlap", transfer_regions, false);
        add("transfer/with_overlap", transfer_regions, true);
    }
}

}  // namespace ostraka::bench

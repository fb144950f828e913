// Ten regions from 50,000 vertices to 100,000 ... 8 million: the search tree, and the transfer once it stands.
#include "ostraka/transfer/transfer.h"

#include "benchmarks.h"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <map>
#include <optional>
#include <string>

namespace ostraka::bench {

namespace {

/// Wall time and processor time (of all threads), in seconds.
struct Times {
    double wall = 1e9, processor = 1e9;
    void keep_fastest(const Times& other) {
        wall = std::min(wall, other.wall);
        processor = std::min(processor, other.processor);
    }
};

class StopWatch {
public:
    [[nodiscard]] Times read() const {
        return {std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_).count(),
                static_cast<double>(std::clock() - processor_) / CLOCKS_PER_SEC};
    }

private:
    std::chrono::steady_clock::time_point wall_ = std::chrono::steady_clock::now();
    std::clock_t processor_ = std::clock();
};

/// Fastest construction so far, by target vertices and by whether closest points were prepared.
std::map<std::pair<std::size_t, bool>, Times> tree_times;

void add_time_per_vertex(benchmark::State& state, std::size_t vertices) {
    state.counters["per_vertex"] = benchmark::Counter(
        static_cast<double>(vertices), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void build_tree(benchmark::State& state, std::size_t vertices, bool closest) {
    const Mesh& mesh = target(vertices);
    Times& fastest = tree_times[{vertices, closest}];
    for ([[maybe_unused]] const auto lap : state) {
        const StopWatch watch;
        std::optional<SurfaceSearch> search(std::in_place, mesh, closest);
        fastest.keep_fastest(watch.read());
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
        if (score.outcome != TransferOutcome::kept) return region + " " + to_string(score.outcome);
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
    Times fastest;
    for ([[maybe_unused]] const auto lap : state) {
        const StopWatch watch;
        const TransferResult result = transfer(from.mesh, from.regions, search, options);
        fastest.keep_fastest(watch.read());
        times = result.times;
        if (const std::string wrong = what_is_wrong(result, overlap); !wrong.empty()) {
            state.SkipWithError(wrong.c_str());
            return;
        }
    }
    add_time_per_vertex(state, vertices);
    if (const auto tree = tree_times.find({vertices, true}); tree != tree_times.end()) {
        state.counters["of_tree"] = fastest.wall / tree->second.wall;
        state.counters["cpu_of_tree"] = fastest.processor / tree->second.processor;
    }
    if (const auto tree = tree_times.find({vertices, false}); tree != tree_times.end()) {
        state.counters["of_ray_tree"] = fastest.wall / tree->second.wall;
        state.counters["cpu_of_ray_tree"] = fastest.processor / tree->second.processor;
    }
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

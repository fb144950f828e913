// Transfers ten regions from 50,000 vertices to 100,000 ... 27 million: the search tree, the transfer with a given tree, and
// both, compared with CGAL's own tree over the same target.
#include "ostraka/transfer/transfer.h"

#include "benchmarks.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <string>

namespace ostraka::bench {

namespace {

/// Fastest construction of CGAL's tree so far, in seconds, by number of target vertices.
std::map<std::size_t, double> cgal_seconds;

void measure_cgal_tree(std::size_t vertices) {
    const double seconds = seconds_of_cgal_tree(target(vertices));
    const auto [entry, is_new] = cgal_seconds.try_emplace(vertices, seconds);
    if (!is_new) entry->second = std::min(entry->second, seconds);
}

/// Times laps one by one, excluding the time to free their results.
class LapTimer {
public:
    LapTimer(benchmark::State& state, std::size_t vertices) : state_(state), vertices_(vertices) {}

    template <class Lap>
    void time(const Lap& lap) {
        const auto start = std::chrono::steady_clock::now();
        const auto result = lap();
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        state_.SetIterationTime(seconds);
        fastest_ = std::min(fastest_, seconds);
    }

    /// Reports the fastest lap relative to CGAL's tree, and the time per target vertex.
    void report() const {
        if (cgal_seconds.count(vertices_) == 0) measure_cgal_tree(vertices_);
        state_.counters["of_cgal_tree"] = fastest_ / cgal_seconds.at(vertices_);
        state_.counters["us_per_vertex"] = 1e6 * fastest_ / static_cast<double>(vertices_);
    }

private:
    benchmark::State& state_;
    std::size_t vertices_;
    double fastest_ = 1e9;
};

void build_cgal_tree(benchmark::State& state, std::size_t vertices) {
    target(vertices);
    for ([[maybe_unused]] const auto lap : state) {
        measure_cgal_tree(vertices);
        state.SetIterationTime(cgal_seconds.at(vertices));
    }
    state.counters["us_per_vertex"] = 1e6 * cgal_seconds.at(vertices) / static_cast<double>(vertices);
}

void build_search(benchmark::State& state, std::size_t vertices) {
    const Mesh& mesh = target(vertices);
    LapTimer timer(state, vertices);
    for ([[maybe_unused]] const auto lap : state) timer.time([&] { return std::make_unique<SurfaceSearch>(mesh); });
    timer.report();
}

/// Empty if every region was transferred; on a target at least as fine as the source, its position and size are checked too.
std::string problem_of(const TransferResult& result, bool overlap) {
    for (const TransferScore& score : result.scores) {
        const std::string region = "region " + std::to_string(score.id);
        if (score.outcome != TransferOutcome::kept) return region + " " + to_string(score.outcome);
        if (distortions(score).area > 0.05) return region + " changed its area by more than 5 %";
        if (overlap && !(score.overlap.value_or(0) > 0.9)) return region + " overlaps its source by less than 0.9";
    }
    return {};
}

void transfer_regions(benchmark::State& state, std::size_t vertices, bool with_tree, bool overlap) {
    const AnnotatedMesh& source_data = source();
    const Mesh& mesh = target(vertices);
    const SurfaceSearch* const existing_search = with_tree ? nullptr : &target_search(vertices);
    TransferOptions options;
    options.overlap = overlap;
    TransferTimes times;
    LapTimer timer(state, vertices);
    for ([[maybe_unused]] const auto lap : state)
        timer.time([&] {
            std::unique_ptr<SurfaceSearch> search;
            if (with_tree) search = std::make_unique<SurfaceSearch>(mesh);
            const TransferResult result = transfer(source_data, with_tree ? *search : *existing_search, options);
            times = result.times;
            if (const std::string problem = problem_of(result, overlap); !problem.empty()) state.SkipWithError(problem.c_str());
            return search;
        });
    timer.report();
    state.counters["s_checks"] = times.checks;
    state.counters["s_places"] = times.correspondence;
    state.counters["s_paths"] = times.paths;
    state.counters["s_regions"] = times.regions;
    state.counters["s_scores"] = times.scores;
}

}  // namespace

void register_transfer_benchmarks() {
    for (const std::size_t vertices : {100'000, 200'000, 500'000, 1'000'000, 2'000'000, 4'000'000, 8'000'000, 27'000'000}) {
        const auto add = [&](const std::string& name, auto run) {
            const std::string full = name + "/" + std::to_string(vertices);
            benchmark::RegisterBenchmark(full.c_str(), run)
                ->UseManualTime()
                ->MeasureProcessCPUTime()
                ->Unit(benchmark::kMillisecond);
            return full;
        };
        const auto transferring = [&](bool with_tree, bool overlap) {
            return [=](benchmark::State& state) { transfer_regions(state, vertices, with_tree, overlap); };
        };
        add("tree/cgal", [=](benchmark::State& state) { build_cgal_tree(state, vertices); });
        add("tree/search", [=](benchmark::State& state) { build_search(state, vertices); });
        add("transfer/without_overlap", transferring(false, false));
        add("transfer/with_overlap", transferring(false, true));
        const std::string without_overlap = add("transfer/and_tree_without_overlap", transferring(true, false)),
                          with_overlap = add("transfer/and_tree_with_overlap", transferring(true, true));
        if (vertices < 1'000'000) continue;  // below, the source dominates the work
        set_aim(without_overlap, "of_cgal_tree", 1);
        set_aim(with_overlap, "of_cgal_tree", 1.3);
    }
}

}  // namespace ostraka::bench

// Fits a template of 25,000 vertices to fragments: time of placement, refinement, fit, completion.
#include "benchmarks.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/reconstruction/reconstruct.h"
#include "ostraka/synthetic/fragments.h"
#include "ostraka/synthetic/statuettes.h"

#include <algorithm>
#include <array>
#include <map>
#include <string>

namespace ostraka::bench {

namespace {

AnnotationSet landmarks_of(const Statuette& statuette) {
    AnnotationSet set;
    for (const StatuetteLandmark& landmark : statuette.landmarks) {
        Annotation annotation;
        annotation.id = static_cast<int>(set.annotations.size());
        annotation.tag = landmark.name;
        annotation.type = AnnotationType::point;
        annotation.points = {landmark.vertex};
        set.annotations.push_back(std::move(annotation));
    }
    return set;
}

const AnnotatedMesh& template_of_class() {
    static const AnnotatedMesh template_class = [] {
        StatuetteParameters parameters;
        parameters.wall = 0;
        parameters.vertices = 25'000;
        Statuette statuette = generate_statuette(parameters);
        AnnotationSet set = landmarks_of(statuette);
        return AnnotatedMesh{std::move(statuette.mesh), std::move(set)};
    }();
    return template_class;
}

/// A share of another member of the class around a landmark, meshed independently like a scan, with about `vertices` vertices.
const Fragment& fragment_of(std::uint64_t vertices, const std::string& landmark = "head joint", double share = 0.5) {
    static std::map<std::pair<std::uint64_t, std::string>, Fragment> fragments;
    const auto [entry, is_new] = fragments.try_emplace({vertices, landmark});
    if (!is_new) return entry->second;
    StatuetteParameters parameters;
    parameters.wall = 0;
    parameters.vertices = static_cast<std::uint64_t>(static_cast<double>(vertices) / share);
    parameters.height = 215;
    parameters.head_height = 50;
    parameters.arm_length = 76;
    parameters.seed = 2;
    const Statuette statuette = generate_statuette(parameters);
    const auto top = std::find_if(statuette.landmarks.begin(), statuette.landmarks.end(),
                                  [&](const StatuetteLandmark& candidate) { return candidate.name == landmark; });
    FragmentOptions options;
    options.share = share;
    options.noise = 0.001;
    SyntheticFragment piece = generate_fragment(statuette.mesh, position(whole.mesh, top->place), options);
    Fragment& fragment = entry->second;
    fragment.name = landmark;
    for (Annotation& annotation : landmarks_of(statuette).annotations) {
        const auto position = std::find(piece.vertices.begin(), piece.vertices.end(), annotation.points.front());
        if (position == piece.vertices.end()) continue;
        annotation.points = {static_cast<Index>(position - piece.vertices.begin())};
        fragment.annotations.annotations.push_back(std::move(annotation));
    }
    fragment.mesh = std::move(piece.mesh);
    return fragment;
}

void run(benchmark::State& state, std::uint64_t vertices, int thread_count) {
    const AnnotatedMesh& template_class = template_of_class();
    const Fragment& fragment = fragment_of(vertices);
    set_threads(thread_count);
    std::map<std::string, double> seconds;
    double laps = 0;
    for ([[maybe_unused]] const auto lap : state) {
        const Reconstruction result = reconstruct(template_class, {}, {&fragment});
        if (!result.placement.any()) state.SkipWithError("the fragment was not placed");
        for (const auto& [phase, time] : result.seconds) seconds[phase] += time;
        seconds["fit: matching"] += result.fit.seconds_matching;
        seconds["fit: solving"] += result.fit.seconds_solving;
        seconds["fit: coarsening"] += result.fit.seconds_coarsening;
        ++laps;
    }
    set_threads(0);
    for (const auto& [phase, time] : seconds) state.counters[phase + " ms"] = 1000 * time / laps;
    state.counters["vertices"] = static_cast<double>(template_class.mesh.number_of_vertices());
    state.counters["fragment"] = static_cast<double>(fragment.mesh.number_of_vertices());
}

/// Two fragments: both new, the second added to the first, only one, or one left after the second was removed; with or without
/// landmarks; without them, poses are searched.
void change(benchmark::State& state, const std::string& variant, bool without_landmarks) {
    const AnnotatedMesh& template_class = template_of_class();
    const std::array<const Fragment*, 2> fragments{&fragment_of(10'000, "head joint", 0.4),
                                                   &fragment_of(10'000, "base centre", 0.2)};
    ReconstructOptions options;
    options.search.search = without_landmarks ? SearchOptions::Search::always : SearchOptions::Search::never;
    set_threads(2);
    const RelationGraph no_graph;
    Reconstructor reconstructor(template_class, no_graph, options);
    reconstructor.add(*fragments[0]);
    (void)reconstructor.run();
    std::map<std::string, double> seconds;
    double laps = 0;
    for ([[maybe_unused]] const auto lap : state) {
        state.PauseTiming();
        if (variant == "removed") {
            reconstructor.add(*fragments[1]);
            (void)reconstructor.run();
        }
        state.ResumeTiming();
        Reconstruction result;
        if (variant == "two") {
            result = reconstruct(template_class, {}, {fragments[0], fragments[1]}, options);
        } else if (variant == "one") {
            result = reconstruct(template_class, {}, {fragments[0]}, options);
        } else {
            if (variant == "added") reconstructor.add(*fragments[1]);
            else reconstructor.remove(1);
            result = reconstructor.run();
        }
        for (const auto& [phase, time] : result.seconds) seconds[phase] += time;
        seconds["fit: matching"] += result.fit.seconds_matching;
        seconds["fit: solving"] += result.fit.seconds_solving;
        seconds["fit: coarsening"] += result.fit.seconds_coarsening;
        ++laps;
        state.PauseTiming();
        if (variant == "added") {
            reconstructor.remove(1);
            (void)reconstructor.run();
        }
        state.ResumeTiming();
    }
    set_threads(0);
    for (const auto& [phase, time] : seconds) state.counters[phase + " ms"] = 1000 * time / laps;
}

}  // namespace

void register_fitting_benchmarks() {
    for (const std::uint64_t vertices : {10'000, 50'000, 200'000})
        for (const int thread_count : {1, 2})
            with_both_times(benchmark::RegisterBenchmark(
                ("fitting/fragment:" + std::to_string(vertices) + "/threads:" + std::to_string(thread_count)).c_str(),
                [=](benchmark::State& state) { run(state, vertices, thread_count); }));
    for (const bool without_landmarks : {false, true})
        for (const std::string variant : {"two", "added", "one", "removed"})
            with_both_times(benchmark::RegisterBenchmark(
                (std::string("fitting/two_fragments/") + (without_landmarks ? "searched/" : "landmarks/") + variant).c_str(),
                [=](benchmark::State& state) { change(state, variant, without_landmarks); }));
}

}  // namespace ostraka::bench

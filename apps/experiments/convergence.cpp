#include "convergence.h"

#include "ostraka/core/error.h"

#include <algorithm>
#include <cstdio>

namespace ostraka::experiments {

namespace {

/// Below this share of the initial value, the remaining objective is rounding error.
constexpr double rounding = 1e-12;

/// When the remaining objective falls to `share` of its value at iteration `from`, or to rounding error.
std::optional<IterationReached> reached(const SolveSummary& summary, std::size_t from, double best, double share) {
    const double enough = std::max(share * (summary.objective[from] - best), rounding * (summary.objective.front() - best));
    for (std::size_t i = from; i < summary.objective.size(); ++i)
        if (summary.objective[i] - best <= enough) return IterationReached{static_cast<int>(i), summary.seconds[i]};
    return {};
}

double left_of(const SolveSummary& summary, std::size_t i, double best) {
    const double whole = summary.objective.front() - best;
    return whole > 0 ? (summary.objective[i] - best) / whole : 0;
}

std::string text_of(const std::optional<IterationReached>& place, int iterations) {
    char text[64];
    if (place) std::snprintf(text, sizeof text, "%d (%.3g s)", place->iterations, place->seconds);
    else std::snprintf(text, sizeof text, "not in %d", iterations);
    return text;
}

}  // namespace

double best_objective(const std::vector<SolveRun>& runs, double known) {
    for (const SolveRun& run : runs)
        for (const double objective : run.summary.objective) known = std::min(known, objective);
    return known;
}

Convergence convergence(const SolveRun& run, double best, double share) {
    const SolveSummary& summary = run.summary;
    if (summary.objective.empty()) fail_usage("the run '" + run.name + "' has no objectives");
    Convergence result;
    result.name = run.name;
    result.iterations = summary.iterations;
    result.setup = summary.times.symbolic + summary.times.factor;
    result.seconds = summary.seconds.back();
    result.left = left_of(summary, summary.objective.size() - 1, best);
    result.of_start = reached(summary, 0, best, share);
    if (summary.objective.size() > 1) {
        result.first_step = left_of(summary, 1, best);
        result.of_first_step = reached(summary, 1, best, share);
    }
    result.refused = summary.refused;
    return result;
}

std::string convergence_header() {
    return "| run | set-up s | iterations | s | left after the first | left at the end | to 1e-3 of the start | to 1e-3 of what "
           "the "
           "first step leaves | refused |\n|---|---|---|---|---|---|---|---|---|\n";
}

std::string convergence_row(const Convergence& run) {
    char text[160];
    std::snprintf(text, sizeof text, " | %.3g | %d | %.3g | %.2g | %.2g | ", run.setup, run.iterations, run.seconds,
                  run.first_step, run.left);
    return "| " + run.name + text + text_of(run.of_start, run.iterations) + " | " + text_of(run.of_first_step, run.iterations) +
           " | " + std::to_string(run.refused) + " |\n";
}

std::string convergence_csv_header() {
    return "problem,run,setup_s,iterations,s,left_after_first,left_at_end,iterations_of_start,s_of_start,"
           "iterations_of_first_step,s_of_first_step,refused\n";
}

std::string convergence_csv(const std::string& problem, const Convergence& run) {
    char text[160];
    std::snprintf(text, sizeof text, ",%.6g,%d,%.6g,%.6g,%.6g,", run.setup, run.iterations, run.seconds, run.first_step,
                  run.left);
    std::string line = '"' + problem + "\",\"" + run.name + '"' + text;
    for (const auto& place : {run.of_start, run.of_first_step}) {
        if (place) std::snprintf(text, sizeof text, "%d,%.6g,", place->iterations, place->seconds);
        line += place ? text : ",,";
    }
    return line + std::to_string(run.refused) + '\n';
}

Plot convergence_plot(const std::string& title, const std::vector<SolveRun>& runs, double best) {
    Plot plot{title, {"iterations", false, 0.0, {}}, {"(objective - best) / (start - best)", true, {}, {}}, {}};
    for (const SolveRun& run : runs) {
        PlotSeries series{run.name, {}, run.summary.objective.size() <= 60, false};
        for (std::size_t i = 0; i < run.summary.objective.size(); ++i) {
            const double left = left_of(run.summary, i, best);
            if (left > rounding) series.points.push_back({static_cast<double>(i), left});
        }
        plot.series.push_back(std::move(series));
    }
    return plot;
}

}  // namespace ostraka::experiments

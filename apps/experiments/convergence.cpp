#include "convergence.h"

#include "harness.h"

#include "ostraka/figures/plot.h"

#include <algorithm>

namespace ostraka::experiments {

namespace {

/// Below this share of the initial value, the remaining objective is rounding error.
constexpr double rounding = 1e-12;
/// Share of the objective above the best at which a run counts as converged.
constexpr double enough = 1e-3;

struct Run {
    std::string name;
    SolveSummary summary;
};

/// The first iteration at which the objective above the best falls to a share of its value at iteration `from`, or to rounding
/// error.
std::optional<std::size_t> reached(const SolveSummary& summary, std::size_t from, double best) {
    if (from >= summary.objective.size()) return {};
    const double limit = std::max(enough * (summary.objective[from] - best), rounding * (summary.objective.front() - best));
    for (std::size_t i = from; i < summary.objective.size(); ++i)
        if (summary.objective[i] - best <= limit) return i;
    return {};
}

/// (objective - best) / (start - best); 0 beyond the last iteration.
double left_of(const SolveSummary& summary, std::size_t i, double best) {
    const double whole = summary.objective.front() - best;
    return whole > 0 && i < summary.objective.size() ? (summary.objective[i] - best) / whole : 0;
}

void add(const Problem& problem, const Run& run, double best, Table& table, Rows& csv) {
    const SolveSummary& summary = run.summary;
    const double setup = summary.times.symbolic + summary.times.factor, seconds = summary.seconds.back();
    const double first = left_of(summary, 1, best), last = left_of(summary, summary.objective.size() - 1, best);
    const auto of_start = reached(summary, 0, best), of_first = reached(summary, 1, best);
    const auto text = [&](const std::optional<std::size_t>& i) {
        return i ? fmt::format("{} ({:.3g} s)", *i, summary.seconds[*i]) : fmt::format("not in {}", summary.iterations);
    };
    const auto cell = [](const std::optional<std::size_t>& i) { return i ? Rows::cell(*i) : ""; };
    const auto time = [&](const std::optional<std::size_t>& i) { return i ? Rows::cell(summary.seconds[*i]) : ""; };
    table.row("{} | {:.3g} | {} | {:.3g} | {:.2g} | {:.2g} | {} | {} | {}", run.name, setup, summary.iterations, seconds, first,
              last, text(of_start), text(of_first), summary.refused);
    csv(problem.name, run.name, setup, summary.iterations, seconds, first, last, cell(of_start), time(of_start), cell(of_first),
        time(of_first), summary.refused);
}

Plot plot_of(const std::string& title, const std::vector<Run>& runs, double best) {
    Plot plot{title, {"iterations", false, 0.0, {}}, {"(objective - best) / (start - best)", true, {}, {}}, {}};
    for (const Run& run : runs) {
        PlotSeries series{run.name, {}, run.summary.objective.size() <= 60, false};
        for (std::size_t i = 0; i < run.summary.objective.size(); ++i)
            if (const double left = left_of(run.summary, i, best); left > rounding)
                series.points.push_back({static_cast<double>(i), left});
        plot.series.push_back(std::move(series));
    }
    return plot;
}

}  // namespace

std::string compare_convergence(const Path& folder, const std::vector<Problem>& problems, int iterations,
                                const std::vector<int>& windows, int longer) {
    if (iterations == 0) return {};
    std::string text;
    Rows csv(
        "problem,run,setup_s,iterations,s,left_after_first,left_at_end,iterations_of_start,s_of_start,iterations_of_first_step,"
        "s_of_first_step,refused");
    for (const Problem& problem : problems) {
        double best = problem.solve(longer * iterations, windows.back()).objective.back();
        std::vector<Run> runs;
        for (const int window : windows) {
            runs.push_back(
                {window == 0 ? "plain" : fmt::format("accelerated, window {}", window), problem.solve(iterations, window)});
            const std::vector<double>& objective = runs.back().summary.objective;
            best = std::min(best, *std::min_element(objective.begin(), objective.end()));
        }
        fmt::print("\n{}:\n\n", problem.title);
        Table table(
            "run | set-up s | iterations | s | left after the first | left at the end | to 1e-3 of the start | to 1e-3 of what "
            "the "
            "first step leaves | refused");
        for (const Run& run : runs) add(problem, run, best, table, csv);
        text += problem.title + ":\n\n" + table.text() + "\n";
        write_plot(folder / ("convergence-" + problem.name + ".svg"), plot_of(problem.title, runs, best));
    }
    write_file(folder / "convergence.md", text);
    csv.write(folder / "convergence.csv");
    return text;
}

}  // namespace ostraka::experiments

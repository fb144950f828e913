// What all experiments share: the list of experiments with their options, tables and rows of results, time and memory.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/figures/table.h"
#include "ostraka/files/file.h"
#include "ostraka/mesh/mesh.h"

#include <fmt/format.h>
#include <Eigen/Core>

#include <chrono>
#include <ctime>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace ostraka::experiments {

/// A command of the program. `options` refer to the options struct that `run` reads.
struct Experiment {
    std::string name, help;
    OptionList options;
    std::function<void()> run;
};

/// All experiments of the program, in no particular order.
std::vector<Experiment>& experiments();

/// Adds an experiment to the program: a constant of this type stands below the function that runs it. `Options` lists its
/// fields in `declare_options`; texts of lists may be joined by commas.
struct Registration {
    template <class Options>
    Registration(std::string name, std::string help, void (*run)(const Options&)) {
        const auto options = std::make_shared<Options>();
        OptionList list;
        options->declare_options(list);
        experiments().push_back({std::move(name), std::move(help), std::move(list), [=] { run(*options); }});
    }
};

/// A Markdown table, printed row by row, so that an interrupted run shows what it has.
class Table {
public:
    /// `columns`: names separated by " | ". `printed` false: the table is only collected.
    explicit Table(const std::string& columns, bool printed = true);
    template <class... Values>
    void row(fmt::format_string<Values...> cells, Values&&... values) {
        add(fmt::format(cells, std::forward<Values>(values)...));
    }
    void add(const std::string& cells);
    [[nodiscard]] const std::string& text() const { return text_; }

private:
    void write(const std::string& lines);
    std::string text_;
    bool printed_;
};

/// Rows of a CSV file: numbers with six digits, nothing for missing numbers.
class Rows {
public:
    /// `columns`: names separated by commas.
    explicit Rows(const std::string& columns) : text_(columns + "\n") {}
    template <class... Values>
    void operator()(const Values&... values) {
        add({cell(values)...});
    }
    void add(const std::vector<std::string>& cells);
    /// Nothing if `file` is empty.
    void write(const Path& file) const;

    static std::string cell(const std::string& text) { return text; }
    static std::string cell(double value) { return fmt::format("{:g}", value); }
    static std::string cell(const std::optional<double>& value) { return value ? cell(*value) : ""; }
    template <std::integral Whole>
    static std::string cell(Whole value) {
        return fmt::format("{:d}", value);
    }

private:
    std::string text_;
};

/// Prints the table, below a title, and writes it to FOLDER/NAME.
void write_table(const TextTable& table, const Path& folder, const std::string& name, const std::string& title = {});

/// Wall time, and processor time of all threads; the latter is unaffected by other load if there is one thread.
struct Seconds {
    double wall = 0, processor = 0;
    Seconds& operator+=(const Seconds& other) {
        wall += other.wall;
        processor += other.processor;
        return *this;
    }
    friend Seconds operator+(Seconds a, const Seconds& b) { return a += b; }
};

class Stopwatch {
public:
    [[nodiscard]] Seconds seconds() const {
        return {std::chrono::duration<double>(Clock::now() - begin_).count(),
                static_cast<double>(std::clock() - processor_) / CLOCKS_PER_SEC};
    }

private:
    using Clock = std::chrono::steady_clock;
    Clock::time_point begin_ = Clock::now();
    std::clock_t processor_ = std::clock();
};

/// Peak memory of the process since construction, minus the memory at construction.
class PeakMemory {
public:
    PeakMemory();
    /// Empty if the system does not report it.
    [[nodiscard]] std::optional<double> megabytes() const;

private:
    std::optional<double> before_;
};

struct MeanAndMax {
    double mean = 0, max = 0;
};
MeanAndMax mean_and_max(const std::vector<double>& values);
/// Of the values of some vertices.
MeanAndMax mean_and_max(const std::vector<double>& values, const std::vector<Index>& vertices);
/// 0 if there are no values.
inline double mean_of(const std::vector<double>& values) { return mean_and_max(values).mean; }
/// In per cent; 0 of nothing.
inline double percentage(std::size_t part, std::size_t all) {
    return all == 0 ? 0 : 100.0 * static_cast<double>(part) / static_cast<double>(all);
}

/// How many of a number of trials succeed.
struct Hits {
    std::size_t hits = 0, all = 0;
    void add(bool hit) { ++all, hits += hit ? 1 : 0; }
    Hits& operator+=(const Hits& other) {
        hits += other.hits, all += other.all;
        return *this;
    }
    [[nodiscard]] double percent() const { return percentage(hits, all); }
    [[nodiscard]] std::string text() const { return fmt::format("{} of {}", hits, all); }
};

/// Calibration of probabilities: weight, expected and true sum of each of ten bins.
struct Calibration {
    Eigen::Array<double, 10, 3> bins = Eigen::Array<double, 10, 3>::Zero();
    void add(double probability, bool truth, double weight = 1);
    /// Mean difference of expected and true share, weighted.
    [[nodiscard]] double error() const;
};

/// Logistic regression weights with ridge penalty (iteratively reweighted least squares). Each row begins with a 1.
Eigen::Vector3d logistic(const std::vector<Eigen::Vector3d>& rows, const std::vector<bool>& truth,
                         const std::vector<double>& weights, double ridge);

}  // namespace ostraka::experiments

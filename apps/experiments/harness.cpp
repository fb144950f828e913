#include "harness.h"

#include "ostraka/files/csv.h"

#include <algorithm>
#include <cstdio>
#include <fstream>

#include <malloc.h>

namespace ostraka::experiments {

namespace {

/// A value from the process's status, in kilobytes (Linux).
std::optional<double> status(const std::string& name) {
    std::ifstream file("/proc/self/status");
    for (std::string word; file >> word;) {
        double kilobytes = 0;
        if (word == name && file >> kilobytes) return kilobytes;
    }
    return {};
}

}  // namespace

std::vector<Experiment>& experiments() {
    static std::vector<Experiment> all;
    return all;
}

Table::Table(const std::string& columns, bool printed) : printed_(printed) {
    std::string rule = "|---|";
    for (std::size_t at = columns.find(" | "); at != std::string::npos; at = columns.find(" | ", at + 3)) rule += "---|";
    write("| " + columns + " |\n" + rule + "\n");
}

void Table::add(const std::string& cells) { write("| " + cells + " |\n"); }

void Table::write(const std::string& lines) {
    text_ += lines;
    if (!printed_) return;
    fmt::print("{}", lines);
    std::fflush(stdout);
}

void Rows::add(const std::vector<std::string>& cells) { text_ += csv_row(cells); }

void Rows::write(const Path& file) const {
    if (!file.empty()) write_file(file, text_);
}

PeakMemory::PeakMemory() {
    malloc_trim(0);
    std::ofstream reset("/proc/self/clear_refs");  // 5: resets the peak
    reset << "5" << std::flush;
    if (reset) before_ = status("VmRSS:");
}

std::optional<double> PeakMemory::megabytes() const {
    const std::optional<double> peak = status("VmHWM:");
    if (!before_ || !peak) return {};
    return (*peak - *before_) * 1024 / 1e6;
}

MeanAndMax mean_and_max(const std::vector<double>& values) {
    MeanAndMax result;
    for (const double value : values) result.mean += value, result.max = std::max(result.max, value);
    result.mean /= std::max<double>(1, static_cast<double>(values.size()));
    return result;
}

MeanAndMax mean_and_max(const std::vector<double>& values, const std::vector<Index>& vertices) {
    std::vector<double> chosen;
    for (const Index v : vertices) chosen.push_back(values[v]);
    return mean_and_max(chosen);
}

}  // namespace ostraka::experiments

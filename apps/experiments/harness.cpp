#include "harness.h"

#include "ostraka/algebra/dense.h"
#include "ostraka/files/csv.h"

#include <algorithm>
#include <cmath>
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

void write_table(const TextTable& table, const Path& folder, const std::string& name, const std::string& title) {
    fmt::print("{}{}{}\n", title, title.empty() ? "" : "\n\n", table.markdown());
    table.write(folder, name);
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

void Calibration::add(double probability, bool truth, double weight) {
    bins.row(static_cast<Eigen::Index>(std::min(9.0, 10 * probability))) +=
        weight * Eigen::Array<double, 1, 3>(1, probability, truth ? 1 : 0);
}

double Calibration::error() const { return (bins.col(1) - bins.col(2)).abs().sum() / std::max(1e-300, bins.col(0).sum()); }

Eigen::Vector3d logistic(const std::vector<Eigen::Vector3d>& rows, const std::vector<bool>& truth,
                         const std::vector<double>& weights, double ridge) {
    Eigen::Vector3d result = Eigen::Vector3d::Zero();
    for (int step = 0; step < 60; ++step) {
        Eigen::Matrix3d hessian = ridge * Eigen::Matrix3d::Identity();
        hessian(0, 0) = 1e-9;
        Eigen::Vector3d gradient = -ridge * result;
        gradient[0] = 0;
        for (std::size_t k = 0; k < rows.size(); ++k) {
            const double p = 1 / (1 + std::exp(-result.dot(rows[k])));
            hessian += weights[k] * std::max(1e-9, p * (1 - p)) * rows[k] * rows[k].transpose();
            gradient += weights[k] * ((truth[k] ? 1 : 0) - p) * rows[k];
        }
        const Eigen::Vector3d move = solve_ldlt<3>(hessian, gradient);
        result += move / std::max(1.0, move.norm());
        if (move.norm() < 1e-9) break;
    }
    return result;
}

}  // namespace ostraka::experiments

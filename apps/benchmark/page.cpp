// Inserts the results into the page that shows them, with the machine and the date.
#include "benchmarks.h"
#include "ostraka/core/error.h"
#include "ostraka/core/text.h"
#include "ostraka/execution/parallel.h"

#include <ctime>
#include <fstream>
#include <map>
#include <utility>

namespace ostraka::bench {

namespace {

using Run = benchmark::BenchmarkReporter::Run;

std::map<std::pair<std::string, std::string>, double>& aims() {
    static std::map<std::pair<std::string, std::string>, double> aim_values;
    return aim_values;
}

std::string processor() {
    std::ifstream info("/proc/cpuinfo");
    for (std::string line; std::getline(info, line);)
        if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
    return "unknown processor";
}

std::string today() {
    const std::time_t now = std::time(nullptr);
    char text[16];
    std::strftime(text, sizeof text, "%Y-%m-%d", std::localtime(&now));
    return text;
}

/// A figure with its target, in bold if the target is missed.
std::string with_aim(const std::string& benchmark, const std::string& figure, double value, const std::string& text) {
    const auto aim = aims().find({benchmark, figure});
    if (aim == aims().end()) return text;
    return (value <= aim->second ? text : "**" + text + "**") + " (aim " + digits(aim->second, 3) + ")";
}

std::string row_of(const Run& run) {
    const std::string& name = run.run_name.function_name;
    const double unit = benchmark::GetTimeUnitMultiplier(run.time_unit), seconds = run.GetAdjustedRealTime() / unit;
    std::string row = "| `" + name + "` | " + with_aim(name, "seconds", seconds, digits(seconds, 3)) + " | ";
    if (run.run_name.time_type.find("process_time") != std::string::npos) row += digits(run.GetAdjustedCPUTime() / unit, 3);
    row += " | ";
    bool first = true;
    for (const auto& [figure, counter] : run.counters) {
        row += std::exchange(first, false) ? "" : ", ";
        if (figure == "bytes_per_second") row += digits(1e-9 * counter.value, 3) + " GB/s";
        else row += figure + " " + with_aim(name, figure, counter.value, digits(counter.value, 3));
    }
    return row + " |\n";
}

std::string group_of(const Run& run) { return run.run_name.function_name.substr(0, run.run_name.function_name.find('/')); }

}  // namespace

void set_aim(const std::string& benchmark, const std::string& figure, double at_most) { aims()[{benchmark, figure}] = at_most; }

void PageReporter::ReportRuns(const std::vector<Run>& runs) {
    ConsoleReporter::ReportRuns(runs);
    for (const Run& run : runs)
        if (!run.error_occurred && (run.run_type == Run::RT_Iteration ? run.repetitions == 1 : run.aggregate_name == "median"))
            runs_.push_back(run);
}

void PageReporter::write(const Path& page) const {
    std::string text = read_file(page);
    const std::string head = today() + ", " + processor() + ", " + std::to_string(threads()) + " threads. Memory is read at " +
                             digits(1e-9 * memory_bandwidth(1), 3) + " GB/s by one thread\nand at " +
                             digits(1e-9 * memory_bandwidth(threads()), 3) + " GB/s by all.\n\n" +
                             "| benchmark | seconds | processor seconds | figures |\n|---|---|---|---|\n";
    std::map<std::string, std::string> tables;
    for (const Run& run : runs_) tables.try_emplace(group_of(run), head).first->second += row_of(run);
    for (const auto& [group, table] : tables) {
        const std::string begin = "<!-- measured: " + group + " -->\n", end = "<!-- end of " + group + " -->";
        const std::size_t from = text.find(begin), to = text.find(end);
        if (from == std::string::npos || to == std::string::npos || to < from) continue;
        text.replace(from + begin.size(), to - from - begin.size(), table + "\n");
    }
    write_file(page, text);
}

}  // namespace ostraka::bench

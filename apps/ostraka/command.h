// What every command of the tool shares: the flags, the report, the exit code.
#pragma once

#include "ostraka/core/error.h"
#include "ostraka/core/finding.h"
#include "ostraka/core/json.h"
#include "ostraka/core/options.h"
#include "ostraka/core/provenance.h"

#include <CLI/CLI.hpp>

#include <functional>
#include <string>
#include <vector>

namespace ostraka::app {

/// Exit codes of the tool: 0 done, 1 failed, 2 wrong usage, 3 done but the answer is "no".
inline constexpr int done = 0, failed = 1, wrong_usage = 2, answer_is_no = 3;

/// The state of one run of the tool: the flags common to all commands, and the action that the parsed command wants run.
struct Session {
    bool json = false;   ///< --json: one report on standard output instead of a table
    bool quiet = false;  ///< --quiet: no notes and no progress on standard error
    int threads = 0;     ///< --threads
    std::function<int()> action;

    /// Adds a command with the common flags; `run` is called after parsing, its result is the exit code.
    CLI::App* add(CLI::App& parent, const std::string& name, const std::string& help, std::function<int()> run);

    /// A line on standard error, unless --quiet.
    void note(const std::string& text) const;

    /// Prints {"format": "ostraka-report", "command", "result", "provenance"} on standard output. `document` lends its
    /// allocator, `result` is consumed. Members that may differ between two runs of the same work go into `run`.
    void print_report(const Provenance& provenance, Json& document, JsonValue& result, JsonValue* run = nullptr) const;
};

/// Adds one flag per field of an options struct (see core/options.h).
struct FlagVisitor {
    CLI::App* app;
    void operator()(const char* name, bool& value, const char* help, Anything) const {
        app->add_flag("--" + std::string(name), value, help);
    }
    template <class T>
    void operator()(const char* name, T& value, const char* help, Range range) const {
        app->add_option("--" + std::string(name), value, help)->check(CLI::Range(range.min, range.max))->capture_default_str();
    }
    void operator()(const char* name, std::string& value, const char* help, const Choices& choices) const {
        app->add_option("--" + std::string(name), value, help)->check(CLI::IsMember(choices.names))->capture_default_str();
    }
    template <class T>
    void operator()(const char* name, T& value, const char* help, Anything) const {
        app->add_option("--" + std::string(name), value, help)->capture_default_str();
    }
};
template <class Options>
void add_flags(CLI::App* app, Options& options) {
    FlagVisitor visitor{app};
    options.describe(visitor);
}

/// Text of annotations and files is data: no control character reaches the terminal, at most `most` columns.
std::string printable(const std::string& text, std::size_t most = 10000);
/// Throws Error (failure) if what was printed so far did not arrive.
void check_standard_output();

/// Calls `work`; what it finds wrong with an input is said with the name of the file it came from.
template <class Work>
auto in_file(const std::string& file, Work&& work) {
    try {
        return work();
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::input || error.where().starts_with(file)) throw;
        throw Error(error.kind(), error.where().empty() || error.where() == "mesh" ? file : file + ", " + error.where(),
                    error.problem(), error.remedy());
    }
}

/// Adds what a check found to `result` (sound, defects, findings) and to the rows of a table; `place` is what its places are
/// called. Returns the number of defects.
std::size_t add_findings(JsonValue& result, const std::vector<Finding>& findings, const std::string& place,
                         std::vector<std::vector<std::string>>& rows, JsonAllocator& allocator);
void print_findings(const std::string& place, const std::vector<std::vector<std::string>>& rows, std::size_t defects);
/// Prints what a check found, as a table or a report. Returns the exit code: `answer_is_no` if there is a defect.
int report_findings(const Session& session, const Provenance& provenance, const std::vector<Finding>& findings);

/// A table for people: columns padded, numbers right-aligned, no text cut.
std::string table(const std::vector<std::string>& header, const std::vector<std::vector<std::string>>& rows);
/// A number for people: `digits` significant digits.
std::string number(double value, int digits = 5);

}  // namespace ostraka::app

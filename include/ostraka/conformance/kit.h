// The conformance kit: golden cases of every operation, and what another program makes of them.
#pragma once

#include "ostraka/operation/operation.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace ostraka {

/// How one output, or the report, is compared with the expected one.
struct Comparison {
    std::string what;  ///< "report", an output, or OUTPUT/FILE of a folder
    std::string as;    ///< "mesh", "annotations", "array", "values", "bytes", "exists"
    double within = 0;
    std::string of = "absolute";         ///< what `within` is a share of: "diagonal", "largest", "value"
    std::vector<std::string> freedoms;   ///< of a mesh: "vertex order", "triangulation"
    std::string mesh;                    ///< of annotations: an input's file, or an output
    std::vector<std::string> only, but;  ///< of values: members that count, or that do not
    std::string reason;                  ///< of the tolerance
};

struct ConformanceCase {
    std::string id, operation, about;
    bool degenerate = false;
    const JsonValue* with = nullptr;             ///< settings; files relative to the kit
    std::map<std::string, std::string> outputs;  ///< and the names of their files
    int code = 0;                                ///< exit code: 0, 1 (failed), 2 (wrong usage), 3 (the answer is no)
    std::vector<std::string> names;              ///< words that the message of a refusal must contain
    std::vector<Comparison> comparisons;
};

struct ConformanceKit {
    Path folder;
    std::string version;
    std::shared_ptr<const Json> document;
    std::vector<ConformanceCase> cases;
};

/// FOLDER/conformance.json. Throws Error (input) with the case that is wrong: operations, settings and outputs are checked
/// against the table.
ConformanceKit read_kit(const Path& folder, const FindOperation& find);

/// What a backend answered.
struct Answer {
    int code = -1;                       ///< as an exit code; 4: it does not have the operation; -1: it crashed
    std::shared_ptr<const Json> result;  ///< of the report; null where there is none
    std::string message;                 ///< what it said of an error
    double seconds = 0;
};

/// A backend: given a case with absolute names of input and output files.
class Backend {
public:
    virtual ~Backend();
    virtual Answer run(const ConformanceCase& one, const JsonValue& settings, const Path& folder) = 0;
};

/// A program that follows the command line: WORDS... mesh info FILE --json. `arguments` makes the words of a call.
using ArgumentsOf = std::function<std::vector<std::string>(const std::string& operation, const JsonValue& settings)>;
std::unique_ptr<Backend> command_backend(std::vector<std::string> words, ArgumentsOf arguments, double time_limit);
/// A program that is started once and answers a line of JSON with a line of JSON (doc/conformance.md).
std::unique_ptr<Backend> lines_backend(std::vector<std::string> words, double time_limit);

enum class Outcome { agrees, differs, unsupported };
struct CaseResult {
    Outcome outcome = Outcome::differs;
    std::vector<std::string> differences;  ///< in words; empty where it agrees
    double seconds = 0;
};
std::string to_string(Outcome outcome);

/// Runs cases with the backend and compares what it makes with what is expected. Each case has a folder of its own in `scratch`.
CaseResult run_case(const ConformanceKit& kit, const ConformanceCase& one, Backend& backend, const Path& scratch,
                    const FindOperation& find);
/// Runs it and keeps what it makes as what is expected. Throws Error (failure) where the exit code is another one.
void record_case(const ConformanceKit& kit, const ConformanceCase& one, Backend& backend, const Path& scratch,
                 const FindOperation& find);

/// Settings of a case with absolute names: inputs from the kit, outputs into `folder`.
Json settings_of(const ConformanceKit& kit, const ConformanceCase& one, const Path& folder, const FindOperation& find);

/// Empty where the two agree; else how they differ, with numbers. `expected`, `got`: files; for "report" JSON documents.
std::string difference(const Comparison& comparison, const Path& expected, const Path& got, const Path& expected_mesh,
                       const Path& got_mesh);
std::string difference_of_values(const Comparison& comparison, const JsonValue& expected, const JsonValue& got);

/// JUnit XML of the results, a test case each.
std::string junit_of(const ConformanceKit& kit, const std::vector<CaseResult>& results, const std::string& backend);

}  // namespace ostraka

// The conformance kit: golden cases of every operation, and the evaluation of other programs on them.
#pragma once

#include "ostraka/framework/operation.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace ostraka {

/// How one output, or the report, is compared with the expected result.
struct Comparison {
    std::string output;  ///< "report", an output, or OUTPUT/FILE for a folder
    std::string method;  ///< "mesh", "annotations", "array", "values", "bytes", "exists"
    double tolerance = 0;
    std::string scale = "absolute";          ///< scale of the tolerance: "absolute", "diagonal", "largest" or "value"
    std::vector<std::string> freedoms;       ///< ignored properties of a mesh: "vertex order", "triangulation"
    std::string mesh;                        ///< for annotations: their mesh, an input's file or an output
    std::vector<std::string> only, ignored;  ///< for values: members to compare, or to ignore
    std::string reason;                      ///< reason for the tolerance
};

struct ConformanceCase {
    std::string id, operation, about;
    bool degenerate = false;
    const JsonValue* with = nullptr;             ///< settings; files relative to the kit
    std::map<std::string, std::string> outputs;  ///< outputs -> file names
    int code = 0;                                ///< expected exit code: 0, 1 (failed), 2 (wrong usage), 3 (the answer is no)
    std::vector<std::string> names;              ///< words that the error message must contain
    std::vector<Comparison> comparisons;
};

struct ConformanceKit {
    Path folder;
    std::string version;
    std::shared_ptr<const Json> document;
    std::vector<ConformanceCase> cases;
};

/// Reads FOLDER/conformance.json. Throws Error (input) that names the invalid case: operations, settings and outputs are
/// checked against the table.
ConformanceKit read_kit(const Path& folder, const FindOperation& find);

/// The answer of a backend.
struct Answer {
    int code = -1;                       ///< exit code; 4: the operation is not supported; -1: crashed
    std::shared_ptr<const Json> result;  ///< result of the report; null if there is none
    std::string message;                 ///< error message
    double seconds = 0;
};

/// A backend; receives a case with absolute names of input and output files.
class Backend {
public:
    virtual ~Backend();
    virtual Answer run(const ConformanceCase& test_case, const JsonValue& settings, const Path& folder) = 0;
};

/// A program with the command-line interface WORDS... mesh info FILE --json. `arguments` produces the words of a call.
using ArgumentsOf = std::function<std::vector<std::string>(const std::string& operation, const JsonValue& settings)>;
std::unique_ptr<Backend> command_backend(std::vector<std::string> words, ArgumentsOf arguments, double time_limit);
/// A program that is started once and answers each line of JSON with a line of JSON (doc/conformance.md).
std::unique_ptr<Backend> lines_backend(std::vector<std::string> words, double time_limit);

enum class Outcome { agrees, differs, unsupported };
struct CaseResult {
    Outcome outcome = Outcome::differs;
    std::vector<std::string> differences;  ///< descriptions; empty if it agrees
    double seconds = 0;
};
std::string to_string(Outcome outcome);

/// Runs a case with the backend and compares its outputs with the expected ones. Each case has its own folder in `scratch`.
CaseResult run_case(const ConformanceKit& kit, const ConformanceCase& test_case, Backend& backend, const Path& scratch,
                    const FindOperation& find);
/// Runs a case and stores its outputs as the expected ones. Throws Error (failure) if the exit code differs from the expected
/// one.
void record_case(const ConformanceKit& kit, const ConformanceCase& test_case, Backend& backend, const Path& scratch,
                 const FindOperation& find);

/// Settings of a case with absolute names: inputs from the kit, outputs in `folder`.
Json settings_of(const ConformanceKit& kit, const ConformanceCase& test_case, const Path& folder, const FindOperation& find);

/// Describes how the two differ, with numbers; empty if they agree. `expected`, `actual`: files; for "report" JSON documents.
std::string difference(const Comparison& comparison, const Path& expected, const Path& actual, const Path& expected_mesh,
                       const Path& actual_mesh);
std::string difference_of_values(const Comparison& comparison, const JsonValue& expected, const JsonValue& actual);

/// JUnit XML of the results, one test case each.
std::string junit_of(const ConformanceKit& kit, const std::vector<CaseResult>& results, const std::string& backend);

}  // namespace ostraka

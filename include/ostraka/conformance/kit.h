// The conformance kit: test cases with expected results for every operation, and the evaluation of other programs on these
// cases.
#pragma once

#include "ostraka/framework/operation.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace ostraka {

/// How one output of a case, or its report, is compared with the expected result.
struct Comparison {
    /// The compared output: "report", the name of an output, or OUTPUT/FILE for a file in an output folder.
    std::string output;
    std::string method;    ///< "mesh", "annotations", "array", "values", "bytes", "exists"
    double tolerance = 0;  ///< largest difference that counts as agreement, in multiples of `scale`
    /// Unit of `tolerance`: "absolute" (the unit of the values), "diagonal" (of the mesh), "largest" (value of the array) or
    /// "value" (each expected value).
    std::string scale = "absolute";
    std::vector<std::string> permitted_differences;  ///< properties of a mesh that may differ: "vertex order", "triangulation"
    /// For annotations: the mesh to which the annotations belong, as an input file or the name of an output.
    std::string mesh;
    /// For method "values": names of the members to compare, or of the members to ignore.
    std::vector<std::string> only, ignored;
    std::string reason;  ///< reason for the tolerance
};

/// One call of an operation, with its expected outcome.
struct ConformanceCase {
    std::string id, operation, about;            ///< id of the case, name of the operation, description
    bool degenerate = false;                     ///< true: the case tests degenerate input
    const JsonValue* with = nullptr;             ///< settings of the operation; file names are relative to the kit's folder
    std::map<std::string, std::string> outputs;  ///< name of each output -> name of its file
    /// Expected exit code: 0 (success), 1 (failure), 2 (wrong usage), 3 (a check found defects, or the answer is no).
    int code = 0;
    std::vector<std::string> names;       ///< words that the error message must contain
    std::vector<Comparison> comparisons;  ///< how each output is compared
};

/// The kit read from a folder.
struct ConformanceKit {
    Path folder;                           ///< folder of the kit
    std::string version;                   ///< version of the kit
    std::shared_ptr<const Json> document;  ///< the parsed conformance.json, to which the cases point
    std::vector<ConformanceCase> cases;    ///< the cases, in the order of the document
};

/// Reads a kit from the file FOLDER/conformance.json. Throws Error (input) that names the invalid case: operations, settings and
/// outputs are checked against the table.
ConformanceKit read_kit(const Path& folder, const FindOperation& find);

/// Result of one case as returned by the tested program.
struct Answer {
    int code = -1;                       ///< exit code; 4: the operation is not supported; -1: crashed
    std::shared_ptr<const Json> result;  ///< result of the report; null if there is none
    std::string message;                 ///< error message
    double seconds = 0;                  ///< run time of the call
};

/// A program under test.
class Backend {
public:
    virtual ~Backend();
    /// Runs a case; `settings` has absolute names of input and output files, and `folder` is the working folder.
    virtual Answer run(const ConformanceCase& test_case, const JsonValue& settings, const Path& folder) = 0;
};

/// Converts an operation and its settings to the words of a command line.
using ArgumentsOf = std::function<std::vector<std::string>(const std::string& operation, const JsonValue& settings)>;
/// Backend that starts the program `words` once per case, with the words from `arguments` appended. `time_limit`: in seconds.
std::unique_ptr<Backend> command_backend(std::vector<std::string> words, ArgumentsOf arguments, double time_limit);
/// Backend that starts the program `words` once; the program answers each line of JSON with a line of JSON (doc/conformance.md).
/// `time_limit`: in seconds per case.
std::unique_ptr<Backend> json_lines_backend(std::vector<std::string> words, double time_limit);

/// Outcome of the comparison of a program's results with the expected results.
enum class Outcome { agrees, differs, unsupported };
/// Result of running a case.
struct CaseResult {
    Outcome outcome = Outcome::differs;
    std::vector<std::string> differences;  ///< descriptions of the differences; empty if the case agrees
    double seconds = 0;                    ///< run time of the call
};
std::string to_string(Outcome outcome);

/// Runs a case with the backend and compares the outputs with the expected outputs. Each case has its own folder in `scratch`.
CaseResult run_case(const ConformanceKit& kit, const ConformanceCase& test_case, Backend& backend, const Path& scratch,
                    const FindOperation& find);
/// Runs a case and stores its outputs in the kit as the expected outputs. Throws Error (failure) if the exit code differs from
/// the expected exit code.
void record_case(const ConformanceKit& kit, const ConformanceCase& test_case, Backend& backend, const Path& scratch,
                 const FindOperation& find);

/// Settings of a case with absolute file names: inputs in the kit, outputs in `folder`.
Json settings_of(const ConformanceKit& kit, const ConformanceCase& test_case, const Path& folder, const FindOperation& find);

/// Describes how the actual file differs from the expected file, with numbers; empty if they agree. For the output "report" both
/// are JSON documents.
std::string difference(const Comparison& comparison, const Path& expected, const Path& actual, const Path& expected_mesh,
                       const Path& actual_mesh);
/// Describes how two JSON documents differ, by the method "values"; empty if they agree.
std::string difference_of_values(const Comparison& comparison, const JsonValue& expected, const JsonValue& actual);

/// The results as JUnit XML, one test case per result.
std::string junit_of(const ConformanceKit& kit, const std::vector<CaseResult>& results, const std::string& backend);

}  // namespace ostraka

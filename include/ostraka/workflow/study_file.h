// Study files: steps that name an operation of the table, their inputs, options and grids of parameters.
#pragma once

#include "ostraka/core/json.h"
#include "ostraka/operation/operation.h"

#include <map>
#include <string>
#include <variant>
#include <vector>

namespace ostraka {

/// "${name}" or "${name.member}": the value of a parameter, or an output of a step.
struct StudyReference {
    std::string name, member;
};
/// A text in which references may stand.
struct StudyText {
    std::vector<std::variant<std::string, StudyReference>> parts;
    /// The text is one reference and nothing else; null otherwise.
    [[nodiscard]] const StudyReference* single() const;
    [[nodiscard]] std::vector<StudyReference> references() const;
};
/// Throws Error (input) where "${" is not followed by a name and "}".
StudyText study_text(const std::string& text, const std::string& where);

/// One of the values of a parameter: of its members by name, "" standing for the parameter itself. Texts, numbers, booleans.
struct ParameterValue {
    std::map<std::string, std::shared_ptr<const Json>> members;
    std::string label;  ///< in tables and names of folders
    [[nodiscard]] const JsonValue* find(const std::string& member) const;
};
struct StudyParameter {
    std::string name;
    std::vector<ParameterValue> values;
    bool by_caller = false;  ///< the values are the caller's, not the file's
    bool varies = false;     ///< given as a list, a range or files: steps run once for each value
};

/// An input or option of a step, as it stands in the file.
struct StudySetting {
    std::string name;
    const JsonValue* value = nullptr;
    std::string place;  ///< JSON pointer
};

struct StudyStep {
    std::string name, place;                    ///< JSON pointer "/steps/NAME"
    const OperationEntry* operation = nullptr;  ///< null: a program
    std::vector<StudySetting> settings;         ///< of an operation
    std::vector<StudySetting> program, reads;   ///< words of a program, and files that it reads
    std::map<std::string, StudyText> keep;      ///< outputs that are written, and their files' names; empty: as usual
    bool is_slow = false;                       ///< left out of quick runs
    std::vector<std::size_t> needs;             ///< steps whose outputs it takes
    std::vector<std::size_t> gathers;           ///< those of them that it takes all instances of
    std::vector<bool> parameters;               ///< which of the study's parameters it varies with
};

struct Study {
    Path file, folder;
    bool allow_programs = false;
    std::vector<Path> readable;  ///< folders, and files, that inputs may lie in: the study's own, and those that the caller named
    std::string sha256;
    std::shared_ptr<const Json> document;
    std::string title;
    std::vector<StudyParameter> parameters;
    std::vector<StudyStep> steps;  ///< each behind those that it needs

    [[nodiscard]] const StudyParameter* parameter(const std::string& name) const;
    [[nodiscard]] std::size_t parameter_index(const std::string& name) const;
    /// Index of the step, or the number of steps.
    [[nodiscard]] std::size_t step(const std::string& name) const;
    /// Throws Error (input) unless the file, links resolved, lies in one of the readable folders. `pointer`: who names it.
    void require_readable(const Path& named, const std::string& pointer) const;
    /// The name of a file as one says it who stands in the study's folder.
    [[nodiscard]] std::string relative(const Path& file) const;
    /// "FILE, at POINTER".
    [[nodiscard]] std::string at(const std::string& pointer) const { return file.string() + ", at " + pointer; }
};

struct StudyOptions {
    bool quick = false;                 ///< parameters as "quick" says, without slow steps
    Path folder = {};                   ///< names are relative to it; empty: to the file's own folder
    std::vector<std::string> set = {};  ///< "NAME=VALUE" or "NAME=VALUE,VALUE": instead of the file's values
    bool set_from_file = false;         ///< `set` was found in a file: what it names is not the caller's word
    std::vector<Path> reads = {};       ///< further folders that inputs may lie in
    bool reads_folder = true;           ///< they may lie in `folder` too
    bool allow_programs = false;        ///< steps may start programs that are not the toolkit's own
};

/// Reads a study file and checks what can be checked without running: the schema, names, references, circles. Operations are
/// looked up by `find`. Throws Error (input) with the file, the place in it and a remedy.
Study read_study(const Path& file, const FindOperation& find, const StudyOptions& options = {});

/// Whether a program of that name is one of the toolkit's own, which studies may start.
bool is_own_program(const std::string& name);

/// How a value of a parameter stands in a text.
std::string scalar_text(const JsonValue& value);

}  // namespace ostraka

// Study files: steps that each name an operation of the table, its inputs, options and parameter grids.
#pragma once

#include "ostraka/files/json.h"
#include "ostraka/framework/operation.h"

#include <map>
#include <string>
#include <variant>
#include <vector>

namespace ostraka {

/// "${name}" or "${name.member}": refers to the value of a parameter or an output of a step.
struct StudyReference {
    std::string name, member;
};
/// A text that may contain references.
struct StudyText {
    std::vector<std::variant<std::string, StudyReference>> parts;
    /// The reference, if the text consists of exactly one; otherwise null.
    [[nodiscard]] const StudyReference* single() const;
    [[nodiscard]] std::vector<StudyReference> references() const;
};
/// Throws Error (input) if "${" is not followed by a name and "}".
StudyText study_text(const std::string& text, const std::string& where);

/// One value of a parameter: its members by name, with "" for the parameter itself. Members are texts, numbers or booleans.
struct ParameterValue {
    std::map<std::string, std::shared_ptr<const Json>> members;
    std::string label;  ///< label in tables and folder names
    [[nodiscard]] const JsonValue* find(const std::string& member) const;
};
struct StudyParameter {
    std::string name;
    std::vector<ParameterValue> values;
    bool by_caller = false;  ///< the values come from the caller, not from the file
    bool varies = false;     ///< given as a list, a range or files: steps run once per value
};

/// An input or option of a step, as in the file.
struct StudySetting {
    std::string name;
    const JsonValue* value = nullptr;
    std::string place;  ///< JSON pointer
};

struct StudyStep {
    std::string name, place;                    ///< JSON pointer "/steps/NAME"
    const OperationEntry* operation = nullptr;  ///< null: a program
    std::vector<StudySetting> settings;         ///< settings of an operation
    std::vector<StudySetting> program, reads;   ///< words of a program, and the files it reads
    std::map<std::string, StudyText> keep;      ///< outputs to write, with their file names; empty name: default
    bool is_slow = false;                       ///< left out of quick runs
    std::vector<std::size_t> needs;             ///< steps whose outputs it uses
    std::vector<std::size_t> gathers;           ///< the needed steps of which it uses all instances
    std::vector<bool> parameters;               ///< whether it varies with each parameter of the study
};

struct Study {
    Path file, folder;
    bool allow_programs = false;
    std::vector<Path> readable;  ///< folders and files from which inputs may be read: the study's, and the caller's
    std::string sha256;
    std::shared_ptr<const Json> document;
    std::string title;
    std::vector<StudyParameter> parameters;
    std::vector<StudyStep> steps;  ///< sorted so that each follows those it needs

    [[nodiscard]] const StudyParameter* parameter(const std::string& name) const;
    [[nodiscard]] std::size_t parameter_index(const std::string& name) const;
    /// Index of the step, or the number of steps.
    [[nodiscard]] std::size_t step(const std::string& name) const;
    /// Throws Error (input) unless the file, with links resolved, lies in a readable folder. `pointer`: JSON pointer that names
    /// it.
    void require_readable(const Path& named, const std::string& pointer) const;
    /// The name of a file relative to the study's folder.
    [[nodiscard]] std::string relative(const Path& file) const;
    /// "FILE, at POINTER".
    [[nodiscard]] std::string at(const std::string& pointer) const { return file.string() + ", at " + pointer; }
};

struct StudyOptions {
    bool quick = false;                 ///< use the parameters of "quick" and omit slow steps
    Path folder = {};                   ///< folder to which names are relative; empty: that of the file
    std::vector<std::string> set = {};  ///< "NAME=VALUE" or "NAME=VALUE,VALUE": replaces values of the file
    bool set_from_file = false;         ///< `set` comes from a file: its paths are not trusted like the caller's
    std::vector<Path> reads = {};       ///< further folders from which inputs may be read
    bool reads_folder = true;           ///< inputs may also be read from `folder`
    bool allow_programs = false;        ///< steps may start external programs
};

/// Reads a study file and performs the checks that do not require running it: schema, names, references, cycles. Operations are
/// looked up with `find`. Throws Error (input) with the file, the place in it and a remedy.
Study read_study(const Path& file, const FindOperation& find, const StudyOptions& options = {});

/// Whether a program with this name belongs to the toolkit, so that studies may start it.
bool is_own_program(const std::string& name);

/// Text form of a parameter value.
std::string scalar_text(const JsonValue& value);

}  // namespace ostraka

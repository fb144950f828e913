// Study files. A study consists of steps (operations with their inputs and options) and of parameters with lists of values.
#pragma once

#include "ostraka/files/json.h"
#include "ostraka/framework/operation.h"

#include <map>
#include <string>
#include <variant>
#include <vector>

namespace ostraka {

/// A reference "${name}" or "${name.member}" to the value of a parameter or to an output of a step.
struct StudyReference {
    std::string name, member;  ///< name of the parameter or step; name of the member or output, empty for "${name}"
};
/// A text that may contain references.
struct StudyText {
    std::vector<std::variant<std::string, StudyReference>> parts;  ///< plain texts and references, in order
    /// The reference, if the text consists of exactly one reference; otherwise null.
    [[nodiscard]] const StudyReference* single() const;
    [[nodiscard]] std::vector<StudyReference> references() const;  ///< all references in the text
};
/// Parses a text with references. Throws Error (input) if "${" is not followed by a name and "}".
StudyText study_text(const std::string& text, const std::string& where);

/// One value of a parameter: a text, number or boolean, stored as the member "", or an object with several named members.
struct ParameterValue {
    std::map<std::string, std::shared_ptr<const Json>> members;            ///< values of the members, by name
    std::string label;                                                     ///< text for the value in tables and folder names
    [[nodiscard]] const JsonValue* find(const std::string& member) const;  ///< value of a member; null: no such member
};
/// A parameter of a study with its values.
struct StudyParameter {
    std::string name;                    ///< name of the parameter
    std::vector<ParameterValue> values;  ///< values for which steps run
    bool by_caller = false;              ///< true: the values come from the caller, not from the study file
    bool varies = false;  ///< true: the parameter was given as a list, a range or files, so that steps run once per value
};

/// An input or option of a step, as in the study file.
struct StudySetting {
    std::string name;                  ///< name of the input or option
    const JsonValue* value = nullptr;  ///< JSON value of the setting
    std::string place;                 ///< JSON pointer of the setting
};

/// A step of a study.
struct StudyStep {
    std::string name, place;                    ///< name of the step; its JSON pointer, "/steps/NAME"
    const OperationEntry* operation = nullptr;  ///< null: the step runs a program
    std::vector<StudySetting> settings;         ///< inputs and options of the operation
    std::vector<StudySetting> program, reads;   ///< words of the program's command, and the files that the program reads
    /// File names of the outputs that are written, by name of the output; an empty file name stands for the default name.
    std::map<std::string, StudyText> keep;
    bool is_slow = false;              ///< true: quick runs omit the step
    std::vector<std::size_t> needs;    ///< indices of the steps whose outputs the step uses
    std::vector<std::size_t> gathers;  ///< indices of the needed steps of which the step uses all instances
    std::vector<bool> parameters;      ///< for each parameter of the study: true if the step varies with it
};

/// A study, read from its file.
struct Study {
    Path file, folder;            ///< path of the study file, and folder to which names are relative
    bool allow_programs = false;  ///< true: steps may start external programs
    /// Folders and files from which inputs may be read: those of the study, and those that the caller permits.
    std::vector<Path> readable;
    std::string sha256;                    ///< SHA-256 of the study file
    std::shared_ptr<const Json> document;  ///< JSON document of the study file
    std::string title;                     ///< title of the study
    std::vector<StudyParameter> parameters;
    std::vector<StudyStep> steps;  ///< sorted so that each step follows the steps that it needs

    /// The parameter with this name; null: there is none.
    [[nodiscard]] const StudyParameter* parameter(const std::string& name) const;
    /// Index of the parameter with this name; the number of parameters if there is none.
    [[nodiscard]] std::size_t parameter_index(const std::string& name) const;
    /// Index of the step with this name; the number of steps if there is none.
    [[nodiscard]] std::size_t step(const std::string& name) const;
    /// Throws Error (input) unless the file `named`, with links resolved, lies in a readable folder. `pointer`: JSON pointer in
    /// the study file that names the file.
    void require_readable(const Path& named, const std::string& pointer) const;
    /// The path of a file relative to the study's folder.
    [[nodiscard]] std::string relative(const Path& file) const;
    /// Place in the study file for messages: "FILE, at POINTER".
    [[nodiscard]] std::string at(const std::string& pointer) const { return file.string() + ", at " + pointer; }
};

struct StudyOptions {
    bool quick = false;                 ///< true: use the parameters of "quick" and omit slow steps
    Path folder = {};                   ///< folder to which names are relative; empty: the folder of the study file
    std::vector<std::string> set = {};  ///< "NAME=VALUE" or "NAME=VALUE,VALUE": replaces the values of a parameter
    bool set_from_file = false;    ///< true: `set` comes from a file, so that its paths are not trusted like paths of the caller
    std::vector<Path> reads = {};  ///< additional folders from which inputs may be read
    bool reads_folder = true;      ///< true: inputs may also be read from `folder`
    bool allow_programs = false;   ///< true: steps may start external programs
};

/// Reads a study file and performs the checks that do not require running the study: schema, names, references, cycles. `find`
/// returns the operation with a given name. Throws Error (input) with the file, the place in the file and a remedy.
Study read_study(const Path& file, const FindOperation& find, const StudyOptions& options = {});

/// True if a program with this name belongs to the toolkit; every study may start such programs.
bool is_own_program(const std::string& name);

/// A parameter value as text.
std::string scalar_text(const JsonValue& value);

}  // namespace ostraka

// Expands a study into instances: each step runs once per combination of values of the parameters with which it varies.
#pragma once

#include "ostraka/workflow/study_file.h"

#include <limits>
#include <set>

namespace ostraka {

inline constexpr std::size_t no_instance = std::numeric_limits<std::size_t>::max();  ///< index of no instance

/// An input of an instance: a file, or an output of another instance.
struct StudyInput {
    std::string slot;                    ///< name of the operation's input
    std::string label;                   ///< NAME, if the input was given as NAME=FILE
    Path file;                           ///< path of the file; empty for an output of another instance
    std::size_t instance = no_instance;  ///< index of the instance that produces the output; no_instance for a file
    std::string output;                  ///< name of the output
    /// True: the input is passed as a file, because the annotation file beside it (NAME.ant.json) is read too.
    bool on_disk = false;
};

/// A step with one combination of parameter values.
struct StudyInstance {
    std::size_t step = 0;  ///< index of the step
    /// For each parameter, the index of its value; `no_instance` if the step does not vary with the parameter.
    std::vector<std::size_t> values;
    std::string label;  ///< values of the parameters, such as "vertices=5000,seed=1"; empty if the step has one instance
    Path folder;        ///< relative to the run folder: steps/NAME or steps/NAME/LABEL
    std::shared_ptr<const Json> options;         ///< options of the operation
    std::vector<StudyInput> inputs;              ///< inputs of the operation or program
    std::map<std::string, std::string> outputs;  ///< file names of the requested outputs, by name of the output
    std::set<std::string> kept;                  ///< names of the outputs that are written to files
    /// Words of the command of an external program; words for inputs and for the folder are filled in at run time.
    std::vector<std::string> program;
    std::vector<std::size_t> needs;  ///< indices of the instances whose outputs the instance uses

    /// Name for messages: "transfer (vertices=5000)".
    [[nodiscard]] std::string title(const Study& study) const;
};

/// The instances of a study, checked before anything runs.
class StudyPlan {
public:
    /// Expands a study and checks every instance against the declaration of its operation: names, types, ranges, kinds of inputs,
    /// existence of files. Throws Error (input) with the file, the place in the file and a remedy.
    explicit StudyPlan(Study study);

    /// Creates the call of an instance; `fill` returns the object or file for an output of another instance.
    using Fill = std::function<Source(const StudyInput&)>;
    [[nodiscard]] Call call(const StudyInstance& instance, const Fill& fill) const;

    /// The command words of an instance that runs a program; `file` returns the file for an output of another instance; `folder`:
    /// folder of the instance.
    using FileOf = std::function<Path(const StudyInput&)>;
    [[nodiscard]] std::vector<std::string> words(const StudyInstance& instance, const FileOf& file, const Path& folder) const;

    /// The value of the parameter "name.member" in an instance; null if the instance does not vary with this parameter.
    [[nodiscard]] const JsonValue* value(const StudyInstance& instance, const StudyReference& reference) const;

    /// Indices of the instances of a step, in the order of their parameter values.
    [[nodiscard]] std::vector<std::size_t> instances_of(std::size_t step) const;

    Study study;                           ///< the study that was expanded
    std::vector<StudyInstance> instances;  ///< sorted so that each instance follows the instances that it needs

private:
    void add_step(std::size_t step);  ///< adds the instances of a step
    /// An instance of a step; `values`: value index per parameter.
    StudyInstance make_instance(std::size_t step, const std::vector<std::size_t>& values);
    /// The text with references replaced by values.
    std::string filled(const StudyText& text, const StudyInstance& instance) const;
    /// Sets an option of an instance to the value of a setting.
    void set_value(StudyInstance& instance, const StudySetting& setting, const JsonValue& value, const std::string& place,
                   const Call& call, JsonValue& options, JsonAllocator& allocator);
    /// Sets an input of an instance to the value of a setting.
    void set_slot(StudyInstance& instance, const StudySetting& setting, const JsonValue& setting_value, const std::string& place,
                  const Slot& slot);
    /// Path of an input file, whose name is relative to the study's folder. Throws Error (input) unless the file can be read and
    /// has an extension of the kind.
    [[nodiscard]] Path input_file(const std::string& name, const std::string& place, Kind kind) const;
    /// Adds the output of another instance as an input of an instance.
    void add_output(StudyInstance& instance, const StudySetting& setting, const StudyReference& reference,
                    const std::string& place, const std::string& label);
    /// Throws Error (input) if a program's word names a path outside the permitted folders.
    void check_word(const StudySetting& word, const StudyText& text, const std::string& filled) const;
    void check_counts(const StudyInstance& instance);  ///< throws Error (input) if the instances have too many inputs
    /// Marks an output of an instance as requested; `keep`: it is written to a file.
    void request_output(std::size_t instance, const std::string& output, bool keep);
    /// Index of the instance of `step` that has the parameter values of the instance `user`.
    [[nodiscard]] std::size_t instance_of(std::size_t step, const StudyInstance& user) const;
    void make_outputs(StudyInstance& instance);       ///< chooses the file names of the requested outputs
    void check(const StudyInstance& instance) const;  ///< checks the call of an instance
    void check_outputs() const;                       ///< checks that requested outputs do not overwrite each other

    /// For each step: index of the instance for each combination of value indices.
    std::vector<std::map<std::vector<std::size_t>, std::size_t>> index_;
    std::size_t inputs_ = 0;  ///< total number of inputs
};

/// True if an object of kind `available` is accepted as an input of kind `required`.
bool is_compatible(Kind available, Kind required);

}  // namespace ostraka

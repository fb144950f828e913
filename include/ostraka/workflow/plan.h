// Expands a study into instances: each step once per combination of values of the parameters it varies with.
#pragma once

#include "ostraka/workflow/study_file.h"

#include <limits>
#include <set>

namespace ostraka {

inline constexpr std::size_t no_instance = std::numeric_limits<std::size_t>::max();

/// An input of an instance: a file, or an output of another instance.
struct StudyInput {
    std::string slot;
    std::string label;                   ///< NAME of NAME=FILE
    Path file;                           ///< empty for an output
    std::size_t instance = no_instance;  ///< the instance that produces the output
    std::string output;
    bool on_disk = false;  ///< passed as a file, because the file beside it is read too (NAME.ant.json)
};

struct StudyInstance {
    std::size_t step = 0;
    std::vector<std::size_t> values;  ///< value index per parameter; `no_instance` if the step does not vary with it
    std::string label;                ///< "vertices=5000,seed=1"; empty if the step has one instance
    Path folder;                      ///< relative to the run folder: steps/NAME or steps/NAME/LABEL
    std::shared_ptr<const Json> options;
    std::vector<StudyInput> inputs;
    std::map<std::string, std::string> outputs;  ///< requested outputs -> file names
    std::set<std::string> kept;                  ///< outputs that are written to files
    std::vector<std::string> program;            ///< command words; those of inputs and of the folder are filled in at run time
    std::vector<std::size_t> needs;              ///< indices of instances it depends on

    /// "transfer (vertices=5000)".
    [[nodiscard]] std::string title(const Study& study) const;
};

class StudyPlan {
public:
    /// Checks every instance against the declaration of its operation: names, types, ranges, kinds of inputs, existence of
    /// files. Throws Error (input) with the file, the place in it and a remedy, before anything runs.
    explicit StudyPlan(Study study);

    /// The call of an instance; `fill` supplies the object or file for an output of another instance.
    using Fill = std::function<Source(const StudyInput&)>;
    [[nodiscard]] Call call(const StudyInstance& instance, const Fill& fill) const;

    /// The words of a program; `file` supplies the file of an output of another instance; `folder` is the instance's own
    /// folder.
    using FileOf = std::function<Path(const StudyInput&)>;
    [[nodiscard]] std::vector<std::string> words(const StudyInstance& instance, const FileOf& file, const Path& folder) const;

    /// The value of "name.member" in an instance; null if the instance does not vary with that parameter.
    [[nodiscard]] const JsonValue* value(const StudyInstance& instance, const StudyReference& reference) const;

    /// Instances of a step, in the order of their parameters.
    [[nodiscard]] std::vector<std::size_t> instances_of(std::size_t step) const;

    Study study;
    std::vector<StudyInstance> instances;  ///< sorted so that each follows those it needs

private:
    void add_step(std::size_t step);
    StudyInstance make_instance(std::size_t step, const std::vector<std::size_t>& values);
    std::string filled(const StudyText& text, const StudyInstance& instance) const;
    void set_value(StudyInstance& instance, const StudySetting& setting, const JsonValue& value, const std::string& place,
                   const Call& call, JsonValue& options, JsonAllocator& allocator);
    void set_slot(StudyInstance& instance, const StudySetting& setting, const JsonValue& setting_value, const std::string& place,
                  const Slot& slot);
    /// The file relative to the study's folder. Throws Error (input) unless it can be read and its ending fits the kind.
    [[nodiscard]] Path input_file(const std::string& name, const std::string& place, Kind kind) const;
    void add_output(StudyInstance& instance, const StudySetting& setting, const StudyReference& reference,
                    const std::string& place, const std::string& label);
    void check_word(const StudySetting& word, const StudyText& text, const std::string& filled) const;
    void check_counts(const StudyInstance& instance);
    void request_output(std::size_t instance, const std::string& output, bool keep);
    [[nodiscard]] std::size_t instance_of(std::size_t step, const StudyInstance& user) const;
    void make_outputs(StudyInstance& instance);
    void check(const StudyInstance& instance) const;
    void check_outputs() const;

    std::vector<std::map<std::vector<std::size_t>, std::size_t>> index_;  ///< per step: values -> instance
    std::size_t inputs_ = 0;                                              ///< total number of inputs
};

/// Whether an object of kind `available` is accepted where `required` is required.
bool is_compatible(Kind available, Kind required);

}  // namespace ostraka

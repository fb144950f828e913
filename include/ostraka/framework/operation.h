// Operations: the functions of the toolkit, each declared once and run from the command line, a run file, another language or
// C++.
//
//     Context context;
//     Call call(find_operation("annotation transfer"));             // operations/table.h
//     call.set_object("source", Object::of(std::move(mesh_file), "pot.ply"));
//     call.set_file("annotations", "pot.ant.json");
//     call.set_file("target", "pot-1000k.ply");
//     call.set("spikes", "avoid");
// "output" has no file: it stays in memory
//     const auto set = call.object("output").as<AnnotationSet>();
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/core/progress.h"
#include "ostraka/framework/objects.h"
#include "ostraka/framework/report.h"

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace ostraka {

/// The declaration of an operation: its slots, options and report. Slots and options refer to members of the operation, which
/// hold the values.
class Parameters {
public:
    /// Declares an input of the operation.
    Slot& input(std::string name, Kind kind, Slot& slot, std::string help);
    /// Declares an output of the operation.
    Slot& output(std::string name, Kind kind, Slot& slot, std::string help);
    /// Declares an optional input that is given by its name: --name FILE.
    Slot& input_option(std::string name, Kind kind, Slot& slot, std::string help) {
        return input(std::move(name), kind, slot, std::move(help)).optional().flag();
    }
    /// Declares an optional output that is given by its name: --name FILE.
    Slot& output_option(std::string name, Kind kind, Slot& slot, std::string help) {
        return output(std::move(name), kind, slot, std::move(help)).optional().flag();
    }
    OptionList options;   ///< options of the operation
    ReportLayout report;  ///< layout of the report
    /// Checks of single options, called before Operation::check; they throw Error (usage).
    std::vector<std::function<void()>> checks;

    /// Lists of the names of the positional arguments in command-line order, if different from the order of the declarations. If
    /// there are several lists, the list whose length fits the number of arguments is used. A repeatable name takes the remaining
    /// arguments.
    std::vector<std::vector<std::string>> orders;
    /// Adds a list of positional names.
    void order(std::vector<std::string> names) { orders.push_back(std::move(names)); }

    /// True if the name occurs in at least one of the lists `orders`.
    [[nodiscard]] bool in_some_order(const std::string& name) const;

    [[nodiscard]] std::vector<Slot*> slots() const { return slots_; }
    [[nodiscard]] Slot* slot(const std::string& name) const;  ///< the slot of this name; null if there is none
    /// True if an output is written in place of this input's file.
    [[nodiscard]] bool updated_in_place(const Slot& input) const;

private:
    std::vector<Slot*> slots_;
};

/// Base class of all operations. A new instance is created for each call.
class Operation {
public:
    virtual ~Operation();
    /// Declares slots, options and report.
    virtual void declare(Parameters& parameters) = 0;
    /// Checks options before any input is read: throws Error (usage) if options contradict each other. Ranges and file names have
    /// been checked already.
    virtual void check() const {}
    /// Estimated memory use in bytes, from the total size of the input files. A call that would exceed the memory limit is
    /// refused. A mesh with its search trees takes about a dozen times the size of its file.
    [[nodiscard]] virtual double memory_needed(double input_bytes) const { return 12 * input_bytes; }
    /// Does the work: reads inputs from the slots, writes outputs to the slots and fills the report.
    virtual void run(Context& context, Report& report) = 0;
};

/// A row of the table of operations.
struct OperationEntry {
    const char* name;                      ///< name of the operation, such as "annotation transfer"
    const char* help;                      ///< help text
    std::unique_ptr<Operation> (*make)();  ///< creates an instance
    /// Version of the results. The version is increased when the operation gives different results for the same inputs, so that
    /// stored results are computed again.
    int version = 1;
    /// True if the operation runs other operations or programs named in files; such operations are refused as steps of studies
    /// and sessions.
    bool runs_others = false;
};

/// Function that returns the table entry of the operation with this name; throws Error (usage) with the most similar name if
/// there is none.
using FindOperation = std::function<const OperationEntry&(const std::string&)>;

/// State shared by the operations that one process runs: objects already read, and in-memory files.
class Context {
public:
    Context();
    ~Context();
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    /// Receives progress and requests cancellation.
    Watch watch;
    /// Called with each note of a report when the note is made.
    std::function<void(const std::string&)> on_note;
    /// True: objects read from files are cached for later operations; a file that changed after it was read is read again.
    bool keep_objects = false;
    /// Enables caching in this and the other context with a common cache, so that a file is read once for both. Each context must
    /// be used by one thread only.
    void share_objects(Context& other);
    /// Removes all objects read from this file from the cache.
    void forget(const Path& file);
    /// Files read by the last call, with the checksums of the files.
    [[nodiscard]] const std::vector<ReadRecord::Entry>& files_read() const { return read_; }

    // ---- for operations ----

    /// Provenance of the current call: command, options, and the SHA-256 of every given file and object and of the files that
    /// these refer to.
    [[nodiscard]] Provenance provenance() const;
    /// Returns the result of `read` for the i-th source of a slot. The source is read once per call, all files read are recorded
    /// as inputs, and the result is cached for later calls if `keep_objects` is set. `key`: text of everything else that the
    /// result depends on.
    using Read = std::function<std::shared_ptr<const void>(const Path&)>;
    std::shared_ptr<const void> load(const Slot& slot, std::size_t i, std::type_index type, const std::string& key,
                                     const Read& read);
    /// Runs `read` and records all files that are read as inputs.
    void record(const std::function<void()>& read);
    /// Files read so far, in the order of reading: the inputs and the files that they name, such as images.
    [[nodiscard]] std::vector<Path> files_so_far() const;
    /// Records the name and checksum of an input that is read elsewhere, such as the objects of a collection read by several
    /// threads.
    void record_input(const std::string& name, const std::string& sha256);
    /// Sets the checksum of the i-th object of a slot; for an object in memory without a checksum.
    void record_object(const Slot& slot, std::size_t i, const std::string& sha256);
    /// Checksum of the i-th object of a slot, for an object in memory; empty if unknown.
    std::string checksum_of_object(const Slot& slot, std::size_t i);
    /// Adds a note to the report of the current call.
    void note(const std::string& text);
    /// Adds notes about a file to the report of the current call.
    void notes(const std::string& file, const std::vector<std::string>& texts);
    /// Returns a new path, ending in `name`, for a file or folder in memory.
    Path memory(const std::string& name);
    /// Checks an output file: throws Error (usage) if the file was read as an input.
    void check_output(const Path& file) const;
    /// Checks output files that do not belong to a slot: throws Error (usage) if one of them is also an input or output of a
    /// slot.
    void check_outputs(const std::vector<Path>& further) const;

private:
    friend class Call;
    struct CallState;
    CallState* call_ = nullptr;
    struct ObjectCache;
    std::shared_ptr<ObjectCache> object_cache_;
    std::vector<Path> memory_;
    std::vector<ReadRecord::Entry> read_;
};

/// An operation together with its inputs, outputs and options.
class Call {
public:
    /// Creates the operation with default options and empty slots.
    explicit Call(const OperationEntry& entry);
    ~Call();
    Call(Call&&) noexcept;

    [[nodiscard]] const OperationEntry& entry() const { return *entry_; }
    Parameters& parameters() { return parameters_; }
    [[nodiscard]] const Parameters& parameters() const { return parameters_; }
    /// The option of this name. Throws Error (usage), with the most similar name, if there is none.
    Option& option(const std::string& name);
    /// The slot of this name. Throws Error (usage), with the most similar name, if there is none.
    Slot& slot(const std::string& name);

    /// Sets an option. Throws Error (usage) if the option does not exist (with the most similar name), or if the value has the
    /// wrong type or is not allowed.
    void set(const std::string& option, const std::string& value);
    void set(const std::string& option, const char* value) { set(option, std::string(value)); }
    /// Sets an option of type boolean.
    void set(const std::string& option, bool value);
    /// Sets an option of type number or integer.
    void set(const std::string& option, double value);
    /// Sets the file of a slot; a repeatable slot gets a further file. Throws Error (usage) if the slot does not exist.
    void set_file(const std::string& slot, const Path& file);
    /// Sets the object of a slot; a repeatable slot gets a further object. Throws Error (usage) if the slot does not exist.
    void set_object(const std::string& slot, Object object);
    /// Sets options and files from a JSON object of names and values. For an output, the value true requests the output in
    /// memory.
    void set(const JsonValue& values, const std::string& where = {});
    /// Requests an output in memory; `object_name`: file name by which other outputs refer to this output.
    void want(const std::string& output, const std::string& object_name = {});

    /// Performs all checks that `run` performs before reading inputs. `will_exist`: returns true for a missing file that will
    /// exist when `run` is called.
    void check(const std::function<bool(const Path&)>& will_exist = {});
    /// Checks the arguments, runs the operation, and writes all output files or none. `run` may be called once. Required outputs
    /// without a file stay in memory. `before_commit` receives the report before the output files get their final names; if
    /// `before_commit` throws, no file is left behind.
    Report run(Context& context, const std::function<void(const Report&)>& before_commit = {});
    /// The i-th object of an output that stayed in memory.
    [[nodiscard]] const Object& object(const std::string& output, std::size_t i = 0) const;

    /// Default file extension of an output, such as ".ply"; empty for an output folder.
    [[nodiscard]] std::string usual_ending(const std::string& output) const;

    /// JSON schema (draft 4) of the values that `set` accepts, with descriptions.
    [[nodiscard]] JsonValue schema(JsonAllocator& allocator) const;
    /// The declaration of the operation as JSON: name, help, inputs, outputs and options, with types, ranges, defaults and units.
    [[nodiscard]] JsonValue declaration(JsonAllocator& allocator) const;

    /// Throws Error (usage) for an unknown name, with the most similar name among the options, the slots and `flags`.
    [[noreturn]] void no_such_name(const std::string& name, const std::vector<std::string>& flags = {}) const;

private:
    void complete();
    [[nodiscard]] double input_bytes() const;
    void check_given(const std::function<bool(const Path&)>& will_exist) const;

    const OperationEntry* entry_;
    std::unique_ptr<Operation> operation_;
    Parameters parameters_;
};

/// Calls `work`. If `work` throws an Error of kind input, the file name is added in front of the error's location.
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

}  // namespace ostraka

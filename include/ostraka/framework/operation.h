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
    Slot& input(std::string name, Kind kind, Slot& slot, std::string help);
    Slot& output(std::string name, Kind kind, Slot& slot, std::string help);
    /// The same for an optional slot that is given by its name: --name FILE.
    Slot& input_option(std::string name, Kind kind, Slot& slot, std::string help) {
        return input(std::move(name), kind, slot, std::move(help)).optional().flag();
    }
    Slot& output_option(std::string name, Kind kind, Slot& slot, std::string help) {
        return output(std::move(name), kind, slot, std::move(help)).optional().flag();
    }
    OptionList options;
    ReportLayout report;
    std::vector<std::function<void()>> checks;  ///< checks of single options; run before Operation::check, and throw like it

    /// Orders of the positional arguments on the command line, if different from the order of the declarations. With several
    /// orders, the number of arguments selects one. A repeatable name takes the remaining arguments.
    std::vector<std::vector<std::string>> orders;
    void order(std::vector<std::string> names) { orders.push_back(std::move(names)); }

    /// Whether the name is positional in at least one of the orders.
    [[nodiscard]] bool in_some_order(const std::string& name) const;

    [[nodiscard]] std::vector<Slot*> slots() const { return slots_; }
    [[nodiscard]] Slot* slot(const std::string& name) const;
    /// Whether an output is written in place of this input's file.
    [[nodiscard]] bool updated_in_place(const Slot& input) const;

private:
    std::vector<Slot*> slots_;
};

/// Base class of all operations. A new instance is created for each call.
class Operation {
public:
    virtual ~Operation();
    virtual void describe(Parameters& parameters) = 0;
    /// Throws Error (usage) if options contradict each other, before anything is read. Ranges and file names have been checked
    /// already.
    virtual void check() const {}
    /// Estimated memory in bytes, given the total size of the input files; used to refuse work that would exceed the memory
    /// limit. A mesh with its search trees takes about a dozen times the size of its file.
    [[nodiscard]] virtual double memory_needed(double input_bytes) const { return 12 * input_bytes; }
    virtual void run(Context& context, Report& report) = 0;
};

/// A row of the table of operations.
struct OperationEntry {
    const char* name;  ///< e.g. "annotation transfer"
    const char* help;
    std::unique_ptr<Operation> (*make)();
    int version = 1;  ///< raised when the same inputs give different results, so that earlier results are computed again
    /// Whether it runs other operations or programs named in files; such operations are refused as steps of studies and
    /// sessions.
    bool runs_others = false;
};

/// Returns the entry with this name; throws Error (usage) with the nearest name if there is none.
using FindOperation = std::function<const OperationEntry&(const std::string&)>;

/// State that operations of one process share: objects already read, and in-memory files.
class Context {
public:
    Context();
    ~Context();
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    /// Receives progress and requests cancellation.
    Watch watch;
    /// Called with each note of a report as it is made.
    std::function<void(const std::string&)> on_note;
    /// Whether objects read from files are cached for later operations. Files that have changed since are read again.
    bool keep_objects = false;
    /// Enables caching in both contexts and shares the cache: a file is read once for both. Each context must be used by one
    /// thread only.
    void share_objects(Context& other);
    /// Removes all objects read from this file from the cache.
    void forget(const Path& file);
    /// Files read by the last call, with their checksums.
    [[nodiscard]] const std::vector<ReadRecord::Entry>& files_read() const { return read_; }

    // ---- for operations ----

    /// Provenance of the current call: command, options, and the SHA-256 of every file and object given and of the files they
    /// refer to.
    [[nodiscard]] Provenance provenance() const;
    /// Returns the result of `read` for the i-th source of a slot. It is read once per call, the files it reads are recorded as
    /// inputs, and it is cached for later calls if `keep_objects` is set. `key`: whatever else the result depends on.
    using Read = std::function<std::shared_ptr<const void>(const Path&)>;
    std::shared_ptr<const void> load(const Slot& slot, std::size_t i, std::type_index type, const std::string& key,
                                     const Read& read);
    /// Runs `read` and records the files it reads as inputs.
    void record(const std::function<void()>& read);
    /// Records the name and checksum of an input that is read elsewhere, such as the objects of a collection read by several
    /// threads.
    void record_input(const std::string& name, const std::string& sha256);
    /// Sets the checksum of an object in memory that does not have its own.
    void record_object(const Slot& slot, std::size_t i, const std::string& sha256);
    /// Checksum of an object in memory; empty if unknown.
    std::string checksum_of_object(const Slot& slot, std::size_t i);
    /// Adds notes to the report of the current call.
    void note(const std::string& text);
    void notes(const std::string& file, const std::vector<std::string>& texts);
    /// A new name for a file or folder in memory.
    Path memory(const std::string& name);
    /// Throws Error (usage) if the file was read as an input.
    void check_output(const Path& file) const;
    /// Checks outputs other than those of the slots: throws Error (usage) if one is an input or an output of a slot.
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
    explicit Call(const OperationEntry& entry);
    ~Call();
    Call(Call&&) noexcept;

    [[nodiscard]] const OperationEntry& entry() const { return *entry_; }
    Parameters& parameters() { return parameters_; }
    [[nodiscard]] const Parameters& parameters() const { return parameters_; }
    /// Both throw Error (usage), with the nearest name, if the name does not exist.
    Option& option(const std::string& name);
    Slot& slot(const std::string& name);

    /// Each throws Error (usage), with the nearest name, if the option or slot does not exist, or if the value has the wrong
    /// type or is not allowed. Setting a repeatable slot again adds a file or object.
    void set(const std::string& option, const std::string& value);
    void set(const std::string& option, const char* value) { set(option, std::string(value)); }
    void set(const std::string& option, bool value);
    void set(const std::string& option, double value);
    void set_file(const std::string& slot, const Path& file);
    void set_object(const std::string& slot, Object object);
    /// Sets options and files by name; the value true requests an output in memory.
    void set(const JsonValue& values, const std::string& where = {});
    /// Requests an output in memory; `object_name`: the file name by which other outputs refer to it.
    void want(const std::string& output, const std::string& object_name = {});

    /// Performs all checks that `run` does before it reads. `will_exist`: whether a missing file will exist by then.
    void check(const std::function<bool(const Path&)>& will_exist = {});
    /// Checks the arguments, runs the operation, and writes all files or none. May be called once. Required outputs without a
    /// file stay in memory. `before_commit` receives the report before the files get their final names; if it throws, no file
    /// is left behind.
    Report run(Context& context, const std::function<void(const Report&)>& before_commit = {});
    /// The i-th object of an output that stayed in memory.
    [[nodiscard]] const Object& object(const std::string& output, std::size_t i = 0) const;

    /// Default file extension of an output, such as ".ply"; empty for a folder.
    [[nodiscard]] std::string usual_ending(const std::string& output) const;

    /// JSON schema (draft 4) of the values that `set` accepts, with descriptions.
    [[nodiscard]] JsonValue schema(JsonAllocator& allocator) const;
    /// Name, help, inputs, outputs and options, with types, ranges, defaults and units.
    [[nodiscard]] JsonValue declaration(JsonAllocator& allocator) const;

    /// Throws Error (usage) with the nearest name among the options, the slots and `flags`.
    [[noreturn]] void no_such_name(const std::string& name, const std::vector<std::string>& flags = {}) const;

private:
    void complete();
    [[nodiscard]] double input_bytes() const;
    void check_given(const std::function<bool(const Path&)>& will_exist) const;

    const OperationEntry* entry_;
    std::unique_ptr<Operation> operation_;
    Parameters parameters_;
};

/// Calls `work`; an input error that it throws is rethrown with the file name in front of its place.
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

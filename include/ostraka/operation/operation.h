// Operations: what the toolkit can do, each declared once and run from a command line, a run file, another language or a program.
//
//     Context context;
//     Call call(find_operation("annotation transfer"));             // operations/table.h
//     call.set_object("source", Object::of(std::move(mesh_file), "pot.ply"));
//     call.set_file("annotations", "pot.ant.json");
//     call.set_file("target", "pot-1000k.ply");
//     call.set("spikes", "avoid");
//     const Report report = call.run(context);                     // "output" was given no file: it stays in memory
//     const auto set = call.object("output").as<AnnotationSet>();
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/core/progress.h"
#include "ostraka/operation/objects.h"
#include "ostraka/operation/report.h"

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace ostraka {

/// What an operation is declared with. An operation's members are declared by reference: options keep their values, slots their
/// objects.
class Parameters {
public:
    Slot& input(std::string name, Kind kind, Slot& slot, std::string help);
    Slot& output(std::string name, Kind kind, Slot& slot, std::string help);
    /// The same for what may be left out, and is given by its name: --name FILE.
    Slot& input_option(std::string name, Kind kind, Slot& slot, std::string help) {
        return input(std::move(name), kind, slot, std::move(help)).optional().flag();
    }
    Slot& output_option(std::string name, Kind kind, Slot& slot, std::string help) {
        return output(std::move(name), kind, slot, std::move(help)).optional().flag();
    }
    OptionList options;
    ReportLayout report;
    std::vector<std::function<void()>> checks;  ///< of single options; run before Operation::check, and throw as it does

    /// Names, in the order in which the command line gives them, where that is not the order of the declarations; several where
    /// there are several ways, distinguished by how many there are. A name that may repeat takes what is left.
    std::vector<std::vector<std::string>> orders;
    void order(std::vector<std::string> names) { orders.push_back(std::move(names)); }

    /// It is given by its place, in one of the orders at least.
    [[nodiscard]] bool in_some_order(const std::string& name) const;

    [[nodiscard]] std::vector<Slot*> slots() const { return slots_; }
    [[nodiscard]] Slot* slot(const std::string& name) const;
    /// Whether the file of this input is written in its place.
    [[nodiscard]] bool updated_in_place(const Slot& input) const;

private:
    std::vector<Slot*> slots_;
};

/// One piece of work. Made anew for each call.
class Operation {
public:
    virtual ~Operation();
    virtual void describe(Parameters& parameters) = 0;
    /// Options that contradict each other: throws Error (usage) before anything is read. Ranges and file names are checked
    /// already.
    virtual void check() const {}
    /// Bytes that the work will take, where its input files have so many: a guess to refuse what cannot end well. A mesh in
    /// memory with its trees comes to about a dozen times its file.
    [[nodiscard]] virtual double memory_needed(double input_bytes) const { return 12 * input_bytes; }
    virtual void run(Context& context, Report& report) = 0;
};

/// A line of the table of operations.
struct OperationEntry {
    const char* name;  ///< e.g. "annotation transfer"
    const char* help;
    std::unique_ptr<Operation> (*make)();
    int version = 1;  ///< raised when the same inputs give other results: what was done before is done again
    /// It runs other operations or programs that files name: refused as a step of a study and of a session.
    bool runs_others = false;
};

/// The line of that name; throws Error (usage) with the nearest name where there is none.
using FindOperation = std::function<const OperationEntry&(const std::string&)>;

/// What operations share within one process: objects that were read, files that are held in memory.
class Context {
public:
    Context();
    ~Context();
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    /// Told of progress; cancels.
    Watch watch;
    /// Called with each note of a report as it is made.
    std::function<void(const std::string&)> on_note;
    /// Whether objects read from files are kept for later operations. Files that have changed since (other bytes) are read again.
    bool keep_objects = false;
    /// From here on both keep objects, and share them: a file is read once, whichever of them needs it. Each is used by a thread
    /// of its own.
    void share_objects(Context& other);
    /// What was made of this file is no longer kept.
    void forget(const Path& file);
    /// Files that the last call read, with their checksums.
    [[nodiscard]] const std::vector<ReadRecord::Entry>& files_read() const { return read_; }

    // ---- for operations ----

    /// Of the call under way: command, options, and SHA-256 of every file and object given, and of what they name.
    [[nodiscard]] Provenance provenance() const;
    /// What `read` makes of the i-th file of a slot: read once a call, with what it reads recorded as input, and kept for later
    /// calls if `keep_objects` is set. `key`: what else it depends on.
    using Read = std::function<std::shared_ptr<const void>(const Path&)>;
    std::shared_ptr<const void> load(const Slot& slot, std::size_t i, std::type_index type, const std::string& key,
                                     const Read& read);
    /// Runs `read` and records the files that it reads as inputs.
    void record(const std::function<void()>& read);
    /// Records what is read elsewhere, such as the objects of a collection by several threads: a name and its checksum.
    void record_input(const std::string& name, const std::string& sha256);
    /// The object in memory has this checksum, if it says none itself.
    void record_object(const Slot& slot, std::size_t i, const std::string& sha256);
    /// That of an object in memory; empty where nothing says it.
    std::string checksum_of_object(const Slot& slot, std::size_t i);
    /// Notes for the report of the call under way.
    void note(const std::string& text);
    void notes(const std::string& file, const std::vector<std::string>& texts);
    /// A fresh name for a file or folder in memory.
    Path memory(const std::string& name);
    /// Throws Error (usage) where a file was read as an input.
    void check_output(const Path& file) const;
    /// Outputs beside those of the slots: throws Error (usage) where one is an input or one of those.
    void check_outputs(const std::vector<Path>& further) const;

private:
    friend class Call;
    struct CallState;
    CallState* run_ = nullptr;
    struct Kept;
    std::shared_ptr<Kept> kept_;
    std::vector<Path> memory_;
    std::vector<ReadRecord::Entry> read_;
};

/// An operation with what it is to be run on.
class Call {
public:
    explicit Call(const OperationEntry& entry);
    ~Call();
    Call(Call&&) noexcept;

    [[nodiscard]] const OperationEntry& entry() const { return *entry_; }
    Parameters& parameters() { return parameters_; }
    [[nodiscard]] const Parameters& parameters() const { return parameters_; }
    /// Throws Error (usage), with the nearest name, if there is none.
    Option& option(const std::string& name);
    Slot& slot(const std::string& name);

    /// Each throws Error (usage), with the nearest name, if there is no such option or object, and if the value is of another
    /// type or not allowed. A slot that is set again takes one more file or object if it may be repeated.
    void set(const std::string& option, const std::string& value);
    void set(const std::string& option, const char* value) { set(option, std::string(value)); }
    void set(const std::string& option, bool value);
    void set(const std::string& option, double value);
    void set_file(const std::string& slot, const Path& file);
    void set_object(const std::string& slot, Object object);
    /// Options and files by name; an output is asked for with true where it is to stay in memory.
    void set(const JsonValue& values, const std::string& where = {});
    /// The output is made, and stays in memory; `called`: what others call it that name it, as a file's name.
    void want(const std::string& output, const std::string& called = {});

    /// Checks all that `run` checks before it reads. `comes`: says of a file that is not there whether it will be.
    void check(const std::function<bool(const Path&)>& comes = {});
    /// Checks all that was given, reads, works, and writes the files all together or not at all. May be called once. Outputs that
    /// are needed and have no file stay in memory. `before_commit` sees the report before files take their names: what it throws
    /// leaves nothing behind.
    Report run(Context& context, const std::function<void(const Report&)>& before_commit = {});
    /// What an output holds that stayed in memory; the i-th of several.
    [[nodiscard]] const Object& object(const std::string& output, std::size_t i = 0) const;

    /// How the name of an output's file ends, where nobody says otherwise: ".ply"; empty: a folder.
    [[nodiscard]] std::string usual_ending(const std::string& output) const;

    /// The JSON schema (draft 4) of what `set` takes, with a description of each; and that of the report's result.
    [[nodiscard]] JsonValue schema(JsonAllocator& allocator) const;
    /// Name, help, inputs, outputs and options, with types, ranges, defaults and units.
    [[nodiscard]] JsonValue declaration(JsonAllocator& allocator) const;

    /// Throws Error (usage) with the nearest name of an option or object, or of these flags beside them.
    [[noreturn]] void no_such_name(const std::string& name, const std::vector<std::string>& flags = {}) const;

private:
    void complete();
    [[nodiscard]] double input_bytes() const;
    void check_given(const std::function<bool(const Path&)>& comes) const;

    const OperationEntry* entry_;
    std::unique_ptr<Operation> operation_;
    Parameters parameters_;
};

/// Calls `work`; what it finds wrong with an input is said with the name of the file it came from.
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

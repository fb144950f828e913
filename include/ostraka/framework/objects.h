// Objects and slots: an input or output of an operation stands for a file or for an object in memory; `Operation::run` works
// with objects only.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/files/file.h"

#include <functional>
#include <memory>
#include <string>
#include <typeindex>
#include <vector>

namespace ostraka {

class Context;

enum class Role { input, output };

/// The kind of an object; it determines the file formats that can hold it.
enum class Kind {
    mesh,
    annotations,
    graph,
    cage,
    coordinates,
    values,     ///< one number per vertex or face
    labels,     ///< one integer per face
    index_map,  ///< maps old element indices to new ones
    edit,
    recipe,
    rules,
    template_package,
    vocabulary,
    shape_class,
    landmarks,
    assembly,
    pose,
    collection,  ///< a folder of objects, or a list of objects
    study,       ///< a sequence of steps to run
    picture,
    table,
    report,
    text,
    folder,  ///< several files; the operation documents them
};
std::string to_string(Kind kind);
/// File extensions of a kind, lower case; empty if any extension is allowed.
std::vector<std::string> endings_of(Kind kind);

/// A shared, immutable object in memory, with its name and the checksum of its source.
class Object {
public:
    Object() = default;
    template <class T>
    explicit Object(std::shared_ptr<const T> data, std::string object_name = {}, std::string checksum = {})
        : name(std::move(object_name)), sha256(std::move(checksum)), data_(std::move(data)), type_(typeid(T)) {}
    template <class T>
    static Object of(T value, std::string object_name = {}) {
        return Object(std::make_shared<const T>(std::move(value)), std::move(object_name));
    }

    /// The data, or null if it is not of type T.
    template <class T>
    [[nodiscard]] std::shared_ptr<const T> as() const {
        return type_ == typeid(T) ? std::static_pointer_cast<const T>(data_) : nullptr;
    }
    explicit operator bool() const { return data_ != nullptr; }

    std::string name;    ///< the file name used in reports and in files that refer to the object
    std::string sha256;  ///< SHA-256 of the file it was read from, or of its content
    /// Writes the object to a file; set for objects made in memory.
    std::function<void(const Path&)> write;

    /// SHA-256 of the object's file, or of the file that `write` would produce; empty if unknown. `beside`: names and checksums
    /// of accompanying files, such as the header of coordinates.
    struct Checksums {
        std::string sha256;
        std::vector<std::pair<std::string, std::string>> beside;
    };
    /// Computed once per name and shared between copies of the object.
    [[nodiscard]] const Checksums& checksums() const;

private:
    struct ChecksumCache;
    std::shared_ptr<ChecksumCache> checksum_cache_ = make_checksum_cache();
    static std::shared_ptr<ChecksumCache> make_checksum_cache();
    std::shared_ptr<const void> data_;
    std::type_index type_ = typeid(void);
};

/// The value of a slot: a file name or an object.
struct Source {
    Path file;
    Object object;
    bool in_place = false;   ///< output that replaces the input it updates
    std::string label = {};  ///< NAME, if the file was given as NAME=FILE
    [[nodiscard]] std::string name() const { return object.name.empty() ? file.string() : object.name; }
    [[nodiscard]] bool empty() const { return file.empty() && !object; }
};

/// An input or output of an operation, declared by Parameters and filled before `run`.
class Slot {
public:
    Slot() = default;
    Slot(const Slot&) = delete;
    Slot& operator=(const Slot&) = delete;
    virtual ~Slot();

    std::string name;  ///< name as flag and as key
    std::string help;
    Role role = Role::input;
    Kind kind = Kind::text;
    bool needed = true;         ///< required
    bool repeated = false;      ///< may be given more than once
    bool is_positional = true;  ///< given by its place on the command line, not by its name
    bool takes_words = false;   ///< several words may follow the flag
    bool may_be_new = false;    ///< updated input that need not exist yet
    Slot* updated = nullptr;    ///< for an output: the input that it updates
    bool is_named = false;      ///< files are given as NAME=FILE
    bool takes_none = false;    ///< the word "none" stands for an absent file
    bool reads_beside = false;  ///< for mesh files: NAME.ant.json beside NAME.ply is read too
    std::vector<Source> sources;

    /// Modifiers of a declaration.
    Slot& optional() { return needed = false, *this; }
    Slot& flag() { return is_positional = false, *this; }  ///< --name FILE
    Slot& many() { return repeated = true, *this; }
    Slot& words() { return takes_words = repeated = true, *this; }
    /// Declares an output as the updated version of an input. Without its own file it is written in place of the input,
    /// and it is produced whenever the input is required or given. The input file need not exist yet (`exists`); a program may
    /// omit it.
    Slot& updates(Slot& input) { return updated = &input, input.may_be_new = true, *this; }
    Slot& named() { return is_named = true, *this; }  ///< NAME=FILE
    /// May be repeated, and "none" stands for an absent entry; query with `has`.
    Slot& many_or_none() { return repeated = takes_none = true, *this; }

    /// Mesh files are read together with the annotation file of the same name.
    Slot& with_annotations_beside() { return reads_beside = true, *this; }

    /// Whether at least one source was given.
    explicit operator bool() const { return !sources.empty(); }
    /// Whether the i-th source can be read.
    [[nodiscard]] bool exists(std::size_t i = 0) const;
    [[nodiscard]] std::size_t size() const { return sources.size(); }
    /// Whether the i-th source was given and is not "none".
    [[nodiscard]] bool has(std::size_t i) const { return i < sources.size() && !sources[i].empty(); }
    /// Name of the i-th file or object, for messages; empty if none was given.
    [[nodiscard]] std::string file(std::size_t i = 0) const { return i < sources.size() ? sources[i].name() : std::string(); }
    [[nodiscard]] std::string file_name(std::size_t i = 0) const { return Path(file(i)).filename().string(); }
    /// NAME of NAME=FILE, or the name of the object.
    [[nodiscard]] std::string label(std::size_t i) const { return sources[i].object ? sources[i].name() : sources[i].label; }

    /// Set by the context before `run`.
    Context* context = nullptr;

    /// Declares the slot's own options, such as --force-mesh for annotations.
    virtual void describe(OptionList& /*options*/) {}
    /// Throws Error (usage) if a file name is invalid for this kind of slot. Called before any work starts.
    virtual void check() const {}
    /// Whether the i-th source is a folder that receives several files.
    [[nodiscard]] virtual bool fills_folder(std::size_t /*i*/) const { return false; }
    /// Called after `run`: turns a file written in memory into the slot's object.
    virtual void finish() {}

protected:
    /// Declares the slot's own options; an option already declared by another slot under the same name is shared with it.
    void describe_shared(OptionList& options, const OptionList& slot_options);
    /// Copies the values of shared options into the slot's own; to be called before those are used.
    void take_shared() const;

private:
    std::vector<std::pair<OptionValue, OptionValue>> shared_;  ///< (option in the operation's list, own option)
};

}  // namespace ostraka

// Objects and slots. A slot is an input or output of an operation; the caller gives a file or an object in memory for it.
// `Operation::run` uses objects only.
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

/// Whether an operation reads or writes the slot.
enum class Role { input, output };

/// The kind of an object, which determines the file formats that can hold the object.
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
    folder,       ///< several files; the documentation page of the operation describes them
    point_cloud,  ///< points without faces
};
std::string to_string(Kind kind);
/// File extensions of a kind, lower case; empty if any extension is allowed.
std::vector<std::string> extensions_of(Kind kind);

/// A shared, immutable object in memory, with its name and the checksum of its source.
class Object {
public:
    Object() = default;
    template <class T>
    explicit Object(std::shared_ptr<const T> data, std::string object_name = {}, std::string checksum = {})
        : name(std::move(object_name)), sha256(std::move(checksum)), data_(std::move(data)), type_(typeid(T)) {}
    /// An object that holds `value`.
    template <class T>
    static Object of(T value, std::string object_name = {}) {
        return Object(std::make_shared<const T>(std::move(value)), std::move(object_name));
    }

    /// The data; null if the data are not of type T.
    template <class T>
    [[nodiscard]] std::shared_ptr<const T> as() const {
        return type_ == typeid(T) ? std::static_pointer_cast<const T>(data_) : nullptr;
    }
    /// True if the object holds data.
    explicit operator bool() const { return data_ != nullptr; }

    std::string name;  ///< the file name used in reports and in files that refer to the object
    /// SHA-256 of the file from which the object was read, or of the object's content; empty if unknown.
    std::string sha256;
    /// Writes the object to a file; set for objects made in memory.
    std::function<void(const Path&)> write;

    /// Checksums of the files that hold an object.
    struct Checksums {
        /// SHA-256 of the object's file, or of the file that `write` would produce; empty if unknown.
        std::string sha256;
        /// Name and SHA-256 of accompanying files, such as the header of coordinates.
        std::vector<std::pair<std::string, std::string>> beside;
    };
    /// The checksums of the object's files, computed once per name and shared between copies of the object.
    [[nodiscard]] const Checksums& checksums() const;

private:
    struct ChecksumCache;
    std::shared_ptr<ChecksumCache> checksum_cache_ = make_checksum_cache();
    static std::shared_ptr<ChecksumCache> make_checksum_cache();
    std::shared_ptr<const void> data_;
    std::type_index type_ = typeid(void);
};

/// One value of a slot: a file name or an object in memory.
struct Source {
    Path file;               ///< empty for an object in memory
    Object object;           ///< empty for a file
    bool in_place = false;   ///< true: the output overwrites the input's file
    std::string label = {};  ///< NAME, if the file was given as NAME=FILE; else empty
    /// File name, or name of the object.
    [[nodiscard]] std::string name() const { return object.name.empty() ? file.string() : object.name; }
    [[nodiscard]] bool empty() const { return file.empty() && !object; }  ///< true: neither file nor object
};

/// An input or output of an operation, declared by Parameters and filled before `run`.
class Slot {
public:
    Slot() = default;
    Slot(const Slot&) = delete;
    Slot& operator=(const Slot&) = delete;
    virtual ~Slot();

    std::string name;                       ///< name of the slot, as flag and as JSON key
    std::string help;                       ///< help text
    Role role = Role::input;                ///< input or output
    Kind kind = Kind::text;                 ///< kind of the objects
    bool needed = true;                     ///< true: the caller must give a file or object
    bool repeated = false;                  ///< true: several files or objects may be given
    bool is_positional = true;              ///< true: given by its position on the command line, not by its name
    bool takes_words = false;               ///< true: several file names may follow the flag
    bool may_be_new = false;                ///< true: the input is updated by an output, and its file need not exist yet
    Slot* updated = nullptr;                ///< for an output: the input slot that it updates; null: none
    bool is_named = false;                  ///< true: files are given as NAME=FILE
    bool takes_none = false;                ///< true: the word "none" stands for an absent file
    bool reads_annotations_beside = false;  ///< for mesh files: true if NAME.ant.json beside NAME.ply is read too
    std::vector<Source> sources;            ///< the given files and objects

    /// Declares that the slot need not be given.
    Slot& optional() { return needed = false, *this; }
    Slot& flag() { return is_positional = false, *this; }  ///< --name FILE
    Slot& many() { return repeated = true, *this; }
    Slot& words() { return takes_words = repeated = true, *this; }
    /// Declares an output as the updated version of an input. An output without its own file is written in place of the input's
    /// file. The output is written if the input is required or given. The input file need not exist yet (`exists`), and a
    /// calling program may omit the input.
    Slot& updates(Slot& input) { return updated = &input, input.may_be_new = true, *this; }
    Slot& named() { return is_named = true, *this; }  ///< NAME=FILE
    /// Declares that the slot may be repeated and that "none" stands for an absent entry; `has(i)` is true for entries that are
    /// present.
    Slot& many_or_none() { return repeated = takes_none = true, *this; }

    /// Declares that mesh files are read together with the annotation files of the same name.
    Slot& with_annotations_beside() { return reads_annotations_beside = true, *this; }

    /// True if at least one file or object was given.
    explicit operator bool() const { return !sources.empty(); }
    /// True if the i-th file or object can be read.
    [[nodiscard]] bool exists(std::size_t i = 0) const;
    [[nodiscard]] std::size_t size() const { return sources.size(); }  ///< number of files and objects given
    /// True if the i-th file or object was given and is not "none".
    [[nodiscard]] bool has(std::size_t i) const { return i < sources.size() && !sources[i].empty(); }
    /// Name of the i-th file or object, for messages; empty if none was given.
    [[nodiscard]] std::string file(std::size_t i = 0) const { return i < sources.size() ? sources[i].name() : std::string(); }
    [[nodiscard]] std::string file_name(std::size_t i = 0) const { return Path(file(i)).filename().string(); }
    /// NAME of NAME=FILE, or the name of the object.
    [[nodiscard]] std::string label(std::size_t i) const { return sources[i].object ? sources[i].name() : sources[i].label; }

    /// The context of the current call; set before Operation::run.
    Context* context = nullptr;

    /// Adds the slot's own options to the options of the operation, such as --force-mesh for annotations.
    virtual void declare_options(OptionList& /*options*/) {}
    /// Throws Error (usage) if a file name is invalid for this kind of slot. The context calls `check` before any work starts.
    virtual void check() const {}
    /// True if the i-th source is a folder that receives several files.
    [[nodiscard]] virtual bool fills_folder(std::size_t /*i*/) const { return false; }
    /// Called after Operation::run: turns a file written in memory into the slot's object.
    virtual void finish() {}

protected:
    /// Adds the slot's own options to `options`; an option that another slot has already added under the same name is shared with
    /// that slot.
    void declare_shared(OptionList& options, const OptionList& slot_options);
    /// Copies the values of shared options into the slot's own options; to be called before the slot's options are used.
    void take_shared() const;

private:
    std::vector<std::pair<OptionValue, OptionValue>> shared_;  ///< (option in the operation's list, own option)
};

}  // namespace ostraka

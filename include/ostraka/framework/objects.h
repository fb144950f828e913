// Inputs and outputs of operations. Each stands for a file or for an object in memory; `Operation::run` works with objects
// only.
#pragma once

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/coords/coordinate_file.h"
#include "ostraka/core/options.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/relation/graph.h"
#include "ostraka/template_package/template.h"

#include <functional>
#include <map>
#include <memory>
#include <optional>
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
    /// Declares an output as the updated version of an input. Without a file of its own it is written in place of the input,
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

// ---- inputs ----

/// A mesh, as a manifold or as the polygons of the file. Remarks of the reader become notes of the report.
class MeshInput : public Slot {
public:
    const MeshFile& operator*() const { return get(0); }
    const MeshFile* operator->() const { return &get(0); }
    [[nodiscard]] const MeshFile& get(std::size_t i) const;
    /// As `get`, but returns the mesh by value, without a copy if nothing else holds it. Invalidates references obtained
    /// earlier.
    [[nodiscard]] MeshFile take(std::size_t i = 0) const;
    /// Polygons of any topology, for operations that do not need a manifold.
    [[nodiscard]] const PolygonSoup& polygons(std::size_t i = 0) const;
    /// As `polygons`, but by value, without a copy if nothing else holds them.
    [[nodiscard]] PolygonSoup take_polygons(std::size_t i = 0) const;
};

/// Checksum of annotations in memory: that of their file without its provenance.
std::string checksum_of(AnnotatedMeshView object);

/// Annotations; adds the option --force-mesh.
class AnnotationsInput : public Slot {
public:
    /// The annotations, which must belong to `mesh`. Remarks of the reader become notes of the report. Throws Error (input) as
    /// read_annotations does.
    [[nodiscard]] const AnnotationSet& on(const Mesh& mesh, std::size_t i = 0) const;
    void describe(OptionList& options) override;

    ReadAnnotationsOptions reading;
};

class GraphInput : public Slot {
public:
    [[nodiscard]] const RelationGraph& on(const AnnotationSet& set) const;
};

/// Coordinates of a mesh with respect to a cage.
class CoordinatesInput : public Slot {
public:
    [[nodiscard]] const Coordinates& of(const Mesh& mesh, const Mesh& cage) const;
};

/// One number per element.
class ValuesInput : public Slot {
public:
    [[nodiscard]] const std::vector<double>& get(std::size_t i = 0) const;
};

/// A JSON document, such as a recipe or an edit.
class JsonInput : public Slot {
public:
    const Json& operator*() const;
};

/// A template with all its parts loaded.
class TemplateInput : public Slot {
public:
    const Template& operator*() const;
    const Template* operator->() const { return &**this; }
    void describe(OptionList& operation_options) override;

    TemplateOptions options;
};

/// Any other kind of file, read by a function that the caller supplies; `load` reads it only once.
class FileInput : public Slot {
public:
    /// The object in memory if it is a T; otherwise the result of `read`, cached for later calls. `key`: whatever else the
    /// result depends on, such as options_text(options) of the reader.
    template <class T>
    [[nodiscard]] const T& load(const std::function<T(const Path&)>& read, std::size_t i = 0, const std::string& key = {}) const {
        if (const auto object = sources.at(i).object.as<T>()) return check_checksum(i), *object;
        return *std::static_pointer_cast<const T>(
            load_any(typeid(T), i, key, [&](const Path& path) { return std::make_shared<const T>(read(path)); }));
    }
    /// Annotations of `mesh` that were given in memory, unchecked; null if there are none.
    [[nodiscard]] std::shared_ptr<const AnnotationSet> annotations_on(const Mesh& mesh) const;
    /// The file's path; an object in memory is written to an in-memory file first.
    [[nodiscard]] Path path(std::size_t i = 0) const;

private:
    /// Throws Error (usage) if the checksum of an object in memory is unknown; provenance requires it.
    void check_checksum(std::size_t i) const;
    using ReadAny = std::function<std::shared_ptr<const void>(const Path&)>;
    [[nodiscard]] std::shared_ptr<const void> load_any(std::type_index type, std::size_t i, const std::string& key,
                                                       const ReadAny& read) const;
};

// ---- outputs: to be produced if the slot has a source; `write` writes the file or keeps the object in memory ----

class MeshOutput : public Slot {
public:
    /// Writes the mesh with the provenance as the file's comment. Reports what the format cannot represent as notes.
    void write(Mesh mesh, MeshExtras extras = {}, WriteOptions options = {}) const;
    /// As above, for triangles of any topology.
    void write(TriangleSoup soup, MeshExtras extras, WriteOptions options = {}) const;
    /// Writes one of several meshes: `ending` is inserted before the file's extension. In memory each part is an object of its
    /// own.
    void write_part(const std::string& ending, Mesh mesh, MeshExtras extras = {}) const;
    /// File of the part with this ending; empty if the output stays in memory.
    [[nodiscard]] std::string part_file(const std::string& ending) const;
    void check() const override;
    void describe(OptionList& options) override;

    /// Adds the option --ascii.
    MeshOutput& with_encoding() { return encoded_ = true, *this; }
    [[nodiscard]] bool ascii() const { return ascii_; }

private:
    void keep(Mesh mesh, MeshExtras extras, WriteOptions options, const std::string& ending) const;
    [[nodiscard]] WriteOptions written(WriteOptions options) const;
    bool encoded_ = false, ascii_ = false;
};

class AnnotationsOutput : public Slot {
public:
    /// `mesh_name`: file name of the mesh that the annotations refer to; `provenance_override`: written instead of that of the
    /// current call.
    void write(AnnotationSet set, const Mesh& mesh, const std::string& mesh_name,
               const std::optional<Provenance>& provenance_override = {}) const;
};

/// A template. Its file refers to the files of its parts; in memory it holds the template with the parts.
class TemplateOutput : public Slot {
public:
    void write(Template package) const;
};

class GraphOutput : public Slot {
public:
    void write(RelationGraph graph, const AnnotationSet& set) const;
};

class CoordinatesOutput : public Slot {
public:
    void write(Coordinates coordinates, const Mesh& mesh, const Mesh& cage, const CoordinateCertificate& certificate) const;
    void check() const override;
};

class ValuesOutput : public Slot {
public:
    void write(std::vector<double> values) const;
};

/// A JSON document; if it is an object, the provenance is appended as its last member.
class JsonOutput : public Slot {
public:
    void write(const JsonValue& document) const;
};

/// Map from old to new indices, `no_index` for removed elements (doc/schema/map.schema.json). All index maps are written here.
struct IndexMap {
    std::string kind;  ///< "vertex", "face" or "face-origin"
    std::vector<Index> map;
    std::size_t to = 0;            ///< number of elements afterwards
    std::string description = {};  ///< may be empty
    bool nearest = false;          ///< matched by distance, not exact
};
class IndexMapOutput : public Slot {
public:
    void write(IndexMap map) const;
};

/// Any other kind of file, written by a function of its own. In memory it holds the bytes (std::string).
class FileOutput : public Slot {
public:
    explicit FileOutput(std::string memory_extension = {}) : extension_(std::move(memory_extension)) {}
    /// Path to write to; call it once all work is done.
    [[nodiscard]] Path path() const;
    void finish() override;
    void write(std::string_view bytes) const { write_file(path(), bytes); }

private:
    friend class Call;
    std::string extension_;  ///< extension of the in-memory file, from which writers choose the format
    mutable Path memory_;
};

/// A folder for several files, created if missing. Files that an earlier run of this operation left in it are removed unless
/// they are written again. In memory it is a folder "memory:...".
class FolderOutput : public Slot {
public:
    /// Creates the folder. Throws Error if it cannot be created or written to. `replaces`: whether to remove files of an
    /// earlier run.
    const Path& open(std::size_t i = 0, bool replaces = true) const;
    /// Path of a file in the folder.
    [[nodiscard]] Path in(const std::string& name, std::size_t i = 0) const;
    [[nodiscard]] Path path() const;
    /// Writes a file into the folder, with the provenance.
    void write(const std::string& name, const Mesh& mesh, const MeshExtras& extras = {}, WriteOptions options = {}) const;
    void write(const std::string& name, AnnotatedMeshView object, const std::string& mesh_name) const;
    void write(const std::string& name, const JsonValue& document) const;
    void check() const override;
    [[nodiscard]] bool fills_folder(std::size_t /*i*/) const override { return true; }
    void finish() override;

protected:
    /// Throws Error (usage) if the name is that of an existing file.
    void check_folder(std::size_t i) const;

private:
    mutable std::map<std::size_t, Path> opened_;
};

}  // namespace ostraka

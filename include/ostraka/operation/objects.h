// The objects that operations take and make: each stands for a file or for an object in memory, and `run` sees objects only.
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

/// What an object is; it says which files hold it.
enum class Kind {
    mesh,
    annotations,
    graph,
    cage,
    coordinates,
    values,     ///< a number for each vertex or face
    labels,     ///< a whole number for each face
    index_map,  ///< new indices of old elements
    edit,
    recipe,
    rules,
    template_package,
    vocabulary,
    shape_class,
    landmarks,
    assembly,
    pose,
    collection,  ///< a folder of objects, or a list of them
    study,       ///< steps to run
    picture,
    table,
    report,
    text,
    folder,  ///< several files, described where the operation is
};
std::string to_string(Kind kind);
/// Endings of the files of a kind, lower case; none: any file.
std::vector<std::string> endings_of(Kind kind);

/// An object in memory, shared, with what it is called and which bytes it was read from.
class Object {
public:
    Object() = default;
    template <class T>
    explicit Object(std::shared_ptr<const T> data, std::string called = {}, std::string checksum = {})
        : name(std::move(called)), sha256(std::move(checksum)), data_(std::move(data)), type_(typeid(T)) {}
    template <class T>
    static Object of(T value, std::string called = {}) {
        return Object(std::make_shared<const T>(std::move(value)), std::move(called));
    }

    /// Null where it is of another type.
    template <class T>
    [[nodiscard]] std::shared_ptr<const T> as() const {
        return type_ == typeid(T) ? std::static_pointer_cast<const T>(data_) : nullptr;
    }
    explicit operator bool() const { return data_ != nullptr; }

    std::string name;    ///< as a file would be called, for reports and files that name it
    std::string sha256;  ///< of the file it was read from, or of what it holds
    /// Writes it as a file of this name; what was made in memory has it.
    std::function<void(const Path&)> write;

    /// SHA-256 of the file of that name, or of what it would be; empty where nothing says it. `beside`: name and checksum of
    /// files that belong to it, such as the header of coordinates.
    struct Checksums {
        std::string sha256;
        std::vector<std::pair<std::string, std::string>> beside;
    };
    /// Made once for all copies of one name.
    [[nodiscard]] const Checksums& checksums() const;

private:
    struct Made;
    std::shared_ptr<Made> made_ = make_made();
    static std::shared_ptr<Made> make_made();
    std::shared_ptr<const void> data_;
    std::type_index type_ = typeid(void);
};

/// What a slot of an operation is filled with: a file's name, or an object.
struct Source {
    Path file;
    Object object;
    bool in_place = false;   ///< an output that takes the place of the input that it brings up to date
    std::string label = {};  ///< NAME of a file that is given as NAME=FILE
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

    std::string name;  ///< as flag and as key
    std::string help;
    Role role = Role::input;
    Kind kind = Kind::text;
    bool needed = true;         ///< must be given
    bool repeated = false;      ///< may be given more than once
    bool is_positional = true;  ///< given by its place on the command line, not by its name
    bool takes_words = false;   ///< several words may follow one flag
    bool may_be_new = false;    ///< an input that is brought up to date: it is begun where there is none yet
    Slot* updated = nullptr;    ///< of an output: the input that it brings up to date
    bool is_named = false;      ///< files are given as NAME=FILE
    bool takes_none = false;    ///< the word "none" holds the place of one that is not there
    bool reads_beside = false;  ///< of mesh files: NAME.ant.json beside NAME.ply is read too
    std::vector<Source> sources;

    /// The modifiers of a declaration.
    Slot& optional() { return needed = false, *this; }
    Slot& flag() { return is_positional = false, *this; }  ///< --name FILE
    Slot& many() { return repeated = true, *this; }
    Slot& words() { return takes_words = repeated = true, *this; }
    /// An output that brings an input up to date: without a file of its own it is written in the input's place, and made wherever
    /// the input is needed or given. The input may be a file that is not there yet (`exists`), or be left out by a program.
    Slot& updates(Slot& input) { return updated = &input, input.may_be_new = true, *this; }
    Slot& named() { return is_named = true, *this; }  ///< NAME=FILE
    /// Repeated, and "none" may be given for one: `has` tells.
    Slot& many_or_none() { return repeated = takes_none = true, *this; }

    /// Mesh files that bring the annotations of their name along.
    Slot& with_annotations_beside() { return reads_beside = true, *this; }

    /// Something was given.
    explicit operator bool() const { return !sources.empty(); }
    /// There is something to read.
    [[nodiscard]] bool exists(std::size_t i = 0) const;
    [[nodiscard]] std::size_t size() const { return sources.size(); }
    /// The i-th was given, and not as "none".
    [[nodiscard]] bool has(std::size_t i) const { return i < sources.size() && !sources[i].empty(); }
    /// The file's name, or the object's, for messages; empty where nothing was given.
    [[nodiscard]] std::string file(std::size_t i = 0) const { return i < sources.size() ? sources[i].name() : std::string(); }
    [[nodiscard]] std::string file_name(std::size_t i = 0) const { return Path(file(i)).filename().string(); }
    /// NAME of NAME=FILE, or the object's name.
    [[nodiscard]] std::string label(std::size_t i) const { return sources[i].object ? sources[i].name() : sources[i].label; }

    /// Set by the context before `run`.
    Context* context = nullptr;

    /// The options that come with the slot, such as --force-mesh with annotations.
    virtual void describe(OptionList& /*options*/) {}
    /// Throws Error (usage) where a name cannot be that of such a file; before any work.
    virtual void check() const {}
    /// The i-th file is a folder that gets several.
    [[nodiscard]] virtual bool fills_folder(std::size_t /*i*/) const { return false; }
    /// After `run`: what was written to a file in memory becomes the object.
    virtual void finish() {}

protected:
    /// Declares the slot's own options; those that another slot declared under the same name are shared with it.
    void describe_shared(OptionList& options, const OptionList& own);
    /// Takes the values of shared options over; before `own` are used.
    void take_shared() const;

private:
    std::vector<std::pair<OptionValue, OptionValue>> shared_;  ///< of the list, own
};

// ---- inputs ----

/// A mesh, as a manifold or as it stands in the file. Notes of reading it are noted.
class MeshInput : public Slot {
public:
    const MeshFile& operator*() const { return get(0); }
    const MeshFile* operator->() const { return &get(0); }
    [[nodiscard]] const MeshFile& get(std::size_t i) const;
    /// The same to keep: without a copy where nobody else has it. What was asked of it before is used up.
    [[nodiscard]] MeshFile take(std::size_t i = 0) const;
    /// Of any topology: what need not be a manifold.
    [[nodiscard]] const PolygonSoup& polygons(std::size_t i = 0) const;
    /// The same to keep: without a copy where nobody else has it.
    [[nodiscard]] PolygonSoup take_polygons(std::size_t i = 0) const;
};

/// Of annotations in memory: that of their file without a provenance.
std::string checksum_of(const AnnotationSet& set, const Mesh& mesh);

/// Annotations; with them comes the option --force-mesh.
class AnnotationsInput : public Slot {
public:
    /// The annotations of this mesh. Notes of reading them are noted. Throws Error (input) as read_annotations does.
    [[nodiscard]] const AnnotationSet& on(const Mesh& mesh, std::size_t i = 0) const;
    void describe(OptionList& options) override;

    ReadAnnotationsOptions reading;
};

class GraphInput : public Slot {
public:
    [[nodiscard]] const RelationGraph& on(const AnnotationSet& set) const;
};

/// Coordinates of a mesh in a cage.
class CoordinatesInput : public Slot {
public:
    [[nodiscard]] const Coordinates& of(const Mesh& mesh, const Mesh& cage) const;
};

/// A number for each element.
class ValuesInput : public Slot {
public:
    [[nodiscard]] const std::vector<double>& get(std::size_t i = 0) const;
};

/// A JSON document, such as a recipe or an edit.
class JsonInput : public Slot {
public:
    const Json& operator*() const;
};

/// A template with all its parts.
class TemplateInput : public Slot {
public:
    const Template& operator*() const;
    const Template* operator->() const { return &**this; }
    void describe(OptionList& list) override;

    TemplateOptions options;
};

/// Anything else that a reader of its own reads: `load` reads it once, whatever operation asks.
class FileInput : public Slot {
public:
    /// What `read` makes of the file, kept for others that ask for it; or the object in memory, if it is a T. `key`: what else it
    /// depends on, such as options_text(options) of the reader.
    template <class T>
    [[nodiscard]] const T& load(const std::function<T(const Path&)>& read, std::size_t i = 0, const std::string& key = {}) const {
        if (const auto object = sources.at(i).object.as<T>()) return check_checksum(i), *object;
        return *std::static_pointer_cast<const T>(
            load_any(typeid(T), i, key, [&](const Path& path) { return std::make_shared<const T>(read(path)); }));
    }
    /// Annotations of the mesh that were given in memory, unchecked; null where there are none.
    [[nodiscard]] std::shared_ptr<const AnnotationSet> annotations_on(const Mesh& mesh) const;
    /// The name of the file (of an object in memory: of one in memory that was written for it).
    [[nodiscard]] Path path(std::size_t i = 0) const;

private:
    /// Throws Error (usage) where an object in memory does not say which bytes it is of: provenance names them.
    void check_checksum(std::size_t i) const;
    using ReadAny = std::function<std::shared_ptr<const void>(const Path&)>;
    [[nodiscard]] std::shared_ptr<const void> load_any(std::type_index type, std::size_t i, const std::string& key,
                                                       const ReadAny& read) const;
};

// ---- outputs: asked for where the slot is filled; `write` writes the file, or keeps the object ----

class MeshOutput : public Slot {
public:
    /// The comment of the file is the provenance. Notes on what the format cannot hold are noted.
    void write(Mesh mesh, MeshExtras extras = {}, WriteOptions options = {}) const;
    /// Triangles of any topology.
    void write(TriangleSoup soup, MeshExtras extras, WriteOptions options = {}) const;
    /// One of several meshes: its file's name ends in this before the extension. In memory they are as many objects.
    void write_part(const std::string& ending, Mesh mesh, MeshExtras extras = {}) const;
    /// The file of such a part; empty in memory.
    [[nodiscard]] std::string part_file(const std::string& ending) const;
    void check() const override;
    void describe(OptionList& options) override;

    /// With it comes the option --ascii.
    MeshOutput& with_encoding() { return encoded_ = true, *this; }
    [[nodiscard]] bool ascii() const { return ascii_; }

private:
    void keep(Mesh mesh, MeshExtras extras, WriteOptions options, const std::string& ending) const;
    [[nodiscard]] WriteOptions written(WriteOptions options) const;
    bool encoded_ = false, ascii_ = false;
};

class AnnotationsOutput : public Slot {
public:
    /// `mesh_name`: of the file of the mesh, which the annotations name; `own`: the provenance, where another call gives the
    /// same.
    void write(AnnotationSet set, const Mesh& mesh, const std::string& mesh_name,
               const std::optional<Provenance>& own = {}) const;
};

/// A template. Its file names its parts, which are where they are; in memory it holds the template with them.
class TemplateOutput : public Slot {
public:
    void write(Template known) const;
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

/// A JSON document; what is written has the provenance as its last member if it is an object.
class JsonOutput : public Slot {
public:
    void write(const JsonValue& document) const;
};

/// Old index -> new index, `no_index` for what is gone (doc/schema/map.schema.json): the one writer of such maps.
struct IndexMap {
    std::string kind;  ///< "vertex", "face" or "face-origin"
    std::vector<Index> map;
    std::size_t to = 0;            ///< elements afterwards
    std::string description = {};  ///< empty: none
    bool nearest = false;          ///< by distance, not exact
};
class IndexMapOutput : public Slot {
public:
    void write(IndexMap map) const;
};

/// Anything else: a file that a writer of its own writes. In memory it holds bytes (std::string).
class FileOutput : public Slot {
public:
    explicit FileOutput(std::string memory_extension = {}) : extension_(std::move(memory_extension)) {}
    /// Where to write it; asked for once all work is done.
    [[nodiscard]] Path path() const;
    void finish() override;
    void write(std::string_view bytes) const { write_file(path(), bytes); }

private:
    friend class Call;
    std::string extension_;  ///< of the file in memory: writers go by it
    mutable Path memory_;
};

/// A folder for several files, made if it is missing; what an earlier run of this operation left in it, and this one does not
/// write again, is removed. In memory it is a folder "memory:...".
class FolderOutput : public Slot {
public:
    /// Makes the folder. Throws Error where it cannot be made or written to. `replaces`: whether what an earlier run left goes.
    const Path& open(std::size_t i = 0, bool replaces = true) const;
    /// A file in it.
    [[nodiscard]] Path in(const std::string& name, std::size_t i = 0) const;
    [[nodiscard]] Path path() const;
    /// Writes such a file, with the provenance.
    void write(const std::string& name, const Mesh& mesh, const MeshExtras& extras = {}, WriteOptions options = {}) const;
    void write(const std::string& name, const AnnotationSet& set, const Mesh& mesh, const std::string& mesh_name) const;
    void write(const std::string& name, const JsonValue& document) const;
    void check() const override;
    [[nodiscard]] bool fills_folder(std::size_t /*i*/) const override { return true; }
    void finish() override;

protected:
    /// Throws Error (usage) where the name is that of a file.
    void check_folder(std::size_t i) const;

private:
    mutable std::map<std::size_t, Path> opened_;
};

}  // namespace ostraka

// Outputs of operations, one class per kind of object. An output is to be produced if its slot has a source; `write` writes the
// file or keeps the object in memory.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/coords/coordinate_file.h"
#include "ostraka/framework/objects.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/relation/graph.h"
#include "ostraka/template_package/template.h"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace ostraka {

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

/// Any other kind of file, written by its own function. In memory it holds the bytes (std::string).
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

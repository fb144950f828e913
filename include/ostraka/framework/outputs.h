// Outputs of operations: one slot class per kind of object. An output is produced if its slot has a source; `write` writes the
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

/// An output that is a mesh.
class MeshOutput : public Slot {
public:
    /// Writes the mesh with the provenance as the file's comment. Notes of the report list data that the file format cannot
    /// represent.
    void write(Mesh mesh, MeshExtras extras = {}, WriteOptions options = {}) const;
    /// Writes triangles of any topology, with the provenance as the file's comment.
    void write(TriangleSoup soup, MeshExtras extras, WriteOptions options = {}) const;
    /// Writes one of several meshes of this output: `suffix` is appended to the file's stem, before its extension. In memory each
    /// of these meshes is a separate object.
    void write_part(const std::string& suffix, Mesh mesh, MeshExtras extras = {}) const;
    /// File name of the mesh written with this suffix; empty if the output stays in memory.
    [[nodiscard]] std::string part_file(const std::string& suffix) const;
    void check() const override;
    void declare_options(OptionList& options) override;

    /// Declares the option --ascii, which selects text or binary encoding.
    MeshOutput& with_ascii_option() { return encoded_ = true, *this; }
    [[nodiscard]] bool ascii() const { return ascii_; }  ///< true: the file is written as text

private:
    void keep(Mesh mesh, MeshExtras extras, WriteOptions options, const std::string& ending) const;
    [[nodiscard]] WriteOptions written(WriteOptions options) const;
    bool encoded_ = false, ascii_ = false;
};

/// An output that is a set of annotations.
class AnnotationsOutput : public Slot {
public:
    /// Writes the annotations. `mesh_name`: file name of the mesh that the annotations refer to; `provenance_override`:
    /// provenance written instead of the provenance of the current call.
    void write(AnnotationSet set, const Mesh& mesh, const std::string& mesh_name,
               const std::optional<Provenance>& provenance_override = {}) const;
};

/// An output that is a template. A template file refers to the files of the template's parts; in memory the object holds the
/// template with all parts.
class TemplateOutput : public Slot {
public:
    void write(Template package) const;
};

/// An output that is a relationship graph.
class GraphOutput : public Slot {
public:
    void write(RelationGraph graph, const AnnotationSet& set) const;
};

/// An output that holds cage coordinates.
class CoordinatesOutput : public Slot {
public:
    void write(Coordinates coordinates, const Mesh& mesh, const Mesh& cage, const CoordinateCertificate& certificate) const;
    void check() const override;
};

/// An output with one number per vertex or face.
class ValuesOutput : public Slot {
public:
    void write(std::vector<double> values) const;
};

/// An output that is a JSON document; if the document is an object, the provenance is appended as its last member.
class JsonOutput : public Slot {
public:
    void write(const JsonValue& document) const;
};

/// Map from old to new indices of vertices or faces (doc/schema/map.schema.json).
struct IndexMap {
    std::string kind;              ///< "vertex", "face" or "face-origin"
    std::vector<Index> map;        ///< for each old element: its new index; `no_index` if it was removed
    std::size_t to = 0;            ///< number of new elements
    std::string description = {};  ///< text for readers of the file; may be empty
    /// True: old elements were matched to the nearest new elements, not to identical elements.
    bool nearest = false;
};
/// The document of an index map, without provenance.
Json to_json(const IndexMap& map);
/// An output that is an index map.
class IndexMapOutput : public Slot {
public:
    void write(IndexMap map) const;  ///< writes the map with provenance
};

/// An output of any other kind, written by a function of the caller. In memory the object holds the bytes (std::string).
class FileOutput : public Slot {
public:
    explicit FileOutput(std::string memory_extension = {}) : extension_(std::move(memory_extension)) {}
    /// Path of the file to write; call this function only when the result is complete.
    [[nodiscard]] Path path() const;
    void finish() override;
    void write(std::string_view bytes) const { write_file(path(), bytes); }

private:
    friend class Call;
    std::string extension_;  ///< extension of the in-memory file; writers choose the format by the extension
    mutable Path memory_;
};

/// An output folder for several files, created if missing. Files that an earlier run of this operation left in the folder are
/// removed unless they are written again. In memory the folder is named "memory:...".
class FolderOutput : public Slot {
public:
    /// Creates the i-th folder. Throws Error if the folder cannot be created or written to. `replaces`: true to remove the files
    /// of an earlier run.
    const Path& open(std::size_t i = 0, bool replaces = true) const;
    /// Path of the file `name` in the i-th folder.
    [[nodiscard]] Path in(const std::string& name, std::size_t i = 0) const;
    [[nodiscard]] Path path() const;  ///< path of the first folder
    /// Writes a mesh file into the folder, with the provenance.
    void write(const std::string& name, const Mesh& mesh, const MeshExtras& extras = {}, WriteOptions options = {}) const;
    /// Writes an annotation file into the folder, with the provenance.
    void write(const std::string& name, AnnotatedMeshView object, const std::string& mesh_name) const;
    /// Writes a JSON file into the folder, with the provenance.
    void write(const std::string& name, const JsonValue& document) const;
    void check() const override;
    [[nodiscard]] bool fills_folder(std::size_t /*i*/) const override { return true; }
    void finish() override;

protected:
    /// Throws Error (usage) if the folder's name is the name of an existing file.
    void check_folder(std::size_t i) const;

private:
    mutable std::map<std::size_t, Path> opened_;
};

}  // namespace ostraka

// Inputs of operations: one slot class per kind of object.
#pragma once

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/coords/coordinates.h"
#include "ostraka/framework/objects.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/relation/graph.h"
#include "ostraka/template_package/template.h"

#include <functional>
#include <memory>
#include <string>
#include <typeindex>
#include <vector>

namespace ostraka {

/// A mesh input, read as a manifold or as the polygons of the file. Remarks of the mesh reader become notes of the report.
class MeshInput : public Slot {
public:
    const MeshFile& operator*() const { return get(0); }
    const MeshFile* operator->() const { return &get(0); }
    [[nodiscard]] const MeshFile& get(std::size_t i) const;  ///< the i-th mesh, read at the first call
    /// The i-th mesh by value; it is not copied if there is no other reference to the mesh. Invalidates references obtained
    /// from `get`.
    [[nodiscard]] MeshFile take(std::size_t i = 0) const;
    /// The i-th mesh as polygons of any topology, for operations that do not need a manifold.
    [[nodiscard]] const PolygonSoup& polygons(std::size_t i = 0) const;
    /// The i-th mesh as polygons by value; they are not copied if there is no other reference to them. Invalidates references
    /// obtained from `polygons`.
    [[nodiscard]] PolygonSoup take_polygons(std::size_t i = 0) const;
};

/// Checksum of annotations in memory: SHA-256 of the annotation file that would be written for them without provenance.
std::string checksum_of(AnnotatedMeshView object);

/// An annotation input; adds the option --force-mesh.
class AnnotationsInput : public Slot {
public:
    /// The i-th annotation set, which must belong to `mesh`. Remarks of the annotation reader become notes of the report. Throws
    /// Error (input) as read_annotations does.
    [[nodiscard]] const AnnotationSet& on(const Mesh& mesh, std::size_t i = 0) const;
    void declare_options(OptionList& options) override;

    ReadAnnotationsOptions reading;  ///< options of the annotation reader
};

/// An input that is a relationship graph.
class GraphInput : public Slot {
public:
    /// The graph, which must belong to `set`.
    [[nodiscard]] const RelationGraph& on(const AnnotationSet& set) const;
};

/// An input that holds cage coordinates.
class CoordinatesInput : public Slot {
public:
    /// The coordinates, which must belong to `mesh` and `cage`.
    [[nodiscard]] const Coordinates& of(const Mesh& mesh, const Mesh& cage) const;
};

/// An input with one number per vertex or face.
class ValuesInput : public Slot {
public:
    /// The numbers of the i-th file or object.
    [[nodiscard]] const std::vector<double>& get(std::size_t i = 0) const;
};

/// An input that is a JSON document, such as a recipe or an edit.
class JsonInput : public Slot {
public:
    const Json& operator*() const;
};

/// An input that is a template, with all its parts loaded.
class TemplateInput : public Slot {
public:
    const Template& operator*() const;
    const Template* operator->() const { return &**this; }
    void declare_options(OptionList& operation_options) override;

    TemplateOptions options;  ///< options of the template reader
};

/// An input of any other kind, read by a function that the caller supplies; `load` reads each file only once.
class FileInput : public Slot {
public:
    /// The i-th object in memory if its type is T; otherwise the result of `read` for the i-th file, cached for later calls.
    /// `key`: text of all other data on which the result depends, such as options_text(options) of the reader.
    template <class T>
    [[nodiscard]] const T& load(const std::function<T(const Path&)>& read, std::size_t i = 0, const std::string& key = {}) const {
        if (const auto object = sources.at(i).object.as<T>()) return check_checksum(i), *object;
        return *std::static_pointer_cast<const T>(
            load_any(typeid(T), i, key, [&](const Path& path) { return std::make_shared<const T>(read(path)); }));
    }
    /// The annotations of `mesh` if they were given in memory, unchecked; null otherwise.
    [[nodiscard]] std::shared_ptr<const AnnotationSet> annotations_on(const Mesh& mesh) const;
    /// The path of the i-th file; an object in memory is first written to an in-memory file.
    [[nodiscard]] Path path(std::size_t i = 0) const;

private:
    /// Throws Error (usage) if the checksum of an object in memory is unknown; provenance requires it.
    void check_checksum(std::size_t i) const;
    using ReadAny = std::function<std::shared_ptr<const void>(const Path&)>;
    [[nodiscard]] std::shared_ptr<const void> load_any(std::type_index type, std::size_t i, const std::string& key,
                                                       const ReadAny& read) const;
};

}  // namespace ostraka

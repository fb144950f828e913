// Inputs of operations, one class per kind of object.
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

}  // namespace ostraka

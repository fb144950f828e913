// The template of an object class as files: a mesh with annotations, relations and deformation data, listed in one file and
// checked as a whole (thesis, section 1.2; doc/templates.md).
#pragma once

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/cage/cage.h"
#include "ostraka/core/options.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/relation/graph.h"
#include "ostraka/vocabulary/class_rules.h"

namespace ostraka {

/// A file of a template.
struct PackagedFile {
    std::string role;    ///< one of template_roles()
    std::string name;    ///< as in the template's file: relative to its folder, with '/'
    Path file;           ///< path of the file
    std::string sha256;  ///< checksum when packed; empty if not stated
};

/// "mesh", "annotations", "graph", "cage", "coordinates", "vocabulary", "rules", "ranges", "landmarks".
const std::vector<std::string>& template_roles();

/// Content of *.template.json: one mesh, any number of cages and coordinates, and at most one part of each other role.
struct TemplateFile {
    std::string object_class, unit;
    std::optional<std::array<double, 3>> up;
    std::vector<PackagedFile> contents;

    [[nodiscard]] std::vector<const PackagedFile*> of(const std::string& role) const;
};

struct TemplateOptions {
    bool allow_outside = false;  ///< parts may lie outside the template's folder
    bool force_mesh = false;     ///< accept annotations of another mesh if their indices and edges fit

    void list_options(OptionList& list);
};

/// Reads a template's file without opening its parts. Throws Error (input) with the file, the JSON pointer and the remedy for:
/// a repeated role, a name that is absolute or leads out of the folder (also through links) unless allowed, a checksum of a
/// file that is not a part.
TemplateFile read_template(const Path& file, const TemplateOptions& options = {});
TemplateFile template_from_json(const JsonValue& document, const Path& folder, const std::string& where,
                                const TemplateOptions& options = {});
Json template_to_json(const TemplateFile& file, const Provenance& provenance);

/// Description of one part of a template.
struct TemplateEntry {
    std::string role, name;
    std::uint64_t bytes = 0;
    std::string text;  ///< "50000 vertices, 100000 faces" ...
};

/// A template with all parts that could be read. Its unit, up direction and class replace those of the annotations.
struct Template {
    TemplateFile file;
    std::optional<MeshFile> mesh;
    std::optional<AnnotationSet> annotations;
    std::optional<RelationGraph> graph;
    std::vector<std::optional<Mesh>> cages;
    std::optional<Vocabulary> vocabulary;
    std::optional<ClassRules> rules;
    std::vector<Finding> findings;  ///< `where` is the file name of the part
    std::vector<TemplateEntry> entries;

    [[nodiscard]] bool sound() const;
};

/// Reads every part and checks them together. Defects: a part that is missing or cannot be parsed, a wrong checksum,
/// annotations that do not fit the mesh, a graph with unknown annotations, tags and attributes that are not in the vocabulary,
/// violated rules of the class, a cage that is not closed, coordinates without a row for each vertex of the mesh or a column
/// for each vertex (or face) of a cage, a unit that differs from that of the annotations. Remarks: contradicting up directions
/// and classes (the template's values are used), a cage that does not enclose the mesh, parts without a checksum. Throws only
/// if memory is exhausted.
Template load_template(TemplateFile file, const TemplateOptions& options = {});

/// Requires a template without defects, and with a mesh: throws Error (input) that names the file and the part.
void check_usable(const Template& loaded, const std::string& file);

/// Name of a part in a template file in `folder`: relative to the folder, with '/'.
std::string part_name(const Path& folder, const Path& part);

/// Copies the parts of a template into a folder, without subfolders, and returns the template there with new checksums; `name`:
/// file name of the new template. Written atomically. Throws Error (input) if two parts have the same name.
TemplateFile copy_template(const TemplateFile& file, const Path& folder, const std::string& name, const Provenance& provenance);

}  // namespace ostraka

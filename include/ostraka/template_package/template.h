// Template packages: the template of an object class as a set of files (a mesh with annotations, relations and deformation
// data). One JSON file lists the files, and they are checked together (thesis, section 1.2; doc/templates.md).
#pragma once

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/cage/cage.h"
#include "ostraka/core/options.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/relation/graph.h"
#include "ostraka/vocabulary/class_rules.h"

namespace ostraka {

/// One file of a template package, here called a part.
struct PackagedFile {
    std::string role;    ///< kind of the part, one of template_roles()
    std::string name;    ///< file name as in the template's JSON file: relative to its folder, with '/'
    Path file;           ///< path of the file
    std::string sha256;  ///< checksum when the template was packed; empty if not stated
};

/// Roles of parts: "mesh", "annotations", "graph", "cage", "coordinates", "vocabulary", "rules", "ranges", "landmarks".
const std::vector<std::string>& template_roles();

/// Content of a template's JSON file (*.template.json): one mesh, any number of cages and coordinates, and at most one part of
/// each other role.
struct TemplateFile {
    std::string object_class, unit;           ///< class of the objects, and unit of the mesh
    std::optional<std::array<double, 3>> up;  ///< upward direction; empty: not stated
    std::vector<PackagedFile> contents;       ///< parts of the template

    [[nodiscard]] std::vector<const PackagedFile*> of(const std::string& role) const;  ///< parts with this role
};

struct TemplateOptions {
    bool allow_outside = false;  ///< true: parts may lie outside the template's folder
    bool force_mesh = false;     ///< true: accept annotations made for another mesh if their indices and edges exist in this mesh

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// Reads the JSON file of a template without opening its parts. Throws Error (input) with the file, the JSON pointer and the
/// remedy for: a repeated role, a name that is absolute or leads out of the folder (also through links) unless allowed, a
/// checksum of a file that is not a part.
TemplateFile read_template(const Path& file, const TemplateOptions& options = {});
/// Reads the JSON document of a template in `folder`, with the checks of read_template; `where` names the file in errors.
TemplateFile template_from_json(const JsonValue& document, const Path& folder, const std::string& where,
                                const TemplateOptions& options = {});
Json template_to_json(const TemplateFile& file, const Provenance& provenance);  ///< content of the JSON file of a template

/// Description of one part of a template, for reports.
struct TemplateEntry {
    std::string role, name;   ///< role and file name of the part
    std::uint64_t bytes = 0;  ///< size of the file
    std::string text;         ///< content of the part, such as "50000 vertices, 100000 faces"
};

/// A template with all parts that could be read. The unit, upward direction and class of the template replace those of the
/// annotations.
struct Template {
    TemplateFile file;                         ///< content of the template's JSON file
    std::optional<MeshFile> mesh;              ///< empty: the mesh could not be read
    std::optional<AnnotationSet> annotations;  ///< empty: none, or not readable
    std::optional<RelationGraph> graph;        ///< empty: none, or not readable
    std::vector<std::optional<Mesh>> cages;    ///< one entry per part of role "cage"; empty: the cage could not be read
    std::optional<Vocabulary> vocabulary;      ///< empty: none, or not readable
    std::optional<ClassRules> rules;           ///< rules of the class; empty: none, or not readable
    std::vector<Finding> findings;             ///< defects and remarks; `where` is the file name of the part
    std::vector<TemplateEntry> entries;        ///< description of each part

    [[nodiscard]] bool sound() const;  ///< true: there is no defect
};

/// Reads every part and checks the parts together. Defects: a part that is missing or cannot be parsed, a wrong checksum,
/// annotations that refer to elements missing in the mesh, a graph that refers to missing annotations, tags and attributes that
/// are not in the vocabulary, violated rules of the class, a cage that is not closed, coordinates that do not have one row per
/// vertex of the mesh and one column per vertex (or face) of a cage, a unit that differs from the unit of the annotations.
/// Remarks: contradicting upward directions and classes (the template's values are used), a cage that does not enclose the
/// mesh, parts without a checksum. Throws only if memory is exhausted.
Template load_template(TemplateFile file, const TemplateOptions& options = {});

/// Throws Error (input) that names the file and the part, unless the template has a mesh and no defects; `file` names the
/// template.
void check_usable(const Template& loaded, const std::string& file);

/// Name of a part in the JSON file of a template in `folder`: path relative to the folder, with '/'.
std::string part_name(const Path& folder, const Path& part);

/// Copies the parts of a template into a folder, without subfolders, and returns the copied template with new checksums; `name`:
/// file name of the new template. Files are written atomically. Throws Error (input) if two parts have the same name.
TemplateFile copy_template(const TemplateFile& file, const Path& folder, const std::string& name, const Provenance& provenance);

}  // namespace ostraka

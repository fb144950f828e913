// The template of a class of objects as files: a mesh, what is said of it, and what deforms it, named by one file that is
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
    std::string name;    ///< as it stands in the template's file: relative to its folder, with '/'
    Path file;           ///< where it is
    std::string sha256;  ///< of its bytes as packed; empty if not stated
};

/// "mesh", "annotations", "graph", "cage", "coordinates", "vocabulary", "rules", "ranges", "landmarks".
const std::vector<std::string>& template_roles();

/// What *.template.json holds. One part of each role at most, but any number of cages and coordinates; one mesh.
struct TemplateFile {
    std::string object_class, unit;
    std::optional<std::array<double, 3>> up;
    std::vector<PackagedFile> contents;

    [[nodiscard]] std::vector<const PackagedFile*> of(const std::string& role) const;
};

struct TemplateOptions {
    bool allow_outside = false;  ///< parts may stand outside the template's folder
    bool force_mesh = false;     ///< annotations made for another mesh are taken if their indices and edges fit

    void describe(OptionList& visit);
};

/// Reads a template's file; its parts are not opened. Throws Error (input) that names the file, the JSON pointer and the remedy:
/// a role given twice, a name that is absolute or leads out of the folder (also over links) unless allowed, a checksum of what is
/// no part.
TemplateFile read_template(const Path& file, const TemplateOptions& options = {});
TemplateFile template_from_json(const JsonValue& document, const Path& folder, const std::string& where,
                                const TemplateOptions& options = {});
Json template_to_json(const TemplateFile& file, const Provenance& provenance);

/// One line of what a template holds.
struct TemplateEntry {
    std::string role, name;
    std::uint64_t bytes = 0;
    std::string text;  ///< "50000 vertices, 100000 faces" ...
};

/// A template with everything that could be read. The template's unit, upward direction and class have taken the place of those
/// of the annotations.
struct Template {
    TemplateFile file;
    std::optional<MeshFile> mesh;
    std::optional<AnnotationSet> annotations;
    std::optional<RelationGraph> graph;
    std::vector<std::optional<Mesh>> cages;
    std::optional<Vocabulary> vocabulary;
    std::optional<ClassRules> rules;
    std::vector<Finding> findings;  ///< `where` is the name of the file of the template
    std::vector<TemplateEntry> entries;

    [[nodiscard]] bool sound() const;
};

/// Reads every part and looks at them together. Defects: a part that is missing or does not parse, a checksum that is not that of
/// the file, annotations that do not fit the mesh, a graph that names annotations that are not there, tags and attributes that
/// are not in the vocabulary, rules of the class that are broken, a cage that is not closed, coordinates without a row for each
/// vertex of the mesh or a column for each vertex (or face) of a cage, a unit that is not that of the annotations. Remarks:
/// upward directions and classes that contradict each other (the template's counts), a cage that does not enclose the mesh, parts
/// without a checksum. Throws only where there is no memory.
Template load_template(TemplateFile file, const TemplateOptions& options = {});

/// For work that needs a template with nothing wrong in it, and a mesh: throws Error (input) that names the file and the part.
void check_usable(const Template& known, const std::string& file);

/// What a template's file in `folder` calls a part: relative to the folder, with '/'.
std::string part_name(const Path& folder, const Path& part);

/// Copies the parts of a template into a folder, flat, and returns the template there, checksums anew; `name` is the file it is
/// to have. Written atomically. Throws Error (input) where two parts have one name.
TemplateFile copy_template(const TemplateFile& file, const Path& folder, const std::string& name, const Provenance& provenance);

}  // namespace ostraka

// Annotation files (*.ant.json): the thesis's Appendix B.1 exactly, with optional additions (doc/annotations.md).
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/core/finding.h"
#include "ostraka/core/options.h"
#include "ostraka/core/provenance.h"

namespace ostraka {

struct ReadAnnotationsOptions {
    bool force_mesh = false;  ///< take the file although it was made for another mesh; indices and edges are checked all the same

    void describe(OptionList& visit);
};

/// Reads the annotations of `mesh`: our files, the thesis's (no format and no mesh member) and, as well as may be and with
/// notes, the prototype's (.ant). Checks the schema, indices, edges, ids, and that the mesh is the one the file was made for.
/// Throws Error (input) that names the file, the JSON pointer and the remedy. Linear in the size of file and selections.
AnnotationSet read_annotations(const Path& file, const Mesh& mesh, const ReadAnnotationsOptions& options = {});

/// The same for a document in memory; `where` stands for the file's name in errors.
AnnotationSet annotations_from_json(const JsonValue& document, const Mesh& mesh, const std::string& where,
                                    const ReadAnnotationsOptions& options = {});

/// Writes the set atomically; the same set, mesh, name and provenance give the same bytes. `mesh_file` is stored without its
/// folder. Throws Error if a selection does not fit the mesh.
void write_annotations(const Path& file, const AnnotationSet& set, const Mesh& mesh, const std::string& mesh_file,
                       const Provenance& provenance);
Json annotations_to_json(const AnnotationSet& set, const Mesh& mesh, const std::string& mesh_file, const Provenance& provenance);

/// Attributes alone, as recipes hold them too; `list` must have passed a schema, pins are not checked. `pointer` is the place of
/// the list in the document.
std::vector<Attribute> attributes_from_json(const JsonValue& list, const std::string& where, const std::string& pointer);

/// Checks a set in memory as reading checks a file: ids, colours, indices, edges, pins. Throws Error (input); `where` is named
/// first.
void check_annotations(const AnnotationSet& set, const Mesh& mesh, const std::string& where);

/// As an annotation file holds it. Throws Error (input) for a checksum of what is no local file.
std::vector<Information> information_from_json(JsonValue::ConstArray list, const std::string& where, const std::string& pointer);

/// Local files that annotations and their attributes refer to, relative to `folder`: defects where one is missing, lies outside
/// of the folder, or its bytes are not those that the checksum is of; remarks where none is known. An array (.npy) of an
/// attribute must have a number for each vertex or for each face of `mesh`, an axis (.json) must be one that was found.
std::vector<Finding> check_files(const AnnotationSet& set, const Mesh& mesh, const Path& folder);

}  // namespace ostraka

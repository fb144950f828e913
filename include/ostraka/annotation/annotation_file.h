// Annotation files (*.ant.json): the format of the thesis's Appendix B.1 with optional additions (doc/annotations.md).
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/core/finding.h"
#include "ostraka/core/options.h"
#include "ostraka/files/provenance.h"

namespace ostraka {

/// Options of `read_annotations`.
struct ReadAnnotationsOptions {
    bool force_mesh = false;  ///< true: accept a file made for another mesh; indices and edges are still checked

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// Reads the annotations of `mesh` from a file of this toolkit, of the thesis (no members "format" and "mesh") or of the
/// thesis's prototype (.ant; notes report content that could not be converted). Checks the schema, indices, edges, ids, and
/// whether the file was made for this mesh. Throws Error (input) with the file, the JSON pointer and the remedy. Time: linear
/// in the size of the file and the selections.
AnnotationSet read_annotations(const Path& file, const Mesh& mesh, const ReadAnnotationsOptions& options = {});

/// Reads the annotations of `mesh` from a JSON document in memory; `where` names the document in error messages.
AnnotationSet annotations_from_json(const JsonValue& document, const Mesh& mesh, const std::string& where,
                                    const ReadAnnotationsOptions& options = {});

/// Writes an annotation file atomically; the same object, mesh file name and provenance give the same bytes. Only the file name
/// of `mesh_file` is stored, not its folder. Throws Error if an annotation selects elements that the mesh does not have.
void write_annotations(const Path& file, AnnotatedMeshView object, const std::string& mesh_file, const Provenance& provenance);
/// Builds the JSON document that `write_annotations` writes.
Json annotations_to_json(AnnotatedMeshView object, const std::string& mesh_file, const Provenance& provenance);

/// Reads a list of attributes from an annotation file or a recipe. `list` must have been validated against a schema; pins are not
/// checked. `pointer`: JSON pointer of the list in the document.
std::vector<Attribute> attributes_from_json(const JsonValue& list, const std::string& where, const std::string& pointer);

/// Checks a set in memory as `read_annotations` checks a file: ids, colours, indices, edges, pins. Throws Error (input) whose
/// message begins with `where`.
void check_annotations(AnnotatedMeshView object, const std::string& where);

/// Reads the `information` of an annotation file. Throws Error (input) if anything other than a local file has a checksum.
std::vector<Information> information_from_json(const JsonValue::ConstArray& list, const std::string& where,
                                               const std::string& pointer);

/// Checks the local files that annotations and their attributes refer to, relative to `folder`. Defects: a file is missing, lies
/// outside the folder or does not match its checksum. Remark: the checksum of a file is unknown. The array (.npy) of an attribute
/// must have one number per vertex or per face of `mesh`; an axis file (.json) must contain an axis.
std::vector<Finding> check_files(AnnotatedMeshView object, const Path& folder);

}  // namespace ostraka

// Annotations in other formats. doc/interchange.md states what each format keeps and loses.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/annotation/annotation_file.h"
#include "ostraka/core/options.h"
#include "ostraka/interchange/landmarks.h"

namespace ostraka {

/// Names of the formats, as used by the commands: "attributes-csv", "landmarks-csv", "tps", "pp", "mrk", "fcsv", "web", "glb",
/// "ant", "fct".
const std::vector<std::string>& interchange_formats();

/// The format of a file by its name, and for .csv by its first line. For a file to be written, `bytes` is empty, and .csv means
/// "attributes-csv". Throws Error (usage) for an unknown extension.
std::string guess_interchange_format(const Path& file, const std::string& bytes = {});

struct ExportOptions {
    LandmarkFileOptions landmarks;

    void describe(OptionList& visit);
};

struct ExportedAnnotations {
    std::string bytes;               ///< contents of the file
    std::vector<std::string> notes;  ///< messages about data that the format cannot store
    std::size_t annotations = 0;     ///< number of annotations in the file
};

/// Exports the annotations in the format. The same object, name and provenance give the same bytes. Throws Error (usage) for an
/// unknown format, Error (input) if the annotations do not fit the mesh.
ExportedAnnotations export_annotations(AnnotatedMeshView object, const std::string& format, const std::string& mesh_file,
                                       const Provenance& provenance, const ExportOptions& options = {});

struct ImportOptions {
    LandmarkFileOptions landmarks;
    PlaceOptions place;

    void describe(OptionList& visit);
};

/// Reads a file of the format, given as `bytes`, onto the mesh. `onto`: the set to which a table of attributes is applied;
/// annotations of other formats are added to it, with a new id if an id is in use (reported by a note). Throws Error (input)
/// with file, position and remedy, Error (usage) for an unknown format or a table of attributes without a set.
PlacedAnnotations import_annotations(const Mesh& mesh, const std::string& bytes, const std::string& format,
                                     const std::string& where, const AnnotationSet* onto = nullptr,
                                     const ImportOptions& options = {});

}  // namespace ostraka

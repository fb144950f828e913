// Export and import of annotations in other formats. doc/interchange.md states what each format keeps and loses.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/annotation/annotation_file.h"
#include "ostraka/core/options.h"
#include "ostraka/interchange/landmarks.h"

namespace ostraka {

/// Names of the exchange formats, as used by the commands: "attributes-csv", "landmarks-csv", "tps", "pp", "mrk", "fcsv", "web",
/// "glb", "ant", "fct".
const std::vector<std::string>& interchange_formats();

/// The name of a file's format, chosen by the file name extension and for .csv by the first line in `bytes`. For a file to be
/// written, `bytes` is empty, and .csv means "attributes-csv". Throws Error (usage) for an unknown extension.
std::string guess_interchange_format(const Path& file, const std::string& bytes = {});

/// Options of `export_annotations`.
struct ExportOptions {
    LandmarkFileOptions landmarks;  ///< options for the landmark formats

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// Result of `export_annotations`.
struct ExportedAnnotations {
    std::string bytes;               ///< contents of the file
    std::vector<std::string> notes;  ///< messages about data that the format cannot store
    std::size_t annotations = 0;     ///< number of annotations in the file
};

/// Exports the annotations of a mesh in the given format. The same object, mesh file name and provenance give the same bytes.
/// Throws Error (usage) for an unknown format, Error (input) if an annotation refers to elements that the mesh does not have.
ExportedAnnotations export_annotations(AnnotatedMeshView object, const std::string& format, const std::string& mesh_file,
                                       const Provenance& provenance, const ExportOptions& options = {});

/// Options of `import_annotations`.
struct ImportOptions {
    LandmarkFileOptions landmarks;  ///< options for the landmark formats
    PlaceOptions place;             ///< options for placing points on the mesh

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// Reads annotations from the `bytes` of a file and places them on the mesh. `onto`: existing set of annotations. A table of
/// attributes sets attributes of its annotations; annotations from other formats are added to it; an annotation whose id is in
/// use gets a new id, and a note reports it. Throws Error (input) with file, position and remedy, Error (usage) for an unknown
/// format or a table of attributes without a set.
PlacedAnnotations import_annotations(const Mesh& mesh, const std::string& bytes, const std::string& format,
                                     const std::string& where, const AnnotationSet* onto = nullptr,
                                     const ImportOptions& options = {});

}  // namespace ostraka

// Annotations in the formats of others. doc/interchange.md says what each keeps and what it loses.
#pragma once

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/core/options.h"
#include "ostraka/interchange/landmarks.h"

namespace ostraka {

/// Names of formats, as the commands take them: "attributes-csv", "landmarks-csv", "tps", "pp", "mrk", "fcsv", "web", "glb",
/// "ant", "fct".
const std::vector<std::string>& interchange_formats();

/// The format of a file by its name, and for .csv by its first line. `bytes` is empty for a file to be written: then .csv is
/// "attributes-csv". Throws Error (usage) for an unknown ending.
std::string guess_interchange_format(const Path& file, const std::string& bytes = {});

struct ExportOptions {
    LandmarkFileOptions landmarks;

    void describe(OptionList& visit);
};

struct ExportedAnnotations {
    std::string bytes;               ///< of the file
    std::vector<std::string> notes;  ///< what the format does not hold, in words
    std::size_t annotations = 0;     ///< how many of the set are in it
};

/// The set as a file of the format. The same set, mesh, name and provenance give the same bytes. Throws Error (usage) for an
/// unknown format, Error (input) if the set does not fit the mesh.
ExportedAnnotations export_annotations(const Mesh& mesh, const AnnotationSet& set, const std::string& format,
                                       const std::string& mesh_file, const Provenance& provenance,
                                       const ExportOptions& options = {});

struct ImportOptions {
    LandmarkFileOptions landmarks;
    PlaceOptions place;

    void describe(OptionList& visit);
};

/// Reads `bytes` of a file of the format onto the mesh. `onto` is the set that a table of attributes belongs to; what other
/// formats hold is added to it, with new ids where an id is taken (a note says so). Throws Error (input) naming file, place and
/// remedy, Error (usage) for an unknown format or a table of attributes without a set.
PlacedAnnotations import_annotations(const Mesh& mesh, const std::string& bytes, const std::string& format,
                                     const std::string& where, const AnnotationSet* onto = nullptr,
                                     const ImportOptions& options = {});

}  // namespace ostraka

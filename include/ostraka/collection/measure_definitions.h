// Measures that are defined once, on annotations or landmarks, and taken on every object of a collection.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/collection/measure_table.h"
#include "ostraka/collection/objects.h"
#include "ostraka/vocabulary/tag_matcher.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace ostraka {

/// A direction: the object's up direction, or coordinates.
struct MeasureDirection {
    bool up = false;
    std::array<double, 3> coordinates{0, 0, 1};
};

/// Position of a pin: the point annotation with this tag ("TAG 2": its second point) or the landmark with this name; with
/// `extreme`, the vertex of the annotation that is farthest along a direction.
struct MeasurePlace {
    std::string name;
    std::optional<MeasureDirection> extreme;
};

struct MeasureDefinition {
    std::string name;
    std::string tool;                ///< "ruler", "tape", "bounding"; empty for attributes and descriptors
    std::string annotation;          ///< tag of the measured annotation; empty: the whole object
    std::vector<MeasurePlace> pins;  ///< pins of a ruler or tape, in order
    MeasureDirection direction;      ///< direction of a bounding measure
    bool exact = false;              ///< tape only: geodesic over the faces instead of a path along edges
    std::string attribute;           ///< name of a measure or descriptor stored in the annotation
    std::string descriptor;          ///< name of a descriptor computed from the annotation (measure/descriptors.h)
    std::string clay;                ///< "max" or "min": clay volume of the whole object (slicing/clay.h)
    int entry = 1;                   ///< 1-based index of the number if the value is a list
};

struct MeasureDefinitions {
    std::vector<MeasureDefinition> measures;
    std::string text;  ///< text of the file; part of the keys of results that depend on it
};

/// Reads a *.measures.json (doc/schema/measures.schema.json). Throws Error (input), naming the JSON pointer, if the file does
/// not match the schema, a name occurs twice, or a direction has length zero.
MeasureDefinitions read_measure_definitions(const Path& file);
MeasureDefinitions measure_definitions_from_text(const std::string& text, const std::string& where);

/// The measures of one object.
struct ObjectMeasures {
    std::string unit;                           ///< unit of the object's lengths, if a file or the collection gives it
    std::vector<std::optional<double>> values;  ///< one per definition; missing if the measure cannot be taken
    std::vector<int> powers;                    ///< one per definition: power of the unit of length
    std::vector<std::string> units;             ///< one per definition: unit of a value that is not a power of a length
    std::vector<std::string> notes;             ///< messages that explain missing values
};

/// Takes the measures of an object from its files. The mesh is read only if a measure needs it. A measure that cannot be taken
/// (no such annotation, no path, no direction) is missing, with a note. Annotations are selected by exact tag; if none has this
/// tag, `words` selects annotations whose tag has the same meaning. Throws Error (input) if a required file cannot be read or
/// if no measure can be taken.
ObjectMeasures take_measures(const CollectionObject& object, const MeasureDefinitions& definitions,
                             const TagMatcher* words = nullptr);

/// The same for a mesh with annotations in memory.
ObjectMeasures take_measures(AnnotatedMeshView object, const MeasureDefinitions& definitions, const TagMatcher* words = nullptr);

Json object_measures_to_json(const ObjectMeasures& measures);
ObjectMeasures object_measures_from_json(const JsonValue& value);

/// Table of the measures. Objects without measures (nullopt: they failed) are left out. If the power of a measure differs
/// between objects, the measure is missing in the objects that differ from the majority, and `notes` reports it.
MeasureTable measure_table(const std::vector<std::string>& names, const std::vector<std::optional<ObjectMeasures>>& objects,
                           const MeasureDefinitions& definitions, std::vector<std::string>& notes);

/// The measures of every object of a collection, as JSON. Results are kept in the store.
std::vector<ObjectResult> take_measures(const Collection& collection, const MeasureDefinitions& definitions,
                                        const ResultStore& store = ResultStore(), const TagMatcher* words = nullptr,
                                        const std::string& words_checksum = {});
/// Table of the measures in `taken`. A note that applies to several objects is reported once. Throws Error (input) if no object
/// could be measured; `where` names the source of the collection in error messages.
MeasureTable measure_table(const Collection& collection, const std::vector<ObjectResult>& results,
                           const MeasureDefinitions& definitions, std::vector<std::string>& notes, const std::string& where);

/// Reads a table from a CSV file. The first column holds the names of the objects; every other column holds a measure and is
/// headed "arm length" or "arm length [mm]". Empty cells and "-" are missing values. A column "unit" gives the unit of each
/// object's lengths. A power of a length in brackets ([cm^2]) marks an area or volume; any other bracket, also [-], marks a
/// value that is not a length. Throws Error (input), naming line and column; a first line that contains numbers (a table
/// without headings) is an error.
MeasureTable read_measure_table(const Path& file);
/// Writes the table as CSV that `read_measure_table` can read.
std::string measure_table_to_csv(const MeasureTable& table);

}  // namespace ostraka

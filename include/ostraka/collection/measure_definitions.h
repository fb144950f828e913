// Definitions of measures on annotations or landmarks, which are then taken on every object of a collection.
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

/// Direction of a measure: the object's up direction, or given coordinates.
struct MeasureDirection {
    bool up = false;                             ///< true: the object's up direction; false: `coordinates`
    std::array<double, 3> coordinates{0, 0, 1};  ///< used unless `up`
};

/// Position of a pin of a measure: the point annotation with the tag `name` ("TAG 2": its second point), the landmark of this
/// name, or, with `extreme`, the vertex of the annotation that is farthest along a direction.
struct MeasurePlace {
    std::string name;  ///< tag of a point annotation, or name of a landmark
    /// The pin is the vertex of the annotation farthest along this direction; none: the point itself.
    std::optional<MeasureDirection> extreme;
};

/// Definition of one measure.
struct MeasureDefinition {
    std::string name;                ///< name of the measure: heading of its column in the table
    std::string tool;                ///< "ruler", "tape", "bounding"; empty for attributes and descriptors
    std::string annotation;          ///< tag of the measured annotation; empty: the whole object
    std::vector<MeasurePlace> pins;  ///< pins of a ruler or tape, in order
    MeasureDirection direction;      ///< direction of a bounding measure
    bool exact = false;              ///< tape only: true for an exact geodesic over the faces, false for a path along edges
    std::string attribute;           ///< name of a measure or descriptor stored in the annotation; empty for other measures
    /// Name of a descriptor computed from the annotation (measure/descriptors.h); empty for other measures.
    std::string descriptor;
    /// "max" or "min" clay volume of the whole object (slicing/clay.h); empty for other measures.
    std::string clay;
    int entry = 1;  ///< index (from 1) of the number that is used if the value is a list of numbers
};

/// The content of a *.measures.json file.
struct MeasureDefinitions {
    std::vector<MeasureDefinition> measures;  ///< the definitions, in the order of the file
    std::string text;                         ///< text of the file; stored results are found by keys that include this text
};

/// Reads a *.measures.json (doc/schema/measures.schema.json). Throws Error (input), naming the JSON pointer, if the file does
/// not match the schema, a name occurs twice, or a direction has length zero.
MeasureDefinitions read_measure_definitions(const Path& file);
/// Parses the text of a *.measures.json file; `where` names its source in error messages.
MeasureDefinitions measure_definitions_from_text(const std::string& text, const std::string& where);

/// The measures of one object.
struct ObjectMeasures {
    std::string unit;  ///< unit of the object's lengths; empty if neither a file nor the collection gives it
    std::vector<std::optional<double>> values;  ///< value of each definition; none if the measure cannot be taken
    std::vector<int> powers;  ///< one per definition: 1 for a length, 2 for an area, 3 for a volume, 0 for other quantities
    std::vector<std::string> units;  ///< one per definition: unit of a value that is not a length, an area or a volume
    std::vector<std::string> notes;  ///< messages that explain missing values
};

/// Takes the defined measures on an object, which is read from its files. The mesh is read only if a measure needs it. A
/// measure that cannot be taken (no such annotation, no path, no direction) is missing, with a note. Annotations are selected
/// by exact tag; if no annotation has the tag, `words` selects annotations whose tags have the same meaning. Throws Error
/// (input) if a required file cannot be read or if no measure can be taken.
ObjectMeasures take_measures(const CollectionObject& object, const MeasureDefinitions& definitions,
                             const TagMatcher* words = nullptr);

/// Takes the defined measures on an annotated mesh in memory; otherwise like `take_measures` for a CollectionObject.
ObjectMeasures take_measures(AnnotatedMeshView object, const MeasureDefinitions& definitions, const TagMatcher* words = nullptr);

/// Measures of an object as JSON for the result store.
Json object_measures_to_json(const ObjectMeasures& measures);
/// Inverse of `object_measures_to_json`.
ObjectMeasures object_measures_from_json(const JsonValue& value);

/// Table of the measures of all objects, in the order of `names`. Objects that failed (nullopt) are left out. If a measure is,
/// for example, a length in some objects and an area in others, it counts as missing in the objects that differ from the
/// majority, and `notes` reports the difference.
MeasureTable measure_table(const std::vector<std::string>& names, const std::vector<std::optional<ObjectMeasures>>& objects,
                           const MeasureDefinitions& definitions, std::vector<std::string>& notes);

/// Takes the measures of every object of a collection; the results, as JSON, are also kept in `store`.
std::vector<ObjectResult> take_measures(const Collection& collection, const MeasureDefinitions& definitions,
                                        const ResultStore& store = ResultStore(), const TagMatcher* words = nullptr,
                                        const std::string& words_checksum = {});
/// Table of the measures in `results` (the result of `take_measures` of a collection). A note that applies to several objects is
/// reported once. Throws Error (input) if no object could be measured; `where` names the source of the collection in error
/// messages.
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

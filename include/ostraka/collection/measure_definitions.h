// Measures defined once on annotations or landmarks, taken on every object of a collection.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/collection/measure_table.h"
#include "ostraka/collection/objects.h"
#include "ostraka/vocabulary/tag_words.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace ostraka {

/// A direction of the object: its own up, or coordinates.
struct MeasureDirection {
    bool up = false;
    std::array<double, 3> coordinates{0, 0, 1};
};

/// Where a pin is set: the point annotation of this tag ("TAG 2": its second point), or the landmark of this name; with
/// `extreme`, the vertex of the annotation that is farthest along a direction.
struct MeasurePlace {
    std::string name;
    std::optional<MeasureDirection> extreme;
};

struct MeasureDefinition {
    std::string name;
    std::string tool;                ///< "ruler", "tape", "bounding"; empty for attributes and descriptors
    std::string annotation;          ///< tag of the annotation that is measured; empty: the whole object
    std::vector<MeasurePlace> pins;  ///< of ruler and tape, in their order
    MeasureDirection direction;      ///< of a bounding measure
    bool exact = false;              ///< of a tape: over the faces instead of along edges
    std::string attribute;           ///< of the annotation: a measure or descriptor that it carries
    std::string descriptor;          ///< computed of the annotation (measure/descriptors.h)
    std::string clay;                ///< "max" or "min": volume of clay of the whole object (slicing/clay.h)
    int entry = 1;                   ///< which number of a list, from 1
};

struct MeasureDefinitions {
    std::vector<MeasureDefinition> list;
    std::string text;  ///< of the file, for keys of results that depend on it
};

/// Reads a *.measures.json (doc/schema/measures.schema.json). Throws Error (input) that names the JSON pointer for what does not
/// fit the schema, a name that comes twice, a direction without length.
MeasureDefinitions read_measure_definitions(const Path& file);
MeasureDefinitions measure_definitions_from_text(const std::string& text, const std::string& where);

/// The measures of one object.
struct ObjectMeasures {
    std::string unit;                           ///< of its lengths, where a file or the collection says
    std::vector<std::optional<double>> values;  ///< one a definition
    std::vector<int> powers;                    ///< of the unit of length, one a definition
    std::vector<std::string> units;             ///< of values that are no power of a length
    std::vector<std::string> notes;             ///< why a value is missing, in words
};

/// Takes the measures of an object from its files; the mesh is read only where a measure needs it. A measure that cannot be taken
/// (no such annotation, no path, no direction) is missing, with a note. Annotations are those of the tag; with `words`, where
/// none has it to the letter, those whose tag means it. Throws Error (input) if a file that is needed cannot be read, or if no
/// measure at all can be taken.
ObjectMeasures take_measures(const CollectionObject& object, const MeasureDefinitions& definitions,
                             const TagWords* words = nullptr);

/// The same on a mesh with annotations in memory.
ObjectMeasures take_measures(const Mesh& mesh, const AnnotationSet& set, const MeasureDefinitions& definitions,
                             const TagWords* words = nullptr);

Json object_measures_to_json(const ObjectMeasures& measures);
ObjectMeasures object_measures_from_json(const JsonValue& value);

/// Objects without measures (nullopt: they failed) are left out. A measure whose power differs between objects is missing in
/// those that differ from most; `notes` says so.
MeasureTable measure_table(const std::vector<std::string>& names, const std::vector<std::optional<ObjectMeasures>>& objects,
                           const MeasureDefinitions& definitions, std::vector<std::string>& notes);

/// The measures of every object of a collection, as JSON; results are kept in the store.
std::vector<ObjectResult> take_measures(const Collection& collection, const MeasureDefinitions& definitions,
                                        const ResultStore& store = ResultStore(), const TagWords* words = nullptr,
                                        const std::string& words_checksum = {});
/// Their table. What the same note says of several objects is one note. Throws Error (input) where not one object could be
/// measured; `where` is what the collection was read from.
MeasureTable measure_table(const Collection& collection, const std::vector<ObjectResult>& taken,
                           const MeasureDefinitions& definitions, std::vector<std::string>& notes, const std::string& where);

/// A table from a CSV file: first the column of names, then a column a measure, headed "arm length" or "arm length [mm]"; empty
/// cells and "-" are missing. A column "unit" gives the unit of each object's lengths. Brackets of the powers of a length
/// ([cm^2]) make areas and volumes; other brackets and [-] make values without a length. Throws Error (input) naming line and
/// column, also for a first line with numbers in it: a table without headings.
MeasureTable read_measure_table(const Path& file);
/// The same as CSV, to be read back.
std::string measure_table_to_csv(const MeasureTable& table);

}  // namespace ostraka

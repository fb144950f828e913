// Relationships determined by the geometry of annotated parts, each with its measured deviation and a tolerance.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/axis/axis.h"
#include "ostraka/core/options.h"
#include "ostraka/relation/check.h"
#include "ostraka/relation/topology.h"

#include <memory>

namespace ostraka {

/// Measures relationships on one object. Data of a part (axis, samples, search tree) are computed once. The meter is not
/// thread-safe. The annotation object must outlive the meter.
class RelationMeter {
public:
    explicit RelationMeter(AnnotatedMeshView object, const RelationOptions& options = {});
    ~RelationMeter();

    /// Measures one relationship of any geometric type other than containment, equal selections and adjacency. Tolerances stated
    /// in the relationship override the tolerances of the options. doc/relations.md describes what each type measures.
    RelationCheck measure(const Relationship& relationship);

    /// All geometric relationships that hold between annotations of the set, without the annotation of the whole object;
    /// doc/relations.md describes the candidates. `types`: the requested types (all types if empty). Ids count up from
    /// `first_id`. At most 10000 relationships of a type are returned; if a type is expensive to measure, only the most similar
    /// pairs are measured, and `notes` reports the omission.
    std::vector<Relationship> extract(const std::vector<std::string>& types, int first_id,
                                      std::vector<std::string>* notes = nullptr);

private:
    friend class RelationCandidates;
    struct State;
    std::unique_ptr<State> state_;
};

/// The relationships determined by the selections and the geometry of an annotated mesh.
struct ExtractedRelations {
    RelationGraph graph;      ///< stated relationships, followed by the extracted ones with fresh ids
    ContainmentOrder order;   ///< containment of the annotations
    std::vector<int> stated;  ///< ids of stated relationships that were also extracted and therefore not added a second time
    /// Types that were not extracted, since they need an upward direction and the set states none.
    std::vector<std::string> skipped_types;
    std::vector<std::string> notes;  ///< messages about relationships that were omitted because of the limits on their number
};

/// Extracts all relationships of these types (all geometric types if `types` is empty) that hold, and keeps the relationships of
/// `old` that were not extracted. Throws Error (usage) for a type that is not geometric.
ExtractedRelations extract_relations(AnnotatedMeshView object, const RelationGraph& old = {},
                                     const std::vector<std::string>& types = {}, const RelationOptions& options = {});

/// Converts type names to their canonical spelling. Throws Error (usage), with the most similar name, for a type that is not
/// geometric.
std::vector<std::string> geometric_types(const std::vector<std::string>& names);

/// The axis of a part for relationships between axes: the axis of its slices if the part is longer than wide and not bent;
/// otherwise its axis of rotation, or the shortest principal axis of a flat round part.
Axis axis_of_part(const Mesh& mesh, const Annotation& annotation);

/// The quantities that RelationMeter measures for a type, e.g. {"angle", "distance"}; empty for types that it does not measure.
std::vector<std::string> measured_quantities(const std::string& type);

}  // namespace ostraka

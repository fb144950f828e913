// Relationships determined by the geometry of the parts, each with its measured deviation and a tolerance.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/axis/axis.h"
#include "ostraka/core/options.h"
#include "ostraka/relation/check.h"
#include "ostraka/relation/topology.h"

#include <memory>

namespace ostraka {

/// Measures relationships on one object. Data of a part (axis, samples, search tree) is computed once. Not thread-safe. The
/// object must outlive it.
class RelationMeter {
public:
    explicit RelationMeter(AnnotatedMeshView object, const RelationOptions& options = {});
    ~RelationMeter();

    /// Measures one relationship of a geometric type except containment, equal selections and adjacency. Tolerances stated in
    /// the relationship override those of the options. doc/relations.md describes what each type measures.
    RelationCheck measure(const Relationship& relationship);

    /// All relationships that hold between annotations of the set, except the root; doc/relations.md describes the candidates.
    /// `types`: the requested types (all if empty). Ids count up from `first_id`. At most 10000 relationships of a type are
    /// returned; of pairs that are expensive to measure only the most similar are measured, and `notes` reports that.
    std::vector<Relationship> extract(const std::vector<std::string>& types, int first_id,
                                      std::vector<std::string>* notes = nullptr);

private:
    friend class RelationCandidates;
    struct State;
    std::unique_ptr<State> state_;
};

/// The relationships determined by the selections and the geometry of an annotated mesh.
struct ExtractedRelations {
    RelationGraph graph;  ///< stated relationships, followed by the extracted ones with fresh ids
    ContainmentOrder order;
    std::vector<int> stated;                  ///< ids of stated relationships that were also extracted, and not added again
    std::vector<std::string> not_looked_for;  ///< types skipped because they need an upward direction, which the set does not
                                              ///< have
    std::vector<std::string> notes;           ///< reports what was omitted because of the limits on number
};

/// Extracts all relationships of these types (all if empty) that hold, and keeps those of `old` that were not extracted. Throws
/// Error (usage) for a type that is not geometric.
ExtractedRelations extract_relations(AnnotatedMeshView object, const RelationGraph& old = {},
                                     const std::vector<std::string>& types = {}, const RelationOptions& options = {});

/// The types in their canonical spelling. Throws Error (usage), with the most similar name, for a type that is not geometric.
std::vector<std::string> geometric_types(const std::vector<std::string>& names);

/// The axis of a part used by relationships about axes: the axis of its slices if the part is longer than wide and not bent;
/// otherwise its axis of rotation, or the shortest principal axis of a flat round part.
Axis axis_of_part(const Mesh& mesh, const Annotation& annotation);

/// The quantities that a type measures, e.g. {"angle", "distance"}; empty for types that are not measured here.
std::vector<std::string> measured_quantities(const std::string& type);

}  // namespace ostraka

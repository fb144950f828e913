// Relationships that the geometry of the parts tells, each with a tolerance and its measured deviation.
#pragma once

#include "ostraka/axis/axis.h"
#include "ostraka/core/options.h"
#include "ostraka/relation/check.h"
#include "ostraka/relation/topology.h"

#include <memory>

namespace ostraka {

/// Measures relationships on one mesh; what it needs of a part (axis, samples, search tree) is made once. Not for use by several
/// threads at a time. Mesh and set must outlive it.
class RelationMeter {
public:
    RelationMeter(const Mesh& mesh, const AnnotationSet& set, const RelationOptions& options = {});
    ~RelationMeter();

    /// One relationship of a geometric type other than containment, equal selections and adjacency. Tolerances that it states
    /// take the place of those of the options. doc/relations.md says what each type measures.
    RelationCheck measure(const Relationship& relationship);

    /// All that hold between annotations of the set, except the root; see doc/relations.md for the candidates. `types` names
    /// those wanted (all if empty). Ids count up from `first_id`. At most 10000 of a type; of pairs that take long to measure the
    /// most alike: `notes` then says so.
    std::vector<Relationship> extract(const std::vector<std::string>& types, int first_id,
                                      std::vector<std::string>* notes = nullptr);

private:
    friend class RelationCandidates;
    struct State;
    std::unique_ptr<State> state_;
};

/// What selections and geometry tell of an annotated mesh.
struct ExtractedRelations {
    RelationGraph graph;  ///< what was stated, then what was found, with fresh ids
    ContainmentOrder order;
    std::vector<int> stated;                  ///< ids of stated relationships that were found too, and not added again
    std::vector<std::string> not_looked_for;  ///< types that need an upward direction, which the set does not have
    std::vector<std::string> notes;           ///< what was left out of very many
};

/// All relationships that hold, of these types (all if empty), beside those of `old` that were not extracted. Throws Error
/// (usage) for a type that geometry does not tell.
ExtractedRelations extract_relations(const Mesh& mesh, const AnnotationSet& set, const RelationGraph& old = {},
                                     const std::vector<std::string>& types = {}, const RelationOptions& options = {});

/// The types under their own spelling. Throws Error (usage), with the nearest name, for one that geometry does not tell.
std::vector<std::string> geometric_types(const std::vector<std::string>& names);

/// The axis of a part that relationships about axes measure: of its slices where it is longer than wide and not bent, else of
/// rotation, or the shortest principal axis of what is flat and round.
Axis axis_of_part(const Mesh& mesh, const Annotation& annotation);

/// The quantities that a type measures, e.g. {"angle", "distance"}; none for types that are not measured here.
std::vector<std::string> measured_quantities(const std::string& type);

}  // namespace ostraka

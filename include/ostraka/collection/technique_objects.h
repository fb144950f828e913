// The measures of technique of every object of a collection.
#pragma once

#include "ostraka/collection/object_part.h"
#include "ostraka/collection/technique_study.h"

namespace ostraka {

/// Measures every object, or a part of it, across `up`; without it across the upward direction of its annotations, else z.
/// Results are kept in the store.
std::vector<ObjectResult> measure_technique(const Collection& collection, const std::optional<std::array<double, 3>>& up,
                                            const TechniqueOptions& options = {}, const ResultStore& store = ResultStore(),
                                            const ObjectParts& parts = ObjectParts());

/// Those that could be measured.
std::vector<TechniqueObject> technique_objects(const Collection& collection, const std::vector<ObjectResult>& measured);

/// Upward directions that nobody gave, and that differ from the annotations' by more than half a degree, in words.
std::vector<std::string> notes_on_directions(const Collection& collection, const std::vector<ObjectResult>& measured);

}  // namespace ostraka

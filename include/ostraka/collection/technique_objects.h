// Technique measures of every object of a collection.
#pragma once

#include "ostraka/collection/object_part.h"
#include "ostraka/collection/technique_study.h"

namespace ostraka {

/// Measures every object, or a part of it, across `up`; without `up`, across the up direction of its annotations, otherwise z.
/// Results are kept in the store.
std::vector<ObjectResult> measure_technique(const Collection& collection, const std::optional<std::array<double, 3>>& up,
                                            const TechniqueOptions& options = {}, const ResultStore& store = ResultStore(),
                                            const ObjectParts& parts = ObjectParts());

/// The objects that could be measured.
std::vector<TechniqueObject> technique_objects(const Collection& collection, const std::vector<ObjectResult>& measured);

/// Notes on objects whose up direction was assumed to be z, and on objects whose annotations differ from the given up direction
/// by more than half a degree.
std::vector<std::string> notes_on_directions(const Collection& collection, const std::vector<ObjectResult>& measured);

}  // namespace ostraka

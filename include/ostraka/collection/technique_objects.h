// Technique measures of every object of a collection.
#pragma once

#include "ostraka/collection/object_part.h"
#include "ostraka/collection/technique_study.h"

namespace ostraka {

/// Measures the forming technique of every object, or of a part of every object, on slices across `up`. If `up` is not given, the
/// up direction in the object's annotations is used, or else z. Results are kept in `store`.
std::vector<ObjectResult> measure_technique(const Collection& collection, const std::optional<std::array<double, 3>>& up,
                                            const TechniqueOptions& options = {}, const ResultStore& store = ResultStore(),
                                            const ObjectParts& parts = ObjectParts());

/// The objects that could be measured, with labels and measures.
std::vector<TechniqueObject> technique_objects(const Collection& collection, const std::vector<ObjectResult>& measured);

/// Notes about objects whose up direction was assumed to be z, and about objects whose annotations give an up direction that
/// differs from the given one by more than half a degree.
std::vector<std::string> notes_on_directions(const Collection& collection, const std::vector<ObjectResult>& measured);

}  // namespace ostraka

// Which region lies on top where several cover a face.
#pragma once

#include "ostraka/annotation/annotation.h"

#include <algorithm>

namespace ostraka {

/// The regions of a set, largest area first; of equal ones the later in the set first, so that painting them in this order leaves
/// the smallest, then the earliest, on top.
inline std::vector<const Annotation*> regions_largest_first(const Mesh& mesh, const AnnotationSet& set) {
    std::vector<std::pair<double, const Annotation*>> regions;
    for (auto annotation = set.annotations.rbegin(); annotation != set.annotations.rend(); ++annotation) {
        if (annotation->type != AnnotationType::region) continue;
        regions.emplace_back(area_of(mesh, annotation->faces), &*annotation);
    }
    std::stable_sort(regions.begin(), regions.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    std::vector<const Annotation*> order;
    order.reserve(regions.size());
    for (const auto& [area, annotation] : regions) order.push_back(annotation);
    return order;
}

}  // namespace ostraka

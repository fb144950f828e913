// Heads for the mould study, synthetic or mixed from scanned faces, and their comparison.
#pragma once

#include "harness.h"

#include "ostraka/collection/moulds.h"
#include "ostraka/synthetic/head_casts.h"

namespace ostraka::experiments {

/// Heads with their moulds.
struct Heads {
    std::vector<Mesh> meshes;
    std::vector<std::vector<std::int32_t>> labels;
    std::vector<std::string> moulds, names;
    std::vector<bool> beard, long_hair, hand_made;
};

Heads synthetic_heads(const MouldPopulationOptions& population, const CastOptions& cast);
/// Casts of moulds that are mixes of the faces in mesh files, with about half of `vertices`. Throws Error (usage) if the faces
/// are not in correspondence.
Heads scanned_heads(const std::vector<std::string>& files, int objects, std::uint64_t vertices, double difference, double wear);

/// Comparison of a selection of heads without some of their parts.
struct Compared {
    MouldMatrices matrices;
    std::vector<int> truth;
    std::vector<std::string> moulds;
    double features = 0;  ///< mean number
    Seconds finding, comparing;
};

/// Compares the heads for which chosen(head), without the parts without(head).
Compared compare(const Heads& heads, const std::function<bool(std::size_t)>& chosen,
                 const std::function<std::vector<HeadPart>(std::size_t)>& without);

}  // namespace ostraka::experiments

// The smallest resolution at which an annotation survives.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/transfer/transfer.h"

#include <cstdint>

namespace ostraka {

struct SurvivalOptions {
    TransferOptions transfer;
    double ratio = 0.7;
    double area_error = 0.25;
    std::uint64_t minimum = 20;
    void describe(OptionList& visit);
};

struct Survival {
    int id = 0;
    std::string tag;
    std::size_t vertices = 0;  ///< the smallest resolution tried down to which the annotation was kept throughout
    std::string end;           ///< what became of it at the next one; empty if it survived all; says so if none could be tried
};

/// Simplifies the mesh step by step and transfers the annotations from the full mesh to each step. An annotation survives while
/// it keeps its type, no outline or point of it vanishes, and, if it is a region, its area stays within the bound. The answer is
/// exact to one step of the ratio. Costs about 1 / (1 - ratio) times one simplification and one transfer.
std::vector<Survival> smallest_resolutions(const Mesh& mesh, const AnnotationSet& annotations,
                                           const SurvivalOptions& options = {});

}  // namespace ostraka

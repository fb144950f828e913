// The smallest resolution at which an annotation survives.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/core/options.h"
#include "ostraka/transfer/transfer.h"

#include <cstdint>

namespace ostraka {

struct SurvivalOptions {
    TransferOptions transfer;
    double ratio = 0.7;
    double area_error = 0.25;
    std::uint64_t minimum = 20;
    void list_options(OptionList& list);
};

struct Survival {
    int id = 0;
    std::string tag;
    std::size_t vertices = 0;  ///< the smallest tested resolution such that the annotation was kept down to it
    std::string end;           ///< its fate at the next resolution; empty if it survived all; a remark if none could be tested
};

/// Simplifies the mesh step by step and transfers the annotations from the full mesh to each step. An annotation survives while
/// it keeps its type, none of its outlines or points vanishes and, for a region, its area error stays within the bound. The
/// result is exact to one step of the ratio. Costs about 1 / (1 - ratio) times one simplification and one transfer.
std::vector<Survival> smallest_resolutions(AnnotatedMeshView object, const SurvivalOptions& options = {});

}  // namespace ostraka

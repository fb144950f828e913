// The smallest resolution of a mesh at which an annotation survives.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/core/options.h"
#include "ostraka/transfer/transfer.h"

#include <cstdint>

namespace ostraka {

struct SurvivalOptions {
    TransferOptions transfer;             ///< options for the transfer to each resolution
    double ratio = 0.7;                   ///< number of vertices of each resolution relative to the previous one
    double area_error = 0.25;             ///< max relative change of the area of a region that survives
    std::uint64_t min_vertices = 20;      ///< min number of vertices tried
    void list_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// How far the resolution can be reduced before an annotation is lost.
struct Survival {
    int id = 0;                ///< id of the annotation
    std::string tag;           ///< tag of the annotation
    std::size_t vertices = 0;  ///< number of vertices of the smallest tested resolution down to which the annotation was kept
    /// What happened to the annotation at the next resolution; empty if it survived all; a remark if no resolution could be
    /// tested.
    std::string end;
};

/// For each annotation, the smallest resolution at which it survives: simplifies the mesh step by step and transfers the
/// annotations from the full mesh to each step. An annotation survives while it keeps its type, none of its outlines or points
/// vanishes and, for a region, the change of its area stays within the bound. The result is exact to one step of the ratio. The
/// cost is about 1 / (1 - ratio) times the cost of one simplification and one transfer.
std::vector<Survival> smallest_resolutions(AnnotatedMeshView object, const SurvivalOptions& options = {});

}  // namespace ostraka

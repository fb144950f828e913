// Finds the smallest resolution of a mesh at which an annotation survives.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/core/options.h"
#include "ostraka/transfer/transfer.h"

#include <cstdint>

namespace ostraka {

struct SurvivalOptions {
    TransferOptions transfer;                ///< options for the transfer to each resolution
    double ratio = 0.7;                      ///< number of vertices of each resolution relative to the previous one
    double area_error = 0.25;                ///< a region survives only if its area changes by at most this relative amount
    std::uint64_t min_vertices = 20;         ///< min number of vertices tried
    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// The resolution down to which an annotation survives.
struct Survival {
    int id = 0;                ///< id of the annotation
    std::string tag;           ///< tag of the annotation
    std::size_t vertices = 0;  ///< number of vertices of the last tested resolution at which the annotation survived
    /// Description of the change of the annotation at the next lower resolution; empty if the annotation survived all tested
    /// resolutions; a message if no resolution could be tested.
    std::string end;
};

/// For each annotation, the smallest resolution at which it survives: simplifies the mesh step by step and transfers the
/// annotations from the full mesh to each step. An annotation survives while it keeps its type, none of its outlines or points
/// vanishes and, for a region, the change of its area stays within the bound. Successive resolutions differ by the factor
/// `ratio`, so that the result is exact up to this factor. The cost is about 1 / (1 - ratio) times the cost of one simplification
/// and one transfer.
std::vector<Survival> smallest_resolutions(AnnotatedMeshView object, const SurvivalOptions& options = {});

}  // namespace ostraka

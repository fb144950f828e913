// Fairing of outlines and lines that zigzag along edges: replaces them by smooth free curves nearby.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/core/options.h"

#include <string>
#include <vector>

namespace ostraka {

struct FairOptions {
    double distance = 0;  ///< maximum deviation in the mesh's unit; 0: mean edge length of the mesh or, if larger, of the curve
    bool let_area_change = false;

    void describe(OptionList& visit);
};

/// Result for one annotation.
struct FairedAnnotation {
    int id = 0;
    double length_before = 0, length_after = 0;  ///< perimeter of a region, length of a line
    double area_before = 0, area_after = 0;
    double moved = 0;  ///< maximum distance of the new curve from the old one
    std::string note;  ///< reason if the annotation was left unchanged
};

/// Fairs the outlines of regions and the lines of the annotations with these ids (empty: all; the whole object has no outline).
/// Curves are split at junctions of three or more, at ends and at the border of the mesh; these places are fixed. Each stretch
/// between them, which neighbours share, is replaced by the curve with the least bending within the distance: least squares of
/// second differences and of the distance to the midpoints of the old segments, with the largest weight of the former that
/// satisfies the distance, projected onto the surface and joined by traces. Then stretches are shifted sideways so that each
/// region keeps its area (least squares over all stretches). An annotation whose outline would intersect itself is left
/// unchanged; its note reports it. Throws Error (input) for an id that is not in the set. O(n log n) in the length of the
/// curves, times some tens of iterations.
std::vector<FairedAnnotation> fair_outlines(const Mesh& mesh, AnnotationSet& set, const std::vector<int>& ids,
                                            const FairOptions& options = {});

}  // namespace ostraka

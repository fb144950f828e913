// Fairing of outlines and lines that zigzag along edges: replaces them by smooth free curves nearby.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/core/options.h"

#include <string>
#include <vector>

namespace ostraka {

/// Options of `fair_outlines`.
struct FairOptions {
    double distance = 0;  ///< maximum deviation in the mesh's unit; 0: mean edge length of the mesh or, if larger, of the curve
    bool let_area_change = false;  ///< true: regions need not keep their areas

    void list_options(OptionList& list);  ///< adds every member to a list of options
};

/// Changes that fairing made to one annotation.
struct FairedAnnotation {
    int id = 0;                                  ///< id of the annotation
    double length_before = 0, length_after = 0;  ///< perimeter of a region, length of a line
    double area_before = 0, area_after = 0;      ///< area of a region; 0 for a line
    double moved = 0;                            ///< maximum distance of the new curve from the old curve, in the mesh's unit
    std::string note;                            ///< reason why the annotation was left unchanged; empty: it was faired
};

/// Fairs the outlines of regions and the lines of the annotations with these ids (empty: all; the whole object has no outline).
/// Curves are split at junctions of three or more, at ends and at the border of the mesh; these places are fixed. Each stretch
/// between two fixed places, which adjacent regions share, is replaced by the curve with the least bending among those within
/// `distance`: least squares of second differences and of the distance to the midpoints of the old segments, with the largest
/// weight of the second differences that keeps the curve within `distance`. The curve is projected onto the surface and joined by
/// traces. Then stretches are shifted sideways so that each region keeps its area (least squares over all stretches). An
/// annotation whose outline would intersect itself is left unchanged; its note gives this reason. Throws Error (input) for an id
/// that is not in the set. Time: O(n log n) in the length of the curves, times some tens of iterations.
std::vector<FairedAnnotation> fair_outlines(const Mesh& mesh, AnnotationSet& set, const std::vector<int>& ids,
                                            const FairOptions& options = {});

}  // namespace ostraka

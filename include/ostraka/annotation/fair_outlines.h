// Outlines and lines that run in steps along edges made fair: free curves near them.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/core/options.h"

#include <string>
#include <vector>

namespace ostraka {

struct FairOptions {
    double distance = 0;  ///< in the mesh's unit; 0: the mean edge length, of the mesh or along the curve where that is more
    bool let_area_change = false;

    void describe(OptionList& visit);
};

/// What became of one annotation.
struct FairedAnnotation {
    int id = 0;
    double length_before = 0, length_after = 0;  ///< perimeter of a region, length of a line
    double area_before = 0, area_after = 0;
    double moved = 0;  ///< the largest distance of its curve from the one before
    std::string note;  ///< why it was left as it was, if so
};

/// Fairs the outlines of regions and the lines of the annotations with these ids (none: of all; the whole object has no outline).
/// Outlines and lines are taken apart where three of them meet, at ends and at the border, which stay; the stretches between,
/// which neighbours share, are replaced by the curve with the least bending that stays within the distance: least squares of
/// second differences and of the distance to the middles of the old pieces, with the largest weight of the first that keeps it
/// near, projected to the surface and joined by traces. Then stretches are shifted sideways so that each region keeps its area
/// (least squares over all). An annotation whose outline would cross itself stays as it is and says so. Throws Error (input) for
/// an id that the set does not have. O(n log n) in the length of the curves, for some tens of rounds.
std::vector<FairedAnnotation> fair_outlines(const Mesh& mesh, AnnotationSet& set, const std::vector<int>& ids,
                                            const FairOptions& options = {});

}  // namespace ostraka

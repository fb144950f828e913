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
    bool let_area_change = false;  ///< true: fairing may change the areas of regions

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// Changes that fairing made to one annotation.
struct FairedAnnotation {
    int id = 0;                                  ///< id of the annotation
    double length_before = 0, length_after = 0;  ///< perimeter of a region, length of a line
    double area_before = 0, area_after = 0;      ///< area of a region; 0 if the annotation is a line
    double moved = 0;                            ///< maximum distance of the new curve from the old curve, in the mesh's unit
    std::string note;                            ///< reason why the annotation was left unchanged; empty: it was faired
};

/// Fairs the outlines of regions and the lines of the annotations with these ids (empty: all annotations; the whole object has
/// no outline). Curves are split at points where three or more curves meet, at their ends and at the border of the mesh; these
/// points are fixed. Each stretch between two fixed points is replaced by a smooth curve; adjacent regions share the stretch.
/// The smooth curve minimises the weighted sum of squared second differences and of squared distances to the midpoints of the
/// old segments. The weight of the second differences is the largest weight that keeps the curve within `distance` of the old
/// curve. The points of the curve are projected onto the surface and connected by straight traces over the faces. Then
/// stretches are shifted sideways so that each region keeps its area (least squares over all stretches). An annotation whose
/// outline would intersect itself is left unchanged; its note gives this reason. Throws Error (input) for an id that is not in
/// the set. Time: O(n log n) in the length of the curves, times some tens of iterations.
std::vector<FairedAnnotation> fair_outlines(const Mesh& mesh, AnnotationSet& set, const std::vector<int>& ids,
                                            const FairOptions& options = {});

}  // namespace ostraka

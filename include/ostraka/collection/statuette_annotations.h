// What is known of a generated statuette, as annotations: its parts, its landmarks and the four measures of the thesis's
// Table 3.1.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/synthetic/statuettes.h"

namespace ostraka {

/// The object itself (a region of all) carries the measures "total height" (bounding along z), "base diameter" (ruler), "arm
/// length right" and "arm length left" (tape along the outside, exact) and "head height" (ruler), each with pins where its
/// landmarks are, inside faces if need be, and valued on the mesh; measures whose landmarks are missing are left out. Then a
/// region for each part and a point for each landmark. Unit mm, up z, class "votive statuette".
AnnotationSet annotate_statuette(const Statuette& statuette);

}  // namespace ostraka

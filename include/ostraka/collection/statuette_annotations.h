// The known properties of a generated statuette as annotations: its parts, its landmarks and the four measures of Table 3.1 of
// the thesis.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/synthetic/statuettes.h"

namespace ostraka {

/// The whole object (a region of all faces) carries the measures "total height" (bounding along z), "base diameter" (ruler), "arm
/// length right" and "arm length left" (tape along the outside, exact) and "head height" (ruler). The pins of these measures lie
/// at the landmarks, inside faces if necessary; the values are computed on the mesh; measures with missing landmarks are left
/// out. The annotation of the whole object is followed by a region for each part and a point for each landmark. The set has unit
/// mm, up direction z and class "votive statuette".
AnnotationSet annotate_statuette(const Statuette& statuette);

}  // namespace ostraka

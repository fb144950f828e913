// Estimates missing landmarks from the other specimens (Gunz et al. 2009; Arbour and Brown 2014).
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/morphometrics/shape_sample.h"

namespace ostraka {

/// How missing landmarks are treated.
enum class MissingMethod {
    leave_out,   ///< landmarks that a specimen lacks are left out of all specimens
    tps,         ///< thin-plate spline of the mean of the complete specimens to the landmarks that are present
    regression,  ///< linear regression on the landmarks that are present, from the complete specimens
    mirror       ///< the counterpart on the other side, mirrored; where it is missing as well, as `tps`
};

/// A missing landmark and what was done about it.
struct MissingLandmark {
    std::size_t specimen = 0, landmark = 0;  ///< indices in the sample
    std::string how;                         ///< "left out", "tps", "regression" or "mirror"
};

/// A sample without missing landmarks.
struct CompletedSample {
    ShapeSample sample;                       ///< complete; with `leave_out` without the landmarks that are missing somewhere
    std::vector<MissingLandmark> missing;     ///< every missing landmark, by specimen; indices into the sample given
    std::vector<std::size_t> kept_landmarks;  ///< indices of the landmarks that were kept
    std::vector<std::string> notes;           ///< messages on how estimates were obtained
};

/// Estimates missing landmarks, or leaves them out. `regression`: the specimen and all complete specimens are superimposed by
/// the landmarks that the specimen has, and the missing landmarks are predicted from the principal components of these
/// landmarks; their number is the one with the least leave-one-out error over the complete specimens. Throws Error (input),
/// naming specimen and landmark, if a specimen has too few landmarks for an estimate (three; in space four), if there are too few
/// complete specimens (`tps`: one, `regression`: four), if `mirror` is given without pairs, or if `leave_out` leaves fewer than
/// three landmarks.
CompletedSample complete_landmarks(const ShapeSample& sample, MissingMethod method, const LandmarkPairs& pairs = {});

}  // namespace ostraka

// The template's annotations on the members of its class.
#pragma once

#include "ostraka/family/shape_class.h"
#include "ostraka/transfer/transfer.h"

namespace ostraka {

struct PropagateOptions {
    MemberFitOptions fit;
    std::string correspondence = "auto";
    TransferOptions transfer;
    PropagateOptions() {
        transfer.correspondence.max_distance = 0.05;
        transfer.overlap = false;
        transfer.force = true;  // the template stands where the member is: it was fitted to it
    }
};

struct Propagated {
    MemberFit fit;                           ///< `problem` says why there is nothing else
    AnnotationSet on_template;               ///< the template's, measures taken on the fitted template
    std::optional<AnnotationSet> on_member;  ///< on the member's own mesh, measures taken anew
    std::vector<std::string> notes;          ///< what was lost or changed on the way
};

/// Lays the template onto the member (fit_as_told) and transfers its annotations to the member's surface (`transfer`); in
/// correspondence they are the same ones. Measures are taken anew.
Propagated propagate(const ClassTemplate& known, const WholeObject& member, const PropagateOptions& options = {});

}  // namespace ostraka

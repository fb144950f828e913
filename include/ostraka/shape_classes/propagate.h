// The template's annotations on the members of its class.
#pragma once

#include "ostraka/shape_classes/shape_class.h"
#include "ostraka/transfer/transfer.h"

namespace ostraka {

struct PropagateOptions {
    MemberFitOptions fit;
    CorrespondenceChoice correspondence = CorrespondenceChoice::automatic;
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
    std::vector<std::string> notes;          ///< what was lost or changed on the way, and whether the template lies on the member
    std::size_t lost = 0;                    ///< annotations that are not on the member
    bool lies_on = true;                     ///< no more is off than MemberFitOptions::max_off
    [[nodiscard]] bool complete() const { return fit.problem.empty() && lost == 0 && lies_on; }
};

/// Lays the template onto the member (fit_by_method) and transfers its annotations to the member's surface (`transfer`); in
/// correspondence they are the same ones. Measures are taken anew. A template that does not lie on the member (`fit_is_off`) is
/// carried over all the same, and said.
Propagated propagate(const ClassTemplate& known, const WholeObject& member, const PropagateOptions& options = {});

}  // namespace ostraka

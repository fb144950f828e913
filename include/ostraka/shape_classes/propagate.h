// Transfer of the template's annotations to the members of its class.
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
        transfer.force = true;  // the template was fitted to the member, so that both are in the same place
    }
};

struct Propagated {
    MemberFit fit;                           ///< `problem` is set if there is no other result
    AnnotationSet on_template;               ///< annotations of the template, with measures taken on the fitted template
    std::optional<AnnotationSet> on_member;  ///< annotations on the member's own mesh, with measures taken again
    std::vector<std::string> notes;          ///< messages on losses and changes, and on whether the template lies on the member
    std::size_t lost = 0;                    ///< number of annotations that are not on the member
    bool lies_on = true;                     ///< whether at most MemberFitOptions::max_off is off
    [[nodiscard]] bool complete() const { return fit.problem.empty() && lost == 0 && lies_on; }
};

/// Registers the template to the member (fit_by_method) and transfers its annotations to the member's surface (`transfer`); in
/// correspondence the annotations stay the same. Measures are taken again. Annotations are also transferred if the template
/// does not lie on the member (`fit_off_message`), and a note reports it.
Propagated propagate(const ClassTemplate& class_template, const WholeObject& member, const PropagateOptions& options = {});

}  // namespace ostraka

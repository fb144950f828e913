// Transfers the annotations of a class's template to members of the class.
#pragma once

#include "ostraka/shape_classes/shape_class.h"
#include "ostraka/transfer/transfer.h"

namespace ostraka {

struct PropagateOptions {
    MemberFitOptions fit;  ///< options for registering the template to the member
    /// Treatment of members that have the template's triangles.
    CorrespondenceChoice correspondence = CorrespondenceChoice::automatic;
    TransferOptions transfer;  ///< options for transferring annotations
    PropagateOptions() {
        transfer.correspondence.max_distance = 0.05;
        transfer.overlap = false;
        transfer.force = true;  // the template was fitted to the member, so that both are in the same place
    }
};

/// Result of `propagate`.
struct Propagated {
    MemberFit fit;              ///< registration of the template to the member; if `problem` is set, the other members are empty
    AnnotationSet on_template;  ///< annotations of the template, with measures computed on the fitted template
    /// Annotations on the member's own mesh, with measures computed on that mesh; empty: not transferred.
    std::optional<AnnotationSet> on_member;
    /// Messages about lost and changed annotations, and whether the template lies on the member.
    std::vector<std::string> notes;
    std::size_t lost = 0;  ///< number of annotations of the template that are not on the member
    bool lies_on = true;   ///< true: FitResiduals::off is at most MemberFitOptions::max_off
    /// True: all annotations were transferred reliably.
    [[nodiscard]] bool complete() const { return fit.problem.empty() && lost == 0 && lies_on; }
};

/// Registers the template to the member (fit_by_method) and transfers the template's annotations to the member's surface
/// (`transfer`); if the member is in correspondence, the annotations are copied. Measures are recomputed. Annotations are also
/// transferred if the template does not lie on the member (`fit_off_message`), and a note reports this.
Propagated propagate(const ClassTemplate& class_template, const WholeObject& member, const PropagateOptions& options = {});

}  // namespace ostraka

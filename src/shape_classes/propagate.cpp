#include "ostraka/shape_classes/propagate.h"

#include "ostraka/geom/with_points.h"
#include "ostraka/measure/measure.h"

#include <fmt/core.h>

#include <algorithm>

namespace ostraka {

namespace {

/// Copy without provenance: the template's does not apply to the copy.
AnnotationSet copy_of(const AnnotationSet& set) {
    AnnotationSet copy;
    copy.object_class = set.object_class;
    copy.unit = set.unit;
    copy.up = set.up;
    copy.annotations = set.annotations;
    return copy;
}

}  // namespace

Propagated propagate(const ClassTemplate& class_template, const WholeObject& member, const PropagateOptions& options) {
    Propagated result;
    result.fit = fit_by_method(class_template, member, options.correspondence, options.fit);
    if (!result.fit.problem.empty()) {
        result.lost = class_template.annotations.annotations.size();
        return result;
    }
    if (std::string off_message = fit_off_message(result.fit, options.fit.max_off); !off_message.empty()) {
        result.lies_on = false;
        result.notes.push_back(std::move(off_message));
    }
    const Mesh fitted = with_points(class_template.mesh, result.fit.points);
    result.on_template = copy_of(class_template.annotations);
    move_extents(class_template, fitted, result.on_template);
    for (std::string& note : refresh_measures(fitted, result.on_template).notes) result.notes.push_back(std::move(note));
    if (result.fit.placed_by == "correspondence") {
        result.on_member = copy_of(result.on_template);
        return result;
    }
    TransferResult carried = transfer({fitted, result.on_template}, SurfaceSearch(member.mesh), options.transfer);
    for (const TransferScore& score : carried.scores)
        if (score.outcome != TransferOutcome::kept || !score.note.empty())
            result.notes.push_back(fmt::format("annotation {} ({}) {}{}", score.id, score.tag, to_string(score.outcome),
                                               score.note.empty() ? "" : ": " + score.note));
    result.on_member = std::move(carried.annotations);
    result.lost = class_template.annotations.annotations.size() -
                  std::min(class_template.annotations.annotations.size(), result.on_member->annotations.size());
    move_extents({fitted, result.on_template}, member.mesh, *result.on_member);
    static_cast<void>(refresh_measures(member.mesh, *result.on_member));
    return result;
}

}  // namespace ostraka

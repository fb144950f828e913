#include "ostraka/geom/with_points.h"
#include "ostraka/measure/measure.h"
#include "ostraka/reconstruction/reconstruct.h"
#include "ostraka/transfer/transfer.h"

namespace ostraka {

AnnotationSet completed_annotations(AnnotatedMeshView template_object, const Reconstruction& result) {
    TransferOptions options;
    options.overlap = false;
    options.force = true;  // the fitted template is in the frame of the object
    const Mesh fitted = with_points(template_object.mesh, result.points);
    AnnotationSet moved_set = template_object.annotations;
    move_extents(template_object, fitted, moved_set);
    AnnotationSet carried = transfer({fitted, moved_set}, SurfaceSearch(result.object.mesh), options).annotations;
    move_extents({fitted, moved_set}, result.object.mesh, carried);
    return carried;
}

}  // namespace ostraka

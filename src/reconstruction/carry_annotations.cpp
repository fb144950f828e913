#include "ostraka/geom/with_points.h"
#include "ostraka/reconstruction/reconstruct.h"
#include "ostraka/transfer/transfer.h"

namespace ostraka {

AnnotationSet carry_annotations(const Mesh& mesh, const AnnotationSet& set, const Reconstruction& result) {
    TransferOptions options;
    options.overlap = false;
    options.force = true;  // the template stands where the object is: it was fitted to it
    return transfer(with_points(mesh, result.points), set, SurfaceSearch(result.object.mesh), options).annotations;
}

}  // namespace ostraka

#include "ostraka/catalogue/catalogue_axis.h"

#include "ostraka/axis/axis.h"

#include <numeric>

namespace ostraka {

CatalogueAxis catalogue_axis(const Mesh& mesh) {
    std::vector<Index> faces(mesh.number_of_faces());
    std::iota(faces.begin(), faces.end(), Index{0});
    const Axis axis = rotation_axis(mesh, faces);
    CatalogueAxis result;
    result.found = axis.found;
    result.reason = axis.reason;
    if (!axis.found) return result;
    result.point = axis.point;
    result.direction = axis.direction;
    if (const AxisFigure* error = axis.figure("direction error")) result.direction_error = error->value;
    constexpr double normal_quantile = 1.96;
    if (const AxisFigure* error = axis.figure("diameter error")) {
        result.diameter_low = -normal_quantile * error->value;
        result.diameter_high = normal_quantile * error->value;
    }
    return result;
}

}  // namespace ostraka

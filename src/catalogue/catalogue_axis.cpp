#include "ostraka/catalogue/catalogue_axis.h"

#include <numeric>

namespace ostraka {

CatalogueAxis catalogue_axis(const Mesh& mesh, const std::vector<Index>& fractures) {
    std::vector<bool> is_fracture(mesh.number_of_faces(), false);
    for (const Index face : fractures) is_fracture.at(face) = true;
    std::vector<Index> faces;
    for (Index face = 0; face < is_fracture.size(); ++face)
        if (!is_fracture[face]) faces.push_back(face);
    CatalogueAxis result;
    if (faces.empty()) {
        result.reason = "all of the surface is fracture";
        return result;
    }
    const RevolutionAxis revolution = revolution_axis(mesh, faces);
    const Axis& axis = revolution.axis;
    result.found = axis.found;
    result.reason = axis.reason;
    if (!axis.found) return result;
    result.point = axis.point;
    result.direction = axis.direction;
    if (const AxisFigure* error = axis.figure("direction error")) result.direction_error = error->value;
    if (!revolution.diameters.empty()) {
        const DiameterEstimate& diameter = revolution.diameters.front();
        result.diameter_low = diameter.low - diameter.value;
        result.diameter_high = diameter.high - diameter.value;
        result.diameters = revolution.diameters;
        result.rim_direction = revolution.rim_direction;
        return result;
    }
    constexpr double normal_quantile = 1.96;
    if (const AxisFigure* error = axis.figure("diameter error")) {
        result.diameter_low = -normal_quantile * error->value;
        result.diameter_high = normal_quantile * error->value;
    }
    return result;
}

}  // namespace ostraka

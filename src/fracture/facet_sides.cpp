#include "fracture/facet_sides.h"

#include "ostraka/algebra/dense.h"
#include "ostraka/axis/axis.h"
#include "ostraka/geom/eigen.h"

#include <algorithm>

namespace ostraka {

std::vector<double> outwardness(const Mesh& mesh, const FacetGraph& graph, const std::vector<Index>& sides,
                                std::vector<std::string>& notes) {
    std::vector<double> result(graph.count(), 0);
    if (sides.empty()) return result;
    std::vector<bool> side(graph.count(), false);
    for (const Index p : sides) side[p] = true;
    std::vector<Index> faces;
    for (std::size_t f = 0; f < graph.patch_of_face.size(); ++f)
        if (side[graph.patch_of_face[f]]) faces.push_back(static_cast<Index>(f));
    constexpr std::size_t max_faces = 50000;
    const std::size_t step = faces.size() / max_faces + 1;
    for (std::size_t k = 0; k * step < faces.size(); ++k) faces[k] = faces[k * step];
    faces.resize((faces.size() + step - 1) / step);
    AxisOptions axis_options;
    axis_options.tolerance = 0.03;
    axis_options.min_quality = 0.5;
    const Axis axis = find_axis(mesh, faces, axis_options);
    if (axis.found) {
        notes.emplace_back("outer and inner surface are distinguished by an axis of rotation");
        const Vector3d place = eigen(axis.point), along = eigen(axis.direction);
        for (std::size_t p = 0; p < result.size(); ++p) {
            Vector3d away = eigen(graph.places[p]) - place;
            away -= along.dot(away) * along;
            if (away.norm() > 0) result[p] = away.normalized().dot(eigen(graph.normals[p]));
        }
        return result;
    }
    // The point nearest to all lines along normals, regularised towards the centroid where they do not determine it.
    Vector3d middle = Vector3d::Zero();
    double area = 0;
    for (const Index p : sides) {
        middle += graph.areas[p] * eigen(graph.places[p]);
        area += graph.areas[p];
    }
    middle /= area;
    Eigen::Matrix3d matrix = 1e-4 * area * Eigen::Matrix3d::Identity();
    Vector3d right = Vector3d::Zero();
    for (const Index p : sides) {
        const Vector3d normal = eigen(graph.normals[p]);
        const Eigen::Matrix3d across = graph.areas[p] * (Eigen::Matrix3d::Identity() - normal * normal.transpose());
        matrix += across;
        right += across * (eigen(graph.places[p]) - middle);
    }
    const Vector3d focus = middle + solve_ldlt<3>(matrix, right);
    notes.emplace_back(
        "outer and inner surface are distinguished by the point where the normals meet: there is no axis of rotation");
    for (std::size_t p = 0; p < result.size(); ++p) {
        const Vector3d away = eigen(graph.places[p]) - focus;
        if (away.norm() > 0) result[p] = away.normalized().dot(eigen(graph.normals[p]));
    }
    return result;
}

double weighted_median(std::vector<std::pair<double, double>> values) {
    std::sort(values.begin(), values.end());
    double half = 0;
    for (const auto& [value, weight] : values) half += weight / 2;
    for (const auto& [value, weight] : values)
        if ((half -= weight) <= 0) return value;
    return 0;
}

}  // namespace ostraka

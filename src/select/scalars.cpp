#include "ostraka/select/scalars.h"

#include "ostraka/core/error.h"
#include "ostraka/fields/statistics.h"
#include "ostraka/mesh/limits.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

double face_value(const Mesh& mesh, const ScalarMap& map, Face face) {
    if (map.on_faces) return map.values[face];
    const auto [a, b, c] = corners(mesh, face);
    return (map.values[a] + map.values[b] + map.values[c]) / 3;
}

}  // namespace

ScalarMap coordinate_map(const Mesh& mesh, const Vector& direction, bool share, const std::string& where) {
    const Vector unit = unit_vector(direction);
    if (unit == CGAL::NULL_VECTOR) fail_input(where, "the direction has no length", "give a vector that is not zero");
    ScalarMap map;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Vertex v : mesh.vertices()) {
        map.values.push_back((mesh.point(v) - CGAL::ORIGIN) * unit);
        if (mesh.is_isolated(v)) continue;
        low = std::min(low, map.values.back());
        high = std::max(high, map.values.back());
    }
    if (!share) return map;
    if (!(high > low)) fail_input(where, "the mesh is flat along the direction", "give another one");
    for (double& x : map.values) x = (x - low) / (high - low);
    return map;
}

std::vector<bool> faces_between(const Mesh& mesh, const ScalarMap& map, const ScalarRange& interval) {
    std::vector<bool> faces(mesh.number_of_faces(), false);
    for (const Face face : mesh.faces()) faces[face] = interval.contains(face_value(mesh, map, face));
    return faces;
}

std::vector<Index> vertices_between(const Mesh& mesh, const ScalarMap& map, const ScalarRange& interval) {
    std::vector<Index> vertices;
    for (const Vertex v : mesh.vertices()) {
        if (mesh.is_isolated(v)) continue;
        double value = 0, area = 0;
        if (!map.on_faces) {
            value = map.values[v];
        } else {
            for (const Face face : mesh.faces_around_target(mesh.halfedge(v))) {
                if (face == Mesh::null_face()) continue;
                const double weight = face_area(mesh, face);
                value += weight * map.values[face];
                area += weight;
            }
            value /= area;
        }
        if (interval.contains(value)) vertices.push_back(v);
    }
    return vertices;
}

double quantile_of(const Mesh& mesh, const ScalarMap& map, double share, const std::string& where) {
    std::vector<double> values, weights;
    for (const Face face : mesh.faces()) {
        const double value = face_value(mesh, map, face);
        if (!std::isfinite(value)) continue;
        values.push_back(value);
        weights.push_back(face_area(mesh, face));
    }
    if (values.empty()) fail_input(where, "the map has no values", "give another one");
    return quantile(values, weights, share, where);
}

void SegmentOptions::declare_options(OptionList& list) {
    list("clusters", clusters, "number of thickness levels", Range{2, 100});
    list("smoothing", smoothing, "preference for short borders between segments in concave places, 0 to 1", Range{0, 1});
}

}  // namespace ostraka

#include "ostraka/fields/statistics.h"

#include "ostraka/core/error.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

void check_region(const Mesh& mesh, const std::vector<Index>& faces) {
    for (const Index face : faces)
        if (face >= mesh.number_of_faces())
            fail_usage("face " + std::to_string(face) + " is not one of the " + std::to_string(mesh.number_of_faces()) + " faces",
                       "was it selected on another mesh?");
}

Statistics vertex_statistics(const Mesh& mesh, const std::vector<double>& map, const std::vector<Index>& faces,
                             const std::string& where) {
    if (map.size() != mesh.number_of_vertices())
        fail_input(where,
                   "has " + std::to_string(map.size()) + " values for " + std::to_string(mesh.number_of_vertices()) + " vertices",
                   "give one value for each of the vertices");
    if (faces.empty()) fail_usage("the region has no faces", "select some");
    check_region(mesh, faces);
    std::vector<std::pair<Index, double>> shares;
    shares.reserve(3 * faces.size());
    for (const Index face : faces) {
        const double third = face_area(mesh, Face(face)) / 3;
        for (const Vertex v : corners(mesh, Face(face))) shares.emplace_back(v, third);
    }
    std::stable_sort(shares.begin(), shares.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<double> values, weights;
    for (std::size_t i = 0; i < shares.size(); ++i) {
        const Index vertex = shares[i].first;
        if (i > 0 && shares[i - 1].first == vertex) {
            weights.back() += shares[i].second;
            continue;
        }
        if (!std::isfinite(map[vertex]))
            fail_input(where, "the value of vertex " + std::to_string(vertex) + " is not a finite number",
                       "correct the map or choose another region");
        values.push_back(map[vertex]);
        weights.push_back(shares[i].second);
    }
    return statistics(values, weights, where);
}

}  // namespace ostraka

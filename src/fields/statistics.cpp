#include "ostraka/fields/statistics.h"

#include "ostraka/core/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace ostraka {

void check_region(const Mesh& mesh, const std::vector<Index>& faces) {
    for (const Index face : faces)
        if (face >= mesh.number_of_faces())
            fail_usage(fmt::format("there is no face {}: the mesh has {} faces, counted from 0", face, mesh.number_of_faces()),
                       "use the mesh on which the faces were selected");
}

Statistics vertex_statistics(const Mesh& mesh, const std::vector<double>& map, const std::vector<Index>& faces,
                             const std::string& where, UndefinedValues treatment) {
    if (map.size() != mesh.number_of_vertices())
        fail_input(where, fmt::format("has {} values for {} vertices", map.size(), mesh.number_of_vertices()),
                   "give one value for each of the vertices");
    if (faces.empty()) fail_usage("the region has no faces", "select faces");
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
        if (std::isnan(map[vertex]) && treatment == UndefinedValues::skipped) {
            // Kept with weight zero until its further shares are read.
            values.push_back(0);
            weights.push_back(-std::numeric_limits<double>::infinity());
            continue;
        }
        if (!std::isfinite(map[vertex]))
            fail_input(where, fmt::format("the value of vertex {} is not a finite number", vertex),
                       "correct the map or choose another region");
        values.push_back(map[vertex]);
        weights.push_back(shares[i].second);
    }
    std::size_t kept = 0;
    for (std::size_t i = 0; i < values.size(); ++i)
        if (weights[i] >= 0) values[kept] = values[i], weights[kept++] = weights[i];
    values.resize(kept), weights.resize(kept);
    if (kept == 0) fail_input(where, "has no value on the region", "choose another region");
    return statistics(values, weights, where);
}

}  // namespace ostraka

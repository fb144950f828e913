#include "fracture/filtered_normals.h"

#include "ostraka/execution/parallel.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ostraka {

std::vector<Vector> filtered_normals(const std::vector<Vector>& areas, const std::vector<std::pair<Index, Index>>& neighbours,
                                     int steps) {
    const auto unit = [](const Vector& v) {
        const double squared = v.squared_length();
        return squared > 0 ? v / std::sqrt(squared) : Vector(0, 0, 0);
    };
    const std::size_t n = areas.size();
    std::vector<std::size_t> first(n + 1, 0);
    for (const auto& [a, b] : neighbours) ++first[a + 1], ++first[b + 1];
    std::partial_sum(first.begin(), first.end(), first.begin());
    std::vector<Index> around(first.back());
    std::vector<std::size_t> place = first;
    for (const auto& [a, b] : neighbours) around[place[a]++] = b, around[place[b]++] = a;
    std::vector<Vector> current(n), next(n);
    std::vector<double> weights(n);
    for (std::size_t k = 0; k < n; ++k) {
        weights[k] = std::sqrt(areas[k].squared_length());
        current[k] = unit(areas[k]);
    }
    for (int step = 0; step < steps; ++step) {
        parallel_for(n, [&](std::size_t k) {
            Vector sum = weights[k] * current[k];
            for (std::size_t i = first[k]; i < first[k + 1]; ++i) {
                const Index other = around[i];
                constexpr double width = 0.5;  // distance of unit vectors: 29 degrees
                const double ratio = (current[other] - current[k]).squared_length() / (width * width);
                sum += std::exp(-ratio) * weights[other] * current[other];
            }
            next[k] = unit(sum);
        });
        std::swap(current, next);
    }
    return current;
}

int filter_steps(double length, double spacing) {
    return spacing > 0 ? static_cast<int>(std::clamp(length / spacing * (length / spacing), 3.0, 60.0)) : 0;
}

std::vector<Vector> filtered_normals(const Mesh& mesh, double length) {
    std::vector<Vector> areas;
    for (const Face f : mesh.faces()) areas.push_back(area_vector(mesh, f));
    std::vector<std::pair<Index, Index>> neighbours;
    for (const Edge e : mesh.edges()) {
        const Face f = mesh.face(mesh.halfedge(e)), g = mesh.face(mesh.opposite(mesh.halfedge(e)));
        if (f != Mesh::null_face() && g != Mesh::null_face()) neighbours.emplace_back(f, g);
    }
    return filtered_normals(areas, neighbours, filter_steps(length, mean_edge_length(mesh)));
}

}  // namespace ostraka

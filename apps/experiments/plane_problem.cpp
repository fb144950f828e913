#include "plane_problem.h"

#include "ostraka/algebra/dense.h"
#include "ostraka/core/error.h"

#include <algorithm>
#include <cmath>

namespace ostraka::experiments {

std::vector<Point> mesh_points(const Points& points) {
    std::vector<Point> result;
    for (Eigen::Index i = 0; i < points.cols(); ++i) result.push_back(point_of(points.col(i)));
    return result;
}

std::vector<std::unique_ptr<Constraint>> plane_constraints(const Mesh& mesh, const Points& rest, const std::vector<Index>& region,
                                                           const PlaneProblem& problem) {
    std::vector<std::unique_ptr<Constraint>> list;
    for (const Vertex v : mesh.vertices()) {
        std::vector<int> ids{static_cast<int>(v.idx())};
        if (problem.rest_kind == "closeness") {
            list.push_back(make_constraint(kinds::Closeness{}, std::move(ids), problem.rest_weight, rest));
        } else if (problem.rest_kind == "laplacian") {
            for (const Vertex w : CGAL::vertices_around_target(mesh.halfedge(v), mesh)) ids.push_back(static_cast<int>(w.idx()));
            list.push_back(make_constraint(kinds::LaplacianDisplacement{}, std::move(ids), problem.rest_weight, rest));
        } else if (problem.rest_kind != "nothing") {
            fail_usage("'" + problem.rest_kind + "' is none of nothing, closeness and laplacian");
        }
    }
    list.push_back(make_constraint(kinds::Plane{}, {region.begin(), region.end()}, problem.plane_weight, rest));
    return list;
}

double flatness(const Points& points, const std::vector<Index>& region) {
    Eigen::Matrix3Xd part(3, static_cast<Eigen::Index>(region.size()));
    for (std::size_t i = 0; i < region.size(); ++i) part.col(static_cast<Eigen::Index>(i)) = points.col(region[i]);
    part.colwise() -= part.rowwise().mean().eval();
    const Eigen::Matrix3d scatter = part * part.transpose();
    const double minimum = symmetric_eigenvalues(scatter)[0];
    return std::sqrt(std::max(0.0, minimum) / static_cast<double>(region.size()));
}

}  // namespace ostraka::experiments

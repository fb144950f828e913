// The optimisation problem of figure 4.6 and Table 4.1 of the thesis: a region is flattened, the rest keeps its shape.
#pragma once

#include "scenes.h"

#include "ostraka/solver/make_constraint.h"
#include "ostraka/solver/solve.h"

#include <memory>

namespace ostraka::experiments {

/// Constraints in addition to the plane: "nothing", "closeness" of every vertex or "laplacian" displacement of every vertex.
struct PlaneProblem {
    std::string rest_kind = "closeness";
    double rest_weight = 1, plane_weight = 1;
};

std::vector<Point> mesh_points(const Points& points);

std::vector<std::unique_ptr<Constraint>> plane_constraints(const Mesh& mesh, const Points& rest, const std::vector<Index>& region,
                                                           const PlaneProblem& problem);

/// Root mean square distance of the region's points from their best-fitting plane.
double flatness(const Points& points, const std::vector<Index>& region);

}  // namespace ostraka::experiments

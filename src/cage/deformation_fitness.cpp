#include "ostraka/cage/cage.h"
#include "ostraka/core/message_text.h"
#include "ostraka/core/text.h"
#include "ostraka/execution/parallel.h"

#include <fmt/core.h>

#include <algorithm>

namespace ostraka {

double amplification(const Coordinates& coordinates) {
    std::vector<double> sums(static_cast<std::size_t>(coordinates.vertex.rows()), 0);
    parallel_for(sums.size(),
                 [&](std::size_t i) { sums[i] = coordinates.vertex.row(static_cast<Eigen::Index>(i)).cwiseAbs().sum(); });
    return sums.empty() ? 0 : *std::max_element(sums.begin(), sums.end());
}

std::vector<std::string> reasons_against_deformation(const CageCheck& check, const Coordinates& coordinates) {
    if (check.components == 0) return {"the cage has no faces"};
    std::vector<std::string> reasons;
    if (!check.closed) reasons.emplace_back("the cage has a border");
    if (check.flat) reasons.emplace_back("the cage has no face with an area");
    if (check.closed && !check.flat && !check.outward) reasons.emplace_back("the cage is inside out");
    if (!check.outside.empty())
        reasons.push_back(fmt::format("{} {} not inside the cage", check.outside.size(),
                                      check.outside.size() == 1 ? "vertex of the mesh is" : "vertices of the mesh are"));
    if (!check.crossing.empty())
        reasons.push_back(fmt::format("the cage crosses {} of the mesh", counted(check.crossing.size(), "face")));
    if (!check.intersections.empty())
        reasons.push_back(fmt::format("{} of faces of the cage intersect", counted(check.intersections.size(), "pair")));
    if (check.degenerate > 0) reasons.push_back(fmt::format("the cage has {} without area", counted(check.degenerate, "face")));
    if (const double factor = amplification(coordinates); factor > max_amplification)
        reasons.push_back(fmt::format("a vertex of the mesh moves up to {} times as far as the cage (weights from {} to {})",
                                      digits(factor, 3), digits(coordinates.vertex.minCoeff(), 3),
                                      digits(coordinates.vertex.maxCoeff(), 3)));
    return reasons;
}

}  // namespace ostraka

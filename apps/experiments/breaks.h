// What experiments on breaks share.
#pragma once

#include "ostraka/core/mesh.h"
#include "ostraka/geom/rigid_fit.h"
#include "ostraka/stats/random.h"

#include <string>
#include <utility>
#include <vector>

namespace ostraka::experiments {

struct BreakExperiment;

/// Two halves of a bottle, and the neighbours among five sherds.
void break_pairs(const BreakExperiment& options);

/// Turned evenly at random, shifted by about `far`.
Motion random_motion(Random& random, double far);
double degrees_of(const Motion& motion);
/// Root mean square way of the vertices.
double off_of(const Mesh& mesh, const Motion& motion);
/// The five sherds of the folder `data` with their numbers; none, and a loud word, where they are not there.
std::vector<std::pair<std::string, Mesh>> scanned_sherds(const std::string& data);

}  // namespace ostraka::experiments

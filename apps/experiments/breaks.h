// Shared by the experiments on fracture surfaces.
#pragma once

#include "ostraka/core/mesh.h"
#include "ostraka/geom/rigid_fit.h"
#include "ostraka/stats/random.h"

#include <string>
#include <utility>
#include <vector>

namespace ostraka::experiments {

struct BreakExperiment;

/// Registers two halves of a bottle, and neighbouring sherds of five.
void break_pairs(const BreakExperiment& options);

/// A uniformly random rotation, and a shift of about `far`.
Motion random_motion(Random& random, double far);
double degrees_of(const Motion& motion);
/// Root mean square displacement of the vertices.
double off_of(const Mesh& mesh, const Motion& motion);
/// The five sherds in the folder `data` with their numbers; if the files are missing, none, with a message.
std::vector<std::pair<std::string, Mesh>> scanned_sherds(const std::string& data);

}  // namespace ostraka::experiments

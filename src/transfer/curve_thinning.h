// Places of laid curves that say next to nothing.
#pragma once

#include "ostraka/transfer/lay_curves.h"

#include <vector>

namespace ostraka {

/// Leaves out places inside faces that are nearer than `tolerance` to the straight piece between their neighbours, the same ones
/// for all curves that share them. O(k log k) for k places.
void thin_out(const Mesh& mesh, double tolerance, std::vector<Laid>& laid);

}  // namespace ostraka

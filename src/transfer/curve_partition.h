// Free regions that part a whole surface among them go on doing so.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/transfer/lay_curves.h"

#include <vector>

namespace ostraka {

/// Whether the regions among annotations, of which there are two or more, part the whole surface of their mesh: their areas are
/// its area, to rounding. What is `all` of the mesh does not count.
bool part_surface(const Mesh& mesh, const std::vector<const Annotation*>& annotations);

/// Where the regions among annotations of `source` part its whole surface, what they became on `target` is made to do so again:
/// pieces of it that lie in none of them, or in several, go to the one with which they share most of their border. Nothing is
/// done where they part it already. O(n log n) for n faces of the target cut along all outlines.
void keep_partition(const Mesh& source, const std::vector<const Annotation*>& annotations, const Mesh& target,
                    std::vector<Laid>& laid);

}  // namespace ostraka

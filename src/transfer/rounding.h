// Which faces along its outline a transferred region takes.
#pragma once

#include "ostraka/core/mesh.h"

#include <utility>
#include <vector>

namespace ostraka {

/// What the rounding aims at.
struct RoundingGoal {
    double area = 0;       ///< of the source region
    double perimeter = 0;  ///< of the source region's outline
    double edge = 0;       ///< typical edge length of the target
    bool coarser = false;  ///< the target cannot show the outline's detail: a shorter outline is as good, and no teeth are added
};

/// Moves single faces across the outline of `selected`, never changing the topology of the region. `shares` tells of the faces
/// near the true outline which share of them lies inside; only those move. `balance` off: each goes to the side that holds most
/// of it. On: one face at a time, that one changes sides which lowers
///     20 |A / A_source - 1| + |P / P_source - 1| + 6 W / (h P_source)
/// most, until none does. W is the area on the wrong side: faces cut in halves may change sides at no cost, and they are enough
/// to meet area A and perimeter P. O(k m) for k faces and m moves, both small beside the mesh.
void round_region(const Mesh& mesh, std::vector<bool>& selected, const std::vector<std::pair<Index, double>>& shares,
                  const RoundingGoal& goal, bool balance);

/// A face near an outline that several regions share, and which share of it lies inside one of them.
struct SharedFace {
    Index face;
    std::size_t region;
    double share;
};

/// The same along outlines that regions share: a face goes over to the region that holds most of it, and the one that had it
/// gives it up in the same move, so that regions that partition the surface still do. Topologies stay. `faces` need not be
/// sorted.
void round_shared(const Mesh& mesh, std::vector<std::vector<bool>>& selected, std::vector<SharedFace> faces);

}  // namespace ostraka

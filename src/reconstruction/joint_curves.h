// Curves on fragments where two annotations meet: targets of the template's vertices where the same two annotations meet.
#pragma once

#include "ostraka/fracture/fragment.h"
#include "ostraka/reconstruction/fit.h"
#include "ostraka/solver/constraint.h"

#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace ostraka {

/// Edges of fragments between faces with different labels.
class JointCurves {
public:
    /// Adds the edges of a fragment. `labels` is per face, `ends` per vertex; lengths are divided by `scale`. Edges beside a
    /// fracture are skipped.
    void add(int fragment, const Mesh& mesh, const std::vector<int>& labels, const std::vector<Facet>& facets,
             const std::vector<bool>& ends, double scale);

    struct Place {
        VertexMatch match;        ///< fragment -1: the nearest point is an end of the fragment
        Eigen::Vector3d along{};  ///< unit direction of the curve
    };
    /// The nearest point on curves where any two of the labels (ascending) meet, if it is within `search_radius`. O(edges).
    [[nodiscard]] std::optional<Place> nearest(const Eigen::Vector3d& place, const std::vector<int>& labels,
                                               double search_radius) const;

private:
    struct Segment {
        int fragment = 0;
        Index face = no_index;
        Eigen::Vector3d from, to;
        bool from_ends = false, to_ends = false;  ///< the fragment ends there
    };
    std::map<std::pair<int, int>, std::vector<Segment>> segments_;  ///< by labels, the lower one first
};

}  // namespace ostraka

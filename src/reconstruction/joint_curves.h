// Where annotations meet on fragments: the curves to which the template's vertices go that lie where the same two meet.
#pragma once

#include "ostraka/fracture/fragment.h"
#include "ostraka/reconstruction/fit.h"
#include "ostraka/solver/constraint.h"

#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace ostraka {

/// Edges of fragments between faces of two labels.
class JointCurves {
public:
    /// Adds those of a fragment. `labels` is of its faces, `breaks` of its vertices; lengths are divided by `scale`. Edges beside
    /// a fracture are none.
    void add(int fragment, const Mesh& mesh, const std::vector<int>& labels, const std::vector<Facet>& facets,
             const std::vector<bool>& breaks, double scale);

    struct Place {
        VertexMatch match;        ///< fragment -1: nearest is where the fragment ends
        Eigen::Vector3d along{};  ///< unit direction of the curve
    };
    /// The nearest place on curves where any two of the labels (ascending) meet, if one is within `search_radius`. O(edges).
    [[nodiscard]] std::optional<Place> nearest(const Eigen::Vector3d& place, const std::vector<int>& labels,
                                               double search_radius) const;

private:
    struct Segment {
        int fragment = 0;
        Index face = no_index;
        Eigen::Vector3d from, to;
        bool from_ends = false, to_ends = false;  ///< where the fragment ends
    };
    std::map<std::pair<int, int>, std::vector<Segment>> segments_;  ///< by labels, the lower one first
};

}  // namespace ostraka

// Curves on fragments where two annotations meet: targets of the template's vertices where the corresponding annotations meet.
#pragma once

#include "ostraka/fracture/fragment.h"
#include "ostraka/reconstruction/fit.h"
#include "ostraka/solver/constraint.h"

#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace ostraka {

/// Edges of fragments between faces with different labels, which form the curves where annotations meet.
class JointCurves {
public:
    /// Adds the edges of a fragment. `labels`: label of each face; `ends`: for each vertex, whether the outer surface ends there;
    /// coordinates are divided by `scale`. Edges beside a fracture are skipped.
    void add(int fragment, const Mesh& mesh, const std::vector<int>& labels, const std::vector<Facet>& facets,
             const std::vector<bool>& ends, double scale);

    /// A point on a curve.
    struct Place {
        VertexMatch match;        ///< match at the point; fragment -1: the nearest point of the curve is an end of the fragment
        Eigen::Vector3d along{};  ///< unit direction of the curve
    };
    /// The point nearest to `place` on the curves where any two of `labels` (ascending) meet, if its distance is at most
    /// `search_radius`. Time: O(edges).
    [[nodiscard]] std::optional<Place> nearest(const Eigen::Vector3d& place, const std::vector<int>& labels,
                                               double search_radius) const;

private:
    /// An edge of a curve.
    struct Segment {
        int fragment = 0;                         ///< index of the fragment
        Index face = no_index;                    ///< face of the fragment beside the edge
        Eigen::Vector3d from, to;                 ///< end points of the edge
        bool from_ends = false, to_ends = false;  ///< whether the outer surface of the fragment ends at the end point
    };
    /// From two labels, the lower one first, to the edges where they meet.
    std::map<std::pair<int, int>, std::vector<Segment>> segments_;
};

}  // namespace ostraka

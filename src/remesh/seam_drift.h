// Keeps the seams of a texture close to where they were before a simplification.
#pragma once

#include "remesh/metric.h"

#include <unordered_map>
#include <utility>
#include <vector>

namespace ostraka {

/// For each edge of a seam, the stretch of the original seam that it stands for. A collapse along a seam is refused if an edge
/// would lie farther than `limit` from its stretch, or the stretch from the edge, measured at the points of the stretch.
class SeamDrift {
public:
    /// `seams`: for each edge, whether it is a seam; kept up to date by the caller. `limit`: in the coordinates of the frame.
    SeamDrift(const Mesh& mesh, const Frame& frame, const std::vector<bool>& seams, double limit);

    /// Whether the seams stay within the limit if the source of `h` is merged into the target at `x` (frame coordinates);
    /// `pinned`: the target does not move.
    [[nodiscard]] bool keeps(const Mesh& mesh, Halfedge h, const Vector& x, bool pinned);
    /// Carries out what the last call of `keeps` found; to be called before the collapse.
    void apply();

private:
    struct Stretch {
        Index from;                  ///< vertex at which it begins
        std::vector<Vector> points;  ///< of the original seam, in frame coordinates
    };
    /// The seam edges that end in the vertex, except `without`.
    [[nodiscard]] std::vector<Edge> seams_at(const Mesh& mesh, Vertex vertex, Edge without) const;
    /// The points of an edge's stretch in the direction from one of its ends.
    [[nodiscard]] std::vector<Vector> points_from(Edge edge, Vertex from) const;
    [[nodiscard]] bool is_near(const std::vector<Vector>& points, const Vector& a, const Vector& b) const;

    const Frame& frame_;
    const std::vector<bool>& seams_;
    double limit_;
    std::unordered_map<Index, Stretch> stretches_;
    std::vector<std::pair<Index, Stretch>> changed_;  ///< by the last call of `keeps`
    std::vector<Index> erased_;
};

}  // namespace ostraka

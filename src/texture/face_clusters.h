// Hierarchical clustering of faces into charts.
#pragma once

#include "ostraka/mesh/mesh.h"

#include <vector>

namespace ostraka::texture {

/// Limits of clusters.
struct ClusterLimits {
    double cone = 40;             ///< largest angle of a normal to the axis of the cluster's bounding cone, in degrees
    double relaxed_cone = 75;     ///< likewise where one of two joined clusters is small
    double small_area = 0;        ///< area below which a cluster is small
    double negligible_width = 0;  ///< height of a triangle below which its normal does not count
};

/// Height of a triangle above its longest side; 0 for a degenerate triangle.
double smallest_height(const Mesh& mesh, Face face);

/// Clusters of faces connected across edges: pairs of clusters are merged in the order of their costs as long as the limits permit
/// (Garland, Willmott and Heckbert 2001). The faces of a cluster ascend; clusters are ordered by their first faces.
std::vector<std::vector<Index>> face_clusters(const Mesh& mesh, const ClusterLimits& limits);

}  // namespace ostraka::texture

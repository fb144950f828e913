// Features of a surface that are put back as rigid details after their base was deformed.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/solver/constraint.h"

namespace ostraka::semantic {

/// Features that are re-attached together.
struct Reattachment {
    std::vector<const Annotation*> features;  ///< regions
    std::optional<Eigen::Vector3d> up;        ///< direction along which they are moved to one level
    /// Vertices of each feature whose mean defines its height; empty: the centroid of its area.
    std::vector<std::vector<Index>> references = {};
    double bend = 0;  ///< maximum root mean square bending of a feature onto the base, as a share of the diagonal
};

/// One column per point.
std::vector<Point> list_of(const Points& points);

/// The halfedges of a region's faces along its outline, including the mesh's border.
std::vector<Halfedge> outline_of(const Mesh& mesh, const Annotation& region);

/// Whether other faces adjoin those of a region: a whole component cannot be re-attached.
bool has_outline(const Mesh& mesh, const Annotation& region);

struct ReattachmentReport {
    std::size_t folded = 0;  ///< number of flipped faces around features
};

/// The base is `points` with the features' interiors replaced by the smoothest surface over their outlines. Each feature returns
/// as a rigid copy of itself at `rest`, with its outline as close to the base as a rigid motion permits, then it is bent onto the
/// base; if `up` is given it slides along the base until its centroid is at the mean level of all. Around a feature, up to about
/// twice its radius, vertices slide on the base to make room, so that the surface keeps its shape there (thesis, sections 5.4
/// and 6.1.2). Other points are unchanged.
ReattachmentReport reattach(const Mesh& mesh, const Points& rest, const std::vector<Reattachment>& reattachments, Points& points);

}  // namespace ostraka::semantic

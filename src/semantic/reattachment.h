// Features of a surface that are put back as rigid details after the surface below (the base) was deformed.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/solver/constraint.h"

namespace ostraka::semantic {

/// Features that are re-attached together.
struct Reattachment {
    std::vector<const Annotation*> features;  ///< the regions of the features
    std::optional<Eigen::Vector3d> up;  ///< direction along which features are moved to one level; empty: they are not moved
    /// For each feature, the vertices whose mean defines its height; empty: the centroid of its area.
    std::vector<std::vector<Index>> references = {};
    double bend = 0;  ///< max root mean square bending of a feature onto the base, as a share of the mesh's diagonal
};

/// Converts a matrix with one column per point to a list of points.
std::vector<Point> list_of(const Points& points);

/// The halfedges of a region's faces along the region's outline, including the border of the mesh.
std::vector<Halfedge> outline_of(const Mesh& mesh, const Annotation& region);

/// Whether faces outside the region adjoin it: a region that is a whole component cannot be re-attached.
bool has_outline(const Mesh& mesh, const Annotation& region);

/// Defects caused by re-attaching.
struct ReattachmentReport {
    std::size_t folded = 0;  ///< number of flipped faces around features
};

/// Re-attaches features. The base is `points` with the features' interiors replaced by the smoothest surface over their outlines.
/// Each feature returns as a rigid copy of its shape in `rest`, with its outline as close to the base as a rigid motion permits,
/// and is then bent onto the base; if `up` is given the feature slides along the base until its centroid is at the mean level of
/// all features. Around a feature, up to about twice its radius, vertices slide on the base to make room, so that the surface
/// keeps its shape there (thesis, sections 5.4 and 6.1.2). Other points are unchanged.
ReattachmentReport reattach(const Mesh& mesh, const Points& rest, const std::vector<Reattachment>& reattachments, Points& points);

}  // namespace ostraka::semantic

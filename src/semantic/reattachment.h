// Features of a surface that are put back as rigid details after their base was deformed.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/solver/constraint.h"

namespace ostraka::semantic {

/// Features that are re-attached together.
struct Reattachment {
    std::vector<const Annotation*> features;  ///< regions
    std::optional<Eigen::Vector3d> up;        ///< they come to one level along it
    /// Of each feature the vertices of which the mean stands for its height; empty: the centroid of its area.
    std::vector<std::vector<Index>> references = {};
    double bend = 0;  ///< root mean square by which one may bend to lie on the base, as a share of the diagonal
};

/// A point a column.
std::vector<Point> list_of(const Points& points);

/// The halfedges of a region's faces along its outline, that of the mesh's border included.
std::vector<Halfedge> outline_of(const Mesh& mesh, const Annotation& region);

/// Whether other faces adjoin those of a region: the whole of a piece has no place to be re-attached at.
bool has_outline(const Mesh& mesh, const Annotation& region);

struct ReattachmentReport {
    std::size_t folded = 0;  ///< faces around features that had to turn over
};

/// The base is `points` with the features' insides replaced by the smoothest surface over their outlines. Each feature comes back
/// as a rigid copy of itself at `rest`, its outline as near to the base as a rigid one can be, then bent to lie on it; where `up`
/// is given it slides along the base until its centroid stands at the mean level of all. Around a feature, up to about twice its
/// radius, vertices slide on the base to make room, so that the surface keeps its shape there (thesis, sections 5.4 and 6.1.2).
/// Other points stay.
ReattachmentReport reattach(const Mesh& mesh, const Points& rest, const std::vector<Reattachment>& reattachments, Points& points);

}  // namespace ostraka::semantic

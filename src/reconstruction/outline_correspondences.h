// Places on a fragment for the vertices of the template's outlines and lines, by their position along them.
#pragma once

#include "ostraka/annotation/annotation.h"

#include <Eigen/Geometry>

#include <utility>
#include <vector>

namespace ostraka {

/// Vertices joined by edges along which positions are given.
struct VertexPath {
    std::vector<Index> vertices;
    bool closed = false;
};

/// The outlines of a region, counter-clockwise, or the lines of an annotation, without the edges that are borders of the mesh or
/// beside a face of `broken` (of each face; empty: none): what is left there is where the object ends, not the annotation. Paths
/// of one vertex are left out.
std::vector<VertexPath> vertex_paths_of(const Mesh& mesh, const Annotation& part, const std::vector<bool>& broken = {});

/// A template vertex and where it belongs.
struct OutlineCorrespondence {
    Index vertex = no_index;
    Eigen::Vector3d place;
    double length = 0;  ///< of the template's line that it stands for
};

/// By the position between landmarks that both have on a path (vertex of the template, vertex of the fragment): between two of
/// them by the share of the way from the one to the other, beyond the last one of an open path by the way from it, as the pieces
/// between landmarks are longer or shorter on the fragment, and as far as both paths go; such correspondences count for a
/// quarter. All the way round a closed path that has one landmark. A landmark is on the path whose vertex is nearest, if it is
/// nearer to it than a twentieth of its length. Paths without a common landmark give none. Outlines have the same sense on both
/// sides; lines are turned so that more landmarks follow each other, or else so that they lie nearer to each other. The fragment
/// lies where the template is when made `scale` times as large; places are on it.
std::vector<OutlineCorrespondence> outline_correspondences(const Mesh& mesh, const Annotation& part, const Mesh& fragment,
                                                           const Annotation& of_fragment, const std::vector<bool>& broken,
                                                           const std::vector<std::pair<Index, Index>>& landmarks, double scale);

}  // namespace ostraka

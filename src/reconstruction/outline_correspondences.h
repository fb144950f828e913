// Matches vertices of the template's outlines and lines with points on a fragment, by their position along the curve.
#pragma once

#include "ostraka/annotation/annotation.h"

#include <Eigen/Geometry>

#include <utility>
#include <vector>

namespace ostraka {

/// Vertices connected by edges along which positions are measured.
struct VertexPath {
    std::vector<Index> vertices;
    bool closed = false;
};

/// The outlines of a region, counter-clockwise, or the lines of an annotation, without the edges on borders of the mesh or
/// beside a face of `broken` (per face; empty: none), where the object ends rather than the annotation. Paths of one vertex are
/// omitted.
std::vector<VertexPath> vertex_paths_of(const Mesh& mesh, const Annotation& part, const std::vector<bool>& broken = {});

/// A template vertex and its target.
struct OutlineCorrespondence {
    Index vertex = no_index;
    Eigen::Vector3d place;
    double length = 0;  ///< length of the template's line that it represents
};

/// Positions are interpolated between landmarks common to both paths (vertex of the template, vertex of the fragment): between
/// two of them, by the share of the arc length; beyond the last one of an open path, by the arc length from it, scaled by the
/// ratio of the intervals between landmarks, as far as both paths reach; such correspondences have a quarter of the weight. A
/// closed path with one landmark is traversed once around. A landmark belongs to the path with the nearest vertex, if its
/// distance is less than a twentieth of the path's length. Paths without a common landmark give no correspondences. Outlines
/// have the same orientation on both sides; lines are oriented so that more landmarks are in the same order, or else so that
/// they are closer to each other. The fragment lies where the template is when scaled by `scale`; targets are on the fragment.
std::vector<OutlineCorrespondence> outline_correspondences(const Mesh& mesh, const Annotation& part, const Mesh& fragment,
                                                           const Annotation& of_fragment, const std::vector<bool>& broken,
                                                           const std::vector<std::pair<Index, Index>>& landmarks, double scale);

}  // namespace ostraka

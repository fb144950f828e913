// Matches vertices of the template's outlines and lines with points on a fragment, by position along the curve.
#pragma once

#include "ostraka/annotation/annotation.h"

#include <Eigen/Geometry>

#include <utility>
#include <vector>

namespace ostraka {

/// A path of vertices connected by edges, along which positions are measured.
struct VertexPath {
    std::vector<Index> vertices;  ///< successive vertices
    bool closed = false;
};

/// Paths of an annotation: the outlines of a region, counter-clockwise, or the lines of an annotation. Edges on borders of the
/// mesh or beside a face marked in `broken` (one flag per face; empty: none) are omitted, since the object ends there rather than
/// the annotation. Paths of one vertex are omitted.
std::vector<VertexPath> vertex_paths_of(const Mesh& mesh, const Annotation& part, const std::vector<bool>& broken = {});

/// A template vertex and its target position on a fragment.
struct OutlineCorrespondence {
    Index vertex = no_index;  ///< index of the template's vertex
    Eigen::Vector3d place;    ///< target position on the fragment
    double length = 0;        ///< length of the template's line that the vertex represents
};

/// Matches the vertices of a template's annotation with points along the curves of a fragment's annotation. Positions are
/// interpolated between landmarks common to both paths (`landmarks`: vertex of the template, vertex of the fragment): between two
/// landmarks, by the share of the arc length; beyond the last landmark of an open path, by the arc length from the landmark,
/// scaled by the ratio of the intervals between landmarks, as far as both paths reach; correspondences beyond the last landmark
/// have a quarter of the weight. A closed path with one landmark is traversed once around. A landmark belongs to the path with
/// the nearest vertex, if its distance is less than a twentieth of the path's length. Paths without a common landmark give no
/// correspondences. Outlines have the same orientation on template and fragment; lines are oriented so that more landmarks are in
/// the same order, or else so that the two lines are closer to each other. The fragment is registered to the template scaled by
/// `scale`; targets are in the fragment's coordinates.
std::vector<OutlineCorrespondence> outline_correspondences(const Mesh& mesh, const Annotation& part, const Mesh& fragment,
                                                           const Annotation& of_fragment, const std::vector<bool>& broken,
                                                           const std::vector<std::pair<Index, Index>>& landmarks, double scale);

}  // namespace ostraka

// Comments in IIIF Presentation manifests: annotations with points or well-known text as their targets in a scene.
#pragma once

#include "interchange/placing.h"

#include "ostraka/files/json.h"

#include <Eigen/Geometry>

#include <string>
#include <utility>
#include <vector>

namespace ostraka::interchange {

/// True if a document is a resource of IIIF Presentation (Manifest, Scene, Canvas, Collection, Range) that contains annotations.
bool is_iiif(const JsonValue& document);

/// The annotations of an IIIF document other than content painted into scenes, at any depth, each with its JSON pointer.
std::vector<std::pair<const JsonValue*, std::string>> iiif_comments(const JsonValue& document);

/// The place of a comment in its scene.
struct SceneTarget {
    enum class Kind {
        none,    ///< no point and no well-known text
        points,  ///< each chain holds points
        lines,   ///< each chain is a poly-line
        areas    ///< each chain is the outline of an area
    } kind = Kind::none;
    std::vector<std::vector<Eigen::Vector3d>> chains;
    std::vector<bool> hole = {};  ///< for each chain of areas: true if it bounds a hole of the area before
};

/// Geometry of the first PointSelector or WktSelector of an annotation's target: in `selector`, as an object or in a list, of the
/// target or of its sources. Well-known text in `value` or `wktLiteral`: POINT, LINESTRING, POLYGON, TRIANGLE, their MULTI forms,
/// POLYHEDRALSURFACE and TIN, with or without Z. Throws Error (input) with `where` for well-known text that is not.
SceneTarget scene_target(const JsonValue& annotation, const std::string& where);

/// Similarity from a scene to the coordinates of the mesh: p -> rotation p / scale.
struct SceneMotion {
    Eigen::Quaterniond rotation{1, 0, 0, 0};
    double scale = 1;
    std::string text = {};  ///< in words; empty: the coordinates are those of the mesh
    [[nodiscard]] Eigen::Vector3d operator()(const Eigen::Vector3d& p) const { return rotation * p / scale; }
};

/// Scenes have the coordinates of the mesh, or those of viewers of its GLB: metres, with y up. The first of these motions (own
/// coordinates, then units mm, cm, m, in, ft with the six axes as upward direction) that brings all points within `tolerance` of
/// the surface, preferring the smallest distance among units and axes; none fits: own coordinates.
SceneMotion scene_motion(const std::vector<SceneTarget>& targets, const Placer& placer, double tolerance);

/// The annotation with a selector of the toolkit (web_terms.h) in place of its target, and its label as a tag.
Json with_places(const JsonValue& annotation, const SceneTarget& target, const SceneMotion& motion, const Placer& placer);

}  // namespace ostraka::interchange

// Finds points on one mesh that correspond to the vertices of another mesh (thesis, Algorithm 2 with its erratum).
#pragma once

#include "ostraka/core/angles.h"
#include "ostraka/core/options.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/mesh/mesh.h"

#include <cmath>
#include <string>
#include <vector>

namespace ostraka {

struct CorrespondenceOptions {
    double max_distance = 0.02;  ///< max distance of a corresponding point, as a share of the target's bounding box diagonal
    double max_angle = 90;       ///< max angle between the normals of source vertex and target face, degrees
    /// Choice of the target vertex that corresponds to a source vertex: the corner of the hit face nearest to the hit point
    /// (projection) or to the source vertex (source).
    enum class Corner { projection, source } vertex = Corner::projection;
    /// Cosine of `max_angle`.
    [[nodiscard]] double min_cosine() const { return std::cos(max_angle * pi / 180); }
    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// The method by which a corresponding point was found.
enum class CorrespondenceKind {
    ray,      ///< the line along the vertex normal, in both directions, hit a face with a compatible normal
    closest,  ///< no ray hit such a face: the nearest point with a compatible normal
    none      ///< there is no compatible point within the search radius
};

/// The point on the target that corresponds to a vertex of the source.
struct Correspondence {
    CorrespondenceKind kind = CorrespondenceKind::none;  ///< how the point was found
    SurfaceHit place;         ///< point on the target; place.distance is the distance to the source vertex
    Index vertex = no_index;  ///< corner of the hit face that corresponds to the vertex
    /// True: the first candidate was rejected because it lay on another layer of the surface (such as the other side of a thin
    /// wall) than the candidates of neighbouring vertices.
    bool relocated = false;
};

/// Correspondences of these vertices of `source` on the target, in the order of `vertices`. Runs on all threads. Time: O(k log n)
/// for k vertices and n target faces.
std::vector<Correspondence> find_correspondences(const Mesh& source, const std::vector<Index>& vertices,
                                                 const SurfaceSearch& target, const CorrespondenceOptions& options = {});

/// All candidate correspondences of a vertex, most likely first: hits of the normal line by distance, then the nearest compatible
/// point. Callers choose another candidate if the first one lies on another layer of the surface.
std::vector<Correspondence> candidate_correspondences(const Mesh& source, Index vertex, const SurfaceSearch& target,
                                                      const CorrespondenceOptions& options = {});

/// Test whether two meshes can be two resolutions of the same object in the same position.
struct Agreement {
    double scale = 1;       ///< diagonal of the target divided by diagonal of the source
    double offset = 0;      ///< distance of the centres of the bounding boxes, as a share of the larger diagonal
    double rotation = 0;    ///< angle between the principal axes, degrees; 0 if the axes are not distinct
    bool opposite = false;  ///< true: one of the meshes is inside out, the other is not
    std::string problem;    ///< the difference, its amount and the remedy, as text; empty if the meshes agree
};
/// Compares size, position and orientation of two meshes.
Agreement compare_alignment(const Mesh& source, const Mesh& target);

}  // namespace ostraka

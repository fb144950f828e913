// Corresponding points of the vertices of one mesh on another mesh (thesis, Algorithm 2 with its erratum).
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
    double max_distance = 0.02;  ///< fraction of the target's box diagonal
    double max_angle = 90;       ///< maximum angle in degrees between the normals of vertex and target face
    enum class Corner { projection, source } vertex = Corner::projection;  ///< face corner nearest to projection or source
    /// Cosine of `max_angle`.
    [[nodiscard]] double min_cosine() const { return std::cos(max_angle * pi / 180); }
    void list_options(OptionList& list);
};

enum class CorrespondenceKind {
    ray,      ///< the line along the vertex normal, in both directions, hit a face with a compatible normal
    closest,  ///< no such face: the nearest point with a compatible normal
    none      ///< nothing within the search radius
};

struct Correspondence {
    CorrespondenceKind kind = CorrespondenceKind::none;
    SurfaceHit place;         ///< point on the target; place.distance is the distance to the source vertex
    Index vertex = no_index;  ///< the chosen corner of the face that was hit
    bool relocated = false;   ///< the first candidate was rejected because it lay on another layer than those of its neighbours
};

/// Correspondences of some vertices of `source` on the target, in the order of `vertices`. Uses all threads. O(k log n) for k
/// vertices and n target faces.
std::vector<Correspondence> find_correspondences(const Mesh& source, const std::vector<Index>& vertices,
                                                 const SurfaceSearch& target, const CorrespondenceOptions& options = {});

/// All candidate correspondences of a vertex, most likely first: hits of the normal line by distance, then the nearest
/// compatible point. Used to choose another candidate if the first one lies on another layer.
std::vector<Correspondence> candidate_correspondences(const Mesh& source, Index vertex, const SurfaceSearch& target,
                                                      const CorrespondenceOptions& options = {});

/// Whether two meshes can be two resolutions of the same object in the same position.
struct Agreement {
    double scale = 1;     ///< target diagonal / source diagonal
    double offset = 0;    ///< distance of the box centres as a fraction of the larger diagonal
    double rotation = 0;  ///< angle between the principal axes in degrees; 0 if they are not distinct
    std::string problem;  ///< empty if the meshes agree; otherwise the difference, its amount and the remedy
};
Agreement compare_alignment(const Mesh& source, const Mesh& target);

}  // namespace ostraka

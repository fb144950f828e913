// Where the vertices of one mesh lie on another one (thesis, Algorithm 2 with its erratum).
#pragma once

#include "ostraka/core/mesh.h"
#include "ostraka/core/options.h"
#include "ostraka/geom/surface_search.h"

#include <string>
#include <vector>

namespace ostraka {

struct CorrespondenceOptions {
    double max_distance = 0.02;  ///< share of the target's box diagonal
    double max_angle = 90;       ///< degrees between the normals of vertex and target face
    enum class Corner { projection, source } vertex = Corner::projection;  ///< of the face: nearest to which of the two
    void describe(OptionList& visit);
};

enum class CorrespondenceKind {
    ray,      ///< the line along the vertex normal, both senses, met a face with a matching normal
    closest,  ///< no such face: the nearest point with a matching normal
    none      ///< nothing within reach
};

struct Correspondence {
    CorrespondenceKind kind = CorrespondenceKind::none;
    SurfaceHit place;         ///< on the target; place.distance is that to the source vertex
    Index vertex = no_index;  ///< the corner of the face that was hit
    bool relocated = false;   ///< the first place was on another layer than its neighbours' and was given up
};

/// Correspondences of some vertices of `source` on the target, in the order of `vertices`. Runs on all threads.
/// O(k log n) for k vertices and n target faces.
std::vector<Correspondence> find_correspondences(const Mesh& source, const std::vector<Index>& vertices,
                                                 const SurfaceSearch& target, const CorrespondenceOptions& options = {});

/// All places a vertex may correspond to, likeliest first: hits of the normal's line by distance, then the nearest
/// compatible point. Used to choose again when the first one turns out to lie on another layer.
std::vector<Correspondence> candidate_correspondences(const Mesh& source, Index vertex, const SurfaceSearch& target,
                                                      const CorrespondenceOptions& options = {});

/// Whether two meshes can be two resolutions of one object standing in one place.
struct Agreement {
    double scale = 1;     ///< target diagonal / source diagonal
    double offset = 0;    ///< distance of the box centres, as a share of the larger diagonal
    double rotation = 0;  ///< angle between the principal axes, in degrees; 0 where they are not distinct
    std::string problem;  ///< empty if the meshes agree; otherwise what differs, by how much and the remedy
};
Agreement compare_alignment(const Mesh& source, const Mesh& target);

}  // namespace ostraka

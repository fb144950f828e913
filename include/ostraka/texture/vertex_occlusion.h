// Ambient occlusion and sky view at the vertices of a mesh.
#pragma once

#include "ostraka/mesh/mesh.h"

#include <vector>

namespace ostraka {

struct VertexOcclusionOptions {
    int rays = 64;           ///< number of rays per vertex
    double distance = 0.25;  ///< length of the rays, as a fraction of the diagonal of the bounding box
};

/// Ambient occlusion: for each vertex the share of the hemisphere around its normal, weighted by the cosine, through which rays
/// meet no surface; 1 is open. NaN at vertices without a normal. The same for any number of threads. Throws Error (usage) unless
/// the number of rays and the distance are positive.
std::vector<double> vertex_occlusion(const Mesh& mesh, const VertexOcclusionOptions& options = {});

/// Sky-view factor (Zaksek, Ostir and Kokalj 2011): for each vertex the share of the solid angle of the hemisphere around `up`
/// that is open; 1 on a plane, less in grooves. NaN and errors likewise; Error (usage) also for a null vector.
std::vector<double> vertex_sky_view(const Mesh& mesh, const Vector& up, const VertexOcclusionOptions& options = {});

}  // namespace ostraka

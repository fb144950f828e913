#include "ostraka/texture/vertex_occlusion.h"

#include "texture/occlusion.h"

#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"
#include "ostraka/execution/parallel.h"

#include <limits>
#include <optional>

namespace ostraka {

namespace {

using texture::Occlusion;

std::vector<double> open_shares(const Mesh& mesh, const VertexOcclusionOptions& options, const std::optional<Vector>& up) {
    if (options.rays < 1 || !(options.distance > 0))
        fail_usage("occlusion needs rays of a length", "give a positive number of rays and a positive distance");
    std::vector<double> shares(mesh.number_of_vertices(), std::numeric_limits<double>::quiet_NaN());
    if (mesh.number_of_faces() == 0) return shares;
    const Occlusion occlusion(mesh, options.rays, options.distance,
                              up ? Occlusion::Weighting::uniform : Occlusion::Weighting::cosine);
    Progress progress("occlusion", shares.size());
    parallel_blocks(shares.size(), 512, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Vertex vertex(static_cast<Index>(i));
            const Vector normal = vertex_normal(mesh, vertex);
            if (normal == CGAL::NULL_VECTOR) continue;
            shares[i] = static_cast<double>(occlusion.open_share(mesh.point(vertex), normal, up ? *up : normal, i));
        }
        progress.advance(end - begin);
    });
    return shares;
}

}  // namespace

std::vector<double> vertex_occlusion(const Mesh& mesh, const VertexOcclusionOptions& options) {
    return open_shares(mesh, options, std::nullopt);
}

std::vector<double> vertex_sky_view(const Mesh& mesh, const Vector& up, const VertexOcclusionOptions& options) {
    if (!(up.squared_length() > 0)) fail_usage("the upward direction has no length", "give a direction such as 0,0,1");
    return open_shares(mesh, options, up);
}

}  // namespace ostraka

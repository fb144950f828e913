#include "ostraka/geom/ray_search.h"

#include "geom/face_tree.h"

namespace ostraka {

struct RaySearch::Tree {
    FaceTree faces;
};

RaySearch::RaySearch(const Mesh& mesh) : tree_(std::make_unique<Tree>(Tree{FaceTree(mesh)})) {}
RaySearch::~RaySearch() = default;
RaySearch::RaySearch(RaySearch&&) noexcept = default;

std::optional<RayExit> RaySearch::first_exit(const Point& origin, const Vector& direction, Index ignored,
                                             double min_distance) const {
    return tree_->faces.first_exit(origin, direction, ignored, min_distance);
}

}  // namespace ostraka

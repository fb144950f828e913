// Maps places of one mesh to places of another mesh along the normals of the coarser mesh.
#pragma once

#include "ostraka/geom/surface_point.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/transfer/correspondence.h"

#include <optional>

namespace ostraka {

/// A place on the source and its corresponding place on the target.
struct MappedPlace {
    SurfacePoint from;       ///< place on the source
    Point start{0, 0, 0};    ///< coordinates of `from`
    Vector normal{0, 0, 0};  ///< normal of the source at `from`
    CorrespondenceKind kind = CorrespondenceKind::none;
    SurfacePoint to;      ///< place on the target
    Point end{0, 0, 0};   ///< coordinates of `to`
    Vector up{0, 0, 0};   ///< normal of the target at `to`
    bool mutual = false;  ///< true: the line from `to` first meets the source at `from`, so that the mapping is invertible there
};

/// Interpolated vertex normal at a place, not normalised.
Vector smooth_normal(const Mesh& mesh, const SurfacePoint& p);

/// Finds the places on a target that correspond to places on a source. Both meshes must outlive this object.
class PlaceMapping {
public:
    PlaceMapping(const Mesh& source, const SurfaceSearch& target, const CorrespondenceOptions& options);

    /// The place on the target that corresponds to a place on the source.
    [[nodiscard]] MappedPlace operator()(const SurfacePoint& place) const;

    [[nodiscard]] double edge() const { return edge_; }  ///< typical edge length of the target
    [[nodiscard]] double far() const { return far_; }    ///< search radius, a length
    /// Cosine of the max angle between the normals of corresponding places.
    [[nodiscard]] double min_cosine() const { return min_cosine_; }
    /// True: places correspond along the target's normals, since the target is the coarser mesh.
    [[nodiscard]] bool by_target_normals() const { return on_source_.has_value(); }

private:
    /// Moves a place (barycentric weights) in a nearly degenerate face to the longest edge of the face.
    [[nodiscard]] std::array<double, 3> on_longest_edge(Index face, std::array<double, 3> weights) const;
    [[nodiscard]] bool is_mutual(const MappedPlace& mapped) const;  ///< whether the mapping is invertible at the place
    /// Place of the target whose interpolated normal passes through p.
    [[nodiscard]] std::optional<SurfaceHit> along_target_normal(const Point& p, const Vector& normal) const;
    /// The place of a face with these weights, if it is near p and its normal is compatible; otherwise empty.
    [[nodiscard]] std::optional<SurfaceHit> hit_in(Index face, const std::array<double, 3>& weights, const Point& p,
                                                   const Vector& normal) const;

    const Mesh& source_;
    const SurfaceSearch& search_;
    const Mesh& target_;
    double edge_, far_, min_cosine_;  ///< edge length of the target; search radius; cosine of the max angle between normals
    std::optional<SurfaceSearch> on_source_;  ///< search tree of the source, if the target is the coarser mesh
};

}  // namespace ostraka

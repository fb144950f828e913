// Mapping of places of one mesh to another along the normals of the coarser mesh.
#pragma once

#include "ostraka/geom/surface_point.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/transfer/correspondence.h"

#include <optional>

namespace ostraka {

/// A place of the source and its corresponding place on the target.
struct MappedPlace {
    SurfacePoint from;
    Point start{0, 0, 0};    ///< coordinates of `from`
    Vector normal{0, 0, 0};  ///< of the source at `from`
    CorrespondenceKind kind = CorrespondenceKind::none;
    SurfacePoint to;
    Point end{0, 0, 0};   ///< coordinates of `to`
    Vector up{0, 0, 0};   ///< of the target at `to`
    bool mutual = false;  ///< the line from `to` first meets the source at `from`: the mapping is invertible there
};

/// Interpolated vertex normal, not normalised.
Vector smooth_normal(const Mesh& mesh, const SurfacePoint& p);

/// Finds corresponding places of a source on a target. Both must outlive it.
class PlaceMapping {
public:
    PlaceMapping(const Mesh& source, const SurfaceSearch& target, const CorrespondenceOptions& options);

    [[nodiscard]] MappedPlace operator()(const SurfacePoint& place) const;

    [[nodiscard]] double edge() const { return edge_; }  ///< typical edge length of the target
    [[nodiscard]] double far() const { return far_; }    ///< search radius
    [[nodiscard]] double min_cosine() const { return min_cosine_; }
    [[nodiscard]] bool by_target_normals() const { return on_source_.has_value(); }  ///< true: the target is the coarser mesh

private:
    [[nodiscard]] std::array<double, 3> on_longest_edge(Index face, std::array<double, 3> weights) const;
    [[nodiscard]] bool is_mutual(const MappedPlace& mapped) const;
    [[nodiscard]] std::optional<SurfaceHit> along_target_normal(const Point& p, const Vector& normal) const;
    [[nodiscard]] std::optional<SurfaceHit> hit_in(Index face, const std::array<double, 3>& weights, const Point& p,
                                                   const Vector& normal) const;

    const Mesh& source_;
    const SurfaceSearch& search_;
    const Mesh& target_;
    double edge_, far_, min_cosine_;
    std::optional<SurfaceSearch> on_source_;  ///< set if the target is the coarser mesh
};

}  // namespace ostraka

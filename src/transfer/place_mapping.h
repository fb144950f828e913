// Where places of one mesh are on another, along the normals of the coarser of the two.
#pragma once

#include "ostraka/geom/surface_search.h"
#include "ostraka/geom/surface_trace.h"
#include "ostraka/transfer/correspondence.h"

#include <cmath>
#include <optional>

namespace ostraka {

/// A place of the source and where it is on the target.
struct MappedPlace {
    SurfaceNode from;
    Vector normal{0, 0, 0};  ///< of the source there
    CorrespondenceKind kind = CorrespondenceKind::none;
    SurfaceNode to;
    Vector up{0, 0, 0};   ///< of the target there
    bool mutual = false;  ///< from there the same line meets the place first: there is one way back
};

/// The vertex normals, interpolated; of no particular length.
Vector smooth_normal(const Mesh& mesh, const SurfaceNode& node);

inline double gap_between(const Point& a, const Point& b) { return std::sqrt(CGAL::squared_distance(a, b)); }

/// Finds places of a source on a target. Both must outlive it.
class PlaceMapping {
public:
    PlaceMapping(const Mesh& source, const SurfaceSearch& target, const CorrespondenceOptions& options);

    [[nodiscard]] MappedPlace operator()(const SurfacePlace& place) const;

    [[nodiscard]] double edge() const { return edge_; }  ///< typical, of the target
    [[nodiscard]] double far() const { return far_; }    ///< beyond that nothing corresponds
    [[nodiscard]] double min_cosine() const { return min_cosine_; }
    [[nodiscard]] bool by_target_normals() const { return on_source_.has_value(); }  ///< the target is the coarser

private:
    [[nodiscard]] std::array<double, 3> on_longest_edge(Index face, std::array<double, 3> weights) const;
    [[nodiscard]] bool is_mutual(const MappedPlace& one) const;
    [[nodiscard]] std::optional<SurfaceHit> along_target_normal(const Point& p, const Vector& normal) const;
    [[nodiscard]] std::optional<SurfaceHit> hit_in(Index face, const std::array<double, 3>& weights, const Point& p,
                                                   const Vector& normal) const;

    const Mesh& source_;
    const SurfaceSearch& search_;
    const Mesh& target_;
    double edge_, far_, min_cosine_;
    std::optional<SurfaceSearch> on_source_;  ///< where the target is the coarser
};

}  // namespace ostraka

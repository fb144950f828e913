// Places on the source of a bake.
#pragma once

#include "ostraka/geom/surface_search.h"
#include "ostraka/texture/bake.h"

#include <array>

namespace ostraka::texture {

/// Where the source was found from a point of the target.
struct SourcePlace {
    enum class Found { by_ray, by_nearest, nowhere } found = Found::nowhere;
    SurfaceHit hit;
    double height = 0;  ///< height of the source above the target along the normal
};

/// Finds the source from points of the target.
class SourceLookup {
public:
    SourceLookup(const Mesh& source, double distance) : search_(source), distance_(distance) {}
    /// `normal`: unit normal of the target; the null vector: only the nearest point is searched.
    [[nodiscard]] SourcePlace find(const Point& point, const Vector& normal) const;

private:
    [[nodiscard]] bool along_normal(const Point& point, const Vector& normal, double distance, SourcePlace& place) const;

    SurfaceSearch search_;
    double distance_;
};

/// Counts of samples, gathered in a fixed order.
struct PlaceCounts {
    BakeCounts counts;
    double sum = 0;  ///< of the distances

    void add(const SourcePlace& place);
    void add(const PlaceCounts& other);
    [[nodiscard]] BakeCounts result() const;
};

}  // namespace ostraka::texture

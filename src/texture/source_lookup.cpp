#include "texture/source_lookup.h"

#include <algorithm>
#include <cmath>

namespace ostraka::texture {

namespace {
constexpr double short_ray = 1.0 / 32;  ///< share of the distance that is searched first
}

bool SourceLookup::along_normal(const Point& point, const Vector& normal, double distance, SourcePlace& place) const {
    for (const SurfaceHit& hit : search_.line_hits(point, normal, distance)) {
        if (!(search_.normal(hit.face) * normal > 0)) continue;
        place.found = SourcePlace::Found::by_ray;
        place.height = hit.distance;
        place.hit = hit;
        place.hit.distance = std::abs(hit.distance);
        return true;
    }
    return false;
}

SourcePlace SourceLookup::find(const Point& point, const Vector& normal) const {
    SourcePlace place;
    if (normal != CGAL::NULL_VECTOR) {
        if (along_normal(point, normal, distance_ * short_ray, place) || along_normal(point, normal, distance_, place)) return place;
        if (const auto hit = search_.closest_compatible(point, normal, 0, distance_)) {
            place.hit = *hit;
            place.found = SourcePlace::Found::by_nearest;
        }
    }
    if (place.found == SourcePlace::Found::nowhere) {
        place.hit = search_.closest(point);
        if (place.hit.distance <= distance_) place.found = SourcePlace::Found::by_nearest;
    }
    if (place.found == SourcePlace::Found::by_nearest) place.height = (place.hit.point - point) * normal;
    return place;
}

void PlaceCounts::add(const SourcePlace& place) {
    if (place.found == SourcePlace::Found::nowhere) {
        ++counts.without;
        return;
    }
    ++(place.found == SourcePlace::Found::by_ray ? counts.by_ray : counts.by_nearest);
    sum += place.hit.distance;
    counts.largest_distance = std::max(counts.largest_distance, place.hit.distance);
}

void PlaceCounts::add(const PlaceCounts& other) {
    counts.by_ray += other.counts.by_ray;
    counts.by_nearest += other.counts.by_nearest;
    counts.without += other.counts.without;
    counts.largest_distance = std::max(counts.largest_distance, other.counts.largest_distance);
    sum += other.sum;
}

BakeCounts PlaceCounts::result() const {
    BakeCounts result = counts;
    const std::size_t with_source = counts.by_ray + counts.by_nearest;
    if (with_source > 0) result.mean_distance = sum / static_cast<double>(with_source);
    return result;
}

}  // namespace ostraka::texture

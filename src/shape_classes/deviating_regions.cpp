#include "ostraka/shape_classes/deviating_regions.h"

#include "ostraka/execution/parallel.h"
#include "ostraka/mesh/flood.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

/// Points sampled evenly over a surface: the given number, or the centroid of each face if there are fewer faces.
struct SurfaceSamples {
    std::vector<Index> faces;
    std::vector<Point> points;
    std::vector<Vector> normals;
};

SurfaceSamples sample_surface(const Mesh& mesh, std::size_t count) {
    SurfaceSamples surface_samples;
    const double area = surface_area(mesh);
    double sum = 0, next = 0.5 * area / static_cast<double>(count);
    for (const Face face : mesh.faces()) {
        sum += face_area(mesh, face);
        if (sum < next) continue;
        const Vector normal = area_vector(mesh, face);
        const double length = std::sqrt(normal.squared_length());
        for (; next < sum; next += area / static_cast<double>(count)) {
            surface_samples.faces.push_back(face.idx());
            surface_samples.points.push_back(centroid(mesh, face));
            surface_samples.normals.push_back(length > 0 ? normal / length : normal);
        }
    }
    return surface_samples;
}

struct SampleOff {
    double distance = 0;
    Index nearest = no_index;
    bool off = false;
};

constexpr std::size_t max_samples = 5000;
constexpr double min_normal_cosine = 0.5;  ///< cosine of 60 degrees
constexpr double min_region_share = 0.01;  ///< minimum area of a reported region

/// For each face, a sample on it, or on the nearest face that has one.
std::vector<std::size_t> samples_of_faces(const Mesh& mesh, const SurfaceSamples& surface_samples) {
    constexpr auto no_sample = static_cast<std::size_t>(-1);
    std::vector<std::size_t> sample(mesh.number_of_faces(), no_sample);
    std::vector<Index> front;
    for (std::size_t i = 0; i < surface_samples.faces.size(); ++i)
        if (sample[surface_samples.faces[i]] == no_sample)
            sample[surface_samples.faces[i]] = i, front.push_back(surface_samples.faces[i]);
    for (std::size_t i = 0; i < front.size(); ++i)
        for (const Halfedge h : mesh.halfedges_around_face(mesh.halfedge(Face(front[i])))) {
            const Halfedge o = mesh.opposite(h);
            if (mesh.is_border(o)) continue;
            const Index next = mesh.face(o).idx();
            if (sample[next] == no_sample) sample[next] = sample[front[i]], front.push_back(next);
        }
    return sample;
}

std::vector<DeviatingRegion> regions_of(const Mesh& mesh, const SurfaceSamples& surface_samples,
                                        const std::vector<SampleOff>& samples) {
    std::vector<DeviatingRegion> regions;
    const std::vector<std::size_t> sample = samples_of_faces(mesh, surface_samples);
    const double area = surface_area(mesh);
    std::vector<bool> is_visited(mesh.number_of_faces());
    const auto is_off = [&](Index face) { return sample[face] < samples.size() && samples[sample[face]].off; };
    for (const Face seed : mesh.faces()) {
        if (is_visited[seed] || !is_off(seed.idx())) continue;
        DeviatingRegion region;
        Vector sum(0, 0, 0);
        double region_area = 0;
        const auto is_off_across = [&](Halfedge h) {
            const Halfedge o = mesh.opposite(h);
            return !mesh.is_border(o) && is_off(mesh.face(o).idx());
        };
        for (const Face face : flood_faces(mesh, seed, is_visited, is_off_across)) {
            const double a = face_area(mesh, face);
            region_area += a;
            sum += a * (centroid(mesh, face) - CGAL::ORIGIN);
            const SampleOff& sample_off = samples[sample[face]];
            if (region.nearest_face == no_index || sample_off.distance > region.farthest) {
                region.farthest = sample_off.distance;
                region.at = surface_samples.points[sample[face]];
                region.face = surface_samples.faces[sample[face]];
                region.nearest_face = sample_off.nearest;
            }
        }
        region.share = region_area / area;
        if (region.share < min_region_share) continue;
        region.middle = CGAL::ORIGIN + sum / region_area;
        regions.push_back(region);
    }
    std::stable_sort(regions.begin(), regions.end(), [](const auto& a, const auto& b) { return a.share > b.share; });
    return regions;
}

}  // namespace

std::vector<bool> inner_wall_faces(const Mesh& object, const SurfaceSearch& other, double max_distance) {
    const SurfaceSamples surface_samples = sample_surface(object, max_samples);
    const SurfaceSearch object_search(object);
    std::vector<char> inside(surface_samples.points.size(), 0);
    parallel_for(inside.size(), [&](std::size_t i) {
        const SurfaceHit hit = other.closest(surface_samples.points[i]);
        const Vector normal = other.normal(hit.face);
        if (!(normal * surface_samples.normals[i] < 0) || !(normal * (surface_samples.points[i] - hit.point) < 0)) return;
        if (hit.distance <= max_distance &&
            other.closest_compatible(surface_samples.points[i], surface_samples.normals[i], min_normal_cosine, max_distance))
            return;
        inside[i] = object_search.closest_compatible(hit.point, normal, min_normal_cosine, max_distance).has_value();
    });
    const std::vector<std::size_t> sample = samples_of_faces(object, surface_samples);
    std::vector<bool> flags(object.number_of_faces(), false);
    for (const Face f : object.faces()) flags[f] = sample[f] < inside.size() && inside[sample[f]] != 0;
    const FacePieces pieces = face_pieces(object, [&](Face f) { return flags[f]; });
    std::vector<double> area(pieces.count, 0);
    for (const Face f : object.faces())
        if (flags[f]) area[pieces.of_face[f]] += face_area(object, f);
    const double min_area = min_region_share * surface_area(object);
    for (const Face f : object.faces()) flags[f] = flags[f] && area[pieces.of_face[f]] >= min_area;
    return flags;
}

SurfaceDeviation surface_deviation(const Mesh& mesh, const SurfaceSearch& other, double max_distance) {
    const SurfaceSamples surface_samples = sample_surface(mesh, max_samples);
    std::vector<SampleOff> samples(surface_samples.points.size());
    parallel_for(samples.size(), [&](std::size_t i) {
        const SurfaceHit hit = other.closest(surface_samples.points[i]);
        samples[i] = {
            hit.distance, hit.face,
            hit.distance > max_distance || !other.closest_compatible(surface_samples.points[i], surface_samples.normals[i],
                                                                     min_normal_cosine, max_distance)};
    });
    SurfaceDeviation result;
    const auto n = static_cast<double>(std::max<std::size_t>(1, samples.size()));
    for (const SampleOff& sample : samples) {
        result.distance += sample.distance * sample.distance / n;
        result.share += sample.off ? 1 / n : 0;
    }
    result.distance = std::sqrt(result.distance);
    result.regions = regions_of(mesh, surface_samples, samples);
    return result;
}

}  // namespace ostraka

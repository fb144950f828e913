#include "ostraka/shape_classes/off_regions.h"

#include "ostraka/core/parallel.h"
#include "ostraka/geom/submesh.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

/// Points sampled evenly over a surface: the given number, or the centroid of each face if there are fewer faces.
struct Spread {
    std::vector<Index> faces;
    std::vector<Point> points;
    std::vector<Vector> normals;
};

Spread spread_over(const Mesh& mesh, std::size_t count) {
    Spread spread;
    const double area = surface_area(mesh);
    double sum = 0, next = 0.5 * area / static_cast<double>(count);
    for (const Face face : mesh.faces()) {
        sum += face_area(mesh, face);
        if (sum < next) continue;
        const Vector normal = area_vector(mesh, face);
        const double length = std::sqrt(normal.squared_length());
        for (; next < sum; next += area / static_cast<double>(count)) {
            spread.faces.push_back(face.idx());
            spread.points.push_back(centroid(mesh, face));
            spread.normals.push_back(length > 0 ? normal / length : normal);
        }
    }
    return spread;
}

struct SampleOff {
    double distance = 0;
    Index nearest = no_index;
    bool off = false;
};

constexpr std::size_t max_samples = 5000;
constexpr double like_normals = 0.5;  ///< cosine of 60 degrees
constexpr double least_share = 0.01;  ///< minimum area of a reported region

/// For each face, a sample on it, or on the nearest face that has one.
std::vector<std::size_t> samples_of_faces(const Mesh& mesh, const Spread& spread) {
    constexpr auto none = static_cast<std::size_t>(-1);
    std::vector<std::size_t> sample(mesh.number_of_faces(), none);
    std::vector<Index> front;
    for (std::size_t i = 0; i < spread.faces.size(); ++i)
        if (sample[spread.faces[i]] == none) sample[spread.faces[i]] = i, front.push_back(spread.faces[i]);
    for (std::size_t i = 0; i < front.size(); ++i)
        for (const Halfedge h : mesh.halfedges_around_face(mesh.halfedge(Face(front[i])))) {
            const Halfedge o = mesh.opposite(h);
            if (mesh.is_border(o)) continue;
            const Index next = mesh.face(o).idx();
            if (sample[next] == none) sample[next] = sample[front[i]], front.push_back(next);
        }
    return sample;
}

std::vector<OffRegion> regions_of(const Mesh& mesh, const Spread& spread, const std::vector<SampleOff>& samples) {
    std::vector<OffRegion> regions;
    const std::vector<std::size_t> sample = samples_of_faces(mesh, spread);
    const double area = surface_area(mesh);
    std::vector<bool> seen(mesh.number_of_faces());
    const auto is_off = [&](Index face) { return sample[face] < samples.size() && samples[sample[face]].off; };
    for (const Face seed : mesh.faces()) {
        if (seen[seed] || !is_off(seed.idx())) continue;
        OffRegion region;
        std::vector<Index> front{seed.idx()};
        seen[seed] = true;
        Vector sum(0, 0, 0);
        double own = 0;
        for (std::size_t i = 0; i < front.size(); ++i) {
            const Face face(front[i]);
            const double a = face_area(mesh, face);
            own += a;
            sum += a * (centroid(mesh, face) - CGAL::ORIGIN);
            const SampleOff& here = samples[sample[face]];
            if (region.nearest_face == no_index || here.distance > region.farthest) {
                region.farthest = here.distance;
                region.at = spread.points[sample[face]];
                region.face = spread.faces[sample[face]];
                region.nearest_face = here.nearest;
            }
            for (const Halfedge h : mesh.halfedges_around_face(mesh.halfedge(face))) {
                const Halfedge o = mesh.opposite(h);
                if (mesh.is_border(o)) continue;
                const Index next = mesh.face(o).idx();
                if (!seen[next] && is_off(next)) seen[next] = true, front.push_back(next);
            }
        }
        region.share = own / area;
        if (region.share < least_share) continue;
        region.middle = CGAL::ORIGIN + sum / own;
        regions.push_back(region);
    }
    std::stable_sort(regions.begin(), regions.end(), [](const auto& a, const auto& b) { return a.share > b.share; });
    return regions;
}

}  // namespace

std::vector<bool> insides_of_walls(const Mesh& object, const SurfaceSearch& other, double near) {
    const Spread spread = spread_over(object, max_samples);
    const SurfaceSearch own(object);
    std::vector<char> inside(spread.points.size(), 0);
    parallel_for(inside.size(), [&](std::size_t i) {
        const SurfaceHit hit = other.closest(spread.points[i]);
        const Vector normal = other.normal(hit.face);
        if (!(normal * spread.normals[i] < 0) || !(normal * (spread.points[i] - hit.point) < 0)) return;
        if (hit.distance <= near && other.closest_compatible(spread.points[i], spread.normals[i], like_normals, near)) return;
        inside[i] = own.closest_compatible(hit.point, normal, like_normals, near).has_value();
    });
    const std::vector<std::size_t> sample = samples_of_faces(object, spread);
    std::vector<bool> flags(object.number_of_faces(), false);
    for (const Face f : object.faces()) flags[f] = sample[f] < inside.size() && inside[sample[f]] != 0;
    const FacePieces pieces = face_pieces(
        object, [&](Face f) { return flags[f]; }, [](Halfedge) { return true; });
    std::vector<double> area(pieces.count, 0);
    for (const Face f : object.faces())
        if (flags[f]) area[pieces.of_face[f]] += face_area(object, f);
    const double least = least_share * surface_area(object);
    for (const Face f : object.faces()) flags[f] = flags[f] && area[pieces.of_face[f]] >= least;
    return flags;
}

SurfaceOff surface_off(const Mesh& mesh, const SurfaceSearch& other, double near) {
    const Spread spread = spread_over(mesh, max_samples);
    std::vector<SampleOff> samples(spread.points.size());
    parallel_for(samples.size(), [&](std::size_t i) {
        const SurfaceHit hit = other.closest(spread.points[i]);
        samples[i] = {hit.distance, hit.face,
                      hit.distance > near || !other.closest_compatible(spread.points[i], spread.normals[i], like_normals, near)};
    });
    SurfaceOff result;
    const auto n = static_cast<double>(std::max<std::size_t>(1, samples.size()));
    for (const SampleOff& one : samples) {
        result.distance += one.distance * one.distance / n;
        result.share += one.off ? 1 / n : 0;
    }
    result.distance = std::sqrt(result.distance);
    result.regions = regions_of(mesh, spread, samples);
    return result;
}

}  // namespace ostraka

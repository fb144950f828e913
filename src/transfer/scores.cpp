#include "scores.h"

#include "ostraka/annotation/outline.h"
#include "ostraka/core/parallel.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

Distortions distortions(const TransferScore& score) {
    const auto off = [](double target, double source) { return source > 0 ? std::abs(target / source - 1) : 0.0; };
    const double a = score.source_area, b = score.target_area, p = score.source_length, q = score.target_length;
    Distortions d{};
    d.area = off(b, a);
    d.perimeter = off(q, p);
    d.perimeter_by_area = b > 0 && a > 0 ? off(q / b, p / a) : 0;
    d.area_by_perimeter = q > 0 && p > 0 ? off(b / q, a / p) : 0;
    d.circularity = b > 0 && a > 0 ? off(q * q / b, p * p / a) : 0;
    d.mean = (d.area + d.perimeter + d.perimeter_by_area + d.area_by_perimeter + d.circularity) / 5;
    return d;
}

double overlapping_area(const Mesh& mesh, const std::vector<Index>& region, const SurfaceSearch& other,
                        const CorrespondenceOptions& options, std::size_t max_inner,
                        const std::function<bool(const SurfaceHit&)>& contains) {
    // Vertices on the outline and their neighbours make the band that is sampled finely.
    std::vector<bool> on_rim(mesh.number_of_vertices(), false), near = on_rim;
    std::vector<Index> rim;
    for (const Outline& outline : extract_outlines(mesh, region))
        for (const Index v : outline) rim.push_back(v);
    for (const Index v : rim) {
        near[v] = on_rim[v] = true;
        for (const Halfedge h : CGAL::halfedges_around_source(Vertex(v), mesh)) near[mesh.target(h)] = true;
    }
    const double fine = 0.3 * other.typical_edge();
    const double search_radius = options.max_distance * other.diagonal();
    const double min_cosine = std::cos(options.max_angle * CGAL_PI / 180);
    const std::size_t stride = std::max<std::size_t>(1, (region.size() + max_inner - 1) / std::max<std::size_t>(1, max_inner));
    std::vector<double> inside(region.size(), -1), area_of(region.size(), 0);
    parallel_for(
        region.size(),
        [&](std::size_t i) {
            const Face f(region[i]);
            const auto [a, b, c] = corners(mesh, f);
            const Vector area = area_vector(mesh, f);
            const double length = std::sqrt(area.squared_length());
            area_of[i] = length;
            if (!(length > 0)) return;
            const Vector normal = area / length;
            int k = 1;
            const bool in_band = near[a] || near[b] || near[c];
            if (!in_band && i % stride != 0) return;
            if (in_band) {
                const double size = std::sqrt(std::max({CGAL::squared_distance(mesh.point(a), mesh.point(b)),
                                                        CGAL::squared_distance(mesh.point(b), mesh.point(c)),
                                                        CGAL::squared_distance(mesh.point(c), mesh.point(a))}));
                k = std::clamp(static_cast<int>(std::ceil(size / fine)), 2, 8);
            }
            const auto share_inside = [&](int n) {  // at the centroids of the n * n equal triangles of a regular subdivision
                int hits = 0;
                for (int u = 0; u < n; ++u)
                    for (int v = 0; u + v < n; ++v)
                        for (int half = 0; half < (u + v + 1 < n ? 2 : 1); ++half) {
                            const double s = (u + (half == 0 ? 1.0 : 2.0) / 3) / n, t = (v + (half == 0 ? 1.0 : 2.0) / 3) / n;
                            const Point p =
                                mesh.point(a) + s * (mesh.point(b) - mesh.point(a)) + t * (mesh.point(c) - mesh.point(a));
                            const auto hit = other.closest_compatible(p, normal, min_cosine, search_radius);
                            if (hit && contains(*hit)) ++hits;
                        }
                return static_cast<double>(hits) / (n * n);
            };
            // A strip away from the outline, four samples that agree will do.
            const bool at_rim = on_rim[a] || on_rim[b] || on_rim[c];
            double share = share_inside(at_rim ? k : std::min(k, 2));
            if (!at_rim && k > 2 && share < 1) share = share_inside(k);
            inside[i] = length * share;
        },
        64);
    // Faces that were passed over share the lot of those inside that were not.
    double sum = 0, passed_over = 0, inner = 0, inner_inside = 0;
    for (std::size_t i = 0; i < region.size(); ++i) {
        if (inside[i] < 0) {
            passed_over += area_of[i];
            continue;
        }
        sum += inside[i];
        const auto vertices = corners(mesh, Face(region[i]));
        if (std::any_of(vertices.begin(), vertices.end(), [&](Vertex v) { return near[v]; })) continue;
        inner += area_of[i];
        inner_inside += inside[i];
    }
    return sum + (inner > 0 ? passed_over * inner_inside / inner : passed_over);
}

void score_overlap(const RegionOn& source, const RegionOn& target, const CorrespondenceOptions& options,
                   const std::function<bool(const SurfaceHit&)>& in_target, TransferScore& score) {
    constexpr std::size_t max_inner = 5000;
    std::vector<bool> in_source(source.mesh.number_of_faces(), false);
    for (const Index f : source.faces) in_source[f] = true;
    const double arrived = overlapping_area(source.mesh, source.faces, target.search, options, max_inner, in_target);
    const double came = overlapping_area(target.mesh, target.faces, source.search, options, max_inner,
                                         [&](const SurfaceHit& hit) { return static_cast<bool>(in_source[hit.face]); });
    const double common = (arrived + came) / 2;
    score.overlap = common / (score.source_area + score.target_area - common);
    score.wrong_side = std::max(0.0, score.source_area - arrived) + std::max(0.0, score.target_area - came);
}

std::vector<bool> region_by_vote(const Mesh& source, const SurfaceSearch& source_search, const std::vector<Index>& region,
                                 const Mesh& target, const CorrespondenceOptions& options) {
    std::vector<bool> in_region(source.number_of_faces(), false);
    CGAL::Bbox_3 box;
    for (const Index f : region) {
        in_region[f] = true;
        for (const Vertex v : corners(source, Face(f))) box += source.point(v).bbox();
    }
    const double search_radius = options.max_distance * box_diagonal(target);
    const double min_cosine = std::cos(options.max_angle * CGAL_PI / 180);
    std::vector<std::uint8_t> vote(target.number_of_faces(), 0);
    parallel_for(
        target.number_of_faces(),
        [&](std::size_t i) {
            const Face f(static_cast<Index>(i));
            const Point p = centroid(target, f);
            if (p.x() < box.xmin() - search_radius || p.x() > box.xmax() + search_radius || p.y() < box.ymin() - search_radius ||
                p.y() > box.ymax() + search_radius || p.z() < box.zmin() - search_radius || p.z() > box.zmax() + search_radius)
                return;
            const Vector area = area_vector(target, f);
            const double length = std::sqrt(area.squared_length());
            const auto hit = source_search.closest_compatible(p, length > 0 ? area / length : area, length > 0 ? min_cosine : -1,
                                                              search_radius);
            vote[i] = hit && in_region[hit->face] ? 1 : 0;
        },
        1024);
    return {vote.begin(), vote.end()};
}

Segments segments_of(const Mesh& mesh, const Annotation& annotation) {
    Segments segments;
    const auto add = [&](Index a, Index b) { segments.emplace_back(mesh.point(Vertex(a)), mesh.point(Vertex(b))); };
    for (const Index v : annotation.points) add(v, v);
    for (const auto& line : annotation.polylines) {
        if (line.size() == 1) add(line[0], line[0]);
        for (std::size_t i = 0; i + 1 < line.size(); ++i) add(line[i], line[i + 1]);
    }
    for (const Outline& outline : extract_outlines(mesh, annotation.faces))
        for (std::size_t i = 0; i < outline.size(); ++i) add(outline[i], outline[(i + 1) % outline.size()]);
    return segments;
}

double length_of(const Segments& segments) {
    double sum = 0;
    for (const auto& [a, b] : segments) sum += std::sqrt(CGAL::squared_distance(a, b));
    return sum;
}

}  // namespace ostraka

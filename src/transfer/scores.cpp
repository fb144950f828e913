#include "transfer/scores.h"

#include "ostraka/execution/parallel.h"

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

namespace {

/// Estimates by sampling the area of a region of one mesh whose corresponding places lie in the corresponding region of the
/// other mesh. The pieces may be processed in parallel.
class RegionSamples {
public:
    RegionSamples(const Mesh& mesh, const RegionArea& area, const SurfaceSearch& other, const CorrespondenceOptions& options,
                  std::function<bool(const SurfaceHit&)> contains)
        : mesh_(mesh),
          region_(area.faces),
          free_(area.free.get()),
          other_(other),
          contains_(std::move(contains)),
          on_rim_(mesh.number_of_vertices(), false),
          near_(on_rim_),
          fine_(0.3 * other.typical_edge()),
          search_radius_(options.max_distance * other.diagonal()),
          min_cosine_(options.min_cosine()),
          stride_(std::max<std::size_t>(1, (region_.size() + max_inner - 1) / max_inner)),
          sums_((region_.size() + piece_size - 1) / piece_size) {
        for (const Index v : area.rim) {
            near_[v] = on_rim_[v] = true;
            for (const Halfedge h : CGAL::halfedges_around_source(Vertex(v), mesh)) near_[mesh.target(h)] = true;
        }
    }

    [[nodiscard]] std::size_t pieces() const { return sums_.size(); }

    void sample(std::size_t piece) {
        for (std::size_t i = piece * piece_size; i < std::min(region_.size(), (piece + 1) * piece_size); ++i)
            sample_face(i, sums_[piece]);
    }

    /// The area inside, after all pieces have been sampled. For skipped faces, the fraction inside is that of the sampled inner
    /// faces.
    [[nodiscard]] double area_inside() const {
        Sums sums;
        for (const Sums& part : sums_) {
            sums.inside += part.inside;
            sums.passed_over += part.passed_over;
            sums.inner += part.inner;
            sums.inner_inside += part.inner_inside;
        }
        return sums.inside + (sums.inner > 0 ? sums.passed_over * sums.inner_inside / sums.inner : sums.passed_over);
    }

private:
    static constexpr std::size_t piece_size = 64, max_inner = 5000;
    struct Sums {  ///< of areas
        double inside = 0, passed_over = 0, inner = 0, inner_inside = 0;
    };

    void sample_face(std::size_t i, Sums& sums) const {
        const auto vertices = corners(mesh_, Face(region_[i]));
        const Point &a = mesh_.point(vertices[0]), &b = mesh_.point(vertices[1]), &c = mesh_.point(vertices[2]);
        const Vector area_vector = 0.5 * CGAL::cross_product(b - a, c - a);
        const double whole = std::sqrt(area_vector.squared_length());
        const Index face = region_[i];
        const bool in_part = free_ != nullptr && free_->cuts(face);
        const double area = in_part ? whole * free_->share(face) : whole;
        if (!(area > 0)) return;
        const auto is_near = [&](Vertex v) -> bool { return near_[v]; };
        const bool in_band = std::any_of(vertices.begin(), vertices.end(), is_near);
        if (!in_band && i % stride_ != 0) {
            sums.passed_over += area;
            return;
        }
        const Vector normal = area_vector / whole;
        const auto share_inside = [&](int n) {  // at the centroids of the n * n equal triangles of a regular subdivision
            int hits = 0, asked = 0;
            for (int u = 0; u < n; ++u)
                for (int v = 0; u + v < n; ++v)
                    for (int half = 0; half < (u + v + 1 < n ? 2 : 1); ++half) {
                        const double s = (u + (half == 0 ? 1.0 : 2.0) / 3) / n, t = (v + (half == 0 ? 1.0 : 2.0) / 3) / n;
                        const Point place = a + s * (b - a) + t * (c - a);
                        if (in_part && !free_->contains(face, place)) continue;
                        ++asked;
                        const auto hit = other_.closest_compatible(place, normal, min_cosine_, search_radius_);
                        if (hit && contains_(*hit)) ++hits;
                    }
            return asked > 0 ? static_cast<double>(hits) / asked : 1.0;  // too small a part to be hit
        };
        if (!in_band) {
            const double inside = area * share_inside(1);
            sums.inside += inside;
            sums.inner += area;
            sums.inner_inside += inside;
            return;
        }
        const double size =
            std::sqrt(std::max({CGAL::squared_distance(a, b), CGAL::squared_distance(b, c), CGAL::squared_distance(c, a)}));
        const int k = std::clamp(static_cast<int>(std::ceil(size / fine_)), 2, 8);
        // In a face away from the outline, four samples suffice if they agree.
        const bool at_rim = std::any_of(vertices.begin(), vertices.end(), [&](Vertex v) -> bool { return on_rim_[v]; });
        double share = share_inside(at_rim ? k : 2);
        if (!at_rim && k > 2 && share < 1) share = share_inside(k);
        sums.inside += area * share;
    }

    const Mesh& mesh_;
    const std::vector<Index>& region_;
    const FreeRegion* free_;
    const SurfaceSearch& other_;
    std::function<bool(const SurfaceHit&)> contains_;
    std::vector<bool> on_rim_, near_;  ///< vertices on the outline; these and their
                                       ///< neighbours form the band that is sampled finely
    double fine_, search_radius_, min_cosine_;
    std::size_t stride_;
    std::vector<Sums> sums_;  ///< by piece
};

}  // namespace

void score_overlaps(const ScoredMesh& source, const ScoredMesh& target, const std::vector<OverlapQuestion>& questions,
                    const CorrespondenceOptions& options) {
    constexpr std::size_t at_once = 32;  // limits the memory of their flags
    for (std::size_t first = 0; first < questions.size(); first += at_once) {
        const std::size_t count = std::min(at_once, questions.size() - first);
        std::vector<std::optional<RegionSamples>> samples(2 * count);  // for each region: samples on the source,
                                                                       // then on the target
        parallel_for(samples.size(), 1, [&](std::size_t i) {
            const OverlapQuestion& question = questions[first + i / 2];
            if (i % 2 == 0) {
                samples[i].emplace(source.mesh, question.source, target.search, options, question.in_target);
                return;
            }
            std::function<bool(const SurfaceHit&)> in_source;
            if (question.source.free)
                in_source = [&free = *question.source.free](const SurfaceHit& hit) { return free.contains(hit.face, hit.point); };
            else
                in_source = [flags = face_flags(source.mesh, question.source.faces)](const SurfaceHit& hit) {
                    return static_cast<bool>(flags[hit.face]);
                };
            samples[i].emplace(target.mesh, question.target, source.search, options, std::move(in_source));
        });
        std::vector<std::pair<RegionSamples*, std::size_t>> pieces;
        for (auto& region : samples)
            for (std::size_t piece = 0; piece < region->pieces(); ++piece) pieces.emplace_back(&*region, piece);
        parallel_for(pieces.size(), 1, [&](std::size_t i) { pieces[i].first->sample(pieces[i].second); });
        for (std::size_t i = 0; i < count; ++i) {
            TransferScore& score = *questions[first + i].score;
            const double arrived = samples[2 * i]->area_inside(), came = samples[2 * i + 1]->area_inside();
            const double common = (arrived + came) / 2;
            score.overlap = common / (score.source_area + score.target_area - common);
            score.wrong_side = std::max(0.0, score.source_area - arrived) + std::max(0.0, score.target_area - came);
        }
    }
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
    const double min_cosine = options.min_cosine();
    std::vector<std::uint8_t> vote(target.number_of_faces(), 0);
    parallel_for(target.number_of_faces(), 1024, [&](std::size_t i) {
        const Face f(static_cast<Index>(i));
        const Point p = centroid(target, f);
        if (p.x() < box.xmin() - search_radius || p.x() > box.xmax() + search_radius || p.y() < box.ymin() - search_radius ||
            p.y() > box.ymax() + search_radius || p.z() < box.zmin() - search_radius || p.z() > box.zmax() + search_radius)
            return;
        const Vector area = area_vector(target, f);
        const double length = std::sqrt(area.squared_length());
        const auto hit =
            source_search.closest_compatible(p, length > 0 ? area / length : area, length > 0 ? min_cosine : -1, search_radius);
        vote[i] = hit && in_region[hit->face] ? 1 : 0;
    });
    return {vote.begin(), vote.end()};
}

FreeRegion::FreeRegion(const Mesh& mesh, const Annotation& annotation)
    : filling_(filling_of(mesh, annotation)), cut_(mesh, curves_on(mesh, annotation), filling_) {}

bool FreeRegion::contains(Index face, const Point& place) const {
    return filling_.sides[face] == FaceSide::in || (cuts(face) && cut_.inside(face, place));
}

double FreeRegion::share(Index face) const {
    const auto found = std::lower_bound(filling_.cut.begin(), filling_.cut.end(), std::make_pair(face, -1.0));
    return found == filling_.cut.end() || found->first != face ? 1.0 : found->second;
}

RegionArea region_area(const Mesh& mesh, const Annotation& annotation) {
    RegionArea area;
    if (!is_free(annotation)) {
        area.faces = annotation.faces;
        for (const Outline& outline : extract_outlines(mesh, annotation.faces))
            area.rim.insert(area.rim.end(), outline.begin(), outline.end());
        return area;
    }
    area.free = std::make_shared<const FreeRegion>(mesh, annotation);
    const std::vector<FaceSide>& sides = area.free->filling().sides;
    for (Index f = 0; f < sides.size(); ++f)
        if (sides[f] != FaceSide::out) area.faces.push_back(f);
    for (const auto& [face, share] : area.free->filling().cut)
        for (const Vertex v : corners(mesh, Face(face))) area.rim.push_back(v);
    return area;
}

Segments segments_of(const Mesh& mesh, const Annotation& annotation) {
    Segments segments;
    for (const auto& curve : drawn_curves(mesh, annotation)) {
        if (curve.size() == 1) segments.emplace_back(curve[0], curve[0]);
        for (std::size_t i = 1; i < curve.size(); ++i) segments.emplace_back(curve[i - 1], curve[i]);
    }
    return segments;
}

double length_of(const Segments& segments) {
    double sum = 0;
    for (const auto& [a, b] : segments) sum += std::sqrt(CGAL::squared_distance(a, b));
    return sum;
}

}  // namespace ostraka

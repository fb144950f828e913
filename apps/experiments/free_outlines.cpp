// Transfers free outlines to other resolutions and meshes and back, and compares them with pointwise projections of the curves.
#include "harness.h"
#include "scenes.h"

#include "ostraka/annotation/curves.h"
#include "ostraka/core/text.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/geom/distance.h"
#include "ostraka/geom/shortest_path.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/select/recipe.h"
#include "ostraka/transfer/transfer.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>

namespace ostraka::experiments {

namespace {

struct FreeOutlineOptions {
    std::vector<std::string> objects{"made:teapot", "made:statuette", "made:hand"};
    std::vector<int> sizes{5000, 50000, 100000, 1000000};
    std::vector<double> shares{0.005, 0.025, 0.1};
    int discs = 3;
    std::string csv;
    void declare_options(OptionList& list) {
        list("objects", objects, "made:NAME or mesh files");
        list("sizes", sizes, "numbers of vertices, in ascending order", Range{100, 1e8});
        list("shares", shares, "sizes of the regions, as shares of the surface");
        list("discs", discs, "number of regions of each size", Range{1, 1000});
        list("csv", csv, "file for the raw rows");
    }
};

/// Other curves end at the border of an open mesh and are not projected.
bool is_closed(const std::vector<Point>& curve) { return curve.front() == curve.back(); }

/// Calls take(index of the segment, point) for points along a curve at distances of at most `step`.
template <class Take>
void sample(const std::vector<Point>& points, double step, const Take& take) {
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        const Point &a = points[i], &b = points[i + 1];
        const int parts = std::max(1, static_cast<int>(std::ceil(distance(a, b) / step)));
        for (int k = 0; k < parts; ++k) take(i, a + (static_cast<double>(k) / parts) * (b - a));
    }
}

/// A region with queries at positions on its mesh.
struct Known {
    Known(const Mesh& mesh, const Annotation& annotation)
        : filling(filling_of(mesh, annotation)), cut(mesh, curves_on(mesh, annotation), filling) {}
    [[nodiscard]] bool holds(Index face, const Point& place) const {
        return filling.sides[face] == FaceSide::in || (filling.sides[face] == FaceSide::cut && cut.inside(face, place));
    }
    CurveFilling filling;
    CutFaces cut;
};

/// The source's curve projected pointwise onto the target, and the area it encloses there, computed independently of the
/// transfer.
struct Laid {
    double perimeter = 0, area = 0;
    double overlap = 0;  ///< with the transferred region
};

Laid laid(const SurfaceSearch& from, const Annotation& source, const SurfaceSearch& to, const Annotation& moved) {
    Laid result;
    const double step = 0.05 * to.typical_edge(), reach = 0.02 * to.diagonal();
    for (const SurfaceCurve& curve : curves_on(from.mesh(), source)) {
        const std::vector<Point> points = positions(from.mesh(), curve.points);
        std::vector<Point> places;
        std::vector<Index> faces;
        sample(points, step, [&](std::size_t i, const Point& p) { places.push_back(p), faces.push_back(curve.faces[i]); });
        std::vector<Point> on(places.size());
        parallel_for(places.size(), [&](std::size_t i) {
            const auto hit = to.closest_compatible(places[i], from.normal(faces[i]), 0, reach);
            on[i] = hit ? hit->point : to.closest(places[i]).point;
        });
        for (std::size_t i = 0; i + 1 < on.size(); ++i) result.perimeter += distance(on[i], on[i + 1]);
        if (is_closed(points)) result.perimeter += distance(on.back(), on.front());
    }
    const Mesh& mesh = to.mesh();
    const Known before(from.mesh(), source), after(mesh, moved);
    const auto came_from_inside = [&](Index face, const Point& place) {
        const auto hit = from.closest_compatible(place, to.normal(face), 0, reach);
        return hit && before.holds(hit->face, hit->point);
    };
    // Faces within two rings of the outline are subdivided, others are tested by their centroid.
    std::vector<bool> near(mesh.number_of_faces(), false);
    for (const auto& [face, share] : after.filling.cut) near[face] = true;
    for (int ring = 0; ring < 2; ++ring) {
        const std::vector<bool> seen = near;
        for (const Face f : mesh.faces())
            if (seen[f])
                for (const Vertex v : corners(mesh, f))
                    for (const Face g : mesh.faces_around_target(mesh.halfedge(v)))
                        if (g != Mesh::null_face()) near[g] = true;
    }
    std::vector<std::array<double, 3>> sums(mesh.number_of_faces());  // area inside, intersection, union
    parallel_for(mesh.number_of_faces(), 256, [&](std::size_t f) {
        const Face face(static_cast<Index>(f));
        const double area = face_area(mesh, face);
        if (!(area > 0)) return;
        const int n = near[f] ? 16 : 1;
        const auto corner = corners(mesh, face);
        for_each_part(n, [&](const std::array<double, 3>& at) {
            const Point place = point_at(mesh.point(corner[0]), mesh.point(corner[1]), mesh.point(corner[2]), at);
            const bool was = came_from_inside(face, place), is = after.holds(face, place);
            const double part = area / (n * n);
            sums[f][0] += was ? part : 0;
            sums[f][1] += was && is ? part : 0;
            sums[f][2] += was || is ? part : 0;
        });
    });
    double both = 0, either = 0;
    for (const auto& sum : sums) result.area += sum[0], both += sum[1], either += sum[2];
    result.overlap = either > 0 ? both / either : 0;
    return result;
}

/// Pointwise projection along rays: along the interpolated normals of the coarser mesh to the other one. The projected curve is
/// the source's if its mesh is the coarser one, otherwise the transferred one, which must return to the source.
struct LaidByRays {
    double perimeter = 0, of_written = 0;  ///< of the projected curve, and of the curve it should equal
    double mean = 0, most = 0;             ///< distance of the projected points from that curve, in target edge lengths
    std::size_t places = 0, without_ray = 0;
};

LaidByRays laid_by_rays(const SurfaceSearch& source, const Annotation& drawn, const SurfaceSearch& target,
                        const Annotation& written) {
    const bool forward = source.typical_edge() >= target.typical_edge();
    const SurfaceSearch &from = forward ? source : target, &to = forward ? target : source;
    const Mesh& mesh = from.mesh();
    std::vector<std::pair<Point, Point>> segments;
    LaidByRays result;
    for (const std::vector<Point>& points : drawn_curves(to.mesh(), forward ? written : drawn))
        for (std::size_t i = 0; i + 1 < points.size(); ++i) {
            segments.emplace_back(points[i], points[i + 1]);
            result.of_written += distance(points[i], points[i + 1]);
        }
    const double step = 0.05 * to.typical_edge(), far = 0.05 * to.diagonal();
    double sum = 0;
    for (const SurfaceCurve& curve : curves_on(mesh, forward ? drawn : written)) {
        const std::vector<Point> points = positions(mesh, curve.points);
        std::vector<std::pair<Point, Vector>> places;
        sample(points, step, [&](std::size_t i, const Point& p) {
            const auto [u, v, w] = corners(mesh, Face(curve.faces[i]));
            const auto weight = nearest_barycentric(mesh.point(u), mesh.point(v), mesh.point(w), p);
            const Vector n =
                weight[0] * vertex_normal(mesh, u) + weight[1] * vertex_normal(mesh, v) + weight[2] * vertex_normal(mesh, w);
            places.emplace_back(p, n / std::sqrt(n.squared_length()));
        });
        std::vector<std::optional<Point>> on(places.size());
        std::vector<double> off(places.size(), 0);
        parallel_for(places.size(), [&](std::size_t i) {
            for (const SurfaceHit& hit : to.line_hits(places[i].first, places[i].second, far))
                if (to.normal(hit.face) * places[i].second > 0) {
                    on[i] = hit.point;
                    break;
                }
            if (!on[i]) return;
            off[i] = std::numeric_limits<double>::infinity();
            for (const auto& [a, b] : segments) off[i] = std::min(off[i], distance_to_segment(*on[i], a, b));
        });
        std::optional<Point> last, first;
        for (std::size_t i = 0; i < on.size(); ++i) {
            ++result.places;
            if (!on[i]) {
                ++result.without_ray;
                continue;
            }
            sum += off[i];
            result.most = std::max(result.most, off[i] / target.typical_edge());
            if (last) result.perimeter += distance(*last, *on[i]);
            last = on[i];
            if (!first) first = on[i];
        }
        if (last && is_closed(points)) result.perimeter += distance(*last, *first);
    }
    result.mean = sum / target.typical_edge() / static_cast<double>(std::max<std::size_t>(1, result.places - result.without_ray));
    return result;
}

/// A spherical region around a point with the given share of the surface.
std::optional<Annotation> ball(const Mesh& mesh, const Point& centre, double share, int id) {
    double low = 0, high = box_diagonal(mesh);
    std::optional<Annotation> best;
    for (int round = 0; round < 12; ++round) {
        const double radius = (low + high) / 2;
        const std::string recipe = fmt::format(
            R"({{"format": "ostraka-recipe", "version": 1, "annotations": [{{"id": {3}, "tag": "disc", "type": "region",
             "outline": "free", "select": {{"component": {{"seed": [{0:.17g}, {1:.17g}, {2:.17g}],
             "of": {{"sphere": {{"centre": [{0:.17g}, {1:.17g}, {2:.17g}], "radius": {4:.17g}}}}}}}}}}}]}})",
            centre.x(), centre.y(), centre.z(), id, radius);
        try {
            AnnotationSet made = apply_recipe(parse_json(recipe, "ball"), mesh, {}, "ball");
            const double area = area_of(mesh, made.annotations.front());
            (area > share * surface_area(mesh) ? high : low) = radius;
            best = std::move(made.annotations.front());
            if (std::abs(area / (share * surface_area(mesh)) - 1) < 0.02) break;
        } catch (const Error&) {
            low = radius;
        }
    }
    if (best && !is_free(*best)) best.reset();
    return best;
}

/// The worst values over the regions of one size.
struct Worst {
    double perimeter = 0, by_rays = 0, away = 0, area = 0, overlap = 1;
    std::size_t cells = 0;
};

/// A mesh of a ladder.
struct Rung {
    Rung(std::string rung, Mesh surface) : name(std::move(rung)), mesh(std::move(surface)), search(mesh) {}
    std::string name;
    Mesh mesh;
    SurfaceSearch search;
};

class FreeOutlines {
public:
    explicit FreeOutlines(const FreeOutlineOptions& options) : options_(options) {}

    void run() {
        for (const std::string& source : options_.objects) {
            const bool made = source.starts_with("made:");
            const std::string name = made ? source.substr(5) : Path(source).stem().string();
            const auto max = static_cast<std::uint64_t>(options_.sizes.back());
            const Mesh full = made ? made_mesh(name, max) : simplified(refined(read_mesh(source).mesh, max), max);
            std::deque<Rung> decimated, independent;  // coarse to fine
            Mesh last = full;
            for (auto size = options_.sizes.rbegin(); size != options_.sizes.rend(); ++size) {
                const auto n = static_cast<std::uint64_t>(*size);
                last = simplified(std::move(last), n);
                last.collect_garbage();
                const Mesh clean = build_mesh(to_soup(last));
                decimated.emplace_front(size_name(n), clean);
                independent.emplace_front(size_name(n), made       ? made_mesh(name, n, 1 + n)
                                                        : n == max ? clean
                                                                   : build_mesh(to_soup(remeshed(full, n))));
            }
            measure_ladder(name, "decimated", decimated);
            measure_ladder(name, "independent", independent);
        }
        fmt::print("kind, from -> to, share: worst perimeter %, by rays %, mean distance by rays in edges, area %, overlap\n");
        for (const auto& [cell, worst] : worst_)
            fmt::print("{}: {:.3g} %, {:.3g} %, {:.3g}, {:.3g} %, {:.6g} ({})\n", cell, worst.perimeter, worst.by_rays,
                       worst.away, worst.area, worst.overlap, worst.cells);
        csv_.write(options_.csv);
    }

private:
    /// Chains from the coarsest mesh to the finest and back, and from the finest to the coarsest and back.
    void measure_ladder(const std::string& name, const std::string& kind, const std::deque<Rung>& rungs) {
        std::vector<const Rung*> way;
        for (const Rung& rung : rungs) way.push_back(&rung);
        for (const bool from_fine : {false, true}) {
            if (from_fine) std::reverse(way.begin(), way.end());
            const Rung &first = *way.front(), &last = *way.back();
            const AnnotationSet set = regions_on(first.mesh);
            fmt::print("{} {} from {}: {} regions\n", name, kind, first.name, set.annotations.size());
            AnnotationSet now = set;
            for (std::size_t i = 0; i + 1 < way.size(); ++i) now = carry(name, kind, *way[i], *way[i + 1], now);
            for (std::size_t i = way.size() - 1; i-- > 0;) now = carry(name, kind, *way[i + 1], *way[i], now);
            // Directly from the first to the last, and back.
            const AnnotationSet far = carry(name, kind, first, last, set);
            carry(name, kind, last, first, far);
            for (const Annotation& region : set.annotations)
                if (const Annotation* there = now.find(region.id)) {
                    const RegionMeasures a = measure_region(first.mesh, region), b = measure_region(first.mesh, *there);
                    fmt::print("  {}, whole chain and back: perimeter {:.3g} %, area {:.3g} %, places {} -> {}\n", region.tag,
                               100 * (b.perimeter / a.perimeter - 1), 100 * (b.area / a.area - 1), region.curves.front().size(),
                               there->curves.front().size());
                }
        }
    }

    [[nodiscard]] AnnotationSet regions_on(const Mesh& mesh) const {
        AnnotationSet set;
        for (const double share : options_.shares)
            for (int k = 0; k < options_.discs; ++k) {
                const Vertex seed(static_cast<Index>((7919U * static_cast<std::size_t>(k + 1)) % mesh.number_of_vertices()));
                if (auto region = ball(mesh, mesh.point(seed), share, static_cast<int>(set.annotations.size()))) {
                    region->tag = fmt::format("disc {:.3g} {}", share, k);
                    region->id = static_cast<int>(set.annotations.size());
                    set.annotations.push_back(std::move(*region));
                }
            }
        return set;
    }

    AnnotationSet carry(const std::string& object, const std::string& kind, const Rung& from, const Rung& to,
                        const AnnotationSet& set) {
        TransferOptions how;
        how.force = true;
        const Stopwatch watch;
        TransferResult moved = transfer({from.mesh, set}, to.search, how);
        const double seconds = watch.seconds().wall;
        for (const Annotation& region : set.annotations) {
            const Annotation* there = moved.annotations.find(region.id);
            if (there == nullptr) {
                fmt::print("{} {} {} -> {}: {} is lost\n", object, kind, from.name, to.name, region.tag);
                continue;
            }
            const auto score =
                std::find_if(moved.scores.begin(), moved.scores.end(), [&](const TransferScore& s) { return s.id == region.id; });
            const Laid exact = laid(from.search, region, to.search, *there);
            const LaidByRays rays = laid_by_rays(from.search, region, to.search, *there);
            const double area = measure_region(to.mesh, *there).area;
            double perimeter = 0;
            for (const SurfaceCurve& curve : curves_on(to.mesh, *there)) perimeter += curve.length(to.mesh);
            const double off_perimeter = 100 * (perimeter / exact.perimeter - 1), off_area = 100 * (area / exact.area - 1),
                         off_by_rays = 100 * (rays.of_written / rays.perimeter - 1),
                         share = area_of(from.mesh, region) / surface_area(from.mesh);
            csv_(object, kind, from.name, to.name, region.tag, share, perimeter, exact.perimeter, off_perimeter, off_by_rays,
                 rays.mean, rays.most, rays.without_ray, area, exact.area, off_area, exact.overlap, score->overlap.value_or(0),
                 score->vertices, score->by_ray, score->detours, score->crossings_resolved, seconds);
            Worst& cell = worst_[fmt::format("{} {} -> {} share {:.1g}", kind, from.name, to.name, share)];
            cell.perimeter = std::max(cell.perimeter, std::abs(off_perimeter));
            cell.by_rays = std::max(cell.by_rays, std::abs(off_by_rays));
            cell.away = std::max(cell.away, rays.mean);
            cell.area = std::max(cell.area, std::abs(off_area));
            cell.overlap = std::min(cell.overlap, exact.overlap);
            ++cell.cells;
        }
        return std::move(moved.annotations);
    }

    const FreeOutlineOptions& options_;
    std::map<std::string, Worst> worst_;
    Rows csv_{
        "object,kind,from,to,region,share,perimeter,laid perimeter,off perimeter %,off perimeter by rays %,mean off by rays in "
        "edges,most,without ray,area,laid area,off area %,overlap,own overlap,places,by ray,detours,untangled,seconds"};
};

const Registration registered(
    "free-outlines", "free outlines carried to other meshes and back, against the same curves laid there place by place",
    +[](const FreeOutlineOptions& options) { FreeOutlines(options).run(); });

}  // namespace

}  // namespace ostraka::experiments

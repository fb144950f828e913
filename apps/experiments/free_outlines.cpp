#include "experiments.h"

#include "report.h"

#include "ostraka/annotation/curves.h"
#include "ostraka/core/file.h"
#include "ostraka/core/parallel.h"
#include "ostraka/core/text.h"
#include "ostraka/geom/distance.h"
#include "ostraka/geom/shortest_path.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/remesh/refine.h"
#include "ostraka/remesh/remesh.h"
#include "ostraka/remesh/simplify.h"
#include "ostraka/select/recipe.h"
#include "ostraka/synthetic/make_mesh.h"
#include "ostraka/transfer/transfer.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <map>
#include <sstream>

namespace ostraka::experiments {

namespace {

/// Other curves end at the border of an open mesh and are not projected.
bool is_closed(const std::vector<Point>& curve) { return curve.front() == curve.back(); }

double length_of_curves(const Mesh& mesh, const Annotation& annotation) {
    double sum = 0;
    for (const SurfaceCurve& curve : curves_on(mesh, annotation))
        for (std::size_t i = 0; i + 1 < curve.points.size(); ++i)
            sum += distance(position(mesh, curve.points[i]), position(mesh, curve.points[i + 1]));
    return sum;
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
        for (std::size_t i = 0; i + 1 < points.size(); ++i) {
            const Point &a = points[i], &b = points[i + 1];
            const int parts = std::max(1, static_cast<int>(std::ceil(distance(a, b) / step)));
            for (int k = 0; k < parts; ++k)
                places.push_back(a + (static_cast<double>(k) / parts) * (b - a)), faces.push_back(curve.faces[i]);
        }
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
    parallel_for(
        mesh.number_of_faces(),
        [&](std::size_t f) {
            const Face face(static_cast<Index>(f));
            const double area = face_area(mesh, face);
            if (!(area > 0)) return;
            const int n = near[f] ? 16 : 1;
            const auto corner = corners(mesh, face);
            for (int u = 0; u < n; ++u)
                for (int v = 0; u + v < n; ++v)
                    for (int half = 0; half < (u + v + 1 < n ? 2 : 1); ++half) {
                        const double s = (u + (half == 0 ? 1.0 : 2.0) / 3) / n, t = (v + (half == 0 ? 1.0 : 2.0) / 3) / n;
                        const Point place =
                            point_at(mesh.point(corner[0]), mesh.point(corner[1]), mesh.point(corner[2]), {1 - s - t, s, t});
                        const bool was = came_from_inside(face, place), is = after.holds(face, place);
                        const double part = area / (n * n);
                        sums[f][0] += was ? part : 0;
                        sums[f][1] += was && is ? part : 0;
                        sums[f][2] += was || is ? part : 0;
                    }
        },
        256);
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
        for (std::size_t i = 0; i + 1 < points.size(); ++i) {
            const Point &a = points[i], &b = points[i + 1];
            const auto [u, v, w] = corners(mesh, Face(curve.faces[i]));
            const int parts = std::max(1, static_cast<int>(std::ceil(distance(a, b) / step)));
            for (int k = 0; k < parts; ++k) {
                const Point p = a + (static_cast<double>(k) / parts) * (b - a);
                const auto weight = nearest_barycentric(mesh.point(u), mesh.point(v), mesh.point(w), p);
                const Vector n =
                    weight[0] * vertex_normal(mesh, u) + weight[1] * vertex_normal(mesh, v) + weight[2] * vertex_normal(mesh, w);
                places.emplace_back(p, n / std::sqrt(n.squared_length()));
            }
        }
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

std::string name_of(std::size_t n) {
    return n % 1000000 == 0 ? std::to_string(n / 1000000) + "M"
           : n % 1000 == 0  ? std::to_string(n / 1000) + "K"
                            : std::to_string(n);
}

/// A spherical region around a point with the given share of the surface.
std::optional<Annotation> ball(const Mesh& mesh, const Point& centre, double share, int id) {
    double low = 0, high = box_diagonal(mesh);
    std::optional<Annotation> best;
    for (int round = 0; round < 12; ++round) {
        const double radius = (low + high) / 2;
        std::ostringstream text;
        text.precision(17);
        const std::string at = "[" + digits(centre.x(), 17) + "," + digits(centre.y(), 17) + "," + digits(centre.z(), 17) + "]";
        text << R"({"format": "ostraka-recipe", "version": 1, "annotations": [{"id": )" << id
             << R"(, "tag": "disc", "type": "region", "outline": "free", "select": {"component": {"seed": )" << at
             << R"(, "of": {"sphere": {"centre": )" << at << R"(, "radius": )" << radius << "}}}}}]}";
        try {
            AnnotationSet made = apply_recipe(parse_json(text.str(), "ball"), mesh, {}, "ball");
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

}  // namespace

void free_outlines(const FreeOutlineOptions& options) {
    std::ostringstream csv;
    csv << "object,kind,from,to,region,share,perimeter,laid perimeter,off perimeter %,off perimeter by rays %,mean off by rays "
           "in edges,most,without ray,area,laid area,off area %,overlap,own "
           "overlap,places,by ray,"
           "detours,untangled,seconds\n";
    struct Worst {
        double perimeter = 0, by_rays = 0, away = 0, area = 0, overlap = 1;
        std::size_t cells = 0;
    };
    std::map<std::string, Worst> worst;
    const auto measure = [&](const std::string& object, const std::string& kind, const std::string& from_name,
                             const SurfaceSearch& from, const std::string& to_name, const SurfaceSearch& to,
                             const AnnotationSet& set) {
        TransferOptions how;
        how.force = true;
        const auto start = std::chrono::steady_clock::now();
        TransferResult moved = transfer(from.mesh(), set, to, how);
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        for (const Annotation& one : set.annotations) {
            const Annotation* there = moved.annotations.find(one.id);
            if (there == nullptr) {
                std::cout << object << ' ' << kind << ' ' << from_name << " -> " << to_name << ": " << one.tag << " is lost\n";
                continue;
            }
            const Laid exact = laid(from, one, to, *there);
            const RegionMeasures now = measure_region(to.mesh(), *there);
            const auto score =
                std::find_if(moved.scores.begin(), moved.scores.end(), [&](const TransferScore& s) { return s.id == one.id; });
            const double perimeter = length_of_curves(to.mesh(), *there);
            const double off_perimeter = 100 * (perimeter / exact.perimeter - 1), off_area = 100 * (now.area / exact.area - 1);
            const LaidByRays rays = laid_by_rays(from, one, to, *there);
            const double off_by_rays = 100 * (rays.of_written / rays.perimeter - 1);
            const double share = area_of(from.mesh(), one) / surface_area(from.mesh());
            csv << object << ',' << kind << ',' << from_name << ',' << to_name << ',' << one.tag << ',' << digits(share, 3) << ','
                << perimeter << ',' << exact.perimeter << ',' << digits(off_perimeter, 3) << ',' << digits(off_by_rays, 3) << ','
                << digits(rays.mean, 3) << ',' << digits(rays.most, 3) << ',' << rays.without_ray << ',' << now.area << ','
                << exact.area << ',' << digits(off_area, 3) << ',' << digits(exact.overlap, 6) << ','
                << digits(score->overlap.value_or(0), 6) << ',' << score->vertices << ',' << score->by_ray << ','
                << score->detours << ',' << score->crossings_resolved << ',' << digits(seconds, 3) << '\n';
            Worst& cell = worst[kind + ' ' + from_name + " -> " + to_name + " share " + digits(share, 1)];
            cell.perimeter = std::max(cell.perimeter, std::abs(off_perimeter));
            cell.by_rays = std::max(cell.by_rays, std::abs(off_by_rays));
            cell.away = std::max(cell.away, rays.mean);
            cell.area = std::max(cell.area, std::abs(off_area));
            cell.overlap = std::min(cell.overlap, exact.overlap);
            ++cell.cells;
        }
        return std::move(moved.annotations);
    };
    for (const std::string& given : options.objects) {
        std::map<std::size_t, Mesh> independent, decimated;
        const bool made = given.starts_with("made:");
        const std::string name = made ? given.substr(5) : Path(given).stem().string();
        Mesh full;
        if (made) {
            MakeOptions making;
            making.vertices = options.sizes.back();
            full = make_mesh(synthetic_object(name), making).mesh;
        } else {
            full = read_mesh(given).mesh;
            RefineOptions refining;
            refining.scheme = RefineOptions::Scheme::loop;
            refining.levels = 1;
            while (full.number_of_vertices() < options.sizes.back()) refine(full, refining);
            SimplifyOptions down;
            down.vertices = options.sizes.back();
            if (full.number_of_vertices() > down.vertices) simplify(full, down);
        }
        Mesh last = full;
        for (auto size = options.sizes.rbegin(); size != options.sizes.rend(); ++size) {
            SimplifyOptions down;
            down.vertices = *size;
            if (last.number_of_vertices() > *size) simplify(last, down);
            last.collect_garbage();
            decimated[*size] = build_mesh(to_soup(last));
            if (*size == options.sizes.back() && !made) {
                independent[*size] = decimated[*size];
            } else if (made) {
                MakeOptions making;
                making.vertices = *size;
                making.seed = 1 + *size;
                independent[*size] = make_mesh(synthetic_object(name), making).mesh;
            } else {
                RemeshOptions remeshing;
                remeshing.vertices = *size;
                independent[*size] = build_mesh(to_soup(remesh(full, remeshing).mesh));
            }
        }
        for (const auto& [kind, meshes] : {std::pair<std::string, const std::map<std::size_t, Mesh>*>{"decimated", &decimated},
                                           {"independent", &independent}}) {
            std::map<std::size_t, SurfaceSearch> searches;
            for (const auto& [size, mesh] : *meshes) searches.emplace(size, mesh);
            // Chains from the coarsest mesh to the finest and back, and from the finest to the coarsest and back.
            for (const bool from_fine : {false, true}) {
                std::vector<std::size_t> order = options.sizes;
                if (from_fine) std::reverse(order.begin(), order.end());
                const Mesh& start = meshes->at(order.front());
                AnnotationSet set;
                for (const double share : options.shares)
                    for (int k = 0; k < options.discs; ++k) {
                        const Vertex seed(static_cast<Index>((7919 * (k + 1)) % start.number_of_vertices()));
                        if (auto region = ball(start, start.point(seed), share, static_cast<int>(set.annotations.size()))) {
                            region->tag = "disc " + digits(share, 3) + " " + std::to_string(k);
                            region->id = static_cast<int>(set.annotations.size());
                            set.annotations.push_back(std::move(*region));
                        }
                    }
                std::cout << name << ' ' << kind << " from " << name_of(order.front()) << ": " << set.annotations.size()
                          << " regions\n"
                          << std::flush;
                std::vector<std::size_t> way = order;
                for (std::size_t i = order.size() - 1; i-- > 0;) way.push_back(order[i]);
                AnnotationSet now = set;
                for (std::size_t i = 0; i + 1 < way.size(); ++i)
                    now = measure(name, kind, name_of(way[i]), searches.at(way[i]), name_of(way[i + 1]), searches.at(way[i + 1]),
                                  now);
                // Directly from the first to the last, and back.
                AnnotationSet far = measure(name, kind, name_of(order.front()), searches.at(order.front()), name_of(order.back()),
                                            searches.at(order.back()), set);
                measure(name, kind, name_of(order.back()), searches.at(order.back()), name_of(order.front()),
                        searches.at(order.front()), far);
                // Compares the returned annotations with the original ones.
                for (const Annotation& one : set.annotations)
                    for (const auto& [what, back] : {std::pair<std::string, const AnnotationSet*>{"whole chain and back", &now}})
                        if (const Annotation* there = back->find(one.id)) {
                            const RegionMeasures a = measure_region(start, one), b = measure_region(start, *there);
                            std::cout << "  " << one.tag << ", " << what << ": perimeter "
                                      << digits(100 * (b.perimeter / a.perimeter - 1), 3) << " %, area "
                                      << digits(100 * (b.area / a.area - 1), 3) << " %, places " << one.curves.front().size()
                                      << " -> " << there->curves.front().size() << '\n';
                        }
            }
        }
    }
    std::cout << "kind, from -> to, share: worst perimeter %, by rays %, mean distance by rays in edges, area %, overlap\n";
    for (const auto& [cell, what] : worst)
        std::cout << cell << ": " << digits(what.perimeter, 3) << " %, " << digits(what.by_rays, 3) << " %, "
                  << digits(what.away, 3) << ", " << digits(what.area, 3) << " %, " << digits(what.overlap, 6) << " ("
                  << what.cells << ")\n";
    if (!options.csv.empty()) write_file(options.csv, csv.str());
}

}  // namespace ostraka::experiments

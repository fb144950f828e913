#include "ostraka/fields/surface_distance.h"

#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/fields/statistics.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

namespace ostraka {

namespace {

constexpr double no_distance = std::numeric_limits<double>::quiet_NaN();
/// Distances below this share of the diagonal count as contact with the border.
constexpr double border_contact = 1e-12;
/// Max tangential component of an offset, as a share of its length, of a place above the border.
constexpr double upright_offset = 1e-6;

Vector unit_normal(const Mesh& mesh, Face face) {
    const Vector area = area_vector(mesh, face);
    const double length = std::sqrt(area.squared_length());
    return length > 0 ? area / length : Vector(0, 0, 0);
}

/// The pseudonormal at a place of a face, and whether the place lies on the border.
struct PlaceNormal {
    Vector normal{0, 0, 0};  ///< not normalised
    bool on_border = false;
};

PlaceNormal normal_at(const Mesh& mesh, Face face, const std::array<double, 3>& weights) {
    const auto vertices = corners(mesh, face);
    std::size_t zeros = 0, zero = 0, corner = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        if (weights[k] == 0) ++zeros, zero = k;
        else corner = k;
    }
    if (zeros == 2) return {vertex_normal(mesh, vertices[corner]), mesh.is_border(vertices[corner])};
    if (zeros == 0) return {unit_normal(mesh, face), false};
    const Halfedge h = find_halfedge(mesh, vertices[(zero + 1) % 3], vertices[(zero + 2) % 3]), o = mesh.opposite(h);
    const bool on_border = mesh.is_border(h) || mesh.is_border(o);
    Vector sum(0, 0, 0);
    for (const Halfedge side : {h, o})
        if (!mesh.is_border(side)) sum += unit_normal(mesh, mesh.face(side));
    return {sum, on_border};
}

bool is_counted(const PlaceDistance& place, bool keep_beyond) {
    return std::isfinite(place.distance) && (keep_beyond || !place.beyond);
}

/// Squared distance of a point from the triangle of a face.
double squared_distance_to(const Mesh& mesh, Index face, const Point& p) {
    const auto [a, b, c] = corners(mesh, Face(face));
    const Point &pa = mesh.point(a), &pb = mesh.point(b), &pc = mesh.point(c);
    return CGAL::squared_distance(point_at(pa, pb, pc, nearest_barycentric(pa, pb, pc, p)), p);
}

/// A triangle that is a part of a face, and an upper bound of the distance of its places.
struct FacePart {
    Index face = no_index;
    std::array<Point, 3> points;
    std::array<std::array<double, 3>, 3> weights{};  ///< of the corners in the face
    std::array<Index, 3> nearest{};                  ///< faces of the reference that are nearest to the corners
    double bound = 0;
};

/// Largest distance of the corners from one triangle of the reference, the best of the triangles nearest to the corners.
double bound_of(const FacePart& part, const Mesh& reference) {
    double best = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < 3; ++k) {
        if (k > 0 && part.nearest[k] == part.nearest[0]) continue;
        double largest = 0;
        for (std::size_t i = 0; i < 3; ++i)
            largest = std::max(largest, squared_distance_to(reference, part.nearest[k], part.points[i]));
        best = std::min(best, std::sqrt(largest));
    }
    return best;
}

/// Branch and bound over the parts of the faces.
class FarthestSearch {
public:
    FarthestSearch(const Mesh& mesh, const std::vector<PlaceDistance>& vertices, const SignedDistance& reference)
        : reference_(reference) {
        std::vector<double> bounds(mesh.number_of_faces());
        parallel_for(bounds.size(), [&](std::size_t f) { bounds[f] = whole(mesh, Face(static_cast<Index>(f)), vertices).bound; });
        for (const PlaceDistance& place : vertices)
            if (std::isfinite(place.distance)) consider(place);
        std::vector<FacePart> open;
        for (const Face face : mesh.faces()) {
            if (bounds[face] > limit()) open.push_back(whole(mesh, face, vertices));
            else skipped_ = std::max(skipped_, bounds[face]);
        }
        heap_ = Heap(Less{}, std::move(open));
    }

    FarthestPlace run(std::size_t queries) {
        CancelCheck cancel;
        while (!heap_.empty() && heap_.top().bound > limit() && queries >= 3) {
            cancel();
            const FacePart part = heap_.top();
            heap_.pop();
            divide(part);
            queries -= 3;
        }
        best_.bound = std::max({std::abs(best_.place.distance), skipped_, heap_.empty() ? 0.0 : heap_.top().bound});
        return best_;
    }

private:
    struct Less {
        bool operator()(const FacePart& a, const FacePart& b) const {
            return a.bound != b.bound ? a.bound < b.bound : a.face > b.face;
        }
    };
    using Heap = std::priority_queue<FacePart, std::vector<FacePart>, Less>;

    [[nodiscard]] double limit() const { return 1.001 * std::abs(best_.place.distance) + 1e-9 * reference_.diagonal(); }
    void consider(const PlaceDistance& place) {
        if (best_.place.face == no_index || std::abs(place.distance) > std::abs(best_.place.distance)) best_.place = place;
    }
    [[nodiscard]] FacePart whole(const Mesh& mesh, Face face, const std::vector<PlaceDistance>& vertices) const {
        FacePart part;
        part.face = face;
        const auto ends = corners(mesh, face);
        for (std::size_t k = 0; k < 3; ++k) {
            part.points[k] = mesh.point(ends[k]);
            part.weights[k] = {0, 0, 0};
            part.weights[k][k] = 1;
            part.nearest[k] = vertices[ends[k]].nearest.face;
        }
        part.bound = bound_of(part, reference_.mesh());
        return part;
    }
    /// Replaces a part by the four parts between its corners and the middles of its sides.
    void divide(const FacePart& part) {
        FacePart middle = part;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
            for (std::size_t c = 0; c < 3; ++c) middle.weights[k][c] = (part.weights[i][c] + part.weights[j][c]) / 2;
            middle.points[k] = CGAL::midpoint(part.points[i], part.points[j]);
            PlaceDistance place = reference_.at(middle.points[k]);
            place.face = part.face;
            place.weights = middle.weights[k];
            middle.nearest[k] = place.nearest.face;
            consider(place);
        }
        push(middle);
        for (std::size_t k = 0; k < 3; ++k) {
            FacePart piece = middle;
            piece.points[k] = part.points[k];
            piece.weights[k] = part.weights[k];
            piece.nearest[k] = part.nearest[k];
            push(piece);
        }
    }
    void push(FacePart part) {
        part.bound = bound_of(part, reference_.mesh());
        if (part.bound > limit()) heap_.push(std::move(part));
        else skipped_ = std::max(skipped_, part.bound);
    }

    const SignedDistance& reference_;
    FarthestPlace best_;
    Heap heap_;
    double skipped_ = 0;  ///< largest bound of the parts that were not divided
};

/// The places that count, by ascending absolute distance.
std::vector<const PlaceDistance*> sorted_places(const std::vector<PlaceDistance>& places, bool keep_beyond,
                                                const std::string& where) {
    std::vector<const PlaceDistance*> sorted;
    for (const PlaceDistance& place : places)
        if (is_counted(place, keep_beyond)) sorted.push_back(&place);
    if (sorted.empty())
        fail_input(where, "no place has a distance",
                   "check that the surface has an area and, with '--border leave-out', that it lies over the other surface");
    std::stable_sort(sorted.begin(), sorted.end(), [](const PlaceDistance* a, const PlaceDistance* b) {
        return std::abs(a->distance) < std::abs(b->distance);
    });
    return sorted;
}

}  // namespace

SignedDistance::SignedDistance(const Mesh& mesh) : search_(mesh) {}

PlaceDistance SignedDistance::at(const Point& query) const {
    PlaceDistance result;
    result.place = query;
    result.nearest = search_.closest(query);
    const PlaceNormal at_nearest = normal_at(mesh(), Face(result.nearest.face), result.nearest.barycentric);
    const Vector offset = query - result.nearest.point;
    result.distance = result.nearest.distance;
    const double height = offset * at_nearest.normal;
    if (at_nearest.on_border && result.distance > border_contact * diagonal()) {
        const double tangential = std::sqrt(CGAL::cross_product(offset, at_nearest.normal).squared_length());
        const double length = std::sqrt(offset.squared_length() * at_nearest.normal.squared_length());
        result.beyond = !(tangential <= upright_offset * length);
    }
    if (!result.beyond && height < 0) result.distance = -result.distance;
    return result;
}

std::vector<SurfacePlace> evenly_spread_places(const Mesh& mesh, const std::vector<Index>& faces, std::size_t count) {
    check_region(mesh, faces);
    std::vector<SurfacePlace> places;
    const std::size_t face_count = faces.empty() ? mesh.number_of_faces() : faces.size();
    const auto face_of = [&](std::size_t i) { return Face(faces.empty() ? static_cast<Index>(i) : faces[i]); };
    double total = 0;
    for (std::size_t i = 0; i < face_count; ++i) total += face_area(mesh, face_of(i));
    if (!(total > 0) || count == 0) return places;
    places.reserve(count);
    const double step = total / static_cast<double>(count);
    double sum = 0;
    for (std::size_t i = 0; i < face_count; ++i) {
        const Face face = face_of(i);
        sum += face_area(mesh, face);
        while (places.size() < count && (static_cast<double>(places.size()) + 0.5) * step < sum) {
            double integer_part = 0;
            const auto k = static_cast<double>(places.size());
            double s = std::modf(0.5 + 0.7548776662466927 * k, &integer_part),
                   t = std::modf(0.5 + 0.5698402909980532 * k, &integer_part);
            if (s + t > 1) s = 1 - s, t = 1 - t;
            const std::array<double, 3> weights{1 - s - t, s, t};
            places.push_back({point_at(mesh, face, weights), face, weights});
        }
    }
    return places;
}

std::vector<PlaceDistance> distances_of(const std::vector<SurfacePlace>& places, const SignedDistance& reference) {
    std::vector<PlaceDistance> result(places.size());
    Progress progress("distances", places.size());
    parallel_blocks(places.size(), 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            result[i] = reference.at(places[i].place);
            result[i].face = places[i].face;
            result[i].weights = places[i].weights;
        }
        progress.advance(end - begin);
    });
    return result;
}

std::vector<PlaceDistance> vertex_distances(const Mesh& mesh, const SignedDistance& reference) {
    std::vector<PlaceDistance> result(mesh.number_of_vertices());
    Progress progress("distances of vertices", result.size());
    parallel_blocks(result.size(), 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Vertex vertex(static_cast<Index>(i));
            if (mesh.is_isolated(vertex)) {
                result[i].place = mesh.point(vertex);
                result[i].distance = no_distance;
                continue;
            }
            result[i] = reference.at(mesh.point(vertex));
            const Halfedge h = mesh.halfedge(vertex);
            const Face face = mesh.face(mesh.is_border(h) ? mesh.opposite(h) : h);
            const auto ends = corners(mesh, face);
            result[i].face = face;
            for (std::size_t k = 0; k < 3; ++k) result[i].weights[k] = ends[k] == vertex ? 1 : 0;
        }
        progress.advance(end - begin);
    });
    return result;
}

FarthestPlace farthest_place(const Mesh& mesh, const std::vector<PlaceDistance>& vertices, const SignedDistance& reference,
                             std::size_t queries) {
    if (vertices.size() != mesh.number_of_vertices())
        fail_usage(fmt::format("there are {} distances for {} vertices", vertices.size(), mesh.number_of_vertices()));
    if (mesh.number_of_faces() == 0) fail_input("mesh", "has no faces", "give a mesh with faces");
    return FarthestSearch(mesh, vertices, reference).run(queries);
}

DistanceSummary summary_of(const std::vector<PlaceDistance>& places, bool keep_beyond, const std::string& where) {
    DistanceSummary result;
    const std::vector<const PlaceDistance*> sorted = sorted_places(places, keep_beyond, where);
    result.places = sorted.size();
    result.lowest = std::numeric_limits<double>::infinity();
    result.highest = -result.lowest;
    std::size_t sided = 0;
    double sum = 0, squares = 0;
    for (const PlaceDistance* place : sorted) {
        const double d = place->distance;
        result.mean_absolute += std::abs(d);
        squares += d * d;
        if (place->beyond) {
            ++result.beyond;
            continue;
        }
        ++sided;
        sum += d;
        (d > 0 ? result.raised : result.lowered) += std::abs(d);
        result.lowest = std::min(result.lowest, d);
        result.highest = std::max(result.highest, d);
    }
    const auto count = static_cast<double>(result.places);
    result.mean_absolute /= count;
    result.rms = std::sqrt(squares / count);
    result.raised /= count;
    result.lowered /= count;
    if (sided == 0) {
        result.mean = result.deviation = result.lowest = result.highest = no_distance;
        return result;
    }
    result.mean = sum / static_cast<double>(sided);
    double spread = 0;
    for (const PlaceDistance* place : sorted)
        if (!place->beyond) spread += (place->distance - result.mean) * (place->distance - result.mean);
    result.deviation = std::sqrt(spread / static_cast<double>(sided));
    return result;
}

std::vector<PlaceDistance> quantile_places(const std::vector<PlaceDistance>& places, const std::vector<double>& shares,
                                           bool keep_beyond, const std::string& where) {
    const std::vector<const PlaceDistance*> sorted = sorted_places(places, keep_beyond, where);
    std::vector<PlaceDistance> result;
    for (const double share : shares) {
        const double rank = std::ceil(share * static_cast<double>(sorted.size()) - 1e-9);
        result.push_back(*sorted[std::clamp<std::size_t>(static_cast<std::size_t>(std::max(1.0, rank)), 1, sorted.size()) - 1]);
    }
    return result;
}

ToleranceShares tolerance_shares(const std::vector<PlaceDistance>& places, double tolerance, bool keep_beyond) {
    ToleranceShares shares;
    std::size_t count = 0;
    for (const PlaceDistance& place : places) {
        if (!is_counted(place, keep_beyond)) continue;
        ++count;
        if (std::abs(place.distance) <= tolerance) ++shares.within;
        else if (place.beyond) ++shares.beyond;
        else if (place.distance > 0) ++shares.above;
        else ++shares.below;
    }
    for (double* share : {&shares.within, &shares.above, &shares.below, &shares.beyond})
        *share = count > 0 ? *share / static_cast<double>(count) : 0;
    return shares;
}

}  // namespace ostraka

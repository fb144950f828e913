#include "transfer/curve_loops.h"

#include "ostraka/annotation/outline.h"
#include "ostraka/core/progress.h"
#include "ostraka/geom/distance.h"
#include "ostraka/mesh/flood.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace ostraka {

namespace {

using Places = std::vector<SurfacePoint>;

/// Barycentric coordinates of the intersection of two segments in one face; nullopt if they do not intersect or only touch.
std::optional<std::array<double, 3>> crossing(const Mesh& mesh, Index face, const SurfacePoint& a, const SurfacePoint& b,
                                              const SurfacePoint& c, const SurfacePoint& d) {
    const auto p = in_face(mesh, a, face), q = in_face(mesh, b, face), r = in_face(mesh, c, face), s = in_face(mesh, d, face);
    const auto side = [](const auto& from, const auto& to, const auto& place) {
        return (to[1] - from[1]) * (place[2] - from[2]) - (to[2] - from[2]) * (place[1] - from[1]);
    };
    const double of_p = side(r, s, p), of_q = side(r, s, q);
    if (!(of_p * of_q < 0) || !(side(p, q, r) * side(p, q, s) < 0)) return std::nullopt;
    const double t = of_p / (of_p - of_q);
    std::array<double, 3> weights{};
    for (std::size_t k = 0; k < 3; ++k) weights[k] = (1 - t) * p[k] + t * q[k];
    return weights;
}

/// A curve under construction; each small loop that a new place closes is removed.
class Unlooped {
public:
    Unlooped(const Mesh& mesh, double edge) : mesh_(mesh), edge_(edge) {}

    void add(const SurfacePoint& place) {
        const Point at = position(mesh_, place);
        while (!places_.empty() && dissolve(place, at)) {
        }
        if (!places_.empty() && places_.back() == place) return;
        push(place, at, places_.empty() ? no_index : shared_face(mesh_, places_.back(), place));
    }

    Places places_;

private:
    void push(const SurfacePoint& place, const Point& at, Index face) {
        places_.push_back(place);
        points_.push_back(at);
        faces_.push_back(face);
    }

    /// Removes the last loop closed by the segment to `place`, which lies at `at`; false if there is none.
    bool dissolve(const SurfacePoint& place, const Point& at) {
        if (places_.back() == place) return false;
        const Index face = shared_face(mesh_, places_.back(), place);
        double length = distance(points_.back(), at);
        for (std::size_t i = places_.size() - 1; i-- > 0;) {
            if (places_[i] == place) {
                if (!is_small(i, at, length + distance(points_[i], points_[i + 1]))) return false;
                cut_back(i);
                return true;
            }
            if (i + 2 < places_.size() && face != no_index && faces_[i + 1] == face)
                if (const auto weights = crossing(mesh_, face, places_[i], places_[i + 1], places_.back(), place)) {
                    const SurfacePoint met = surface_point(mesh_, face, *weights);
                    const Point met_at = position(mesh_, met);
                    if (!is_small(i, met_at, length)) return false;
                    cut_back(i);
                    if (const SurfacePoint stored = stored_point(mesh_, met); stored != places_.back())
                        push(stored, met_at, face);
                    return true;
                }
            length += distance(points_[i], points_[i + 1]);
            if (length > 20 * edge_) return false;
        }
        return false;
    }

    /// Whether the loop from the point `at` through the places after place i encloses a small area.
    [[nodiscard]] bool is_small(std::size_t i, const Point& at, double length) const {
        if (length > 20 * edge_) return false;
        Vector sum(0, 0, 0);
        for (std::size_t k = i + 1; k + 1 < points_.size(); ++k)
            sum = sum + CGAL::cross_product(points_[k] - at, points_[k + 1] - at);
        return std::sqrt(sum.squared_length()) < 2 * edge_ * edge_;
    }

    void cut_back(std::size_t i) {
        places_.resize(i + 1);
        points_.erase(points_.begin() + static_cast<std::ptrdiff_t>(i) + 1, points_.end());
        faces_.resize(i + 1);
    }

    const Mesh& mesh_;
    double edge_;
    std::vector<Point> points_;  ///< coordinates of the places
    std::vector<Index> faces_;   ///< face of the segment that leads to each place
};

Places unlooped(const Mesh& mesh, const Places& places, double edge) {
    Unlooped result(mesh, edge);
    CancelCheck check;
    for (std::size_t i = 0; i < places.size(); ++i) {
        check();
        // The end of a closed curve coincides with its start and is no loop.
        if (i + 1 == places.size() && places.size() > 1 && places.back() == places.front()) break;
        result.add(places[i]);
    }
    if (places.size() > 1 && places.back() == places.front()) result.places_.push_back(places.back());
    return std::move(result.places_);
}

}  // namespace

std::vector<SurfacePoint> without_small_loops(const Mesh& mesh, std::vector<SurfacePoint> places, double edge, bool closed) {
    places = unlooped(mesh, places, edge);
    if (!closed || places.size() < 4) return places;
    // A second pass from the opposite point, for a loop that contains the start.
    places.pop_back();
    std::rotate(places.begin(), places.begin() + static_cast<std::ptrdiff_t>(places.size() / 2), places.end());
    places.push_back(places.front());
    return unlooped(mesh, places, edge);
}

void dissolve_small_parts(const Mesh& mesh, double area, std::size_t outlines, std::vector<bool>& selected) {
    if (extract_outlines(mesh, selected).size() <= outlines) return;
    struct Part {
        double area = 0;
        std::vector<Face> faces;
    };
    std::vector<Part> parts;
    std::vector<bool> seen(mesh.number_of_faces(), false);
    CancelCheck check;
    for (const Face start : mesh.faces()) {
        check();
        if (seen[start]) continue;
        Part& part = parts.emplace_back();
        part.faces = flood_faces(mesh, start, seen, [&](Halfedge h) {
            const Face beyond = mesh.face(mesh.opposite(h));
            return beyond != Mesh::null_face() && selected[beyond] == selected[start];
        });
        for (const Face f : part.faces) part.area += face_area(mesh, f);
    }
    std::stable_sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.area < b.area; });
    for (const Part& part : parts) {
        if (part.area >= area) return;
        for (const Face f : part.faces) selected[f] = !selected[f];
        if (extract_outlines(mesh, selected).size() <= outlines) return;
    }
}

}  // namespace ostraka

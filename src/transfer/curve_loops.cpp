#include "curve_loops.h"

#include "ostraka/annotation/outline.h"
#include "ostraka/core/flood.h"
#include "ostraka/core/progress.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace ostraka {

std::array<double, 3> weights_in(const Mesh& mesh, Index face, const SurfaceNode& node) {
    const auto corner = corners(mesh, Face(face));
    if (node.kind == SurfaceNode::Kind::face) return node.barycentric;
    std::array<double, 3> weights{0, 0, 0};
    for (std::size_t k = 0; k < 3; ++k) {
        if (node.kind == SurfaceNode::Kind::vertex) {
            if (static_cast<Index>(corner[k]) == node.element) weights[k] = 1;
        } else {
            const Halfedge h = mesh.halfedge(Edge(node.element), 0);
            if (corner[k] == mesh.source(h)) weights[k] = 1 - node.parameter;
            if (corner[k] == mesh.target(h)) weights[k] = node.parameter;
        }
    }
    return weights;
}

namespace {

using Places = std::vector<SurfacePlace>;

/// Barycentric coordinates of the intersection of two segments in one face; nullopt if they do not intersect or only touch.
std::optional<std::array<double, 3>> crossing(const Mesh& mesh, Index face, const SurfaceNode& a, const SurfaceNode& b,
                                              const SurfaceNode& c, const SurfaceNode& d) {
    const auto p = weights_in(mesh, face, a), q = weights_in(mesh, face, b), r = weights_in(mesh, face, c),
               s = weights_in(mesh, face, d);
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

    void add(const SurfacePlace& place) {
        const SurfaceNode node = node_at(mesh_, place);
        while (!kept_.empty() && dissolve(place, node)) {
        }
        if (!kept_.empty() && places_.back() == place) return;
        faces_.push_back(kept_.empty() ? no_index : common_face(mesh_, kept_.back(), node));
        kept_.push_back(node);
        places_.push_back(place);
    }

    Places places_;

private:
    /// Removes the last loop closed by the segment to `place`; false if there is none.
    bool dissolve(const SurfacePlace& place, const SurfaceNode& node) {
        if (places_.back() == place) return false;
        const Index face = common_face(mesh_, kept_.back(), node);
        double length = gap(kept_.back(), node);
        for (std::size_t i = kept_.size() - 1; i-- > 0;) {
            if (places_[i] == place) {
                if (!is_small(i, node, length + gap(kept_[i], kept_[i + 1]))) return false;
                cut_back(i);
                return true;
            }
            if (i + 2 < kept_.size() && face != no_index && faces_[i + 1] == face)
                if (const auto at = crossing(mesh_, face, kept_[i], kept_[i + 1], kept_.back(), node)) {
                    const SurfaceNode met = surface_node(mesh_, face, *at);
                    if (!is_small(i, met, length)) return false;
                    cut_back(i);
                    if (const SurfacePlace there = place_of(mesh_, met); there != places_.back()) {
                        faces_.push_back(face);
                        kept_.push_back(met);
                        places_.push_back(there);
                    }
                    return true;
                }
            length += gap(kept_[i], kept_[i + 1]);
            if (length > 20 * edge_) return false;
        }
        return false;
    }

    static double gap(const SurfaceNode& a, const SurfaceNode& b) { return std::sqrt(CGAL::squared_distance(a.point, b.point)); }

    /// Whether the loop from the node through the places after place i encloses a small area.
    [[nodiscard]] bool is_small(std::size_t i, const SurfaceNode& node, double length) const {
        if (length > 20 * edge_) return false;
        Vector sum(0, 0, 0);
        for (std::size_t k = i + 1; k + 1 < kept_.size(); ++k)
            sum = sum + CGAL::cross_product(kept_[k].point - node.point, kept_[k + 1].point - node.point);
        return std::sqrt(sum.squared_length()) < 2 * edge_ * edge_;
    }

    void cut_back(std::size_t i) {
        faces_.resize(i + 1);
        kept_.erase(kept_.begin() + static_cast<std::ptrdiff_t>(i) + 1, kept_.end());
        places_.resize(i + 1);
    }

    const Mesh& mesh_;
    double edge_;
    std::vector<SurfaceNode> kept_;
    std::vector<Index> faces_;  ///< face of the segment that leads to each place
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

std::vector<SurfacePlace> without_small_loops(const Mesh& mesh, std::vector<SurfacePlace> places, double edge, bool closed) {
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

#include "transfer/corner_texture.h"

#include "ostraka/geom/surface_search.h"

#include <algorithm>
#include <limits>

namespace ostraka {

namespace {

/// Calls action(halfedge) for each halfedge with a face that ends where `first` ends.
template <class Action>
void for_each_corner(const Mesh& mesh, Halfedge first, Action&& action) {
    Halfedge h = first;
    do {
        if (!mesh.is_border(h)) action(h);
        h = mesh.opposite(mesh.next(h));
    } while (h != first);
}

/// Finds the point nearest to a position among faces, and its texture coordinates.
class NearestTexture {
public:
    NearestTexture(const Mesh& mesh, const Mesh::Property_map<Halfedge, TexturePoint>& texture, const Point& position)
        : mesh_(mesh), texture_(texture), position_(position) {}

    void add(Halfedge first) {
        const std::array<Halfedge, 3> sides{first, mesh_.next(first), mesh_.prev(first)};
        std::array<Point, 3> points;
        for (std::size_t k = 0; k < 3; ++k) points[k] = mesh_.point(mesh_.target(sides[k]));
        const auto weights = nearest_barycentric(points[0], points[1], points[2], position_);
        const double distance = CGAL::squared_distance(point_at(points[0], points[1], points[2], weights), position_);
        if (!(distance < distance_)) return;
        distance_ = distance;
        for (std::size_t axis = 0; axis < 2; ++axis) {
            double sum = 0;
            for (std::size_t k = 0; k < 3; ++k) sum += weights[k] * static_cast<double>(texture_[sides[k]][axis]);
            coordinates[axis] = static_cast<float>(sum);
        }
    }

    TexturePoint coordinates{};

private:
    const Mesh& mesh_;
    const Mesh::Property_map<Halfedge, TexturePoint>& texture_;
    Point position_;
    double distance_ = std::numeric_limits<double>::infinity();
};

}  // namespace

void attach_texture(Mesh& mesh, const std::vector<TexturePoint>& corner_texture) {
    if (corner_texture.empty()) return;
    auto texture = mesh.add_property_map<Halfedge, TexturePoint>(halfedge_texture, TexturePoint{}).first;
    for (const Face face : mesh.faces()) {
        Halfedge h = mesh.halfedge(face);
        for (std::size_t k = 0; k < 3; ++k, h = mesh.next(h)) texture[h] = corner_texture[3 * static_cast<std::size_t>(face) + k];
    }
}

std::vector<TexturePoint> detach_texture(Mesh& mesh) {
    std::vector<TexturePoint> corner_texture;
    auto [texture, exists] = mesh.property_map<Halfedge, TexturePoint>(halfedge_texture);
    if (!exists) return corner_texture;
    corner_texture.reserve(3 * static_cast<std::size_t>(mesh.number_of_faces()));
    for (const Face face : mesh.faces()) {
        Halfedge h = mesh.halfedge(face);
        for (int k = 0; k < 3; ++k, h = mesh.next(h)) corner_texture.push_back(texture[h]);
    }
    mesh.remove_property_map(texture);
    return corner_texture;
}

void CornerTexture::place_vertex(const Mesh& mesh, Halfedge h, const Point& position) {
    changes_.clear();
    const Halfedge o = mesh.opposite(h);
    const bool target_stays = position == mesh.point(mesh.target(h));
    const auto place_side = [&](const TexturePoint& at_source, const TexturePoint& at_target) {
        const auto for_chart = [&](const auto& action) {
            for_each_corner(mesh, o, [&](Halfedge corner) {
                if (texture_[corner] == at_source) action(corner);
            });
            if (target_stays) return;
            for_each_corner(mesh, h, [&](Halfedge corner) {
                if (texture_[corner] == at_target) action(corner);
            });
        };
        TexturePoint moved = at_target;
        if (!target_stays) {
            NearestTexture nearest(mesh, texture_, position);
            for_chart([&](Halfedge corner) { nearest.add(corner); });
            moved = nearest.coordinates;
        }
        for_chart([&](Halfedge corner) { changes_.emplace_back(corner, moved); });
    };
    // Where both sides have the same coordinates, the first call changes the corners of both.
    const bool left = !mesh.is_border(h), right = !mesh.is_border(o);
    std::array<TexturePoint, 2> left_side{}, right_side{};
    if (left) left_side = {texture_[mesh.prev(h)], texture_[h]};
    if (right) right_side = {texture_[o], texture_[mesh.prev(o)]};
    if (left) place_side(left_side[0], left_side[1]);
    if (right && !(left && left_side == right_side)) place_side(right_side[0], right_side[1]);
    for (const auto& [corner, coordinates] : changes_) texture_[corner] = coordinates;
}

}  // namespace ostraka

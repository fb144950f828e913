// Edge collapses of a surface around an object that keep the object enclosed.
#pragma once

#include "ostraka/cage/cage.h"

#include <memory>

namespace ostraka::cage {

/// The object that the cage must enclose: its triangles, and one point per connected component.
class Obstacle {
public:
    explicit Obstacle(const TriangleSoup& soup);
    ~Obstacle();
    /// True if the triangle (a, b, c) intersects the object.
    [[nodiscard]] bool meets(const Point& a, const Point& b, const Point& c) const;
    /// One point per connected component of the object.
    [[nodiscard]] const std::vector<Point>& pieces() const { return pieces_; }

private:
    struct Tree;
    std::unique_ptr<Tree> tree_;
    std::vector<Point> pieces_;
};

/// Collapses edges until `target` vertices are left or no collapse is admissible. `surface` is closed or, with a mirror plane,
/// one half whose border lies on the plane; `target` then counts both halves. Faces stay at a distance of about `clearance` from
/// the object where possible. Returns the number of vertices reached.
std::size_t shrink(Mesh& surface, const Obstacle& obstacle, std::size_t target, double clearance, const CageDensity& density,
                   const std::optional<MirrorPlane>& mirror);

/// Number of vertices of the whole surface, both halves together.
std::size_t whole_size(const Mesh& half);
/// The part of a closed surface on the side of the plane to which the plane's normal points, cut along the plane.
Mesh upper_half(const Mesh& surface, const MirrorPlane& plane);
/// The half and its mirror image, joined at the border.
Mesh mirrored_whole(const Mesh& half, const MirrorPlane& plane);
/// The mirror image of a point.
Point image(const Point& p, const MirrorPlane& plane);

}  // namespace ostraka::cage

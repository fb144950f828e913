// Selections in a picture: by a rectangle, a polygon or a pixel.
#pragma once

#include "ostraka/geom/surface_search.h"
#include "ostraka/render/camera.h"

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace ostraka {

using Pixel = std::array<double, 2>;  ///< distances from the picture's left and top edges, pixels

/// An area of a picture: a function that is true for pixels inside.
using ScreenArea = std::function<bool(const Pixel&)>;
/// The rectangle between two opposite corners, including its border.
ScreenArea screen_rectangle(const Pixel& one, const Pixel& other);
/// The interior of a simple polygon. Throws Error (input), starting with `where`, for fewer than three points, zero area or
/// crossing sides; the error names the two sides and the position of the first crossing.
ScreenArea screen_polygon(const std::vector<Pixel>& points, const std::string& where);

/// For each face, whether its centroid is seen within the area of the picture. With `search` only visible points count: the
/// segment from the point to the eye (for parallel rays, until it has left the object) must not meet another face. Faces that
/// contain the point itself never hide it, so that both sides of an open surface can be seen. Exact for the coordinates of the
/// eye. With a null `search` hidden points count too. Time: O(n), plus O(log n) per point that needs a ray.
std::vector<bool> faces_seen(const Mesh& mesh, const PictureCamera& camera, const ScreenArea& area, const SurfaceSearch* search);
/// Indices of the vertices with a face that are seen within the area of the picture, ascending, as for `faces_seen`.
std::vector<Index> vertices_seen(const Mesh& mesh, const PictureCamera& camera, const ScreenArea& area,
                                 const SurfaceSearch* search);

/// The surface point seen at a pixel; nothing for the background.
std::optional<SurfaceHit> seen_at(const SurfaceSearch& search, const PictureCamera& camera, const Pixel& pixel);

/// True if the point lies within the solid that a closed mesh bounds (by solid angles: O(n)); false for an open mesh.
bool is_inside(const Mesh& mesh, const Point& point);

}  // namespace ostraka

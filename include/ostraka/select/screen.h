// Selections made on a picture: by a rectangle or a polygon drawn on it, and by a pixel.
#pragma once

#include "ostraka/geom/surface_search.h"
#include "ostraka/render/camera.h"

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace ostraka {

using Pixel = std::array<double, 2>;  ///< to the right and downwards from the picture's top left corner

/// A part of a picture.
using ScreenArea = std::function<bool(const Pixel&)>;
/// Between two opposite corners, borders included.
ScreenArea screen_rectangle(const Pixel& one, const Pixel& other);
/// Inside a closed polygon. Throws Error (input), starting with `where`, for fewer than three points, one that has no area, and
/// one whose sides cross: the two sides and the place of the first crossing are named.
ScreenArea screen_polygon(const std::vector<Pixel>& points, const std::string& where);

/// The faces whose centroid, and the vertices (ascending, with a face) that are seen within the area. With `search` only what is
/// visible counts: what the segment to the eye (for parallel rays, to where no surface is any more) reaches without meeting
/// another face. Faces that the place itself belongs to never hide it, so that both sides of an open surface can be seen. Exact
/// for the coordinates of the eye; without `search` hidden parts count too. O(n), and O(log n) a place where rays are needed.
std::vector<bool> faces_seen(const Mesh& mesh, const PictureCamera& camera, const ScreenArea& area, const SurfaceSearch* search);
std::vector<Index> vertices_seen(const Mesh& mesh, const PictureCamera& camera, const ScreenArea& area,
                                 const SurfaceSearch* search);

/// What is seen at a pixel; nothing where the background is.
std::optional<SurfaceHit> seen_at(const SurfaceSearch& search, const PictureCamera& camera, const Pixel& pixel);

/// True if the point lies within the solid that a closed mesh bounds (by solid angles: O(n)); false for an open mesh.
bool is_inside(const Mesh& mesh, const Point& point);

}  // namespace ostraka

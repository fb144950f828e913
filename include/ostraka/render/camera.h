// Mapping between pixels of a picture and points, in the mesh's own coordinates.
#pragma once

#include "ostraka/mesh/mesh.h"
#include "ostraka/render/view.h"

#include <array>
#include <optional>

namespace ostraka {

/// A part of a picture in pixels; x grows to the right, y downwards. The centre of the top left pixel is (0.5, 0.5).
struct PixelBox {
    double left = 0, top = 0, width = 0, height = 0;
};

/// A pinhole or parallel projection. right x up = toward, all of unit length.
struct PictureCamera {
    Vector right{1, 0, 0}, up{0, 0, 1}, toward{0, -1, 0};  ///< `toward` points to the viewer
    Point centre{0, 0, 0};                                 ///< the point shown in the middle of the picture
    double scale = 1;                                      ///< pixels per unit; in perspective at the depth of the centre
    double distance = 0;                                   ///< distance from the centre to the eye; 0 for parallel projection
    double middle_x = 0, middle_y = 0;                     ///< pixel coordinates of the centre

    struct Ray {
        Point origin;      ///< the eye, or for parallel projection the point in the plane through the centre
        Vector direction;  ///< unit vector away from the viewer
    };
    [[nodiscard]] Ray ray(double x, double y) const;
    /// Pixel coordinates; none for points level with the eye or behind it.
    [[nodiscard]] std::optional<std::array<double, 2>> project(const Point& point) const;
    /// The eye; none for parallel projection.
    [[nodiscard]] std::optional<Point> eye() const;
};

/// Camera settings of `render` for one object.
struct CameraPlan {
    View view;
    std::array<double, 3> up{0, 0, 1};  ///< unit length
    bool perspective = false;
    double zoom = 1;
    PixelBox pane;  ///< the part of the picture where the object is drawn
};

/// The camera that `render` uses for the mesh: the whole object fits the pane with a margin. Linear. Throws Error (input) for a
/// mesh without vertices.
PictureCamera fit_camera(const Mesh& mesh, const CameraPlan& plan);

/// The pane of the object in a picture of this size with a single object, a scale bar, no legend and no title.
PixelBox plain_pane(int width, int height);

}  // namespace ostraka

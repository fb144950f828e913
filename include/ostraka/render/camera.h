// Maps pixels of a picture to lines of sight, and points in the mesh's coordinates to pixels.
#pragma once

#include "ostraka/mesh/mesh.h"
#include "ostraka/render/view.h"

#include <array>
#include <optional>

namespace ostraka {

/// A part of a picture in pixels; x grows to the right, y downwards. The centre of the top left pixel is (0.5, 0.5).
struct PixelBox {
    double left = 0, top = 0, width = 0, height = 0;  ///< position of the top left corner, and size
};

/// A pinhole camera or parallel projection. `right`, `up` and `toward` are unit vectors with right x up = toward.
struct PictureCamera {
    Vector right{1, 0, 0}, up{0, 0, 1}, toward{0, -1, 0};  ///< `toward` points from the object to the viewer
    Point centre{0, 0, 0};                                 ///< the point shown at (middle_x, middle_y)
    double scale = 1;                   ///< pixels per unit of length; with perspective, at the depth of `centre`
    double distance = 0;                ///< distance from `centre` to the eye; 0 for parallel projection
    double middle_x = 0, middle_y = 0;  ///< pixel coordinates of `centre`

    /// Line of sight through a pixel.
    struct Ray {
        Point origin;      ///< the eye; for parallel projection, the point of the line in the plane through `centre`
        Vector direction;  ///< unit vector away from the viewer
    };
    /// Line of sight through the pixel coordinates x, y.
    [[nodiscard]] Ray ray(double x, double y) const;
    /// Pixel coordinates of a point; none for points level with the eye or behind the eye.
    [[nodiscard]] std::optional<std::array<double, 2>> project(const Point& point) const;
    /// Position of the eye; none for parallel projection.
    [[nodiscard]] std::optional<Point> eye() const;
};

/// Camera settings of `render` for one object.
struct CameraPlan {
    View view;                          ///< view direction
    std::array<double, 3> up{0, 0, 1};  ///< upward direction of the object, of unit length
    bool perspective = false;           ///< true: pinhole camera; false: parallel projection
    double zoom = 1;                    ///< magnification; 1 shows the whole object
    PixelBox pane;                      ///< the part of the picture where the object is drawn
};

/// The camera with which `render` shows the mesh: the whole object fits the pane with a margin. Time: linear. Throws Error
/// (input) for a mesh without vertices.
PictureCamera fit_camera(const Mesh& mesh, const CameraPlan& plan);

/// The pane of a single object in a picture of this size, with a scale bar and without legend and title.
PixelBox plain_pane(int width, int height);

}  // namespace ostraka

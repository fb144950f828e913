// Which pixel of a picture sees which place, in the mesh's own coordinates.
#pragma once

#include "ostraka/core/mesh.h"
#include "ostraka/render/view.h"

#include <array>
#include <optional>

namespace ostraka {

/// A part of a picture in pixels; x grows to the right, y downwards. The middle of the top left pixel is (0.5, 0.5).
struct PixelBox {
    double left = 0, top = 0, width = 0, height = 0;
};

/// A pinhole, or parallel rays. right x up = toward, all of unit length.
struct PictureCamera {
    Vector right{1, 0, 0}, up{0, 0, 1}, toward{0, -1, 0};  ///< `toward` points to the viewer
    Point centre{0, 0, 0};                                 ///< the point seen in the middle
    double scale = 1;                                      ///< pixels per unit, in perspective at the centre's depth
    double distance = 0;                                   ///< from the centre to the eye; 0 for parallel rays
    double middle_x = 0, middle_y = 0;                     ///< pixel coordinates of the centre

    struct Ray {
        Point origin;      ///< the eye, or for parallel rays the place in the plane through the centre
        Vector direction;  ///< unit vector away from the viewer
    };
    [[nodiscard]] Ray ray(double x, double y) const;
    /// Pixel coordinates; nothing for what lies level with the eye or behind it.
    [[nodiscard]] std::optional<std::array<double, 2>> project(const Point& point) const;
    /// The eye; nothing for parallel rays.
    [[nodiscard]] std::optional<Point> eye() const;
};

/// How `render` sees one object.
struct CameraPlan {
    View view;
    std::array<double, 3> up{0, 0, 1};  ///< unit length
    bool perspective = false;
    double zoom = 1;
    PixelBox pane;  ///< where the object is drawn
};

/// The camera that `render` uses for the mesh: the whole object fits the pane but for a margin. Linear. Throws Error (input) for
/// a mesh without vertices.
PictureCamera fit_camera(const Mesh& mesh, const CameraPlan& plan);

/// Where a picture of one object of this size, without a legend and a title and with its scale bar, shows the object.
PixelBox plain_pane(int width, int height);

}  // namespace ostraka

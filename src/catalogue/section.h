// Sections of a wall through the axis, and the thickness of the wall.
#pragma once

#include "catalogue/pose.h"
#include "ostraka/slicing/slice.h"

namespace ostraka::detail {

/// Frame of the half plane in a direction (radians around z): the section lies at negative x, y is the height.
SliceFrame section_frame(double angle);
/// The contours of the section in this half plane; contours at positive x belong to the opposite half plane.
Slice section_at(const Mesh& mesh, double angle);

/// Direction of the half plane in which the most of the wall is preserved, nearest to the middle of the sherd; in a sherd with a
/// rim, among the directions that reach the rim.
double best_section(const Pose& pose);

/// Thickness of the wall at points along its contours: diameter of the largest circle in the wall that touches the contour at
/// the point and the opposite wall. Only parts at negative x count.
std::vector<double> wall_thickness(const Slice& section);

/// The distance of the section from the axis at equal heights (x positive, ascending), where there is a section.
std::vector<Eigen::Vector2d> outer_profile(const Slice& section, double low, double high, std::size_t count);

/// The parts of the section's closed contours that lie on the fracture at the top or bottom: where the contour turns across the
/// wall, within 1.5 `thickness` of the end.
std::vector<std::vector<Eigen::Vector2d>> fracture_parts(const Slice& section, bool top, double thickness);

}  // namespace ostraka::detail

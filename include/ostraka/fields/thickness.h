// Thickness of a solid under each face: the shape diameter function.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/mesh/mesh.h"

#include <vector>

namespace ostraka {

/// Options of `thickness`.
struct ThicknessOptions {
    int rays = 30;     ///< number of rays in the cone under each face
    double cone = 60;  ///< full opening angle of the cone, in degrees
    /// Radius over which normals are averaged for the cone's axis, as a fraction of the diagonal of the mesh's bounding box.
    double scale = 0.01;

    void list_options(OptionList& list);  ///< adds every member to a list of options
};

/// The shape diameter (Shapira, Shamir and Cohen-Or 2008) of each face in the mesh's unit: rays in a cone around the inward
/// normal are cast to the first face through which they leave the solid; ray lengths that differ from the median by more than one
/// standard deviation are dropped, and the others are averaged with weights that fall with the angle between ray and axis.
/// Between parallel walls at distance t the value is a few per cent above t, in a sphere a few per cent below the diameter; a
/// narrower cone is more accurate. The value is NaN if fewer than half of the rays hit a face (open meshes). Rays start at the
/// face's centroid. Throws Error (usage) for options out of range.
std::vector<double> thickness(const Mesh& mesh, const ThicknessOptions& options = {});

/// For each vertex: the mean of the values of its faces, weighted by the areas of the faces; NaN if no face of the vertex has a
/// value.
std::vector<double> vertices_from_faces(const Mesh& mesh, const std::vector<double>& face_values);

}  // namespace ostraka

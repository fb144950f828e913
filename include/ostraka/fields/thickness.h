// Thickness of a solid under each face: the shape diameter function.
#pragma once

#include "ostraka/core/mesh.h"
#include "ostraka/core/options.h"

#include <vector>

namespace ostraka {

struct ThicknessOptions {
    int rays = 30;        ///< in the cone under each face
    double cone = 60;     ///< opening of the cone, degrees
    double scale = 0.01;  ///< radius over which normals are averaged to find the cone's axis, as a share of the box diagonal

    void describe(OptionList& visit);
};

/// The shape diameter (Shapira, Shamir and Cohen-Or 2008) of each face in the mesh's unit: rays inside a cone around the inward
/// normal run to the first face that they leave the solid through; those farther from the median than a standard deviation are
/// left out and the others averaged with weights that fall with the angle. Between parallel walls t apart the value is up to some
/// per cent above t, in a ball some per cent below its diameter; a narrower cone is nearer. NaN where fewer than half of the rays
/// meet anything (open meshes). Rays start at the face's centroid. Throws Error (usage) for options out of range.
std::vector<double> thickness(const Mesh& mesh, const ThicknessOptions& options = {});

/// Per vertex: the mean of its faces' values, weighted by their areas; NaN where no face has one.
std::vector<double> vertices_from_faces(const Mesh& mesh, const std::vector<double>& face_values);

}  // namespace ostraka

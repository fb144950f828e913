// Thickness of a solid under each face: the shape diameter function.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/mesh/mesh.h"

#include <vector>

namespace ostraka {

struct ThicknessOptions {
    int rays = 30;        ///< number of rays in the cone under each face
    double cone = 60;     ///< opening of the cone, degrees
    double scale = 0.01;  ///< radius over which normals are averaged for the cone's axis, as a share of the box diagonal

    void describe(OptionList& visit);
};

/// The shape diameter (Shapira, Shamir and Cohen-Or 2008) of each face in the mesh's unit: rays in a cone around the inward
/// normal are cast to the first face through which they leave the solid; lengths farther from the median than a standard
/// deviation are dropped and the others averaged with weights that fall with the angle. Between parallel walls at distance t
/// the value is some per cent above t, in a sphere some per cent below its diameter; a narrower cone is more accurate. NaN if
/// fewer than half of the rays hit anything (open meshes). Rays start at the face's centroid. Throws Error (usage) for options
/// out of range.
std::vector<double> thickness(const Mesh& mesh, const ThicknessOptions& options = {});

/// Per vertex: the mean of the values of its faces, weighted by their areas; NaN if no face has a value.
std::vector<double> vertices_from_faces(const Mesh& mesh, const std::vector<double>& face_values);

}  // namespace ostraka

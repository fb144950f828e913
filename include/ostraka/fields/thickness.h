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

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// The shape diameter (Shapira, Shamir and Cohen-Or 2008) of each face in the mesh's unit. Rays in a cone around the inward
/// normal end at the first face through which they leave the solid. Ray lengths that differ from the median by more than one
/// standard deviation are dropped, and the other lengths are averaged with weights that decrease with the angle between ray and
/// cone axis. For a solid between parallel planes at distance t the value is a few per cent above t, for a ball a few per cent
/// below the diameter; a narrower cone is more accurate. The value is NaN if fewer than half of the rays hit a face (open
/// meshes). Rays start at the face's centroid. Throws Error (usage) for options out of range.
std::vector<double> thickness(const Mesh& mesh, const ThicknessOptions& options = {});

/// Vertex values from face values: for each vertex, the mean over the adjacent faces, weighted by their areas; NaN if no
/// adjacent face has a value.
std::vector<double> vertices_from_faces(const Mesh& mesh, const std::vector<double>& face_values);

}  // namespace ostraka

// Colours of a surface at points and vertices, and the distribution of colours over a part.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/image/colour_space.h"
#include "ostraka/io/mesh_file.h"

#include <string>
#include <vector>

namespace ostraka {

/// True if the mesh has an image, a material, or colours of vertices or faces.
bool has_colours(const MeshExtras& extras);

/// Reads the colour of a surface where it is asked for: the image (or base colour) of the material times the colours of vertices
/// or, without these, of faces; white where there is none.
class SurfaceColour {
public:
    /// `mesh` and `extras` must outlive the object. `where`: file for messages. Throws Error (input) for an image that cannot be
    /// decoded.
    SurfaceColour(const Mesh& mesh, const MeshExtras& extras, const std::string& where);

    /// Linear red, green and blue at a point of a face, given by its barycentric coordinates: the mean over an area of the given
    /// width, in the unit of the mesh; 0: at the point.
    [[nodiscard]] std::array<float, 3> at(Face face, const std::array<double, 3>& barycentric, double width = 0) const;
    /// Size of a material's image in pixels; {0, 0} without an image.
    [[nodiscard]] std::array<int, 2> image_size(Index material) const { return sampler_.size(material); }

private:
    const Mesh& mesh_;
    const MeshExtras& extras_;
    TextureSampler sampler_;
};

/// CIELAB colour of each vertex: the mean over the faces around it, within a third of their edges. Vertices without faces: black.
std::vector<Lab> vertex_lab(const Mesh& mesh, const MeshExtras& extras, const std::string& where);

/// Distribution of the colours of a part over its area.
struct ColourMeasures {
    Lab mean{};                                    ///< mean in CIELAB
    double spread = 0;                             ///< root mean square distance from the mean in CIELAB
    std::array<std::uint8_t, 3> mean_rgb{};        ///< mean light, as sRGB
    double lightness_low = 0, lightness_high = 0;  ///< lightness below which 10 % and 90 % of the area lie
};
/// Colours of a region, by area: about `samples` samples on grids of its faces, at least one in each; free regions are cut along
/// their outlines. Throws Error (input) for an annotation that is not a region, and for a region without area.
ColourMeasures measure_colour(AnnotatedMeshView object, const Annotation& region, const MeshExtras& extras,
                              const std::string& where, std::size_t samples = 20000);

}  // namespace ostraka

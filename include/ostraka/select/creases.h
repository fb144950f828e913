// Ridges and hollows, where clay was pressed on, joined or smeared, as candidates for line and region annotations.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/core/options.h"
#include "ostraka/mesh/mesh.h"

#include <string>
#include <vector>

namespace ostraka {

struct CreaseOptions {
    enum class Kind { ridge, hollow, both } kind = Kind::both;  ///< which creases are found
    double scale = 0.01;          ///< radius over which curvature is averaged, as a share of the bounding box diagonal
    double background_scale = 3;  ///< radius of the neighbourhood used for comparison, in multiples of the scale
    double lower_threshold = 3;   ///< lower hysteresis threshold of the response, in robust standard deviations
    double upper_threshold = 6;   ///< upper hysteresis threshold of the response, in robust standard deviations
    double floor = 0.03;          ///< min response of a crease (curvature times scale)
    double shortest = 0.05;       ///< min length of a crease, as a share of the bounding box diagonal

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// A ridge or hollow.
struct Crease {
    bool ridge = true;         ///< true: convex crease; false: hollow
    bool closed = false;       ///< true: the line is a closed loop
    std::vector<Index> faces;  ///< indices of the faces of the crease, ascending
    /// Successive vertices along the crest, connected by edges; if closed, the first vertex is repeated at the end.
    std::vector<Index> line;
    double length = 0;          ///< length of the line, in the mesh's unit
    double width = 0;           ///< mean width: area of the faces divided by the length
    double mean_curvature = 0;  ///< mean curvature over the scale, averaged along the line; unit: 1 / length
    double strength = 0;        ///< mean response along the line, in robust standard deviations, at most 1e6
};

/// Finds ridges and hollows. The response of a vertex is s (H(s) - H(wide s)), where H(r) is the mean curvature over a ball of
/// radius r (fields/curvature.h) and s is the scale as a length. The response is zero on planes, spheres and cylinders of any
/// radius, positive on ridges, negative in hollows. The robust standard deviation of the response is 1.4826 times the median of
/// its absolute values over the area (zero on a shape without noise or detail, hence the option `floor`). Vertices above
/// `lower_threshold` that are connected with a vertex above `upper_threshold` form a crease (hysteresis), unless a response of
/// the other sign within the radius of the background is more than three times as strong (then the crease is a side effect of the
/// stronger one). The line of a crease is the path along the crest between the two ends farthest apart, or, if the crease is a
/// ring, the shortest loop around the ring (found on its double cover). Creases are sorted by length, then strength, both
/// descending. Border vertices have no response. Time as for curvature, plus n log n in each crease. Throws Error (usage) for
/// options out of range, `lower_threshold` above `upper_threshold`, or a scale below the mean edge length.
std::vector<Crease> find_creases(const Mesh& mesh, const CreaseOptions& options = {});

/// One annotation for each crease, in the order of `creases`: "ridge 1", "ridge 2", ... in warm and "hollow 1", ... in cold
/// colours, as lines along the crests or (`regions`) as regions. Descriptors: length (of lines), width, mean curvature and
/// strength. `unit`: unit of the mesh's coordinates, "" if unknown.
AnnotationSet annotate_creases(const std::vector<Crease>& creases, bool regions, const std::string& unit = {});

}  // namespace ostraka

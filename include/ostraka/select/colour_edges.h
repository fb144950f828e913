// Lines along the edges of what is painted: where the colour of the surface changes most.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/core/options.h"
#include "ostraka/io/mesh_file.h"

#include <string>
#include <vector>

namespace ostraka {

struct ColourEdgeOptions {
    double contrast = 10;     ///< difference of the colours of both sides (CIELAB) that each line exceeds somewhere
    double min_contrast = 5;  ///< difference of the colours of both sides at which lines end
    double texels = 1.5;      ///< standard deviation of the smoothing, in texels
    double shortest = 0.05;   ///< min length of a line, as a share of the bounding box diagonal
};

/// An edge of what is painted.
struct ColourEdge {
    /// Successive points of the line, each two in a common face; closed if the first is repeated at the end.
    std::vector<SurfacePoint> line;
    bool closed = false;  ///< true: the line is a closed loop
    double length = 0;    ///< length of the line, in the mesh's unit
    double contrast = 0;  ///< mean difference of the colours of both sides, in CIELAB (CIE 1976)
};

/// Finds the edges of what is painted (Canny 1986, on the surface). The surface is divided into triangles of the size of the
/// image's texels, and its CIELAB colour is smoothed. The gradient of a colour is that of its largest change: the first
/// eigenvector of the sum of the outer products of the gradients of L, a and b (Di Zenzo 1986). An edge lies where the size of
/// the gradient is largest along its direction: on the zero level of its derivative, traced linearly through the triangles.
/// Pieces whose contrast is at least `min_contrast` are joined to lines; lines whose contrast is at least `contrast` somewhere,
/// and which are long enough, are returned, those with the largest product of length and contrast first. The contrast is that of
/// a step with the same largest gradient after the smoothing. Takes linear time in the number of texels. Throws Error (input) for
/// a mesh without colours, Error (usage) for options out of range or `min_contrast` above `contrast`. `where`: file for messages.
std::vector<ColourEdge> find_colour_edges(const Mesh& mesh, const MeshExtras& extras, const ColourEdgeOptions& options,
                                          const std::string& where);

/// One free line for each edge, in their order: "colour edge 1", ... Descriptors: length and contrast.
AnnotationSet annotate_colour_edges(const Mesh& mesh, const std::vector<ColourEdge>& edges, const std::string& unit = {});

}  // namespace ostraka

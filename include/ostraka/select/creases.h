// Ridges and hollows, where clay was pressed on, joined or smeared: candidates for line and region annotations.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/core/options.h"
#include "ostraka/mesh/mesh.h"

#include <string>
#include <vector>

namespace ostraka {

struct CreaseOptions {
    enum class Kind { ridge, hollow, both } kind = Kind::both;
    double scale = 0.01;
    double wide = 3;
    double weak = 3;
    double strong = 6;
    double floor = 0.03;
    double shortest = 0.05;

    void describe(OptionList& visit);
};

struct Crease {
    bool ridge = true;          ///< convex crease; otherwise a hollow
    bool closed = false;        ///< the line is a closed loop
    std::vector<Index> faces;   ///< ascending
    std::vector<Index> line;    ///< successive vertices along the crest, connected by edges; closed: first = last
    double length = 0;          ///< length of the line, in the mesh's unit
    double width = 0;           ///< area of the faces / length
    double mean_curvature = 0;  ///< mean curvature, averaged along the line at the scale; 1/length
    double strength = 0;        ///< mean response along the line in robust deviations, at most 1e6
};

/// Finds ridges and hollows. The response of a vertex is s (H(s) - H(wide s)), where H(r) is the mean curvature over a ball of
/// radius r (fields/curvature.h) and s the scale as a length. It is zero on planes, spheres and cylinders of any radius,
/// positive on ridges, negative in hollows. Its robust deviation is 1.4826 times the median of its absolute values over the
/// area (zero on a shape without noise or detail, hence the floor). Vertices above `weak` that are connected with a vertex
/// above `strong` form a crease (hysteresis), unless a response of the other sign within the wide radius is more than three
/// times as strong (the crease is then its echo). The line of a crease is the path along the crest between the two ends
/// farthest apart, or, if the crease is a ring, the shortest such loop around it (found on its double cover). Creases are
/// sorted by length and strength, descending. Border vertices have no response. Time as for curvature, plus n log n in each
/// crease. Throws Error (usage) for options out of range, `weak` above `strong`, or a scale below the mean edge length.
std::vector<Crease> find_creases(const Mesh& mesh, const CreaseOptions& options = {});

/// One annotation for each crease, in their order: "ridge 1", "ridge 2", ... in warm and "hollow 1", ... in cold colours, as
/// lines along the crests or as regions. Descriptors: length (of lines), width, mean curvature and strength. `unit`: unit of
/// the mesh's coordinates, "" if unknown.
AnnotationSet annotate_creases(const std::vector<Crease>& creases, bool regions, const std::string& unit = {});

}  // namespace ostraka

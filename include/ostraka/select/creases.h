// Ridges and hollows: where clay was pressed on, joined or smeared, as candidates for lines and regions.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/core/mesh.h"
#include "ostraka/core/options.h"

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
    bool ridge = true;          ///< convex; else a hollow
    bool closed = false;        ///< it runs around something
    std::vector<Index> faces;   ///< ascending
    std::vector<Index> line;    ///< successive vertices joined by edges along its crest; closed: first = last
    double length = 0;          ///< of the line, in the mesh's unit
    double width = 0;           ///< area of the faces / length
    double mean_curvature = 0;  ///< mean along the line, at the scale, 1/length
    double strength = 0;        ///< mean response along the line in robust deviations, at most 1e6
};

/// The response of a vertex is s (H(s) - H(wide s)), where H(r) is the mean curvature over a ball of radius r
/// (fields/curvature.h) and s the scale as a length: nothing on planes, spheres and cylinders, whatever their radius, positive on
/// ridges, negative in hollows. Its robust deviation is 1.4826 times the median of its absolute values over the area (zero on a
/// shape without noise or detail, hence the floor). Vertices above `weak` that are connected with one above `strong` make a
/// crease (hysteresis), unless one of the other sign within the wide radius is over three times as strong (its echo). Its line is
/// the path that keeps to the crest between the two ends farthest apart, or, where the crease is a ring, the shortest such loop
/// around it (found on its double cover). Longest strongest first. Border vertices have no response. Time as for curvature, and n
/// log n in each crease. Throws Error (usage) for options out of range, `weak` above `strong`, or a scale below the mean
/// length of the edges.
std::vector<Crease> find_creases(const Mesh& mesh, const CreaseOptions& options = {});

/// One annotation for each crease in their order: "ridge 1", "ridge 2", ... in warm and "hollow 1", ... in cold colours, as lines
/// along the crests or as regions, with length (of lines), width, mean curvature and strength as descriptors. `unit`: of the
/// mesh's coordinates, "" if unknown.
AnnotationSet annotate_creases(const std::vector<Crease>& creases, bool regions, const std::string& unit = {});

}  // namespace ostraka

// Outer, inner and fracture surface of a fragment classified by its shape.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/fracture/fragment.h"

#include <string>
#include <vector>

namespace ostraka {

struct FacetOptions {
    double edge = 40;        ///< degrees by which a surface turns over an edge that may be where a break begins
    double wall = 0.25;      ///< a shell is thinner than this share of the square root of its area
    double coherence = 0.3;  ///< how much neighbours count against what a face shows by itself
    double rough = 0.01;     ///< a break in a solid deviates from a smooth surface by more than this share of its size

    void describe(OptionList& visit);
};

/// Faces of one kind joined over edges.
struct FacetSegment {
    Facet facet = Facet::outer;
    std::vector<Index> faces;  ///< ascending
    double area = 0;
    double confidence = 0;  ///< 0 to 1: how far the faces themselves show what they are taken for, mean over the area
};

struct Facets {
    std::vector<Facet> of_face;
    std::vector<FacetSegment> segments;  ///< largest first
    bool shell = false;                  ///< a wall with two sides
    double thickness = 0;                ///< of the wall, where there is one
    double confidence = 0;               ///< mean over the area
    std::vector<std::string> notes;
    [[nodiscard]] double area(Facet facet) const;
};

/// Shells: from each face rays go into the solid. Where they leave it soon, through a face that looks the other way, the face is
/// of the outer or the inner side; the fracture is the rest: a narrow band between two sides that face away from each other. The
/// outer side looks away from the axis of rotation (axis/axis.h), or, where there is none, from the point nearest to the lines
/// along all normals. Labels minimise what faces show plus the length of their boundaries, which cost little along
/// sharp convex edges (alpha expansion; Boykov, Veksler and Zabih 2001). Solids, and open meshes: patches are merged as long as
/// the surface does not turn sharply outward, on average, over the boundary of two; of what remains, parts that lie over a plane
/// but not smoothly (quadric) are fractures, never the largest one. A clean cut is not distinguished from a formed end. Throws
/// Error (input) for a mesh without area.
Facets find_facets(const Mesh& mesh, const FacetOptions& options = {});

}  // namespace ostraka

// Outer, inner and fracture surface of a fragment classified by its shape.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/fracture/facet_evidence.h"
#include "ostraka/fracture/fragment.h"

#include <string>
#include <vector>

namespace ostraka {

struct FacetOptions {
    double edge = 40;        ///< degrees by which a surface turns over an edge that may be where a break begins
    double wall = 0.25;      ///< a shell is thinner than this share of the square root of its area
    double coherence = 0.3;  ///< how much neighbours count against what a face shows by itself

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
    /// Whether there is a break: one is found; none is seen anywhere; it cannot be told, what is called one may be none, or what
    /// is not may be one.
    enum class Answer { broken, whole, unclear };

    std::vector<Facet> of_face;
    std::vector<double> probability;     ///< of each face, that it is of a break, by what it shows itself
    std::vector<FacetSegment> segments;  ///< largest first
    Answer answer = Answer::unclear;
    bool shell = false;     ///< a wall with two sides
    double thickness = 0;   ///< of the wall, where there is one
    double confidence = 0;  ///< mean over the area
    std::vector<std::string> notes;
    [[nodiscard]] double area(Facet facet) const;
};

std::string to_string(Facets::Answer answer);

/// Faces are seen together in at most about 24 000 patches. A model (data/facets.model.json) learnt from broken objects, made and
/// scanned, gives each the probability that it is of a break. Labels minimise what patches show plus the length of their
/// boundaries, which cost little along sharp convex edges (alpha expansion; Boykov, Veksler and Zabih 2001). Where most of what
/// is intact lies over a thin wall whose other side is intact too, it has an outer and an inner side: the outer one looks away
/// from the axis of rotation (axis/axis.h), or, where there is none, from the point nearest to the lines along all normals.
/// Throws Error (input) for a mesh without area.
Facets find_facets(const Mesh& mesh, const FacetOptions& options = {});

/// As above, with log odds of each patch from elsewhere.
Facets find_facets(const Mesh& mesh, const FacetEvidence& evidence, const std::vector<double>& log_odds,
                   const FacetOptions& options = {});

}  // namespace ostraka

// Classifies the surface of a fragment by its shape: outer, inner or fracture surface.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/fracture/facet_evidence.h"
#include "ostraka/fracture/fragment.h"

#include <string>
#include <vector>

namespace ostraka {

struct FacetOptions {
    double edge = 40;        ///< dihedral angle in degrees at which an edge may bound a fracture
    double wall = 0.25;      ///< max wall thickness of a shell, as a share of the square root of its area
    double coherence = 0.3;  ///< weight of the neighbours relative to the evidence of a face itself

    void describe(OptionList& visit);
};

/// A connected component of faces with the same facet.
struct FacetSegment {
    Facet facet = Facet::outer;
    std::vector<Index> faces;  ///< ascending
    double area = 0;
    double confidence = 0;  ///< 0 to 1: how well the evidence of the faces supports the label, mean over the area
};

struct Facets {
    /// Whether the object is broken: a fracture was found; there is no evidence of one; undecided (the fracture that was found
    /// may be none, or one may have been missed).
    enum class Answer { broken, whole, unclear };

    std::vector<Facet> of_face;
    std::vector<double> probability;     ///< per face, probability of being fracture, from the face's own evidence
    std::vector<FacetSegment> segments;  ///< largest first
    Answer answer = Answer::unclear;
    bool shell = false;     ///< a wall with two sides
    double thickness = 0;   ///< thickness of the wall, if there is one
    double confidence = 0;  ///< mean over the area
    std::vector<std::string> notes;
    [[nodiscard]] double area(Facet facet) const;
};

std::string to_string(Facets::Answer answer);

/// Groups the faces into at most about 24 000 patches. A model (data/facets.model.json) trained on broken objects, synthetic
/// and scanned, gives each patch its probability of being fracture. The labels minimise the data cost of the patches plus the
/// length of their boundaries, which is cheap along sharp convex edges (alpha expansion; Boykov, Veksler and Zabih 2001). If
/// most of the intact surface lies over a thin wall whose other side is intact too, it is split into an outer and an inner
/// side: the outer side faces away from the axis of rotation (axis/axis.h) or, without an axis, from the point nearest to the
/// lines along all normals. Throws Error (input) for a mesh without area.
Facets find_facets(const Mesh& mesh, const FacetOptions& options = {});

/// As above, with given log odds of each patch.
Facets find_facets(const Mesh& mesh, const FacetEvidence& evidence, const std::vector<double>& log_odds,
                   const FacetOptions& options = {});

}  // namespace ostraka

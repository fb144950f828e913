// Classifies the faces of a fragment as outer, inner or fracture surface, from the shape of the mesh alone.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/fracture/facet_evidence.h"
#include "ostraka/fracture/fragment.h"

#include <string>
#include <vector>

namespace ostraka {

/// Options of `find_facets`.
struct FacetOptions {
    /// Angle between the normals of two faces, in degrees, at which a convex edge costs 0.4 times as much as a flat place as the
    /// boundary of a fracture surface; the cost falls as exp(-(angle / crease_angle)^2).
    double crease_angle = 40;
    /// Max wall thickness of a shell, as a fraction of the square root of the fragment's area.
    double wall = 0.25;
    /// Weight of the smoothness term (neighbouring faces get equal classes) relative to the data term (features of each face).
    double coherence = 0.3;

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// A connected component of faces of the same facet class.
struct FacetSegment {
    Facet facet = Facet::outer;
    std::vector<Index> faces;  ///< indices of the faces, ascending
    double area = 0;           ///< total area of the faces
    double confidence = 0;     ///< how well the features of the faces support the class: mean over the area, 0 to 1
};

/// Facet class of each face of a mesh, and the decision whether the mesh is a fragment of a broken object.
struct Facets {
    /// Decision whether the object is broken. broken: a fracture surface was found; whole: there is no evidence of a fracture
    /// surface; unclear: the evidence for or against a fracture surface is weak.
    enum class Answer { broken, whole, unclear };

    std::vector<Facet> of_face;  ///< class of each face
    /// For each face: probability that it is fracture surface, from the features of its patch alone.
    std::vector<double> probability;
    std::vector<FacetSegment> segments;  ///< connected components of equal class, largest area first
    Answer answer = Answer::unclear;
    bool shell = false;              ///< true: the fragment is a shell, that is a wall with an outer and an inner side
    double thickness = 0;            ///< thickness of the wall, if `shell`
    double confidence = 0;           ///< mean confidence of the classes over the area, 0 to 1
    std::vector<std::string> notes;  ///< messages about the classification, for the user
    [[nodiscard]] double area(Facet facet) const;  ///< total area of a class
};

std::string to_string(Facets::Answer answer);

/// Classifies the faces of a fragment. The faces are grouped into at most about 24 000 patches. A model (data/facets.model.json)
/// trained on broken objects, synthetic and scanned, gives each patch its probability of being fracture. The classes minimise
/// the sum of the data costs of the patches and of the lengths of the boundaries between classes; the cost per length is low
/// along sharp convex edges (alpha expansion; Boykov, Veksler and Zabih 2001). If most of the intact surface lies over a thin
/// wall whose other side is intact too, the intact surface is split into an outer and an inner side: the outer side faces away
/// from the axis of rotation (axis/axis.h) or, without an axis, from the point closest to the lines along all normals. Throws
/// Error (input) for a mesh without area.
Facets find_facets(const Mesh& mesh, const FacetOptions& options = {});

/// Classifies the faces of a fragment from its patch features and given log odds of fracture surface for each patch.
Facets find_facets(const Mesh& mesh, const FacetEvidence& evidence, const std::vector<double>& log_odds,
                   const FacetOptions& options = {});

}  // namespace ostraka

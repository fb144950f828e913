// Completes an object as one closed surface, which consists of the fragments' triangles and, where no fragment is observed, of
// the fitted template.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/reconstruction/fit.h"

#include <cstdint>
#include <string>
#include <vector>

namespace ostraka {

/// Origin of a face of the completed object: a fragment, the template near an observed face, or the template elsewhere.
enum class Origin : std::uint8_t { observed, interpolated, hypothesis };
std::string to_string(Origin origin);  ///< "observed", "interpolated" or "hypothesis"

struct CompleteOptions {
    /// A fragment's vertex is used if its distance from the fitted template is at most this share of the template's diagonal.
    double tolerance = 0.02;
    double angle = 60;  ///< max angle between the normals of fragment and template at a fragment's vertex, degrees
    /// Width of the zone around the seam in which the template is deformed towards the seam, as a share of the template's
    /// diagonal.
    double blend = 0.03;
    /// The confidence of a face is halved with every such distance from the observed faces (share of the template's diagonal).
    double confidence_half_distance = 0.1;
    bool join = true;         ///< true: use the fragments' triangles where possible; false: use only the template's triangles
    double min_piece = 0.01;  ///< min area of a piece of a fragment that is used, as a share of the fragment's area

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// Reason why the triangles of a fragment could not be used.
struct CompletionNote {
    int fragment = 0;  ///< index of the fragment
    std::string text;  ///< the reason as a sentence
};

/// A completed object with the origin of its faces.
struct CompletedObject {
    Mesh mesh;  ///< closed and manifold if the template is closed and manifold
    // For each face of `mesh`:
    std::vector<Origin> origin;
    std::vector<int> fragment;  ///< index of the fragment from which the face comes; -1: from the template
    /// Index of the fragment's face from which the face comes; no_index: the face is from the template.
    std::vector<Index> fragment_face;
    /// Index of the template's face from which the face comes; no_index: the face is from a fragment.
    std::vector<Index> template_face;
    /// Distance of the face's centroid from the nearest observed face; 0 if observed, -1 if no face is observed.
    std::vector<double> distance;
    std::vector<double> confidence;     ///< 1 if observed, halved with every `confidence_half_distance` of distance
    std::vector<CompletionNote> notes;  ///< fragments whose triangles could not be used
    // For each fragment:
    std::vector<std::size_t> joined;  ///< number of faces of `mesh` that come from the fragment
    /// Share of the fragment's outer area that lies on the fitted template within the tolerance; 0 if the fragment has no outer
    /// area.
    std::vector<double> on_template;
    std::vector<double> shared;  ///< share of the fragment's outer area that an earlier fragment covers too
};

/// Joins fragments and the fitted template into one surface. Uses each fragment's faces that lie on `fitted` (all corners within
/// the tolerance, compatible normals, no fracture) and form pieces with simple borders. The border of a piece is projected onto
/// the template and inserted as edges, the template's faces to the left of the border are removed, and the seam is moved to the
/// fragment's border; the template around the seam is displaced too, by an amount that decreases with the distance from the
/// seam. Where projected borders intersect, rings of faces along the fragment's border are removed until the border is simple.
/// If this is not possible, the template's triangles replace the fragment, and a note reports it. Fragments are processed in
/// order: later fragments do not cover earlier ones. Template faces within the width of the seam zone of observed faces are
/// "interpolated". Time: linear in the number of faces, plus the nearest-point queries.
CompletedObject complete(const Mesh& fitted, const std::vector<PlacedFragment>& fragments, const CompleteOptions& options = {});

}  // namespace ostraka

// Completes the object as one closed surface: the fragments' own triangles where they exist, the fitted template elsewhere.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/reconstruction/fit.h"

#include <cstdint>
#include <string>
#include <vector>

namespace ostraka {

/// Provenance of a face of the completed object.
enum class Origin : std::uint8_t { observed, interpolated, hypothesis };
std::string to_string(Origin origin);

struct CompleteOptions {
    double tolerance = 0.02;  ///< max distance of a fragment's vertex from the fitted template, as a share of its diagonal
    double angle = 60;        ///< max angle between their normals, degrees
    double blend = 0.03;   ///< width of the zone in which the template is deformed towards the seam, as a share of the diagonal
    double halving = 0.1;  ///< distance over which confidence halves, as a share of the diagonal
    bool join = true;      ///< false: use the template's triangles everywhere
    double min_piece = 0.01;  ///< pieces below this share of the fragment's area are dropped

    void describe(OptionList& visit);
};

/// Reason why a fragment could not be joined.
struct CompletionNote {
    int fragment = 0;
    std::string text;
};

struct CompletedObject {
    Mesh mesh;  ///< closed and manifold if the template is
    // Per face:
    std::vector<Origin> origin;
    std::vector<int> fragment;         ///< index of the fragment observed here; -1: none
    std::vector<Index> fragment_face;  ///< face of that fragment that contains it; no_index: it is from the template
    std::vector<Index> template_face;  ///< face of the template that contains it; no_index: it is from a fragment
    std::vector<double> distance;  ///< distance of its centroid from the nearest observed face; 0 if observed, -1: none observed
    std::vector<double> confidence;  ///< 1 if observed, halved with every `halving` of distance
    std::vector<CompletionNote> notes;
    // Per fragment:
    std::vector<std::size_t> joined;  ///< number of its faces in the mesh
    std::vector<double> lying;        ///< share of its outer area that lies on the fitted template; 0 if it has none
    std::vector<double> shared;       ///< share of its outer area where an earlier fragment is observed
};

/// Uses each fragment's faces that lie on `fitted` (all corners within the tolerance, compatible normals, no fracture) and form
/// pieces with simple borders. Their border is projected onto the template and inserted as edges, the template's faces to its
/// left are removed, and the seam is moved to the fragment's border; the template around it follows with a displacement that
/// fades. Where projected borders cross, the fragment's faces are removed, ring by ring; if a border cannot be made simple, the
/// template's triangles represent the fragment and a note reports it. Fragments are processed in order: later ones do not cover
/// earlier ones. Faces within the width of the seam zone of observed faces are "interpolated". Linear in faces plus the
/// nearest-point queries.
CompletedObject complete(const Mesh& fitted, const std::vector<PlacedFragment>& fragments, const CompleteOptions& options = {});

}  // namespace ostraka

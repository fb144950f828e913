// The whole object as one closed surface: the fragments' own triangles where they are, the fitted template elsewhere.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/reconstruction/fit.h"

#include <cstdint>
#include <string>
#include <vector>

namespace ostraka {

/// Whether a face of the completed object was seen.
enum class Origin : std::uint8_t { observed, interpolated, hypothesis };
std::string to_string(Origin origin);

struct CompleteOptions {
    double tolerance = 0.02;  ///< farthest that a fragment's vertex lies from the fitted template, as a share of its diagonal
    double angle = 60;        ///< and how far their normals differ, degrees
    double blend = 0.03;      ///< width over which the template gives way to the seam, as a share of the diagonal
    double halving = 0.1;     ///< length over which confidence halves, as a share of the diagonal
    bool join = true;         ///< false: the template's own triangles everywhere
    double min_piece = 0.01;  ///< pieces below this share of the fragment's area are left out

    void describe(OptionList& visit);
};

/// Why a fragment could not be joined.
struct CompletionNote {
    int fragment = 0;
    std::string text;
};

struct CompletedObject {
    Mesh mesh;  ///< closed and manifold if the template is
    // Of each face:
    std::vector<Origin> origin;
    std::vector<int> fragment;         ///< that was observed here; -1: none
    std::vector<Index> fragment_face;  ///< of that fragment, which the face is or is cut from; no_index: it is the template's
    std::vector<Index> template_face;  ///< that the face is or is cut from; no_index: it is a fragment's
    std::vector<double> distance;      ///< of its centre from the nearest observed face; 0 where observed, -1 where nothing was
    std::vector<double> confidence;    ///< 1 where observed, halved with every `halving` of distance
    std::vector<CompletionNote> notes;
    // Of each fragment:
    std::vector<std::size_t> joined;  ///< its faces that are in the mesh
    std::vector<double> lying;        ///< share of its outer area that lies on the fitted template; 0 of none
    std::vector<double> shared;       ///< share of its outer area that lies where a fragment before it is seen
};

/// Each fragment's faces that lie on `fitted` (all corners within the tolerance, normals agree, no fracture) and form pieces with
/// simple borders replace what they cover: their border is projected onto the template and inserted as edges, the template's
/// faces to its left go, and the seam takes the places of the fragment's border, which the template around follows with a
/// displacement that fades. Where borders cross each other once projected the fragment's faces there are taken away, ring by
/// ring; where the border of a fragment does not come out simple the template's own triangles show it, and that is said.
/// Fragments come in their order: what one has taken the next does not cover. Interpolated is what lies within the seam's width
/// of what was observed. Linear in faces plus the queries for the nearest point.
CompletedObject complete(const Mesh& fitted, const std::vector<PlacedFragment>& fragments, const CompleteOptions& options = {});

}  // namespace ostraka

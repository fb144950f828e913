// Correspondence between the vertices of a template's part and of a fragment's part (thesis, section 5.3.1, equation 5.1, with
// its errata).
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/core/options.h"

#include <utility>
#include <vector>

namespace ostraka {

struct VertexAssignmentOptions {
    enum class Counterpart { best, one_to_one };
    /// best: each template vertex gets the counterpart of lowest cost; one_to_one: each fragment vertex is used at most once.
    Counterpart counterpart = Counterpart::best;
    double boundary = 1;       ///< weight of the cost of matching a vertex on an outline with an interior vertex
    double distance = 1;       ///< weight of the distance between counterparts
    double outline = 1;        ///< weight of the difference of positions along the outline
    double search_radius = 0;  ///< max distance of a counterpart, in the meshes' unit; 0: unlimited
    double angle = 180;        ///< max angle between the normals of counterparts, degrees
    int candidates = 12;       ///< one-to-one: number of candidate counterparts for each vertex
    /// One-to-one: cost of leaving a vertex without a counterpart, as a share of the sum of the weights.
    double unassigned = 1;

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// Counterparts of the vertices of a template's part.
struct VertexAssignment {
    std::vector<Index> vertices;     ///< indices of the vertices of the template's part, ascending
    std::vector<Index> counterpart;  ///< for each of `vertices`, index of its counterpart on the fragment; no_index: none
    std::vector<double> cost;        ///< for each of `vertices`, cost of its counterpart; infinite without a counterpart
    double total = 0;                ///< sum of the costs of vertices with a counterpart
};

/// Assigns vertices of a fragment's part to vertices of a template's part; the fragment is in the template's frame. `landmarks`:
/// pairs of vertices (template, fragment). A pair of vertices has three costs, each normalised to 0 to 1 over all pairs. C is
/// the distance of the two vertices. B is 1 if exactly one of the two vertices is on an outline, otherwise 0; all vertices of
/// line and point annotations count as on an outline. D compares positions along the outline: the distance from the vertex to a
/// landmark, counter-clockwise along the outline (the landmark is moved to the nearest vertex of the outline), is computed on
/// both meshes, and the differences are added over the landmarks. A landmark is used only if both distances are defined: vertex
/// and landmark lie on the same loop, and the path does not leave the fragment. D is 0 unless both vertices are on an outline.
/// "best" finds for each vertex the exact minimum of boundary B + distance C + outline D, as in equation 5.1 (ties: the lower
/// vertex). The matrix of the equation is not computed: interior vertices are compared by search trees in O(n log n), and only
/// outline vertices are compared pair by pair. "one-to-one" solves an assignment problem (minimum cost flow) over the
/// `candidates` counterparts of lowest cost for each vertex. Pairs beyond `search_radius` or `angle` are rejected. Throws Error
/// (input) for parts without vertices or landmarks out of range.
VertexAssignment assign_vertices(const Mesh& mesh, const Annotation& part, const Mesh& fragment, const Annotation& of_fragment,
                                 const std::vector<std::pair<Index, Index>>& landmarks = {},
                                 const VertexAssignmentOptions& options = {});

}  // namespace ostraka

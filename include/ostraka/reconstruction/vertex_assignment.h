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
    Counterpart counterpart =
        /// Best: the counterpart of least cost for each template vertex; one-to-one: each fragment vertex is used at most once.
        Counterpart::best;
    double boundary = 1;       ///< weight of the cost of matching a vertex on an outline with an interior vertex
    double distance = 1;       ///< weight of the distance between counterparts
    double outline = 1;        ///< weight of the difference of positions along the outline
    double search_radius = 0;  ///< max distance of a counterpart, in the meshes' unit; 0: unlimited
    double angle = 180;        ///< max angle between the normals of counterparts, degrees
    int candidates = 12;       ///< one-to-one: number of candidate counterparts for each vertex
    double unassigned = 1;     ///< one-to-one: cost of a vertex without a counterpart, as a share of the sum of the weights

    void list_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// Counterparts of the vertices of a template's part.
struct VertexAssignment {
    std::vector<Index> vertices;     ///< indices of the vertices of the template's part, ascending
    std::vector<Index> counterpart;  ///< for each of `vertices`, index of its counterpart on the fragment; no_index: none
    std::vector<double> cost;        ///< for each of `vertices`, cost of its counterpart; infinite without a counterpart
    double total = 0;                ///< sum of the costs of vertices with a counterpart
};

/// Assigns vertices of a fragment's part to vertices of a template's part; the fragment is in the template's frame. `landmarks`:
/// pairs of vertices (template, fragment). The costs of a pair of vertices, each normalised to 0 to 1 over all pairs: C, the
/// distance of the two vertices; B, whether one vertex is on an outline (every vertex of a line or point annotation is) and the
/// other is not; D, the sum over the landmarks of the differences of the distances along the outline, counter-clockwise, from
/// vertex to landmark (taken at the outline's nearest vertex), where both distances are defined: on the same loop, and not beyond
/// the fragment's end. D is 0 unless both vertices are on an outline. "best" is the exact minimum of boundary B + distance C +
/// outline D for each vertex, as in equation 5.1 (ties: the lower vertex), without the matrix of the equation: interior vertices
/// by search trees, O(n log n), and outline against outline in full. "one-to-one" solves an assignment over the candidates of
/// least cost for each vertex (minimum cost flow). `search_radius` and `angle` reject pairs. Throws Error (input) for parts
/// without vertices or landmarks out of range.
VertexAssignment assign_vertices(const Mesh& mesh, const Annotation& part, const Mesh& fragment, const Annotation& of_fragment,
                                 const std::vector<std::pair<Index, Index>>& landmarks = {},
                                 const VertexAssignmentOptions& options = {});

}  // namespace ostraka

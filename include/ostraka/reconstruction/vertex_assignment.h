// Vertex correspondence of a fragment's part and the template's part (thesis, section 5.3.1, equation 5.1, with its errata).
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/core/options.h"

#include <utility>
#include <vector>

namespace ostraka {

struct VertexAssignmentOptions {
    enum class Counterpart { best, one_to_one };
    Counterpart counterpart =
        Counterpart::best;     ///< best for each template vertex; one to one: each fragment vertex at most once
    double boundary = 1;       ///< weight of the cost of matching outline vertices with interior ones
    double distance = 1;       ///< weight of the distance
    double outline = 1;        ///< weight of the positions along the outline
    double search_radius = 0;  ///< max distance of a counterpart, in the meshes' unit; 0: unlimited
    double angle = 180;        ///< max angle between the normals of counterparts, degrees
    int candidates = 12;       ///< one-to-one: number of candidates per vertex
    double unassigned = 1;     ///< one-to-one: cost of a vertex without a counterpart, as a share of the weights' sum

    void describe(OptionList& visit);
};

struct VertexAssignment {
    std::vector<Index> vertices;     ///< vertices of the template's part, ascending
    std::vector<Index> counterpart;  ///< per vertex, on the fragment; no_index: none
    std::vector<double> cost;        ///< per vertex; infinite without counterpart
    double total = 0;                ///< sum over the vertices with a counterpart
};

/// A part of the template and its counterpart on a fragment in the template's frame, with pairs of landmarks (vertex of the
/// template, vertex of the fragment). The costs of a pair of vertices, each normalised to 0 to 1 over all pairs: C, their
/// distance; B, whether one is on an outline (every vertex of a line or point annotation is) and the other is not; D, the sum
/// over the landmarks of the differences of the distances along the outline, counter-clockwise, from vertex to landmark (taken
/// at the outline's nearest vertex), where both are defined: on the same loop, and not beyond the fragment's end. D is 0 unless
/// both are on an outline. "best" is the exact minimum of boundary B + distance C + outline D for each vertex, as in equation
/// 5.1 (ties: the lower vertex), without its matrix: interior vertices by search trees, O(n log n), and outline against outline
/// in full. "one-to-one" solves an assignment over the best candidates of each vertex (minimum cost flow). `search_radius` and
/// `angle` reject pairs. Throws Error (input) for parts without vertices or landmarks out of range.
VertexAssignment assign_vertices(const Mesh& mesh, const Annotation& part, const Mesh& fragment, const Annotation& of_fragment,
                                 const std::vector<std::pair<Index, Index>>& landmarks = {},
                                 const VertexAssignmentOptions& options = {});

}  // namespace ostraka

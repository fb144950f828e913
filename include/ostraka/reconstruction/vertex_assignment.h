// Which vertex of a fragment's part is which of the template's part (thesis, section 5.3.1, equation 5.1, with its errata).
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/core/options.h"

#include <utility>
#include <vector>

namespace ostraka {

struct VertexAssignmentOptions {
    enum class Counterpart { best, one_to_one };
    Counterpart counterpart =
        Counterpart::best;     ///< each template vertex its best one; one to one: each fragment vertex once at most
    double boundary = 1;       ///< weight of the cost of vertices on an outline against vertices inside
    double distance = 1;       ///< weight of the distance
    double outline = 1;        ///< weight of the positions along the outline
    double search_radius = 0;  ///< farthest counterpart, in the meshes' unit; 0: any
    double angle = 180;        ///< of the normals of counterparts, degrees
    int candidates = 12;       ///< one-to-one: counterparts tried for each vertex
    double unassigned = 1;     ///< one-to-one: cost of a vertex without one, as a share of the weights' sum

    void describe(OptionList& visit);
};

struct VertexAssignment {
    std::vector<Index> vertices;     ///< of the template's part, ascending
    std::vector<Index> counterpart;  ///< of each on the fragment; no_index: none
    std::vector<double> cost;        ///< of each; infinite without counterpart
    double total = 0;                ///< of those with one
};

/// A part of the template and its counterpart on a fragment that lies where the template is, with pairs of landmarks (vertex of
/// the template, vertex of the fragment). The costs of a pair of vertices, each from 0 to 1 over all pairs: C, their distance; B,
/// whether one is on an outline (every vertex of a line or point annotation is) and the other is not; D, the sum over the
/// landmarks of the differences of the distances along the outline, counter-clockwise, from vertex to landmark (taken at the
/// outline's nearest vertex), where both have one: on the same loop, and not beyond where a fragment ends. D is 0 unless both are
/// on an outline. "best" is the exact minimum of boundary B + distance C + outline D for each vertex, as equation 5.1 states it
/// (ties: the lower vertex), without its matrix: inside by search trees, O(n log n), and outline against outline in full.
/// "one-to-one" assigns over the best candidates of each vertex (least cost flow). `search_radius` and `angle` reject. Throws
/// Error (input) for parts without vertices or landmarks out of range.
VertexAssignment assign_vertices(const Mesh& mesh, const Annotation& part, const Mesh& fragment, const Annotation& of_fragment,
                                 const std::vector<std::pair<Index, Index>>& landmarks = {},
                                 const VertexAssignmentOptions& options = {});

}  // namespace ostraka

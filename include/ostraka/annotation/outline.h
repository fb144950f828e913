// Outlines of regions: extraction (thesis, Algorithm 4, with its erratum) and filling (section 2.4.1).
#pragma once

#include "ostraka/core/mesh.h"

#include <optional>
#include <vector>

namespace ostraka {

/// A closed path of vertices, the first not repeated; the interior lies to the left of each edge.
using Outline = std::vector<Index>;

/// The outlines of a set of faces, given as one flag per face. Where an outline touches itself at a vertex it turns so
/// that the interior stays on the left and the loops stay apart (each fan of selected faces around a vertex gives one
/// passage). Border edges of an open mesh belong to the outline. Loops start at their smallest vertex and come in the
/// order of their first halfedge. Linear in the number of selected faces, except for one pass over the flags.
std::vector<Outline> extract_outlines(const Mesh& mesh, const std::vector<bool>& selected);
std::vector<Outline> extract_outlines(const Mesh& mesh, const std::vector<Index>& faces);

/// What the interior of a set of outlines is.
struct Filling {
    std::vector<bool> selected;  ///< one flag per face
    std::size_t conflicts = 0;   ///< faces claimed from the left and from the right: the outlines cross
};

/// Grows the region from the faces on the left of the outlines' edges, without crossing an outline edge. Edges that
/// outlines run through in both directions bound nothing and are ignored. Throws Error (input) naming the outline and the
/// edge if an index is out of range, an edge does not exist or an outline has fewer than three vertices.
Filling fill_outlines(const Mesh& mesh, const std::vector<Outline>& outlines);

/// The same for directed edges that need not close: they may end on the border of the mesh.
Filling fill_edges(const Mesh& mesh, const std::vector<Halfedge>& edges);

/// The faces by winding number: crossing an edge from right to left adds the net number of times that `edges` run through it.
/// Where outlines cross each other this still has an answer: of the sets "winding number at least k", the empty one included,
/// that whose area is nearest to `expected_area`. Returns nothing if the numbers contradict each other (the edges do not
/// bound). Linear in the mesh.
std::optional<std::vector<bool>> fill_by_winding(const Mesh& mesh, const std::vector<Halfedge>& edges, double expected_area);

/// Measures of a region.
struct RegionMeasures {
    double area = 0;       ///< sum of the faces' areas
    double perimeter = 0;  ///< sum of the lengths of the outline edges
    [[nodiscard]] double circularity() const {
        return area > 0 ? perimeter * perimeter / area : 0;
    }  ///< P^2 / A, 4 pi for a disc
};
RegionMeasures measure_region(const Mesh& mesh, const std::vector<Index>& faces);

}  // namespace ostraka

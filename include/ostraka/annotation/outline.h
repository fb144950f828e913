// Outlines of regions: extraction (thesis, Algorithm 4, with its erratum) and filling (section 2.4.1).
#pragma once

#include "ostraka/mesh/mesh.h"

#include <optional>
#include <vector>

namespace ostraka {

/// A closed path of vertices that does not repeat its first vertex; the interior of the region lies to the left of each edge.
using Outline = std::vector<Index>;

/// The outlines of a set of faces, given as one flag per face. An outline that touches itself at a vertex is split there into
/// separate loops with the interior on the left (each loop passes one fan of selected faces around the vertex). Border edges of
/// an open mesh belong to the outline. Loops start at their smallest vertex and are ordered by their first halfedge. Time:
/// linear in the number of selected faces, except for one pass over the flags.
std::vector<Outline> extract_outlines(const Mesh& mesh, const std::vector<bool>& selected);
/// The outlines of a set of faces, given by their indices.
std::vector<Outline> extract_outlines(const Mesh& mesh, const std::vector<Index>& faces);

/// A path of vertices along an outline: the whole outline, or a stretch between two vertices on the border of the mesh.
struct OutlinePath {
    std::vector<Index> vertices;  ///< along the path, in order
    bool closed = false;          ///< true: the whole outline, without repeating its first vertex
};
/// The outlines of a set of faces, without their edges on the border of the mesh; where such edges are left out, an outline is
/// split into open paths.
std::vector<OutlinePath> outline_paths(const Mesh& mesh, const std::vector<Index>& faces);

/// Removes from a walk over vertices immediate repeats ("a, a") and spikes ("a, b, a"); if the walk is `closed`, also across its
/// end. A closed walk of fewer than three vertices becomes empty.
std::vector<Index> prune_spikes(const std::vector<Index>& walk, bool closed);

/// The faces inside a set of outlines.
struct Filling {
    std::vector<bool> selected;  ///< one flag per face: true if the face is inside
    /// Number of faces that lie to the left of one outline edge and to the right of another one. The number is above 0 if
    /// outlines intersect.
    std::size_t conflicts = 0;
};

/// Selects the faces inside the outlines by growing from the faces left of outline edges, without crossing an outline edge. Edges
/// that are traversed in both directions are not boundaries and are ignored. Throws Error (input) with the outline and the edge
/// if an index is out of range, an edge does not exist or an outline has fewer than three vertices.
Filling fill_outlines(const Mesh& mesh, const std::vector<Outline>& outlines);

/// Selects the faces inside directed edges like `fill_outlines`, but the paths that the edges form may also start and end on the
/// border of the mesh.
Filling fill_edges(const Mesh& mesh, const std::vector<Halfedge>& edges);

/// Selects faces by winding number: crossing an edge from right to left adds the net number of its traversals in `edges`. The
/// result is defined for intersecting outlines too. In each connected component, the candidates are the empty set and, for each
/// k, the set of faces with winding number at least k; the candidate whose area is closest to `expected_area` is selected.
/// Returns nullopt if the winding numbers contradict each other (the edges are not a boundary). Time: linear in the size of the
/// mesh.
std::optional<std::vector<bool>> fill_by_winding(const Mesh& mesh, const std::vector<Halfedge>& edges, double expected_area);

/// Area and perimeter of a region.
struct RegionMeasures {
    double area = 0;       ///< sum of the faces' areas
    double perimeter = 0;  ///< sum of the lengths of the outline edges
    /// perimeter^2 / area: 4 pi for a disc; 0 if the area is 0.
    [[nodiscard]] double circularity() const { return area > 0 ? perimeter * perimeter / area : 0; }
};
/// Area and perimeter of a set of faces.
RegionMeasures measure_region(const Mesh& mesh, const std::vector<Index>& faces);

}  // namespace ostraka

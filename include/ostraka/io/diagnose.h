// Diagnosis of a triangle soup: topology, size, self-intersections.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/geom/oriented_box.h"
#include "ostraka/mesh/mesh.h"

#include <string>
#include <utility>
#include <vector>

namespace ostraka {

struct DiagnoseOptions {
    bool skip_self_intersections = false;  ///< skip the most expensive check; the verdict then ignores self-intersections
    void describe(OptionList& visit);
};

struct BorderLoop {
    std::size_t edges = 0;
    double length = 0;
};

/// Triangles connected through shared vertices.
struct ComponentDiagnosis {
    Index first_vertex = no_index;  ///< its lowest vertex index
    std::size_t vertices = 0, edges = 0, triangles = 0;
    std::size_t border_edges = 0, nonmanifold_edges = 0, misoriented_edges = 0, nonmanifold_vertices = 0;
    bool orientable = true;
    double area = 0;
    double volume = 0;        ///< signed; for an open component, relative to the centre of the object's bounding box
    bool inside_out = false;  ///< closed, volume negative, and not a cavity
    bool cavity = false;      ///< closed, volume negative, and completely inside another closed component
    [[nodiscard]] long long euler() const { return static_cast<long long>(vertices + triangles) - static_cast<long long>(edges); }
    [[nodiscard]] bool manifold() const { return nonmanifold_edges + nonmanifold_vertices == 0; }
    [[nodiscard]] bool closed() const { return border_edges == 0 && nonmanifold_edges == 0; }
    /// Number of handles; -1 unless closed, manifold and orientable.
    [[nodiscard]] long long genus() const { return closed() && manifold() && orientable ? (2 - euler()) / 2 : -1; }
};

/// A guess based on the size only.
struct UnitGuess {
    std::string unit;  ///< "m", "mm", "um" or "unknown"
    std::string reason;
};

struct MeshDiagnosis {
    std::size_t vertices = 0, triangles = 0, edges = 0;
    // Defects of elements. Triangles with a repeated corner are ignored in all other counts.
    std::size_t isolated_vertices = 0;
    std::size_t duplicate_vertices = 0;    ///< vertices at exactly the position of a vertex of lower index
    std::size_t repeated_corners = 0;      ///< triangles with a repeated vertex
    std::size_t degenerate_triangles = 0;  ///< other triangles with exactly collinear corners
    std::size_t thin_triangles = 0;        ///< not degenerate, but with a height below 1e-9 of the box diagonal
    std::size_t duplicate_triangles = 0;   ///< triangles with the same three vertices as one of lower index
    // Topology.
    std::size_t border_edges = 0;                ///< edges with one triangle
    std::size_t nonmanifold_edges = 0;           ///< edges with more than two triangles
    std::size_t misoriented_edges = 0;           ///< edges that two triangles traverse in the same direction
    std::size_t nonmanifold_vertices = 0;        ///< vertices whose triangles form more than one fan
    std::vector<BorderLoop> border_loops;        ///< longest first
    std::vector<ComponentDiagnosis> components;  ///< sorted by lowest vertex
    std::size_t inside_out_components = 0, nonorientable_components = 0, cavities = 0;
    // Self-intersections: pairs of triangles that coincide or whose intersection exceeds their common vertices and edges.
    // Degenerate triangles are ignored.
    bool self_intersections_checked = false;
    bool self_intersections_complete = false;  ///< false: the search was stopped early; the number is a lower bound
    std::size_t self_intersections = 0;
    std::vector<std::pair<Index, Index>> self_intersection_examples;  ///< the first few pairs, by triangle
    // Size, in the unit of the file.
    double area = 0;
    double volume = 0;  ///< signed sum over the triangles; the volume of the solid only if the mesh is closed and oriented
    double shortest_edge = 0, mean_edge = 0, longest_edge = 0;
    CGAL::Bbox_3 box;
    double diagonal = 0;  ///< diagonal of the bounding box of the vertices with triangles
    OrientedBox oriented_box;
    UnitGuess unit;
    std::vector<std::pair<std::string, double>> seconds;  ///< wall time per step; differs from run to run

    [[nodiscard]] long long euler() const;
    [[nodiscard]] bool closed() const { return triangles > 0 && border_edges == 0 && nonmanifold_edges == 0; }
    [[nodiscard]] bool manifold() const { return nonmanifold_edges + nonmanifold_vertices == 0; }
    [[nodiscard]] bool oriented() const { return misoriented_edges == 0 && nonorientable_components == 0; }
    /// Reasons why it is not a closed, outward oriented, manifold mesh without degenerate triangles and self-intersections (the
    /// latter if checked), as text; empty if there are none.
    [[nodiscard]] std::vector<std::string> defects() const;
};

/// Diagnoses any soup, without assumptions about its topology. O(n log n) in the number of triangles, except for the pairs of
/// triangles with overlapping boxes, whose number is capped. Throws Error (input) for indices out of range and for coordinates
/// that are not finite or beyond 1e100.
MeshDiagnosis diagnose(const TriangleSoup& soup, const DiagnoseOptions& options = {});

/// Estimated width of cracks in a surface torn along its edges. A border point has a mate if another border point is closer
/// than half of its shortest edge. The width is four times the distance within which nine in ten of these points have their
/// mate; 0 if fewer than nine in ten border points have a mate. O(n log n).
double crack_width(const TriangleSoup& soup);

struct SelfIntersections {
    std::vector<std::pair<Index, Index>> pairs;  ///< lower triangle first, sorted
    bool complete = true;                        ///< false: the search was stopped early
};

/// Pairs of triangles whose intersection exceeds their common vertices and edges; vertices with equal positions count as
/// common. Exact. Degenerate triangles are ignored. `limit` bounds the number of pairs; the work is bounded as well. The result
/// does not depend on the number of threads.
SelfIntersections self_intersections(const TriangleSoup& soup, std::size_t limit = 10'000'000);

}  // namespace ostraka

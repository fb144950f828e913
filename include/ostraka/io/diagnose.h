// Diagnosis of a triangle soup: topology, sizes, self-intersections.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/geom/oriented_box.h"
#include "ostraka/io/bodies.h"
#include "ostraka/mesh/mesh.h"

#include <string>
#include <utility>
#include <vector>

namespace ostraka {

/// Options of `diagnose`.
struct DiagnoseOptions {
    /// True: do not search for self-intersections, which is the most expensive check; the list of defects then does not include
    /// them.
    bool skip_self_intersections = false;
    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// A closed path of border edges.
struct BorderLoop {
    std::size_t edges = 0;  ///< number of edges
    double length = 0;      ///< total length of the edges
};

/// Diagnosis of one connected component: triangles connected through shared vertices.
struct ComponentDiagnosis {
    Index first_vertex = no_index;                       ///< smallest vertex index of the component
    std::size_t vertices = 0, edges = 0, triangles = 0;  ///< number of vertices, edges and triangles
    /// Number of defective elements of each kind (as in MeshDiagnosis).
    std::size_t border_edges = 0, nonmanifold_edges = 0, misoriented_edges = 0, nonmanifold_vertices = 0;
    bool orientable = true;  ///< true: the triangles can be oriented consistently
    double area = 0;         ///< area of the component
    /// Signed volume; for an open component, the signed volume of the cone from the centre of the object's bounding box over
    /// the component.
    double volume = 0;
    bool inside_out = false;     ///< true: closed, with negative volume, and not a cavity
    bool cavity = false;         ///< true: closed, with negative volume, and inside an odd number of other closed components
    bool turned_cavity = false;  ///< true: closed, with positive volume, and inside an odd number of other closed components
    /// Euler characteristic.
    [[nodiscard]] long long euler() const { return static_cast<long long>(vertices + triangles) - static_cast<long long>(edges); }
    /// True: no non-manifold edges or vertices.
    [[nodiscard]] bool manifold() const { return nonmanifold_edges + nonmanifold_vertices == 0; }
    /// True: each edge has two triangles.
    [[nodiscard]] bool closed() const { return border_edges == 0 && nonmanifold_edges == 0; }
    /// Number of handles; -1 unless the component is closed, manifold and orientable.
    [[nodiscard]] long long genus() const { return closed() && manifold() && orientable ? (2 - euler()) / 2 : -1; }
};

/// A guess of the unit of length, based only on the size of the object.
struct UnitGuess {
    std::string unit;    ///< "m", "mm", "um" or "unknown"
    std::string reason;  ///< reason for the guess, in words
};

/// Diagnosis of a whole triangle soup.
struct MeshDiagnosis {
    std::size_t vertices = 0, triangles = 0, edges = 0;
    // Defects of elements. Triangles with a repeated corner are ignored in all other counts.
    std::size_t isolated_vertices = 0;     ///< number of vertices without triangles
    std::size_t duplicate_vertices = 0;    ///< number of vertices at exactly the position of a vertex of lower index
    std::size_t repeated_corners = 0;      ///< number of triangles with a repeated vertex
    std::size_t degenerate_triangles = 0;  ///< number of other triangles with exactly collinear corners
    /// Number of triangles that are not degenerate, but whose height is below 1e-9 of the bounding box's diagonal.
    std::size_t thin_triangles = 0;
    /// Number of triangles with the same three vertices as a triangle of lower index.
    std::size_t duplicate_triangles = 0;
    // Topology.
    std::size_t border_edges = 0;                ///< number of edges with one triangle
    std::size_t nonmanifold_edges = 0;           ///< number of edges with more than two triangles
    std::size_t misoriented_edges = 0;           ///< number of edges that two triangles traverse in the same direction
    std::size_t nonmanifold_vertices = 0;        ///< number of vertices whose triangles form more than one fan
    std::vector<BorderLoop> border_loops;        ///< closed paths of border edges, longest first
    std::vector<ComponentDiagnosis> components;  ///< connected components, sorted by smallest vertex index
    /// Number of components of each kind.
    std::size_t inside_out_components = 0, nonorientable_components = 0, cavities = 0, turned_cavities = 0;
    // Self-intersections: pairs of triangles that coincide, or that intersect outside their common vertices and edges.
    // Degenerate triangles are ignored.
    bool self_intersections_checked = false;  ///< true: self-intersections were searched
    /// False: the search was stopped early, and `self_intersections` is a lower bound.
    bool self_intersections_complete = false;
    std::size_t self_intersections = 0;  ///< number of intersecting pairs of triangles
    /// The first few intersecting pairs of triangles, by index.
    std::vector<std::pair<Index, Index>> self_intersection_examples;
    // Size, in the unit of the file.
    double area = 0;
    /// Signed sum over the triangles; equal to the volume of the solid only if the mesh is closed and oriented outwards, with
    /// cavities oriented inwards, and no bodies overlap.
    double volume = 0;
    /// The closed components as one solid, with the volume of the solid; without centroid if there is one component only.
    SolidBodies solid;
    double shortest_edge = 0, mean_edge = 0, longest_edge = 0;  ///< lengths of edges
    CGAL::Bbox_3 box;
    double diagonal = 0;  ///< diagonal of the bounding box of the vertices with triangles
    OrientedBox oriented_box;
    UnitGuess unit;
    /// Name and wall time in seconds of each step; the times differ from run to run.
    std::vector<std::pair<std::string, double>> seconds;

    [[nodiscard]] long long euler() const;  ///< Euler characteristic
    [[nodiscard]] bool closed() const { return triangles > 0 && border_edges == 0 && nonmanifold_edges == 0; }
    /// True: no non-manifold edges or vertices.
    [[nodiscard]] bool manifold() const { return nonmanifold_edges + nonmanifold_vertices == 0; }
    /// True: all triangles are oriented consistently.
    [[nodiscard]] bool oriented() const { return misoriented_edges == 0 && nonorientable_components == 0; }
    /// The defects as text. The list is empty if the soup is a closed, outward oriented, manifold mesh without degenerate
    /// triangles and, if this was checked, without self-intersections.
    [[nodiscard]] std::vector<std::string> defects() const;
};

/// Diagnoses any triangle soup, without assumptions about its topology. Time: O(n log n) in the number of triangles, plus the
/// number of pairs of triangles with overlapping boxes, which is capped. Throws Error (input) for indices out of range and for
/// coordinates that are not finite or beyond 1e100.
MeshDiagnosis diagnose(const TriangleSoup& soup, const DiagnoseOptions& options = {});

/// Estimated width of the cracks in a surface whose faces are disconnected along edges. A border point has a mate if another
/// border point is closer than half of the shortest edge at the point. The width is four times the 90 % quantile of the
/// distances between mates; 0 if fewer than 90 % of the border points have a mate. Time: O(n log n).
double crack_width(const TriangleSoup& soup);

/// Result of `self_intersections`.
struct SelfIntersections {
    /// Indices of intersecting triangles, smaller index first; sorted.
    std::vector<std::pair<Index, Index>> pairs;
    bool complete = true;  ///< false: the search was stopped early, and pairs may be missing
};

/// Finds pairs of triangles that intersect outside their common vertices and edges; vertices with equal positions count as
/// common. The test is exact. Degenerate triangles are ignored. `limit`: max number of pairs; the running time is limited too.
/// The result does not depend on the number of threads.
SelfIntersections self_intersections(const TriangleSoup& soup, std::size_t limit = 10'000'000);

}  // namespace ostraka

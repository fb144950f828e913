// What a triangle soup is and what is wrong with it: topology, size, self-intersections.
#pragma once

#include "ostraka/core/mesh.h"
#include "ostraka/core/options.h"
#include "ostraka/geom/oriented_box.h"

#include <string>
#include <utility>
#include <vector>

namespace ostraka {

struct DiagnoseOptions {
    bool skip_self_intersections = false;  ///< leave out the most expensive check; the verdict is then without it
    void describe(OptionList& visit);
};

struct BorderLoop {
    std::size_t edges = 0;
    double length = 0;
};

/// Triangles connected through shared vertices.
struct ComponentDiagnosis {
    Index first_vertex = no_index;  ///< its lowest vertex
    std::size_t vertices = 0, edges = 0, triangles = 0;
    std::size_t border_edges = 0, nonmanifold_edges = 0, misoriented_edges = 0, nonmanifold_vertices = 0;
    bool orientable = true;
    double area = 0;
    double volume = 0;        ///< signed; of an open component, relative to the centre of the object's box
    bool inside_out = false;  ///< closed, volume negative, and not a cavity
    bool cavity = false;      ///< closed, volume negative, and wholly inside another closed component
    [[nodiscard]] long long euler() const { return static_cast<long long>(vertices + triangles) - static_cast<long long>(edges); }
    [[nodiscard]] bool manifold() const { return nonmanifold_edges + nonmanifold_vertices == 0; }
    [[nodiscard]] bool closed() const { return border_edges == 0 && nonmanifold_edges == 0; }
    /// Number of handles; -1 unless closed, manifold and orientable.
    [[nodiscard]] long long genus() const { return closed() && manifold() && orientable ? (2 - euler()) / 2 : -1; }
};

/// A guess from the size alone.
struct UnitGuess {
    std::string unit;  ///< "m", "mm", "um" or "unknown"
    std::string reason;
};

struct MeshDiagnosis {
    std::size_t vertices = 0, triangles = 0, edges = 0;
    // Defects of elements. Triangles that repeat a corner take no part in anything below.
    std::size_t isolated_vertices = 0;
    std::size_t duplicate_vertices = 0;    ///< vertices at exactly the place of a vertex of lower index
    std::size_t repeated_corners = 0;      ///< triangles that name a vertex twice
    std::size_t degenerate_triangles = 0;  ///< other triangles with exactly collinear corners
    std::size_t thin_triangles = 0;        ///< not degenerate, but lower than 1e-9 of the box diagonal
    std::size_t duplicate_triangles = 0;   ///< triangles on the same three vertices as one of lower index
    // Topology.
    std::size_t border_edges = 0;                ///< edges of one triangle
    std::size_t nonmanifold_edges = 0;           ///< edges of more than two
    std::size_t misoriented_edges = 0;           ///< edges of two triangles that run through it in the same direction
    std::size_t nonmanifold_vertices = 0;        ///< vertices whose triangles form more than one fan
    std::vector<BorderLoop> border_loops;        ///< the longest first
    std::vector<ComponentDiagnosis> components;  ///< by their lowest vertex
    std::size_t inside_out_components = 0, nonorientable_components = 0, cavities = 0;
    // Self-intersections: pairs of triangles that share more than the vertices and edges at which they are joined or
    // coincide. Degenerate triangles are left out.
    bool self_intersections_checked = false;
    bool self_intersections_complete = false;  ///< false: the search was given up, there are at least as many
    std::size_t self_intersections = 0;
    std::vector<std::pair<Index, Index>> self_intersection_examples;  ///< the first few, by triangle
    // Size, in the unit of the file.
    double area = 0;
    double volume = 0;  ///< signed sum over the triangles; the volume of the solid only if the mesh is closed and oriented
    double shortest_edge = 0, mean_edge = 0, longest_edge = 0;
    CGAL::Bbox_3 box;
    double diagonal = 0;  ///< of the box of the vertices that have a triangle
    OrientedBox oriented_box;
    UnitGuess unit;
    std::vector<std::pair<std::string, double>> seconds;  ///< wall time of each part; differs from run to run

    [[nodiscard]] long long euler() const;
    [[nodiscard]] bool closed() const { return triangles > 0 && border_edges == 0 && nonmanifold_edges == 0; }
    [[nodiscard]] bool manifold() const { return nonmanifold_edges + nonmanifold_vertices == 0; }
    [[nodiscard]] bool oriented() const { return misoriented_edges == 0 && nonorientable_components == 0; }
    /// What keeps it from being a closed, outward oriented, manifold mesh without degenerate triangles and
    /// self-intersections (the latter as far as checked), in words; empty if nothing does.
    [[nodiscard]] std::vector<std::string> defects() const;
};

/// Examines any soup: nothing is promised of its topology. Time O(n log n) in the number of triangles but for the pairs of
/// overlapping triangles, whose number is capped. Throws Error (input) for indices out of range and coordinates that are
/// not finite or beyond 1e100.
MeshDiagnosis diagnose(const TriangleSoup& soup, const DiagnoseOptions& options = {});

/// How wide cracks are where a surface is torn along its edges: four times the distance within which nine in ten points of its
/// border, of those that have another one nearer than half of their shortest edge, have that one. 0 where fewer than nine in ten
/// of the border do. O(n log n).
double crack_width(const TriangleSoup& soup);

struct SelfIntersections {
    std::vector<std::pair<Index, Index>> pairs;  ///< lower triangle first, sorted
    bool complete = true;                        ///< false: the search was given up
};

/// Pairs of triangles that share more than the vertices and edges at which they are joined; vertices at the same place
/// count as joined. Exact. Triangles without area are left out. `limit` bounds the number of pairs, the work is bounded as
/// well; what is found does not depend on the number of threads.
SelfIntersections self_intersections(const TriangleSoup& soup, std::size_t limit = 10'000'000);

}  // namespace ostraka

// From any triangle soup to an oriented manifold mesh, step by step, with maps from old elements to new ones.
#pragma once

#include "ostraka/io/diagnose.h"
#include "ostraka/io/mesh_file.h"

#include <string>
#include <utility>
#include <vector>

namespace ostraka {

/// Shares of a diagonal refer to the box of the vertices that have a triangle.
struct RepairOptions {
    double merge_distance = 0;
    bool keep_isolated = false;
    bool keep_largest = false;
    double min_component_share = 0;
    int fill_holes = 500;
    double fill_holes_size = 0.3;
    bool remove_self_intersections = false;
    bool wrap = false;
    double wrap_alpha = 0.02;
    double wrap_offset = 0.002;
    template <class Visitor>
    void describe(Visitor& visit) {
        visit("merge-distance", merge_distance, "merge border points closer than this share of the diagonal (0: only equal ones)",
              Range{0, 0.1});
        visit("keep-isolated", keep_isolated, "keep vertices without a face", Anything{});
        visit("keep-largest", keep_largest, "keep only the component with the largest area", Anything{});
        visit("min-component-share", min_component_share, "drop components with less than this share of the area", Range{0, 1});
        visit("fill-holes", fill_holes, "fill holes of at most so many border edges (0: none)", Range{0, 100000});
        visit("fill-holes-size", fill_holes_size,
              "and at most so wide (diameter of a disc of the same area) as a share of their component's diagonal", Range{0, 1});
        visit("remove-self-intersections", remove_self_intersections, "cut out intersecting triangles and close the gap",
              Anything{});
        visit("wrap", wrap, "replace the surface by a watertight wrap (loses detail below wrap-alpha)", Anything{});
        visit("wrap-alpha", wrap_alpha, "the wrap enters openings wider than this share of the diagonal", Range{0.002, 0.5});
        visit("wrap-offset", wrap_offset, "distance of the wrap from the surface, as a share of the diagonal",
              Range{0.0001, 0.1});
    }
};

/// What one step changed, in counts.
struct RepairStep {
    std::string name;
    std::vector<std::pair<std::string, std::size_t>> counts;
};

struct RepairResult {
    Mesh mesh;          ///< an oriented manifold, open or closed
    MeshExtras extras;  ///< carried over: values of a made element are those of the nearest kept one
    /// Old vertex -> new vertex, old triangle -> new triangle; no_index for what is gone. Merged vertices and duplicate
    /// triangles map to the one kept; of several copies of a split vertex, or parts of a split triangle, the first.
    std::vector<Index> vertex_map, face_map;
    /// New -> old; no_index for what was made.
    std::vector<Index> vertex_source, face_source;
    bool maps_by_distance = false;  ///< after a wrap: the maps tell the nearest element
    std::vector<RepairStep> steps;
    std::vector<std::string> notes;  ///< what was not done, and why
    MeshDiagnosis after;             ///< of `mesh`
};

/// Steps: merge points on open borders (closed components stay as they are), drop triangles that repeat a corner or are
/// duplicates, orient by flooding across manifold edges, take non-manifold edges and vertices apart, drop small components,
/// flip triangles without area away, turn closed components outwards (cavities stay), fill holes, remove self-intersections,
/// wrap. All components stay unless the options say otherwise. `extras` as of `triangulate`.
/// Throws Error (input) when nothing is left to mend, naming why; Error (usage) for options out of range.
RepairResult repair(const TriangleSoup& soup, const MeshExtras& extras = {}, const RepairOptions& options = {});

}  // namespace ostraka

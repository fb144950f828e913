// From any triangle soup to an oriented manifold mesh, step by step, with maps from old elements to new ones.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/io/diagnose.h"
#include "ostraka/io/mesh_file.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace ostraka {

/// Shares of a diagonal refer to the box of the vertices that have a triangle.
struct RepairOptions {
    double merge_distance = 0;
    double merge_gap = 0.25;
    bool keep_isolated = false;
    bool keep_largest = false;
    double min_component_share = 0;
    int fill_holes = 500;
    double fill_holes_size = 0.3;
    bool remove_self_intersections = false;
    bool wrap = false;
    double wrap_alpha = 0.02;
    double wrap_offset = 0.002;
    void describe(OptionList& visit);
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
    /// triangles map to the one kept; vertices that were moved to smooth a fold stay the same ones; of several copies of a split
    /// vertex, or parts of a split triangle, the first.
    std::vector<Index> vertex_map, face_map;
    /// New -> old; no_index for what was made.
    std::vector<Index> vertex_source, face_source;
    bool maps_by_distance = false;  ///< after a wrap: the maps tell the nearest element
    std::vector<RepairStep> steps;
    std::vector<std::string> notes;  ///< what was not done, and why; what was lost
    /// The surface before self-intersections were removed or it was wrapped, without a search for self-intersections; only then.
    std::optional<MeshDiagnosis> before;
    MeshDiagnosis after;  ///< of `mesh`
};

/// Steps: merge points on open borders (closed components stay as they are), drop triangles that repeat a corner or are
/// duplicates (of either sense where one closes the surface), insert border vertices into the sides they lie on, orient by
/// flooding across manifold edges, take non-manifold edges and vertices apart, drop small components, flip triangles without area
/// away, turn closed components outwards (cavities stay), fill holes, remove self-intersections, wrap. All components stay unless
/// the options say otherwise. `extras` as of `triangulate`. Throws Error (input) when nothing is left to mend, naming why; Error
/// (usage) for options out of range.
RepairResult repair(const TriangleSoup& soup, const MeshExtras& extras = {}, const RepairOptions& options = {});

/// Judges the result as a reader of STL sees it (`after`): single precision, vertices at one place joined. Where that would make
/// copies of vertices one again, so that the mesh is no manifold any more, they are moved apart by a hair first, each towards
/// its own triangles: 1e-6 of the diagonal, or eight steps of single precision where that is more; a note says so.
void prepare_for_stl(RepairResult& result);

}  // namespace ostraka

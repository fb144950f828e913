// Repair of any triangle soup to an oriented manifold mesh in steps, with maps from old to new elements.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/io/diagnose.h"
#include "ostraka/io/mesh_file.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace ostraka {

/// Fractions of a diagonal refer to the bounding box of the vertices with triangles.
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

/// Counts of the changes made by one step.
struct RepairStep {
    std::string name;
    std::vector<std::pair<std::string, std::size_t>> counts;
};

struct RepairResult {
    Mesh mesh;          ///< an oriented manifold, open or closed
    MeshExtras extras;  ///< transferred attributes; new elements take the values of the nearest old element that was kept
    /// Old vertex -> new vertex, old triangle -> new triangle; no_index if removed. Merged vertices and duplicate triangles map
    /// to the one kept; vertices moved to smooth a fold keep their identity; a split vertex maps to its first copy, a split
    /// triangle to its first part.
    std::vector<Index> vertex_map, face_map;
    /// New -> old; no_index for new elements.
    std::vector<Index> vertex_source, face_source;
    bool maps_by_distance = false;  ///< after wrapping: the maps give the nearest element
    std::vector<RepairStep> steps;
    std::vector<std::string> notes;  ///< steps not carried out, with reasons; data lost
    /// The surface before self-intersections were removed or it was wrapped, without a search for self-intersections; only set
    /// in these cases.
    std::optional<MeshDiagnosis> before;
    MeshDiagnosis after;  ///< of `mesh`
};

/// Steps: merge points on open borders (closed components are not changed), drop triangles with a repeated corner and duplicate
/// triangles (of either orientation if one of them closes the surface), insert border vertices into the edges they lie on,
/// orient by flooding across manifold edges, split non-manifold edges and vertices, drop small components, remove degenerate
/// triangles by edge flips, orient closed components outwards (except cavities), fill holes, remove self-intersections, wrap.
/// All components are kept unless the options demand otherwise. `extras`: as returned by `triangulate`. Throws Error (input),
/// with the reason, if nothing is left to repair; Error (usage) for options out of range.
RepairResult repair(const TriangleSoup& soup, const MeshExtras& extras = {}, const RepairOptions& options = {});

/// Diagnoses the result as an STL reader sees it (`after`): single precision, vertices with equal positions merged. If that
/// would merge copies of split vertices again, so that the mesh is no longer manifold, they are first moved apart slightly,
/// each towards its own triangles: by 1e-6 of the diagonal, or eight steps of single precision if that is more; a note reports
/// it.
void prepare_for_stl(RepairResult& result);

}  // namespace ostraka

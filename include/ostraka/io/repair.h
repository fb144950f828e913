// Repairs any triangle soup to an oriented manifold mesh in several steps, with maps from old to new elements.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/io/diagnose.h"
#include "ostraka/io/mesh_file.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace ostraka {

/// Options of `repair`. Fractions of a diagonal refer to the bounding box of the vertices with triangles.
struct RepairOptions {
    /// Border points closer than this fraction of the diagonal are merged; 0: only equal points.
    double merge_distance = 0;
    /// Border points on both sides of a crack are merged if the crack is narrower than this fraction of the shortest edge at
    /// the point.
    double merge_gap = 0.25;
    bool keep_isolated = false;      ///< true: keep vertices without a face
    bool keep_largest = false;       ///< true: keep only the component with the largest area
    double min_component_share = 0;  ///< components with a smaller fraction of the area are dropped
    int fill_holes = 500;            ///< max number of border edges of a hole that is filled; 0: fill no holes
    /// Max width of a hole that is filled, as a fraction of its component's diagonal.
    double fill_holes_size = 0.3;
    bool remove_self_intersections = false;  ///< true: cut out intersecting triangles and close the gaps
    bool wrap = false;                       ///< true: replace the surface by a watertight wrap
    double wrap_alpha = 0.02;                ///< the wrap enters openings wider than twice this fraction of the diagonal
    double wrap_offset = 0.002;              ///< distance of the wrap from the surface, as a fraction of the diagonal
    void declare_options(OptionList& list);  ///< adds every member to a list of options
};

/// The changes made by one repair step.
struct RepairStep {
    std::string name;                                         ///< name of the step
    std::vector<std::pair<std::string, std::size_t>> counts;  ///< pairs of a kind of change and the number of such changes
};

/// The repaired mesh, with maps from old to new elements.
struct RepairResult {
    Mesh mesh;  ///< the repaired mesh: an oriented manifold, open or closed
    /// Attributes of the new elements; a new element without an identical old element takes the values of the nearest old element
    /// that was kept.
    MeshExtras extras;
    /// For each old vertex (triangle): index of the new vertex (triangle); no_index if removed. Merged vertices and duplicate
    /// triangles map to the element that was kept; vertices moved to smooth a fold keep their identity; a split vertex maps to
    /// its first copy, and a split triangle to its first part.
    std::vector<Index> vertex_map, face_map;
    /// For each new vertex (triangle): index of the old vertex (triangle); no_index for elements that are new.
    std::vector<Index> vertex_source, face_source;
    /// True after wrapping: the maps give the nearest elements instead of identical elements.
    bool maps_by_distance = false;
    std::vector<RepairStep> steps;  ///< the steps carried out, in order
    /// Messages about steps that were not carried out, with reasons, and about lost data.
    std::vector<std::string> notes;
    /// Diagnosis (without self-intersections) of the surface just before the removal of self-intersections or the wrapping;
    /// none if neither step was carried out.
    std::optional<MeshDiagnosis> before;
    MeshDiagnosis after;  ///< diagnosis of `mesh`
};

/// Repairs a triangle soup in these steps: merge points on open borders (closed components are not changed), drop triangles with
/// a repeated corner and duplicate triangles (of either orientation if one of them closes the surface), insert border vertices
/// into the edges on which they lie, orient by flooding across manifold edges, split non-manifold edges and vertices, drop small
/// components, remove degenerate triangles by edge flips, orient closed components outwards (except cavities), fill holes, remove
/// self-intersections, wrap. All components are kept unless the options demand otherwise. `extras`: as returned by `triangulate`.
/// Throws Error (input), with the reason, if nothing is left to repair; Error (usage) for options out of range.
RepairResult repair(const TriangleSoup& soup, const MeshExtras& extras = {}, const RepairOptions& options = {});

/// Updates the diagnosis `after` to the mesh that will be read from an STL file: its coordinates are in single precision, and
/// vertices with equal positions are merged. If merging would join copies of split vertices again, so that the mesh would no
/// longer be manifold, these copies are first moved apart slightly, each towards its own triangles, by the larger of 1e-6 of
/// the diagonal and eight steps of single precision; a note reports the change.
void prepare_for_stl(RepairResult& result);

}  // namespace ostraka

// Transfer of annotations to another resolution of the same object (thesis, section 2.4).
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/core/options.h"
#include "ostraka/geom/insert_curves.h"
#include "ostraka/geom/shortest_path.h"
#include "ostraka/transfer/correspondence.h"

#include <optional>
#include <string>
#include <vector>

namespace ostraka {

struct TransferOptions {
    CorrespondenceOptions correspondence;       ///< options for finding corresponding points
    PathMetric metric = PathMetric::euclidean;  ///< length that paths between corresponding vertices minimise
    /// Treatment of spikes of an outline: removed (prune), avoided while paths are traced (avoid), or kept.
    enum class Spikes { prune, avoid, keep } spikes = Spikes::prune;
    /// Assignment of target faces that the projected outline crosses. path: by the edge paths; area: to the side with most of
    /// the face's area; balanced: so that area and perimeter of the region are preserved.
    enum class Rounding { path, area, balanced } rounding = Rounding::balanced;
    /// Position of a transferred region relative to the source region: it overlaps the source region, encloses it, or is
    /// enclosed by it.
    enum class Cover { overlapping, enclosing, enclosed } cover = Cover::overlapping;
    /// Representation of outlines and lines on the target: as free curves or as paths of edges. partitions: regions that
    /// partition the surface become free, and other annotations keep their representation; kept: all annotations keep their
    /// representation; free: all become free; edges: all become paths of edges of the target.
    enum class Outlines { partitions, kept, free, edges } outlines = Outlines::partitions;
    bool refine = false;                     ///< true: insert vertices on the target so that outlines are exact
    bool overlap = true;                     ///< true: measure the overlap with the source region
    bool force = false;                      ///< true: continue although the meshes differ in size or position
    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// Outcome of the transfer of an annotation: kept, reduced to a line or point, or lost.
enum class TransferOutcome { kept, became_line, became_point, lost };
std::string to_string(TransferOutcome outcome);

/// Accuracy of the transfer of one annotation.
struct TransferScore {
    int id = 0;       ///< id of the annotation
    std::string tag;  ///< tag of the annotation
    /// Types before and after the transfer.
    AnnotationType source_type = AnnotationType::region, target_type = AnnotationType::region;
    TransferOutcome outcome = TransferOutcome::kept;  ///< outcome of the transfer
    std::string note;                                 ///< messages about the transfer of this annotation
    double source_area = 0, target_area = 0;          ///< areas of regions
    double source_length = 0, target_length = 0;      ///< perimeter of regions, length of lines
    /// Two-sided Hausdorff distance between the outlines (lines, points); empty if one of them is empty.
    std::optional<double> hausdorff;
    std::optional<double> overlap;  ///< intersection over union of the areas; empty: not measured
    /// Area that is inside only one of the two regions: the sum of the parts of the source region outside the target region and
    /// of the target region outside the source region. Empty: not measured.
    std::optional<double> wrong_side;
    std::size_t vertices = 0;  ///< number of outline vertices, line vertices or points of the source
    /// Number of source vertices with each kind of correspondence (CorrespondenceKind), and number of vertices with a relocated
    /// correspondence.
    std::size_t by_ray = 0, by_closest_point = 0, without_place = 0, relocated = 0;
    std::size_t detours = 0;          ///< number of pairs of consecutive vertices that are not connected by a short path
    bool crossings_resolved = false;  ///< true: outlines intersected, and the interior was computed by winding numbers
    bool voted = false;               ///< true: the interior was computed for each face separately, not from the outlines
};

/// Distortions of a region as in Table 2.1 of the thesis: |target / source - 1| for area A, perimeter P, P / A, A / P and
/// circularity P^2 / A, and the mean of these values.
struct Distortions {
    double area, perimeter, perimeter_by_area, area_by_perimeter, circularity, mean;
};
Distortions distortions(const TransferScore& score);  ///< distortions of the region that the score describes

/// Computing times of a transfer.
struct TransferTimes {
    double checks = 0, correspondence = 0, paths = 0, regions = 0, scores = 0;  ///< seconds
};

/// Result of a transfer.
struct TransferResult {
    AnnotationSet annotations;              ///< annotations on the target, or on `refined->mesh`
    std::vector<TransferScore> scores;      ///< one score per annotation of the source, in the order of the source
    std::optional<InsertedCurves> refined;  ///< the refined target, with options.refine; otherwise empty
    TransferTimes times;                    ///< computing times
    bool turned_over = false;  ///< true: one of the meshes is inside out; the source's faces were turned over for the transfer
};

/// Transfers all annotations. Points are transferred to the corresponding vertices; poly-lines and outlines become edge paths
/// between corresponding vertices; regions are the faces to the left of their outlines; measures are transferred with their pins
/// and recomputed. A region too small for the target becomes a line or a point, and the note of its score reports this. Some
/// annotations are projected by their curves (project_curves.h) and keep their type, even if they are very small: free
/// annotations; with `outlines` = free, all annotations; with `outlines` = partitions, regions that partition the whole surface
/// (unless `refine` or `cover` require edges). If one of the meshes is inside out, the source's faces are turned over in memory.
/// Throws Error (input) if the meshes differ in unit or position, unless options.force.
TransferResult transfer(AnnotatedMeshView source, const SurfaceSearch& target, const TransferOptions& options = {});

}  // namespace ostraka

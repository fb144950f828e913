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
    CorrespondenceOptions correspondence;
    PathMetric metric = PathMetric::euclidean;
    enum class Spikes { prune, avoid, keep } spikes = Spikes::prune;
    enum class Rounding { path, area, balanced } rounding = Rounding::balanced;
    enum class Cover { overlapping, enclosing, enclosed } cover = Cover::overlapping;
    enum class Outlines { partitions, kept, free, edges } outlines = Outlines::partitions;
    bool refine = false;
    bool overlap = true;
    bool force = false;
    void list_options(OptionList& list);
};

enum class TransferOutcome { kept, became_line, became_point, lost };
std::string to_string(TransferOutcome outcome);

/// Accuracy of the transfer of one annotation.
struct TransferScore {
    int id = 0;
    std::string tag;
    AnnotationType source_type = AnnotationType::region, target_type = AnnotationType::region;
    TransferOutcome outcome = TransferOutcome::kept;
    std::string note;                             ///< further remarks
    double source_area = 0, target_area = 0;      ///< areas of regions
    double source_length = 0, target_length = 0;  ///< perimeter of regions, length of lines
    std::optional<double> hausdorff;   ///< two-sided, between the outlines (lines, points); nullopt if one of them is empty
    std::optional<double> overlap;     ///< intersection over union of the areas
    std::optional<double> wrong_side;  ///< area on the wrong side of the outline, summed over both sides
    std::size_t vertices = 0;          ///< outline vertices, line vertices or points of the source
    std::size_t by_ray = 0, by_closest_point = 0, without_place = 0, relocated = 0;
    std::size_t detours = 0;          ///< pairs of consecutive vertices not connected by a short path
    bool crossings_resolved = false;  ///< outlines intersected; the interior was computed by winding numbers
    bool voted = false;               ///< the interior was computed face by face instead of from outlines
};

/// Distortions of a region as in Table 2.1 of the thesis: |target / source - 1| of area A, perimeter P, P / A, A / P and
/// circularity P^2 / A, and their mean.
struct Distortions {
    double area, perimeter, perimeter_by_area, area_by_perimeter, circularity, mean;
};
Distortions distortions(const TransferScore& score);

struct TransferTimes {
    double checks = 0, correspondence = 0, paths = 0, regions = 0, scores = 0;  ///< seconds
};

struct TransferResult {
    AnnotationSet annotations;              ///< on the target, or on `refined->mesh`
    std::vector<TransferScore> scores;      ///< one per annotation of the source, in their order
    std::optional<InsertedCurves> refined;  ///< with options.refine
    TransferTimes times;
};

/// Transfers all annotations. Points go to the corresponding vertices; poly-lines and outlines become edge paths between
/// corresponding vertices; regions are the faces to the left of their outlines; measures move with their pins and are
/// recomputed. A region too small for the target becomes a line or a point, and its note reports it. Three kinds of annotations
/// are projected by their curves (project_curves.h) and keep their type, however small: free annotations; with `outlines` = free,
/// all annotations; with `outlines` = partitions, regions that partition the whole surface (unless `refine` or `cover` require
/// edges). Throws Error (input) if the meshes differ in unit, position or orientation, unless options.force.
TransferResult transfer(AnnotatedMeshView source, const SurfaceSearch& target, const TransferOptions& options = {});

}  // namespace ostraka

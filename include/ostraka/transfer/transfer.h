// Annotations carried to another resolution of the same object (thesis, section 2.4).
#pragma once

#include "ostraka/annotation/annotation.h"
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
    void describe(OptionList& visit);
};

enum class TransferOutcome { kept, became_line, became_point, lost };
std::string to_string(TransferOutcome outcome);

/// How faithful the transfer of one annotation is.
struct TransferScore {
    int id = 0;
    std::string tag;
    AnnotationType source_type = AnnotationType::region, target_type = AnnotationType::region;
    TransferOutcome outcome = TransferOutcome::kept;
    std::string note;                             ///< what else is to be known, in words
    double source_area = 0, target_area = 0;      ///< of regions
    double source_length = 0, target_length = 0;  ///< perimeter of regions, length of lines
    std::optional<double> hausdorff;   ///< between the outlines (lines, points), two-sided; nothing if one of them has none
    std::optional<double> overlap;     ///< intersection over union of the areas
    std::optional<double> wrong_side;  ///< area put on the wrong side of the outline, both ways added
    std::size_t vertices = 0;          ///< outline vertices, line vertices or points of the source
    std::size_t by_ray = 0, by_closest_point = 0, without_place = 0, relocated = 0;
    std::size_t detours = 0;          ///< pairs of neighbours joined by no short path
    bool crossings_resolved = false;  ///< outlines crossed; the interior was found by winding numbers
    bool voted = false;               ///< the interior was found face by face instead of from outlines
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

/// Transfers every annotation. Points go to the corresponding vertices; poly-lines and outlines become edge paths between
/// corresponding vertices; regions are what lies to the left of their outlines; measures move with their pins and are
/// evaluated anew. A region too small for the target becomes a line or a point and says so. Free annotations, with `outlines`
/// free all, and with `partitions` those regions which part the whole surface (unless `refine` or `cover` ask for edges), are
/// laid by their curves (lay_curves.h) and keep their type, however small. Throws Error (input) if the meshes differ in unit,
/// position or orientation, unless options.force.
TransferResult transfer(const Mesh& source, const AnnotationSet& annotations, const SurfaceSearch& target,
                        const TransferOptions& options = {});

}  // namespace ostraka

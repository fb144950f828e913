#include "ostraka/transfer/survival.h"

#include "ostraka/core/progress.h"
#include "ostraka/core/text.h"
#include "ostraka/remesh/simplify.h"

#include <cmath>

namespace ostraka {

std::vector<Survival> smallest_resolutions(AnnotatedMeshView object, const SurvivalOptions& options) {
    check_options(options, "annotation survival");
    TransferOptions transferring = options.transfer;
    transferring.overlap = false;
    transferring.refine = false;
    transferring.force = true;  // the same object, however coarse
    // Each annotation by itself, whether or not it is part of a partition.
    if (transferring.outlines == TransferOptions::Outlines::partitions) transferring.outlines = TransferOptions::Outlines::kept;
    // Coarse surfaces lie farther away than the usual search radius.
    transferring.correspondence.max_distance = std::max(transferring.correspondence.max_distance, 0.1);
    std::vector<Survival> survivals;
    for (const Annotation& annotation : object.annotations.annotations)
        survivals.push_back({annotation.id, annotation.tag, object.mesh.number_of_vertices(), ""});
    Mesh coarse = object.mesh;
    const double steps =
        std::log(static_cast<double>(options.min_vertices) / static_cast<double>(object.mesh.number_of_vertices())) /
        std::log(options.ratio);
    Progress progress("resolutions", static_cast<std::size_t>(std::max(1.0, steps)));
    std::size_t alive = survivals.size();
    bool tried = false;
    while (alive > 0) {
        SimplifyOptions simplifying;
        simplifying.vertices = static_cast<std::uint64_t>(options.ratio * static_cast<double>(coarse.number_of_vertices()));
        if (simplifying.vertices < options.min_vertices) break;
        const SimplifyResult simplified = simplify(coarse, simplifying);
        if (!simplified.reached) break;
        tried = true;
        const SurfaceSearch search(coarse);
        const TransferResult result = transfer(object, search, transferring);
        for (std::size_t i = 0; i < survivals.size(); ++i) {
            if (!survivals[i].end.empty()) continue;
            const TransferScore& score = result.scores[i];
            if (score.outcome != TransferOutcome::kept) survivals[i].end = to_string(score.outcome);
            else if (!score.note.empty()) survivals[i].end = score.note;
            else if (score.source_type == AnnotationType::region && distortions(score).area > options.area_error)
                survivals[i].end = "area off by " + digits(100 * distortions(score).area, 3) + " %";
            if (survivals[i].end.empty()) survivals[i].vertices = coarse.number_of_vertices();
            else --alive;
        }
        progress.advance();
    }
    if (!tried)
        for (Survival& survival : survivals) survival.end = "no smaller resolution could be made";
    return survivals;
}

void SurvivalOptions::declare_options(OptionList& list) {
    list("ratio", ratio, "ratio of the number of vertices of each resolution to that of the previous resolution",
         Range{0.1, 0.95});
    list("area-error", area_error, "a region counts as lost if its area changes by more than this relative amount",
         Range{0.001, 1});
    list("min-vertices", min_vertices, "minimum number of vertices of the resolutions that are tried", Range{4, 1e9});
}

}  // namespace ostraka

// Rounding of transferred regions to the exact course of their outlines.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "transfer/path_tracer.h"
#include "transfer/region_transfer.h"

#include <vector>

namespace ostraka {

/// A face near an outline shared by several regions, and the fraction of it inside one of them.
struct SharedFace {
    Index face;
    std::size_t region;
    double share;
};

class OutlineRounding {
public:
    /// Traces the outlines of all regions of `source` across the faces of the target; `vertex_paths` are their paths, by
    /// annotation.
    OutlineRounding(AnnotatedMeshView source, const Mesh& target, const std::vector<std::vector<SourcePath>>& vertex_paths,
                    PathTracer& tracer);

    /// Rounds the parts of the outline that belong to this region only; faces along shared outlines are deferred. `edge`:
    /// typical edge length of the target. Regions may be rounded in parallel.
    void round(std::size_t region, FilledRegion& filled, double edge, bool balance);
    /// Rounds the deferred faces of all regions.
    void round_shared_outlines(std::vector<FilledRegion>& regions);

private:
    const AnnotatedMeshView source_;
    const Mesh& target_;
    const PathTracer& tracer_;
    double source_edge_;
    std::vector<std::vector<PathTracer::Step>> steps_;  ///< by annotation
    std::vector<int> users_;                            ///< by curve: number of regions that it bounds
    std::vector<std::vector<SharedFace>> put_aside_;    ///< by annotation
};

}  // namespace ostraka

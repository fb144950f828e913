// Transferred regions rounded to the outlines as they truly run.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "path_tracer.h"
#include "region_transfer.h"

#include <vector>

namespace ostraka {

/// A face near an outline that several regions share, and which share of it lies inside one of them.
struct SharedFace {
    Index face;
    std::size_t region;
    double share;
};

class OutlineRounding {
public:
    /// Draws the outlines of all regions of `set` across the target's faces; `paths` are theirs, by annotation.
    OutlineRounding(const Mesh& source, const AnnotationSet& set, const Mesh& target,
                    const std::vector<std::vector<SourcePath>>& vertex_paths, PathTracer& tracer);

    /// Rounds what only this region borders on; faces along outlines that regions share are put aside. `edge` is the typical
    /// edge length of the target. Regions may be rounded side by side.
    void round(std::size_t region, FilledRegion& filled, double edge, bool balance);
    /// Rounds what was put aside, for all regions in one move.
    void round_shared_outlines(std::vector<FilledRegion>& regions);

private:
    const Mesh& source_;
    const AnnotationSet& set_;
    const Mesh& target_;
    const PathTracer& tracer_;
    double source_edge_;
    std::vector<std::vector<PathTracer::Step>> steps_;  ///< by annotation
    std::vector<int> users_;                            ///< by curve: how many regions it bounds
    std::vector<std::vector<SharedFace>> put_aside_;    ///< by annotation
};

}  // namespace ostraka

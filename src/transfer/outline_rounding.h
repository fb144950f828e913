// Adjusts transferred regions face by face to the exact course of their outlines.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "transfer/path_tracer.h"
#include "transfer/region_transfer.h"

#include <vector>

namespace ostraka {

/// A face near an outline that several regions share, and the share of its area that lies inside one region.
struct SharedFace {
    Index face;
    std::size_t region;  ///< index of the annotation
    double share;        ///< share of the face's area inside the region
};

/// Assigns faces that the exact outlines of regions cross to either side.
class OutlineRounding {
public:
    /// Traces the outlines of all regions of `source` across the faces of the target; `vertex_paths`: for each annotation, its
    /// outlines on the source.
    OutlineRounding(AnnotatedMeshView source, const Mesh& target, const std::vector<std::vector<SourcePath>>& vertex_paths,
                    PathTracer& tracer);

    /// Adjusts the faces along those parts of the outline that belong to this region only; faces along shared outlines are
    /// deferred. `edge`: typical edge length of the target; `balance`: true to preserve area and perimeter. Regions may be
    /// adjusted in parallel.
    void round(std::size_t region, FilledRegion& filled, double edge, bool balance);
    /// Assigns the deferred faces of all regions.
    void round_shared_outlines(std::vector<FilledRegion>& regions);

private:
    const AnnotatedMeshView source_;
    const Mesh& target_;
    const PathTracer& tracer_;
    double source_edge_;                                ///< typical edge length of the source
    std::vector<std::vector<PathTracer::Step>> steps_;  ///< for each annotation, the curves of its outlines on the target
    std::vector<int> users_;                            ///< for each curve, number of regions that it bounds
    std::vector<std::vector<SharedFace>> put_aside_;    ///< for each annotation, its deferred faces
};

}  // namespace ostraka

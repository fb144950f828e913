// An object in segments along its height: like slices grouped by k-means (thesis, section 3.2.1, figure 3.5).
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/core/options.h"
#include "ostraka/stats/k_means.h"

#include <optional>

namespace ostraka {

struct SliceSegmentOptions {
    int slices = 100;
    int clusters = 0;  ///< 0: as many as the criterion proposes
    int min_run = 3;
    bool size = false;
    ClusterCountOptions count;

    void describe(OptionList& visit);
};

/// Slices in a row of one kind.
struct SliceSegment {
    int cluster = 0;
    double low = 0, high = 0;  ///< over the lowest place, in the mesh's unit
    std::size_t slices = 0;
};

struct SliceSegments {
    std::vector<std::string> descriptors;
    std::vector<double> heights;              ///< of the slices over the lowest place
    std::vector<int> raw;                     ///< cluster of each slice by k-means; -1 where it has no closed outline
    std::vector<int> labels;                  ///< after short runs were joined: every slice has one
    ClusterCount count;                       ///< the criterion's curve
    int clusters = 0;                         ///< asked for or proposed, as many as k-means found
    std::vector<SliceSegment> segments;       ///< from below
    std::vector<std::int32_t> face_segments;  ///< of each face: that of the slice nearest to its centroid
};

/// Cuts the mesh across `up`, describes the slices (elongation, solidity, compactness, circular and rectangular variance, Euler
/// number, hole-area ratio; those that are the same everywhere have no weight), standardises the descriptors and groups them by
/// k-means. Then runs of fewer than `min_run` slices join the longer of their neighbours (the lower of equal ones), shortest
/// runs first: segments are bands, and a kind may come back in several. Slices without a closed outline take the kind of the
/// nearest one that has one. The criterion's curve has costs and silhouettes of 1 to `max_clusters`. Throws Error (input) for a
/// mesh without height or with fewer than four slices that have a closed outline.
SliceSegments segment_by_slices(const Mesh& mesh, const Vector& up, const SliceSegmentOptions& options = {});

/// A region for each segment, "segment 1" the lowest one; segments of one kind have one colour. Segments too thin to hold a face
/// have none.
AnnotationSet annotate_segments(const Mesh& mesh, const SliceSegments& segments);

/// Adjusted Rand index of the segments and known labels of faces, over the faces that have a label; none where no face has one.
std::optional<double> segment_agreement(const SliceSegments& segments, const std::vector<std::int32_t>& known);

}  // namespace ostraka

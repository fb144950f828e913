// Segments of an object along its height: slices clustered by k-means (thesis, section 3.2.1, figure 3.5).
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/core/options.h"
#include "ostraka/stats/k_means.h"

#include <optional>

namespace ostraka {

struct SliceSegmentOptions {
    int slices = 100;
    int clusters = 0;  ///< 0: the number proposed by the criterion
    int min_run = 3;
    bool size = false;
    ClusterCountOptions count;

    void describe(OptionList& visit);
};

/// Consecutive slices of one cluster.
struct SliceSegment {
    int cluster = 0;
    double low = 0, high = 0;  ///< heights above the lowest point, in the mesh's unit
    std::size_t slices = 0;
};

struct SliceSegments {
    std::vector<std::string> descriptors;
    std::vector<double> heights;              ///< heights of the slices above the lowest point
    std::vector<int> raw;                     ///< cluster of each slice by k-means; -1 for slices without a closed outline
    std::vector<int> labels;                  ///< cluster of each slice after short runs were merged and gaps filled
    ClusterCount count;                       ///< the criterion's curve
    int clusters = 0;                         ///< given or proposed number, or the smaller number that k-means found
    std::vector<SliceSegment> segments;       ///< from bottom to top
    std::vector<std::int32_t> face_segments;  ///< segment of each face: that of the slice nearest to its centroid
};

/// Slices the mesh across `up`, describes the slices (elongation, solidity, compactness, circular and rectangular variance,
/// Euler number, hole-area ratio; descriptors that are constant have no weight), standardises the descriptors and clusters them
/// by k-means. Then runs of fewer than `min_run` slices are merged into the longer of their neighbours (the lower if equal),
/// shortest runs first. Segments are therefore bands, and several segments may have the same cluster. Slices without a closed
/// outline take the cluster of the nearest slice that has one. The criterion's curve has the costs and silhouettes of 1 to
/// `max_clusters` clusters. Throws Error (input) for a mesh without height or with fewer than four slices that have a closed
/// outline.
SliceSegments segment_by_slices(const Mesh& mesh, const Vector& up, const SliceSegmentOptions& options = {});

/// A region for each segment; "segment 1" is the lowest. Segments of one cluster have one colour. Segments too thin to contain
/// a face are omitted.
AnnotationSet annotate_segments(const Mesh& mesh, const SliceSegments& segments);

/// Adjusted Rand index between the segments and known labels, over the faces that have a label; nothing if no face has one.
std::optional<double> segment_agreement(const SliceSegments& segments, const std::vector<std::int32_t>& known);

}  // namespace ostraka

// Segments of an object along its height: slices clustered by k-means on their descriptors (thesis, section 3.2.1, figure 3.5).
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/core/options.h"
#include "ostraka/stats/k_means.h"

#include <optional>

namespace ostraka {

struct SliceSegmentOptions {
    int slices = 100;           ///< number of evenly spaced slices
    int clusters = 0;           ///< number of clusters; 0: the number that the criterion proposes
    int min_run = 3;            ///< min number of consecutive slices of one cluster that form a segment
    bool size = false;          ///< also use the radius of the circle with the slice's area as a descriptor
    ClusterCountOptions count;  ///< criterion for the number of clusters

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// A segment: consecutive slices of one cluster.
struct SliceRun {
    int cluster = 0;           ///< index of the cluster
    double low = 0, high = 0;  ///< heights above the lowest point, in the mesh's unit
    std::size_t slices = 0;    ///< number of slices
};

/// Result of `segment_by_slices`.
struct SliceSegments {
    std::vector<std::string> descriptors;  ///< names of the descriptors used
    std::vector<double> heights;           ///< heights of the slices above the lowest point
    std::vector<int> raw;                  ///< for each slice, its cluster by k-means; -1: no closed outline
    std::vector<int> labels;               ///< for each slice, its cluster after short runs were merged and gaps filled
    ClusterCount count;                    ///< value of the criterion for each number of clusters
    int clusters = 0;                      ///< number of clusters: given or proposed, or the smaller number that k-means found
    std::vector<SliceRun> segments;        ///< from bottom to top
    /// For each face, index of its segment: the segment of the slice nearest to the face's centroid.
    std::vector<std::int32_t> face_segments;
};

/// Slices the mesh across `up`, describes the slices (elongation, solidity, compactness, circular and rectangular variance, Euler
/// number, hole-area ratio; descriptors that are constant have no weight), standardises the descriptors and clusters the slices
/// by k-means. Then runs of fewer than `min_run` slices are merged into the longer of their neighbouring runs (the lower if
/// equal), shortest runs first. Segments are therefore bands, and several segments may belong to the same cluster. Slices without
/// a closed outline take the cluster of the nearest slice that has a closed outline. The criterion is evaluated by costs and
/// silhouettes for 1 to `max_clusters` clusters. Throws Error (input) for a mesh without height or with fewer than four slices
/// that have a closed outline.
SliceSegments segment_by_slices(const Mesh& mesh, const Vector& up, const SliceSegmentOptions& options = {});

/// One region for each segment; "segment 1" is the lowest. Segments of one cluster have the same colour. Segments too thin to
/// contain a face are omitted.
AnnotationSet annotate_segments(const Mesh& mesh, const SliceSegments& segments);

/// Adjusted Rand index between the segments and the labels in `known` (one per face), over the faces that have a label; nothing
/// if no face has a label.
std::optional<double> segment_agreement(const SliceSegments& segments, const std::vector<std::int32_t>& known);

}  // namespace ostraka

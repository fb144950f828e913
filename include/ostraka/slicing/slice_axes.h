// Axes through the barycentres of slices, straightness of an object, homogeneity of its wall thickness, and its tubular part
// (thesis, section 3.2).
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/slicing/slice_descriptors.h"

#include <limits>
#include <string>

namespace ostraka {

/// Barycentres of the slices that have one, in the order of the stack and in the mesh's coordinates: barycentres of the
/// material or, with `of_outline`, of the filled outline.
std::vector<Point> barycentres(const SliceStack& stack, const std::vector<SliceDescriptors>& descriptors,
                               bool of_outline = false);

/// An axis through the barycentres of slices.
struct SliceLine {
    Point point{0, 0, 0};       ///< a point on the axis
    Vector direction{0, 0, 1};  ///< unit vector of the axis; its angle with the frame's normal is at most 90 degrees
};

/// The line in the direction of the slices' normal through the mean of the barycentres (as in the thesis). Throws Error (input)
/// without barycentres.
SliceLine mean_line(const SliceFrame& frame, const std::vector<Point>& barycentres);
/// The total least squares line through the barycentres. Throws Error (input) for fewer than two distinct points.
SliceLine regression_line(const SliceFrame& frame, const std::vector<Point>& barycentres);

/// Straightness of an object: statistics of the distances of the barycentres from an axis.
struct Straightness {
    /// Mean, standard deviation (divisor n - 1; 0 for a single barycentre) and maximum of the distances, in the mesh's unit.
    double mean = 0, deviation = 0, maximum = 0;
    double length = 0;    ///< length of the interval of the axis that the barycentres cover, in the mesh's unit
    double relative = 0;  ///< mean / length; 0 if the length is 0
};
/// Distances of the barycentres from a straight axis.
Straightness straightness(const std::vector<Point>& barycentres, const SliceLine& axis);
/// Distances of the barycentres from a curved axis; `length` is the length of the poly-line. Throws Error (usage) for a poly-line
/// without points.
Straightness straightness(const std::vector<Point>& barycentres, const std::vector<Point>& polyline);

/// Homogeneity of the wall thickness. The wall of a slice is measured between its main outline and the main hole in this
/// outline. A slice qualifies if it has no intersecting contours and no other outer contour or hole larger than a fiftieth of
/// the main one (handles and feet have such contours). Values are NaN if no slice qualifies.
struct ThicknessHomogeneity {
    static constexpr double absent = std::numeric_limits<double>::quiet_NaN();  ///< value of absent results (NaN)
    std::size_t slices = 0;                                                     ///< number of slices that qualify
    std::size_t beside = 0;  ///< number of slices excluded because they have further contours, for example those of handles
    double mean = absent;    ///< median of the slices' mean wall thickness, in the mesh's unit
    /// Median over the slices of the coefficient of variation (standard deviation / mean) of the thickness around the slice.
    double within = absent;
    /// Variation between slices: 1.4826 times the median absolute deviation of the slices' mean thickness, divided by the median;
    /// NaN for a single slice.
    double across = absent;
    /// Coefficient of variation of the thickness over all qualifying slices together, with equal weights.
    double overall = absent;
};
/// Measures the homogeneity of the wall thickness over these slices.
ThicknessHomogeneity thickness_homogeneity(const std::vector<Slice>& slices);

struct TubeOptions {
    /// Min ratio of the short to the long side of the minimum-area bounding rectangle of a slice in a tube.
    double min_eccentricity = 0.7;
    /// Max mean distance of the outline of a slice in a tube from its fitted circle, as a share of the radius.
    double max_roundness = 0.1;
    double similarity = 0.1;  ///< max root mean square distance of a cluster's slices from the centre of the cluster
    std::uint64_t seed = 1;   ///< random seed of the clustering

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// The tubular part of an object.
struct Tube {
    bool found = false;               ///< true: there is a tubular part
    std::string reason;               ///< reason why no tube was found; empty if a tube was found
    std::size_t first = 0, last = 0;  ///< indices of the first and last slice of the tube, in the order of heights
    /// For each slice, in the order of heights, the index of its cluster; -1: the slice cannot belong to a tube.
    std::vector<int> cluster;
};

/// The longest run of consecutive slices (by height) that each have one closed, round outer contour and belong to the same
/// cluster. Round slices are clustered by three dimensionless values: equivalent radius divided by its median, eccentricity,
/// relative roundness. The clustering is k-means with the smallest number of clusters for which every cluster has a root mean
/// square distance from its centre of at most `similarity`. A tube has at least two slices. Throws Error (usage) unless there
/// is one set of descriptors per slice.
Tube tubular_part(const SliceStack& stack, const std::vector<SliceDescriptors>& descriptors, const TubeOptions& options = {});

}  // namespace ostraka

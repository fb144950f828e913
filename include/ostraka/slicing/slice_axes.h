// Axes through the barycentres of slices, straightness, evenness of the wall, and the tubular part (thesis, section 3.2).
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/slicing/slice_descriptors.h"

#include <limits>
#include <string>

namespace ostraka {

/// Barycentres of the material or of the filled outline, in the mesh's frame, of the slices that have one, in stack order.
std::vector<Point> barycentres(const SliceStack& stack, const std::vector<SliceDescriptors>& descriptors,
                               bool of_outline = false);

struct SliceLine {
    Point point{0, 0, 0};
    Vector direction{0, 0, 1};  ///< unit vector in the direction of the frame's normal
};

/// The line along the slices' normal through the mean of the barycentres (as in the thesis). Throws Error (input) without
/// barycentres.
SliceLine mean_line(const SliceFrame& frame, const std::vector<Point>& barycentres);
/// The total least squares line through the barycentres. Throws Error (input) for fewer than two distinct points.
SliceLine regression_line(const SliceFrame& frame, const std::vector<Point>& barycentres);

/// Distances of the barycentres from an axis.
struct Straightness {
    /// In the mesh's unit; `deviation` with divisor n - 1 (0 for a single barycentre).
    double mean = 0, deviation = 0, maximum = 0;
    double length = 0;    ///< length of the interval of the axis covered by the barycentres, in the mesh's unit
    double relative = 0;  ///< mean / length; 0 if the length is 0
};
Straightness straightness(const std::vector<Point>& barycentres, const SliceLine& axis);
/// Distances from a curved axis; the length is that of the poly-line. Throws Error (usage) for a poly-line without points.
Straightness straightness(const std::vector<Point>& barycentres, const std::vector<Point>& polyline);

/// Evenness of the wall. Absent (NaN) if no slice qualifies. A slice is measured between its main outline and the main hole in
/// it. It qualifies if it has no other outer contour or hole larger than a fiftieth of them, as handles and feet have, and no
/// intersecting contours.
struct ThicknessHomogeneity {
    static constexpr double absent = std::numeric_limits<double>::quiet_NaN();
    std::size_t slices = 0;  ///< number of slices that qualify
    std::size_t beside = 0;  ///< number of slices left out because of handles or other parts beside or within the wall
    double mean = absent;    ///< median of the slices' mean thickness, in the mesh's unit
    double within = absent;  ///< median over the slices of deviation / mean around each slice
    /// 1.4826 x median absolute deviation of the slices' means, over their median; absent for a single slice.
    double across = absent;
    double overall = absent;  ///< deviation / mean over all qualifying slices together, with equal weights
};
ThicknessHomogeneity thickness_homogeneity(const std::vector<Slice>& slices);

struct TubeOptions {
    double min_eccentricity = 0.7;
    double max_roundness = 0.1;
    double similarity = 0.1;
    std::uint64_t seed = 1;

    void list_options(OptionList& list);
};

struct Tube {
    bool found = false;
    std::string reason;               ///< why no tube was found
    std::size_t first = 0, last = 0;  ///< indices of the slices, sorted by height
    std::vector<int> cluster;         ///< cluster of each slice, sorted by height; -1: cannot belong to a tube
};

/// The longest run of consecutive slices (by height) that each have one closed, round outer contour and belong to the same
/// cluster. Round slices are clustered by three dimensionless values: equivalent radius over its median, eccentricity, relative
/// roundness. The clustering is k-means with the smallest number of clusters for which every cluster has an rms distance from
/// its centre of at most `similarity`. A single slice is not a tube. Throws Error (usage) unless there is one set of
/// descriptors per slice.
Tube tubular_part(const SliceStack& stack, const std::vector<SliceDescriptors>& descriptors, const TubeOptions& options = {});

}  // namespace ostraka

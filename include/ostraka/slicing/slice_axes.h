// Axes through the barycentres of slices, how straight these lie, how even the walls are, and which slices make a tube
// (thesis, section 3.2).
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/slicing/slice_descriptors.h"

#include <limits>
#include <string>

namespace ostraka {

/// In the mesh's frame, of the slices that have one, in the order of the stack. Of the material, or of the filled outline.
std::vector<Point> barycentres(const SliceStack& stack, const std::vector<SliceDescriptors>& descriptors,
                               bool of_outline = false);

struct SliceLine {
    Point point{0, 0, 0};
    Vector direction{0, 0, 1};  ///< unit vector that goes up the frame's normal
};

/// The line along the slices' normal through the mean of the barycentres (the choice of the thesis). Throws Error (input) without
/// barycentres.
SliceLine mean_line(const SliceFrame& frame, const std::vector<Point>& barycentres);
/// The line of least squared distance from the barycentres (total least squares). Throws Error (input) for fewer than two places.
SliceLine regression_line(const SliceFrame& frame, const std::vector<Point>& barycentres);

/// Distances of the barycentres from an axis.
struct Straightness {
    double mean = 0, deviation = 0, maximum = 0;  ///< unit; `deviation` with n - 1 (0 for one)
    double length = 0;                            ///< of the stretch of the axis that the barycentres stand along; unit
    double relative = 0;                          ///< mean / length; 0 where the length is
};
Straightness straightness(const std::vector<Point>& barycentres, const SliceLine& axis);
/// From a bent axis; the length is that of the poly-line. Throws Error (usage) for a poly-line without points.
Straightness straightness(const std::vector<Point>& barycentres, const std::vector<Point>& polyline);

/// How even the wall is. Absent (NaN) where no slice counts. A slice counts by its main outline and the main hole in it, if there
/// is nothing else of size: no other outer contour and no other hole of more than a fiftieth of theirs, as handles and feet make,
/// and no contours that cross.
struct ThicknessHomogeneity {
    static constexpr double absent = std::numeric_limits<double>::quiet_NaN();
    std::size_t slices = 0;   ///< that count
    std::size_t beside = 0;   ///< left out, since handles or other parts are beside or within the wall
    double mean = absent;     ///< median of the slices' means; unit
    double within = absent;   ///< median over the slices of deviation / mean around each
    double across = absent;   ///< 1.4826 x median distance of the slices' means from their median / that; absent for one slice
    double overall = absent;  ///< deviation / mean over all these slices together, each with the same weight
};
ThicknessHomogeneity thickness_homogeneity(const std::vector<Slice>& slices);

struct TubeOptions {
    double min_eccentricity = 0.7;
    double max_roundness = 0.1;
    double similarity = 0.1;
    std::uint64_t seed = 1;

    void describe(OptionList& visit);
};

struct Tube {
    bool found = false;
    std::string reason;               ///< why there is none
    std::size_t first = 0, last = 0;  ///< places of the slices, by height from the lowest
    std::vector<int> cluster;         ///< of each slice by height, -1: cannot belong to a tube
};

/// The longest run (by height) of slices, one above the other, that are one closed outer contour each, round, and of one group.
/// The slices that are round are grouped by three numbers without unit: equivalent radius over its median, eccentricity, relative
/// roundness; by k-means, with the least number of groups that leaves none with a larger rms distance from its centre than
/// `similarity`. One slice makes no tube. Throws Error (usage) unless there is one set of descriptors a slice.
Tube tubular_part(const SliceStack& stack, const std::vector<SliceDescriptors>& descriptors, const TubeOptions& options = {});

}  // namespace ostraka

#include "ostraka/slicing/clay.h"
#include "ostraka/core/angles.h"

#include "ostraka/geom/planar.h"
#include "ostraka/slicing/slice_descriptors.h"
#include "ostraka/stats/summary.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace ostraka {

namespace {

/// Values of one layer.
struct Layer {
    bool met = false, outlined = false, cavity = false, crossing = false;
    double material = 0;                          ///< area that may be clay
    double outline = 0;                           ///< area within outer contours
    double wall = 0, thinnest = 0, thickest = 0;  ///< layers with a cavity: mean, min and max thickness over the outline
};

/// Upper bound of the area that intersecting contours enclose together: the smaller of the sum of their areas and the area of
/// their convex hull.
double max_clay_area(const Slice& slice) {
    double sum = 0;
    std::vector<Eigen::Vector2d> points;
    for (const Contour& contour : slice.contours) {
        if (!contour.closed) continue;
        points.insert(points.end(), contour.points.begin(), contour.points.end());
        sum += contour.hole ? 0 : contour.area;
    }
    const auto hull = convex_hull(points);
    return std::min(sum, polygon_moments(hull, hull[0]).area);
}

Layer layer_of(const Slice& slice, const SliceDescriptors& descriptors) {
    Layer layer;
    layer.met = !slice.contours.empty();
    layer.crossing = !slice.completeness.has_areas();
    if (layer.crossing) {
        layer.outlined = true;
        layer.material = max_clay_area(slice), layer.outline = ClayVolume::unknown;
        return layer;
    }
    if (std::isnan(descriptors.area)) return layer;
    layer.outlined = true;
    layer.material = descriptors.area;
    layer.outline = descriptors.outline_area;
    layer.cavity = descriptors.holes > 0 && std::isfinite(descriptors.thickness_mean);
    if (layer.cavity) {
        layer.wall = descriptors.thickness_mean;
        layer.thinnest = descriptors.thickness_min, layer.thickest = descriptors.thickness_max;
    }
    return layer;
}

/// Lower bound of the clay of a slice: contours with a hole are taken as they are, others as hollow except for a wall.
double min_clay_area(const Slice& slice, double wall) {
    double sum = 0;
    std::vector<bool> holed(slice.contours.size(), false);
    for (const Contour& contour : slice.contours)
        if (contour.closed && contour.hole && contour.parent >= 0) holed[static_cast<std::size_t>(contour.parent)] = true;
    for (std::size_t i = 0; i < slice.contours.size(); ++i) {
        const Contour& contour = slice.contours[i];
        if (!contour.closed) continue;
        const double area = std::abs(contour.area);
        if (contour.hole) {
            if (contour.parent >= 0) sum -= area;
        } else {
            // The cavity, dilated by the wall thickness t, lies within the contour: by Brunn-Minkowski its area is at most that
            // of the circle of equal area with its radius reduced by t.
            const double inside = holed[i] ? 0 : std::max(0.0, std::sqrt(area / pi) - wall);
            sum += area - pi * inside * inside;
        }
    }
    return std::max(0.0, sum);
}

/// Interpolates layers that the object crosses without an outline from the nearest layers above and below.
void fill_between(std::vector<Layer>& layers) {
    const auto nearest_outlined = [&](std::size_t i, int step) {
        auto k = static_cast<long long>(i);
        while (k >= 0 && k < static_cast<long long>(layers.size()) && !layers[static_cast<std::size_t>(k)].outlined) k += step;
        return k;
    };
    const std::vector<Layer> original = layers;
    for (std::size_t i = 0; i < layers.size(); ++i) {
        if (!layers[i].met || layers[i].outlined) continue;
        const long long below = nearest_outlined(i, -1), above = nearest_outlined(i, 1);
        const bool has_below = below >= 0, has_above = above < static_cast<long long>(layers.size());
        if (!has_below && !has_above) continue;
        const double weight = !has_below ? 1 : !has_above ? 0 : (double(i) - double(below)) / double(above - below);
        const Layer& a = original[static_cast<std::size_t>(has_below ? below : above)];
        const Layer& b = original[static_cast<std::size_t>(has_above ? above : below)];
        layers[i].material = (1 - weight) * a.material + weight * b.material;
        layers[i].outline = (1 - weight) * a.outline + weight * b.outline;
    }
}

}  // namespace

ClayVolume clay_volume(const Mesh& mesh, const SliceFrame& frame, const ClayOptions& options) {
    check_options(options, "clay");
    const auto [lowest, highest] = height_range(mesh, frame);
    const SliceStack stack = slice_mesh(mesh, frame, slice_heights(lowest, highest, options.slices));
    const std::vector<SliceDescriptors> descriptors = describe_slices(stack.slices);
    std::vector<Layer> layers(stack.slices.size());
    for (std::size_t i = 0; i < layers.size(); ++i) layers[i] = layer_of(stack.slices[i], descriptors[i]);
    ClayVolume result;
    result.reversed = stack.reversed;
    for (const Slice& slice : stack.slices) result.reversed_slices += slice.completeness.reversed_contours > 0 ? 1 : 0;
    std::vector<double> thinnest, thickest;
    for (const Layer& layer : layers) {
        if (!layer.met) continue;
        ++result.slices;
        if (!layer.outlined) ++result.without_outline;
        if (layer.crossing) ++result.crossing;
        if (!layer.cavity) continue;
        if (result.with_cavity == 0) result.wall_mean = 0;
        ++result.with_cavity;
        result.wall_mean += layer.wall;
        thinnest.push_back(layer.thinnest), thickest.push_back(layer.thickest);
    }
    if (result.with_cavity > 0) {
        result.wall_mean /= result.with_cavity;
        result.wall_min = sample_quantile(thinnest, 0.05), result.wall_max = sample_quantile(thickest, 0.95);
    }
    result.wall = options.wall > 0 ? options.wall : result.wall_min;
    fill_between(layers);
    const double height = (highest - lowest) / options.slices;
    for (const Layer& layer : layers) {
        result.maximum += height * layer.material;
        result.envelope += height * layer.outline;
    }
    if (result.without_outline == result.slices) result.maximum = result.envelope = ClayVolume::unknown;
    if (std::isnan(result.wall) || std::isnan(result.maximum)) return result;
    result.minimum = 0;
    for (const Slice& slice : stack.slices) {
        if (!slice.completeness.has_areas()) continue;
        const bool at_end = std::min(slice.height - lowest, highest - slice.height) < result.wall;
        result.minimum += height * min_clay_area(slice, at_end ? std::numeric_limits<double>::infinity() : result.wall);
    }
    result.minimum = std::min(result.minimum, result.maximum);
    return result;
}

void ClayOptions::declare_options(OptionList& list) {
    list("slices", slices, "number of layers of equal height from which the volume is summed", Range{2, 1000000});
    list("wall", wall,
         "minimum thickness of walls whose inner side was not scanned; 0: the 5 % quantile of the thickness of scanned walls",
         Range{0, 1e60}, "the mesh's unit");
}

}  // namespace ostraka

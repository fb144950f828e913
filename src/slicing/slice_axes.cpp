// Axes, straightness, wall evenness, tubes.
#include "ostraka/slicing/slice_axes.h"

#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/line.h"
#include "ostraka/geom/shortest_path.h"
#include "ostraka/mesh/limits.h"
#include "ostraka/stats/k_means.h"
#include "ostraka/stats/summary.h"

#include <numeric>

namespace ostraka {

namespace {

Straightness summary_of(const std::vector<double>& distances, double length) {
    Straightness result;
    if (distances.empty()) return result;
    const Summary summary = summarise(distances);
    result.mean = summary.mean, result.deviation = summary.standard_deviation.value_or(0), result.maximum = summary.max;
    result.length = length;
    if (length > 0) result.relative = result.mean / length;
    return result;
}

bool may_belong(const Slice& slice, const SliceDescriptors& d, const TubeOptions& options) {
    return slice.completeness.complete() && d.components == 1 && d.eccentricity >= options.min_eccentricity &&
           d.roundness_equivalent_relative <= options.max_roundness;
}

struct Wall {
    double mean = ThicknessHomogeneity::absent, variance = 0;
    bool beside = false;  ///< there is more than the wall
};

/// Wall between the largest outer contour and the largest hole in it.
Wall wall_of(const Slice& slice) {
    Wall wall;
    if (!slice.completeness.has_areas()) return wall;
    const auto parts = components(slice);
    if (parts.empty() || parts[0].contours.size() < 2) return wall;
    const Contour &outer = parts[0].contours[0], &hole = parts[0].contours[1];
    const auto of_size = [](const Contour& contour, const Contour& main) {
        return std::abs(contour.area) > std::abs(main.area) / 50;
    };
    for (std::size_t k = 2; k < parts[0].contours.size(); ++k) wall.beside = wall.beside || of_size(parts[0].contours[k], hole);
    for (std::size_t k = 1; k < parts.size(); ++k) wall.beside = wall.beside || of_size(parts[k].contours[0], outer);
    if (wall.beside) return wall;
    Slice bare_wall = parts[0];
    bare_wall.contours.resize(2);
    const SliceDescriptors d = describe_slice(bare_wall);
    wall.mean = d.thickness_mean, wall.variance = d.thickness_variance;
    return wall;
}

/// k-means with the smallest number of clusters whose rms distances from their centres are small enough.
std::vector<int> similar_groups(const Eigen::MatrixXd& samples, const TubeOptions& options) {
    KMeansOptions means;
    means.seed = options.seed;
    for (means.clusters = 1;; ++means.clusters) {
        const KMeansResult groups = k_means(samples, means);
        std::vector<double> square(static_cast<std::size_t>(groups.centres.rows()), 0), count(square.size(), 0);
        for (Eigen::Index i = 0; i < samples.rows(); ++i) {
            const int label = groups.labels[static_cast<std::size_t>(i)];
            square[static_cast<std::size_t>(label)] += (samples.row(i) - groups.centres.row(label)).squaredNorm();
            count[static_cast<std::size_t>(label)] += 1;
        }
        bool homogeneous = true;
        for (std::size_t g = 0; g < square.size(); ++g)
            homogeneous = homogeneous && std::sqrt(square[g] / count[g]) <= options.similarity;
        if (homogeneous || means.clusters >= samples.rows()) return groups.labels;
    }
}

}  // namespace

std::vector<Point> barycentres(const SliceStack& stack, const std::vector<SliceDescriptors>& descriptors, bool of_outline) {
    std::vector<Point> points;
    for (std::size_t i = 0; i < stack.slices.size(); ++i) {
        const auto& barycentre = of_outline ? descriptors[i].outline_barycentre : descriptors[i].barycentre;
        if (barycentre.allFinite()) points.push_back(stack.frame.point(barycentre, stack.slices[i].height));
    }
    return points;
}

SliceLine mean_line(const SliceFrame& frame, const std::vector<Point>& barycentres) {
    if (barycentres.empty())
        fail_input("slices", "no slice has a barycentre", "choose heights where the mesh has closed contours");
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const auto& p : barycentres) sum += eigen(p) - eigen(barycentres[0]);
    return {barycentres[0] + vector_of(sum / double(barycentres.size())), frame.normal};
}

SliceLine regression_line(const SliceFrame& frame, const std::vector<Point>& barycentres) {
    std::vector<Eigen::Vector3d> points;
    for (const auto& p : barycentres) points.push_back(eigen(p));
    bool distinct = false;
    for (const auto& p : points) distinct = distinct || p != points[0];
    if (!distinct) fail_input("slices", "a line cannot be fitted to fewer than two distinct barycentres", "use more slices");
    const LineFit fit = fit_line(points, std::vector<double>(points.size(), 1));
    const Vector direction = unit_vector(vector_of(fit.direction));
    return {point_of(fit.point), direction * frame.normal < 0 ? -direction : direction};
}

Straightness straightness(const std::vector<Point>& barycentres, const SliceLine& axis) {
    std::vector<double> distances;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const auto& p : barycentres) {
        const double along = axis.direction * (p - axis.point);
        low = std::min(low, along), high = std::max(high, along);
        distances.push_back(std::sqrt(CGAL::cross_product(axis.direction, p - axis.point).squared_length()));
    }
    return summary_of(distances, high - low);
}

Straightness straightness(const std::vector<Point>& barycentres, const std::vector<Point>& polyline) {
    if (polyline.empty()) fail_usage("the axis has no points", "give a poly-line");
    std::vector<double> distances;
    double length = 0;
    for (std::size_t i = 1; i < polyline.size(); ++i) length += std::sqrt((polyline[i] - polyline[i - 1]).squared_length());
    for (const auto& p : barycentres) distances.push_back(distance_to_polyline(p, polyline));
    return summary_of(distances, length);
}

ThicknessHomogeneity thickness_homogeneity(const std::vector<Slice>& slices) {
    std::vector<Wall> walls(slices.size());
    parallel_for(slices.size(), 1, [&](std::size_t i) { walls[i] = wall_of(slices[i]); });
    ThicknessHomogeneity result;
    std::vector<double> means, within;
    double first = 0, second = 0;
    for (const Wall& wall : walls) {
        if (wall.beside) ++result.beside;
        if (!std::isfinite(wall.mean)) continue;
        means.push_back(wall.mean);
        if (wall.mean > 0) within.push_back(std::sqrt(wall.variance) / wall.mean);
        first += wall.mean, second += wall.variance + wall.mean * wall.mean;
    }
    result.slices = means.size();
    if (means.empty()) return result;
    result.mean = sample_quantile(means, 0.5);
    if (!within.empty()) result.within = sample_quantile(within, 0.5);
    first /= double(means.size()), second /= double(means.size());
    if (first > 0) result.overall = std::sqrt(std::max(0.0, second - first * first)) / first;
    if (means.size() > 1 && result.mean > 0) {
        for (double& mean : means) mean = std::abs(mean - result.mean);
        result.across = 1.4826 * sample_quantile(means, 0.5) / result.mean;
    }
    return result;
}

Tube tubular_part(const SliceStack& stack, const std::vector<SliceDescriptors>& descriptors, const TubeOptions& options) {
    check_options(options, "tube");
    if (descriptors.size() != stack.slices.size())
        fail_usage("the number of descriptors differs from the number of slices", "describe each slice");
    const std::size_t n = stack.slices.size();
    std::vector<std::size_t> order(n);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return stack.slices[a].height < stack.slices[b].height; });
    Tube tube;
    tube.cluster.assign(n, -1);
    std::vector<std::size_t> candidates;
    for (std::size_t i = 0; i < n; ++i)
        if (may_belong(stack.slices[order[i]], descriptors[order[i]], options)) candidates.push_back(i);
    if (candidates.size() < 2) {
        tube.reason = "fewer than two slices are round, complete and have exactly one outer contour";
        return tube;
    }
    std::vector<double> radii;
    for (const std::size_t i : candidates) radii.push_back(descriptors[order[i]].equivalent_radius);
    const double median = summarise(radii).median;
    Eigen::MatrixXd samples(candidates.size(), 3);
    for (std::size_t k = 0; k < candidates.size(); ++k) {
        const auto& d = descriptors[order[candidates[k]]];
        samples.row(static_cast<Eigen::Index>(k)) << d.equivalent_radius / median, d.eccentricity,
            d.roundness_equivalent_relative;
    }
    const auto labels = similar_groups(samples, options);
    for (std::size_t k = 0; k < candidates.size(); ++k) tube.cluster[candidates[k]] = labels[k];
    double longest = 0;
    for (std::size_t i = 0; i < n;) {
        std::size_t j = i;
        while (j + 1 < n && tube.cluster[j + 1] == tube.cluster[i]) ++j;
        const double length = stack.slices[order[j]].height - stack.slices[order[i]].height;
        if (tube.cluster[i] >= 0 && length > longest) longest = length, tube.first = i, tube.last = j, tube.found = true;
        i = j + 1;
    }
    if (!tube.found) tube.reason = "no two consecutive slices belong to the same group";
    return tube;
}

void TubeOptions::declare_options(OptionList& list) {
    list("min-eccentricity", min_eccentricity,
         "tube: minimum ratio of short to long side of the smallest rectangle around a slice", Range{0, 1});
    list("max-roundness", max_roundness, "tube: maximum mean distance of a slice's outline from its fitted circle", Range{0, 10},
         "share of the radius");
    list("similarity", similarity,
         "tube: maximum root mean square distance of the slices of a group from the group's centre, in dimensionless shape "
         "descriptors",
         Range{1e-6, 1e6});
    list("tube-seed", seed, "tube: random seed of the grouping of slices", Range{0, 1e18});
}

}  // namespace ostraka

#include "ostraka/select/slice_segments.h"

#include "ostraka/annotation/colouring.h"
#include "ostraka/annotation/label_file.h"
#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/slicing/slice.h"
#include "ostraka/slicing/slice_descriptors.h"
#include "ostraka/stats/scores.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

struct LabelRun {
    std::size_t begin = 0, end = 0;
    int cluster = 0;
    [[nodiscard]] std::size_t size() const { return end - begin; }
};

std::vector<LabelRun> runs_of(const std::vector<int>& labels) {
    std::vector<LabelRun> runs;
    for (std::size_t i = 0; i < labels.size(); ++i) {
        if (runs.empty() || runs.back().cluster != labels[i]) runs.push_back({i, i, labels[i]});
        runs.back().end = i + 1;
    }
    return runs;
}

/// Gives each slice without a cluster that of the nearest slice that has one (of two, the lower).
void fill_gaps(std::vector<int>& labels) {
    const std::vector<int> known = labels;
    const auto n = static_cast<std::ptrdiff_t>(labels.size());
    for (std::ptrdiff_t i = 0; i < n; ++i)
        for (std::ptrdiff_t away = 1; away < n && labels[static_cast<std::size_t>(i)] < 0; ++away)
            for (const std::ptrdiff_t j : {i - away, i + away})
                if (j >= 0 && j < n && labels[static_cast<std::size_t>(i)] < 0)
                    labels[static_cast<std::size_t>(i)] = known[static_cast<std::size_t>(j)];
}

void join_short_runs(std::vector<int>& labels, std::size_t minimum) {
    for (;;) {
        const std::vector<LabelRun> runs = runs_of(labels);
        if (runs.size() < 2) return;
        const auto shortest =
            std::min_element(runs.begin(), runs.end(), [](const LabelRun& a, const LabelRun& b) { return a.size() < b.size(); });
        if (shortest->size() >= minimum) return;
        const bool has_below = shortest != runs.begin(), has_above = shortest + 1 != runs.end();
        const bool below = has_below && (!has_above || (shortest - 1)->size() >= (shortest + 1)->size());
        const int joined = below ? (shortest - 1)->cluster : (shortest + 1)->cluster;
        std::fill(labels.begin() + static_cast<std::ptrdiff_t>(shortest->begin),
                  labels.begin() + static_cast<std::ptrdiff_t>(shortest->end), joined);
    }
}

/// Descriptors, one row per slice with a closed outline; `slices` receives the indices of these slices.
Eigen::MatrixXd sample_table(const std::vector<SliceDescriptors>& described, double height, bool size,
                             std::vector<std::size_t>& slices) {
    const Eigen::Index columns = size ? 8 : 7;
    for (std::size_t i = 0; i < described.size(); ++i)
        if (std::isfinite(described[i].elongation)) slices.push_back(i);
    Eigen::MatrixXd samples(static_cast<Eigen::Index>(slices.size()), columns);
    for (std::size_t row = 0; row < slices.size(); ++row) {
        const SliceDescriptors& d = described[slices[row]];
        Eigen::VectorXd values(columns);
        values.head(7) << d.elongation, d.solidity, d.compactness, d.circular_variance, d.rectangular_variance,
            static_cast<double>(d.euler_number), d.hole_area_ratio;
        if (size) values[7] = d.equivalent_radius / height;
        samples.row(static_cast<Eigen::Index>(row)) = values;
    }
    return samples;
}

}  // namespace

SliceSegments segment_by_slices(const Mesh& mesh, const Vector& up, const SliceSegmentOptions& options) {
    check_options(options, "segments by slices");
    const SliceFrame frame = slice_frame(Point(0, 0, 0), up);
    const auto [low, high] = height_range(mesh, frame);
    const double height = high - low;
    if (!(height > 0)) fail_input("mesh", "has no height along its upward direction", "check --up, or repair the mesh");
    SliceSegments result;
    result.descriptors = {"elongation",           "solidity",     "compactness",    "circular variance",
                          "rectangular variance", "Euler number", "hole-area ratio"};
    if (options.size) result.descriptors.emplace_back("radius");
    const std::vector<double> heights = slice_heights(low, high, options.slices);
    for (const double each : heights) result.heights.push_back(each - low);
    const SliceStack stack = slice_mesh(mesh, frame, heights);
    const auto described = describe_slices(stack.slices);
    std::vector<std::size_t> numbers;
    const Eigen::MatrixXd samples = sample_table(described, height, options.size, numbers);
    if (numbers.size() < 4)
        fail_input("mesh", "only " + std::to_string(numbers.size()) + " slices have a closed outline",
                   "fill the holes (ostraka mesh repair), or ask for more slices");
    const Eigen::MatrixXd standard = standardised(samples);
    result.count = propose_cluster_count(standard, options.count);
    KMeansOptions k_means_options = options.count.k_means;
    k_means_options.clusters = options.clusters > 0 ? options.clusters : result.count.proposed;
    const KMeansResult found = k_means(standard, k_means_options);
    result.clusters = static_cast<int>(found.centres.rows());
    result.raw.assign(heights.size(), -1);
    for (std::size_t row = 0; row < numbers.size(); ++row) result.raw[numbers[row]] = found.labels[row];
    result.labels = result.raw;
    fill_gaps(result.labels);
    join_short_runs(result.labels, static_cast<std::size_t>(options.min_run));

    const double layer = height / static_cast<double>(heights.size());
    std::vector<std::int32_t> segment_of(heights.size());
    for (const LabelRun& run : runs_of(result.labels)) {
        for (std::size_t i = run.begin; i < run.end; ++i) segment_of[i] = static_cast<std::int32_t>(result.segments.size());
        result.segments.push_back(
            {run.cluster, layer * static_cast<double>(run.begin), layer * static_cast<double>(run.end), run.size()});
    }
    result.face_segments.resize(mesh.number_of_faces());
    parallel_for(result.face_segments.size(), [&](std::size_t f) {
        const double at = (frame.height(centroid(mesh, Face(static_cast<Index>(f)))) - low) / layer;
        const auto slice = std::min(static_cast<std::size_t>(std::max(at, 0.0)), heights.size() - 1);
        result.face_segments[f] = segment_of[slice];
    });
    return result;
}

AnnotationSet annotate_segments(const Mesh& mesh, const SliceSegments& segments) {
    std::map<std::int32_t, std::string> names;
    for (std::size_t i = 0; i < segments.segments.size(); ++i)
        names[static_cast<std::int32_t>(i)] = "segment " + std::to_string(i + 1);
    AnnotationSet set = regions_from_labels(mesh, segments.face_segments, names);
    for (Annotation& region : set.annotations)
        region.colour = distinct_colour(static_cast<std::size_t>(segments.segments[static_cast<std::size_t>(region.id)].cluster));
    return set;
}

std::optional<double> segment_agreement(const SliceSegments& segments, const std::vector<std::int32_t>& known) {
    std::vector<int> found, truth;
    for (std::size_t f = 0; f < known.size(); ++f) {
        if (known[f] < 0) continue;
        found.push_back(segments.face_segments[f]);
        truth.push_back(known[f]);
    }
    return found.empty() ? std::nullopt : std::optional(adjusted_rand_index(found, truth));
}

void SliceSegmentOptions::declare_options(OptionList& list) {
    list("slices", slices, "number of evenly spaced slices across the object", Range{4, 10000});
    list("clusters", clusters, "number of clusters of slices; 0: the number that --criterion proposes", Range{0, 1000});
    list("min-run", min_run,
         "minimum number of consecutive slices of one cluster that form a segment; a shorter run joins the longer neighbouring "
         "run",
         Range{1, 1000});
    list("size", size, "also cluster by the size of slices: the radius of the circle with the same area", Anything{});
    count.declare_options(list);
}

}  // namespace ostraka

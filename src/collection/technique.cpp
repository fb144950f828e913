#include "ostraka/collection/technique.h"

#include "collection/outline_harmonics.h"

#include "ostraka/algebra/dense.h"
#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/files/json_build.h"
#include "ostraka/geom/circle.h"
#include "ostraka/slicing/slice.h"
#include "ostraka/slicing/slice_descriptors.h"

#include <fmt/core.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <optional>

namespace ostraka {

namespace {

constexpr double unknown = TechniqueSlice::unknown;

/// The slice reduced to one contour and the holes directly in it.
Slice only_contour(const Slice& slice, std::size_t outline) {
    Slice part;
    part.height = slice.height;
    part.contours.push_back(slice.contours[outline]);
    part.contours[0].parent = -1;
    part.contours[0].depth = 0;
    for (const Contour& contour : slice.contours) {
        if (!contour.hole || contour.parent != static_cast<int>(outline)) continue;
        part.contours.push_back(contour);
        part.contours.back().parent = 0;
        part.contours.back().depth = 1;
    }
    return part;
}

/// The outline of the body: the longest contour; a hole only if there is no other contour.
std::optional<std::size_t> main_outline(const Slice& slice) {
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < slice.contours.size(); ++i) {
        const Contour& contour = slice.contours[i];
        if (contour.closed && contour.hole) continue;
        if (!best || contour.length > slice.contours[*best].length) best = i;
    }
    return best;
}

/// Measures of one slice of the body; only the angular coverage if its outline is too open.
TechniqueSlice measure_slice(const Slice& slice, std::size_t outline, double min_turn) {
    TechniqueSlice result;
    const Slice body = only_contour(slice, outline);
    const SliceDescriptors d = describe_slice(body);
    const Contour& contour = body.contours[0];
    Circle circle{d.fitted_centre, contour.closed ? d.fitted_radius : -1};
    double roundness = d.roundness_fitted_relative;
    if (!contour.closed) {
        PlaneSegments segments;
        for (std::size_t i = 0; i + 1 < contour.points.size(); ++i)
            segments.emplace_back(contour.points[i], contour.points[i + 1]);
        circle = fit_circle(segments);
        roundness = circle_deviation(segments, circle).absolute / circle.radius;  // of an almost full turn
    }
    if (!(circle.radius > 0)) return result;
    const OutlineHarmonics shape = outline_harmonics(contour, circle.centre);
    result.turn = contour.closed ? 1 : shape.turn;
    if (result.turn < min_turn) return result;
    result.radius = circle.radius;
    result.centre = {circle.centre.x(), circle.centre.y()};
    result.roundness = roundness;
    result.ovality = {shape.cosine[2] / shape.radius, shape.sine[2] / shape.radius};
    double squares = 0;
    for (std::size_t k = 3; k <= max_harmonics; ++k)
        squares += 0.5 * (shape.cosine[k] * shape.cosine[k] + shape.sine[k] * shape.sine[k]);
    result.marks = std::sqrt(squares) / shape.radius;
    if (!contour.closed) return result;
    result.roundness_equivalent = d.roundness_equivalent_relative;
    result.eccentricity = d.eccentricity;
    if (std::isfinite(d.thickness_mean)) {
        result.thickness = d.thickness_mean / d.fitted_radius;
        result.thickness_deviation = std::sqrt(std::max(d.thickness_variance, 0.0)) / d.fitted_radius;
    }
    return result;
}

/// Mean and variance (divisor n - 1) of one value over the slices where it is known.
struct Moments {
    std::size_t count = 0;
    double mean = unknown, variance = unknown;
};
template <class Value>
Moments moments(const std::vector<TechniqueSlice>& slices, Value&& value) {
    Moments m;
    double sum = 0, squares = 0;
    for (const auto& slice : slices)
        if (std::isfinite(value(slice))) sum += value(slice), ++m.count;
    if (m.count == 0) return m;
    m.mean = sum / static_cast<double>(m.count);
    for (const auto& slice : slices)
        if (std::isfinite(value(slice))) squares += (value(slice) - m.mean) * (value(slice) - m.mean);
    if (m.count > 1) m.variance = squares / static_cast<double>(m.count - 1);
    return m;
}

/// Distances of the centres from their fitted line x = a + b h, y = c + d h and from their mean, relative to the mean radius.
struct LineDeviation {
    double line = unknown, upright = unknown;
    std::size_t count = 0;
};
LineDeviation line_deviation(const std::vector<TechniqueSlice>& slices) {
    LineDeviation result;
    result.count = slices.size();
    if (slices.size() < 3) return result;
    const auto n = static_cast<Eigen::Index>(slices.size());
    Eigen::MatrixXd A(n, 2), B(n, 2);
    double radius = 0;
    for (Eigen::Index i = 0; i < n; ++i) {
        const TechniqueSlice& slice = slices[static_cast<std::size_t>(i)];
        A.row(i) << 1, slice.height;
        B.row(i) << slice.centre[0], slice.centre[1];
        radius += slice.radius;
    }
    radius /= static_cast<double>(n);
    const Eigen::MatrixXd residual = B - A * solve_full_rank(A, B);
    result.line = std::sqrt(residual.squaredNorm() / static_cast<double>(n)) / radius;
    result.upright = (B.rowwise() - B.colwise().mean()).rowwise().norm().mean() / radius;
    return result;
}

}  // namespace

const std::vector<DescriptorMeaning>& technique_descriptors() {
    static const std::vector<DescriptorMeaning> meanings{
        {"roundness mean", "mean distance from the fitted circle", true},
        {"roundness variance", "variance of that over the slices", true},
        {"equivalent roundness mean", "mean distance from the circle of equal area", true},
        {"equivalent roundness variance", "variance of that over the slices", true},
        {"eccentricity mean", "mean ratio of the sides of the smallest rectangle", false},
        {"eccentricity variance", "variance of that over the slices", true},
        {"ovality", "second harmonic of the radius, root mean square", true},
        {"marks", "harmonics 3 to 6 of the radius, root mean square", true},
        {"coherence", "how far all slices are oval in one direction", false},
        {"straightness", "centres' distance from their straight line, root mean square", true},
        {"upright straightness", "centres' mean distance from the upright line through their mean", true},
        {"wall variation", "deviation of the thickness around a slice, over its mean", true}};
    return meanings;
}

double TechniqueMeasures::value(const std::string& descriptor) const {
    for (const TechniqueDescriptor& descriptor_value : descriptors)
        if (descriptor_value.name == descriptor) return descriptor_value.value;
    return unknown;
}

void describe_technique(TechniqueMeasures& measures) {
    const auto& slices = measures.slices;
    measures.descriptors.clear();
    const auto add = [&](const std::string& name, double value, std::size_t count) {
        measures.descriptors.push_back({name, value, count});
    };
    const auto add_moments = [&](const std::string& name, const Moments& m) {
        add(name + " mean", m.mean, m.count);
        add(name + " variance", m.variance, m.count);
    };
    add_moments("roundness", moments(slices, [](const auto& s) { return s.roundness; }));
    add_moments("equivalent roundness", moments(slices, [](const auto& s) { return s.roundness_equivalent; }));
    add_moments("eccentricity", moments(slices, [](const auto& s) { return s.eccentricity; }));
    const auto amplitude = [](const TechniqueSlice& s) { return std::hypot(s.ovality[0], s.ovality[1]); };
    const Moments oval = moments(slices, [&](const auto& s) { return amplitude(s) * amplitude(s); });
    add("ovality", std::sqrt(oval.mean), oval.count);
    const Moments mark_moments = moments(slices, [](const auto& s) { return s.marks * s.marks; });
    add("marks", std::sqrt(mark_moments.mean), mark_moments.count);
    const Moments x = moments(slices, [](const auto&s) { return s.ovality[0]; }),
                  y = moments(slices, [](const auto&s) { return s.ovality[1]; }), length = moments(slices, amplitude);
    add("coherence", length.mean > 0 ? std::hypot(x.mean, y.mean) / length.mean : unknown, length.count);
    const LineDeviation straight = line_deviation(slices);
    add("straightness", straight.line, straight.count);
    add("upright straightness", straight.upright, straight.count);
    const Moments wall = moments(slices, [](const auto& s) { return s.thickness; });
    const Moments uneven = moments(slices, [](const auto& s) { return s.thickness_deviation * s.thickness_deviation; });
    add("wall variation", wall.mean > 0 ? std::sqrt(uneven.mean) / wall.mean : unknown, uneven.count);
}

TechniqueMeasures measure_technique(const Mesh& mesh, const Vector& up, const TechniqueOptions& options) {
    check_options(options, "technique");
    if (!(options.from < options.to))
        fail_usage(fmt::format("the slices begin at {} of the height and end at {}", std::to_string(options.from),
                               std::to_string(options.to)),
                   "give a value of --from that is below --to");
    const SliceFrame frame = slice_frame(Point(0, 0, 0), up);
    const auto [low, high] = height_range(mesh, frame);
    if (!(high > low)) fail_input("mesh", "has no height along its upward direction", "check --up, or repair the mesh");
    const double height = high - low;
    const SliceStack stack =
        slice_mesh(mesh, frame, slice_heights(low + options.from * height, low + options.to * height, options.slices));

    TechniqueMeasures result;
    result.asked = stack.slices.size();
    std::vector<std::optional<TechniqueSlice>> measured(stack.slices.size());
    parallel_for(stack.slices.size(), 1, [&](std::size_t i) {
        const Slice& slice = stack.slices[i];
        const auto outline = main_outline(slice);
        if (!outline) return;
        measured[i] = measure_slice(slice, *outline, options.min_turn);
        measured[i]->height = (slice.height - low) / height;
    });
    for (const auto& slice : measured) {
        if (!slice) ++result.empty;
        else if (!std::isfinite(slice->radius)) ++result.too_open;
        else {
            if (slice->turn < 1) ++result.open_used;
            result.slices.push_back(*slice);
        }
    }
    if (result.slices.size() < static_cast<std::size_t>(options.min_slices))
        fail_input("mesh",
                   fmt::format("only {} of {} slices can be used: {} are too open, {} have no outline", result.slices.size(),
                               result.asked, result.too_open, result.empty),
                   "fill the holes (ostraka mesh repair), check --up, or lower --min-turn or --min-slices");
    describe_technique(result);
    return result;
}

namespace {

JsonValue number_or_null(double value) { return std::isfinite(value) ? JsonValue(value) : JsonValue(rapidjson::kNullType); }
double number_of(const JsonValue& value) { return value.IsNumber() ? value.GetDouble() : unknown; }

}  // namespace

Json technique_to_json(const TechniqueMeasures& measures) {
    Json json(rapidjson::kObjectType);
    auto& allocator = json.GetAllocator();
    JsonValue slices(rapidjson::kArrayType);
    for (const TechniqueSlice& s : measures.slices) {
        JsonValue row(rapidjson::kArrayType);
        for (const double value : {s.height, s.turn, s.radius, s.centre[0], s.centre[1], s.roundness, s.roundness_equivalent,
                                   s.eccentricity, s.ovality[0], s.ovality[1], s.marks, s.thickness, s.thickness_deviation})
            row.PushBack(number_or_null(value), allocator);
        slices.PushBack(row, allocator);
    }
    add_members(json, allocator, "slices", std::move(slices), "asked", measures.asked, "empty", measures.empty, "tooOpen",
                measures.too_open, "openUsed", measures.open_used);
    return json;
}

TechniqueMeasures technique_from_json(const JsonValue& json) {
    TechniqueMeasures measures;
    for (const auto& row : json["slices"].GetArray()) {
        std::array<double, 13> v{};
        for (rapidjson::SizeType i = 0; i < v.size(); ++i) v.at(i) = number_of(row[i]);
        measures.slices.push_back({v[0], v[1], v[2], {v[3], v[4]}, v[5], v[6], v[7], {v[8], v[9]}, v[10], v[11], v[12]});
    }
    measures.asked = json["asked"].GetUint64();
    measures.empty = json["empty"].GetUint64();
    measures.too_open = json["tooOpen"].GetUint64();
    measures.open_used = json["openUsed"].GetUint64();
    describe_technique(measures);
    return measures;
}

void TechniqueOptions::declare_options(OptionList& list) {
    list("slices", slices, "number of slices per object", Range{2, 100000});
    list("from", from, "lower end of the sliced range of each object", Range{0, 1}, "share of the height");
    list("to", to, "upper end of the sliced range of each object (thesis: 0.4)", Range{0, 1}, "share of the height");
    list("min-turn", min_turn, "slices with an open outline are used only if the outline covers at least this share",
         Range{0.5, 1}, "share of the full turn");
    list("min-slices", min_slices, "minimum number of usable slices per object", Range{2, 100000});
}

}  // namespace ostraka

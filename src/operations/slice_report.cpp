#include "operations/slice_report.h"

#include "ostraka/core/angles.h"
#include "ostraka/core/text.h"
#include "ostraka/files/csv.h"
#include "ostraka/files/json_build.h"
#include "ostraka/render/colour_scale.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace ostraka {

using namespace fields;

namespace {

/// Descriptors shown to people, in this order: name, title, number of digits.
struct ShownDescriptor {
    std::string_view name, title;
    int digits;
};
constexpr std::array<ShownDescriptor, 8> shown_descriptors{{{"area", "area", 4},
                                                            {"perimeter", "perimeter", 4},
                                                            {"eccentricity", "m/M", 3},
                                                            {"solidity", "solidity", 3},
                                                            {"compactness", "compactness", 3},
                                                            {"roundness_fitted_relative", "off circle %", 3},
                                                            {"hole_area_ratio", "hole ratio", 3},
                                                            {"thickness_mean", "thickness", 3}}};

const ShownDescriptor* shown_descriptor(std::string_view name) {
    const auto descriptor =
        std::find_if(shown_descriptors.begin(), shown_descriptors.end(), [&](const auto& entry) { return entry.name == name; });
    return descriptor == shown_descriptors.end() ? nullptr : &*descriptor;
}

bool is_slice_count(std::string_view name) { return name == "components" || name == "holes" || name == "euler_number"; }

Field descriptor_field(const NamedDescriptor& entry) {
    const ShownDescriptor* shown = shown_descriptor(entry.name);
    return {"descriptors." + std::string(entry.name), is_slice_count(entry.name) ? FieldType::integer : FieldType::number,
            std::string(shown == nullptr ? "" : shown->title), std::string(entry.unit) == "area" ? "length^2" : entry.unit};
}

std::vector<double> slice_triple(const Vector& v) { return {v.x(), v.y(), v.z()}; }
std::vector<double> slice_triple(const Point& p) { return {p.x(), p.y(), p.z()}; }

/// JSON list; numbers that are not finite become null.
JsonValue slice_list(const std::vector<double>& values, JsonAllocator& allocator) {
    std::vector<std::optional<double>> finite_values;
    for (const double x : values) finite_values.push_back(std::isfinite(x) ? std::optional(x) : std::nullopt);
    return json_value(finite_values, allocator);
}
JsonValue slice_points(const std::vector<Eigen::Vector2d>& points, JsonAllocator& allocator) {
    return json_list(points, allocator, [&](const auto& p) { return slice_list({p.x(), p.y()}, allocator); });
}

JsonValue slice_json(const SliceFrame& frame, JsonAllocator& allocator) {
    const auto coordinates = [&](const auto& vector) { return slice_list(slice_triple(vector), allocator); };
    return json_object(allocator, "origin", coordinates(frame.origin), "u", coordinates(frame.u), "v", coordinates(frame.v),
                       "normal", coordinates(frame.normal));
}

JsonValue slice_json(const Contour& contour, JsonAllocator& allocator) {
    JsonValue object = json_object(allocator, "closed", contour.closed);
    if (contour.closed) {
        add_members(object, allocator, "hole", contour.hole, "parent", contour.parent, "depth", contour.depth, "area",
                    contour.area);
        if (contour.crosses) add_members(object, allocator, "crosses", true);
        if (contour.reversed) add_members(object, allocator, "reversed", true);
    } else {
        add_members(object, allocator, "gap", contour.gap);
    }
    add_members(object, allocator, "length", contour.length, "points", slice_points(contour.points, allocator));
    return object;
}

JsonValue slice_json(const MedialAxis& medial, JsonAllocator& allocator) {
    const auto branch_json = [&](const MedialAxis::Branch& branch) {
        return json_object(allocator, "points", slice_points(branch.points, allocator), "radii",
                           slice_list(branch.radii, allocator));
    };
    return json_list(medial.levels, allocator, [&](const MedialAxis::Level& level) {
        return json_object(allocator, "residue", level.residue, "length", level.length, "branches",
                           json_list(level.branches, allocator, branch_json));
    });
}

void add_slice_completeness(Report::Row& row, const Slice& slice) {
    const Completeness& c = slice.completeness;
    const bool empty = slice.contours.empty();
    row("completeness.empty", empty)("completeness.complete", !empty && c.complete());
    row.shown("completeness.share", "empty");
    if (empty) return;
    const auto percent = [](double share) { return number(100 * share, 3); };
    std::string shown = percent(c.share);
    if (!std::isfinite(c.share)) shown = "at most " + percent(c.share_at_most);
    else if (c.share_low < c.share_high) shown += fmt::format(" ({} to {})", percent(c.share_low), percent(c.share_high));
    row("completeness.closed_share", c.closed_share)("completeness.share", c.share)("completeness.share_low", c.share_low)(
        "completeness.share_high", c.share_high)("completeness.share_at_most", c.share_at_most)(
        "completeness.angle_degrees", c.angle() / degree)("completeness.crossing_contours", c.crossing)(
        "completeness.turned_contours", c.reversed_contours)("completeness.doubtful_share", c.doubtful);
    row.shown("completeness.share", shown);
}

void add_slice_descriptors(Report::Row& row, const SliceDescriptors& descriptors) {
    for (const auto& [name, unit, value] : list_descriptors(descriptors)) {
        const std::string key = "descriptors." + std::string(name);
        const ShownDescriptor* shown = shown_descriptor(name);
        if (is_slice_count(name) && std::isfinite(value)) row(key, static_cast<int>(value));
        else row(key, value, shown == nullptr ? "" : number(shown->title.ends_with('%') ? 100 * value : value, shown->digits));
    }
}

void add_one_slice(Report& report, const SlicedObject& cut, std::size_t i) {
    auto& allocator = report.allocator();
    const Slice& slice = cut.slices[i];
    Report::Row row = report.row("slices");
    row.shown("slice", std::to_string(i + 1)).shown("contours", std::to_string(slice.contours.size()));
    row("height", slice.height)("frame", slice_json(cut.frames[i], allocator));
    add_slice_completeness(row, slice);
    add_slice_descriptors(row, cut.descriptors[i]);
    if (const auto profile = thickness_profile(slice, 72); !profile.empty())
        row("thickness_profile", slice_list(profile, allocator));
    row("contours", json_list(slice.contours, allocator, [&](const auto& contour) { return slice_json(contour, allocator); }));
    if (!cut.medial.empty()) row("medial_axis", slice_json(cut.medial[i], allocator));
}

void add_compared_axis(Report& report, const ComparedAxis& axis) {
    auto& allocator = report.allocator();
    Report::Row row = report.row("axes");
    row("name", axis.name)("found", axis.reason.empty());
    if (!axis.reason.empty()) {
        row("reason", axis.reason).shown("straightness.relative", axis.reason);
        return;
    }
    if (axis.polyline.empty()) {
        row("point", slice_triple(axis.line.point))("direction", slice_triple(axis.line.direction));
    } else {
        const auto point = [&](const Point& p) { return slice_list(slice_triple(p), allocator); };
        row("polyline", json_list(axis.polyline, allocator, point));
    }
    const Straightness& s = axis.straightness;
    row("straightness.mean_distance", s.mean)("straightness.deviation", s.deviation)("straightness.largest_distance", s.maximum)(
        "straightness.length", s.length)("straightness.relative", s.relative, number(100 * s.relative, 3));
}

void add_slice_thickness(Report& report, const SliceFindings& findings) {
    const ThicknessHomogeneity& t = findings.thickness;
    report("thickness.slices", t.slices)("thickness.slices_with_parts_beside", t.beside)("thickness.mean", t.mean)(
        "thickness.variation_within", t.within)("thickness.variation_across", t.across)("thickness.variation_overall", t.overall);
    const auto percent = [](double share) { return std::isfinite(share) ? number(100 * share, 3) : std::string("-"); };
    if (std::isfinite(t.mean))
        report.line(fmt::format(
            "\nwall {}{}: varies by {} % within slices, {} (medians; {} of {} slices show the wall alone)", number(t.mean),
            findings.unit.empty() ? "" : " " + findings.unit, percent(t.within),
            t.slices < 2 ? "and the variation between slices needs two of them" : percent(t.across) + " % between them", t.slices,
            findings.cut.slices.size()));
    else if (t.beside > 0) report.line("\nno slice shows the wall alone: all that do have handles or other parts beside it");
}

void add_slice_tube(Report& report, const SliceFindings& findings) {
    const Tube& tube = findings.tube;
    report("tube.found", tube.found);
    if (tube.found) {
        const auto heights = findings.cut.sorted_heights();
        report("tube.lowest", heights[tube.first])("tube.highest", heights[tube.last]);
        report.line(fmt::format("\ntubular from {} to {}{} ({} slices)", number(heights[tube.first]), number(heights[tube.last]),
                                findings.unit.empty() ? "" : " " + findings.unit, tube.last - tube.first + 1));
    } else {
        report("tube.reason", tube.reason);
        report.line("\nno tubular part: " + tube.reason);
    }
    report("tube.groups_by_height", json_value(tube.cluster, report.allocator()));
}

}  // namespace

void declare_slices(ReportLayout& layout) {
    layout.values(text("unit"), text("planes"), boolean("reversed"), numbers("heights_of_the_mesh", "", "length"));
    std::vector<Field> columns{text_only("slice"),
                               number("height", "height", "length"),
                               text_only("contours"),
                               any("frame"),
                               boolean("completeness.empty"),
                               boolean("completeness.complete"),
                               number("completeness.closed_share", "", "fraction of the contours"),
                               number("completeness.share_low", "", "fraction of the outline"),
                               number("completeness.share_high", "", "fraction of the outline"),
                               number("completeness.share_at_most", "", "fraction of the outline"),
                               number("completeness.angle_degrees", "", "degrees"),
                               integer("completeness.crossing_contours"),
                               integer("completeness.turned_contours"),
                               number("completeness.doubtful_share", "", "fraction of the outer area")};
    const auto descriptors = list_descriptors({});
    for (const ShownDescriptor& shown : shown_descriptors)
        for (const auto& entry : descriptors)
            if (entry.name == shown.name) columns.push_back(descriptor_field(entry));
    for (const auto& entry : descriptors)
        if (shown_descriptor(entry.name) == nullptr) columns.push_back(descriptor_field(entry));
    columns.insert(columns.end(),
                   {number("completeness.share", "complete %"), any("thickness_profile"), any("contours"), any("medial_axis")});
    layout.table("slices", std::move(columns));
    layout.table("axes", text("name", "axis"), boolean("found"), text("reason"), numbers("point", "", "length"),
                 numbers("direction"), any("polyline"), number("straightness.mean_distance", "mean distance", "length"),
                 number("straightness.deviation", "", "length"), number("straightness.largest_distance", "largest", "length"),
                 number("straightness.length", "length", "length"), number("straightness.relative", "mean / length %"));
    layout.values(integer("thickness.slices"), integer("thickness.slices_with_parts_beside"),
                  number("thickness.mean", "", "length"));
    for (const char* part : {"within", "across", "overall"})
        layout.values(number("thickness.variation_" + std::string(part), "", "fraction of the mean thickness"));
    layout.values(boolean("tube.found"), text("tube.reason"), number("tube.lowest", "", "length"),
                  number("tube.highest", "", "length"), any("tube.groups_by_height"));
}

void add_slices(Report& report, const SliceFindings& findings) {
    const SlicedObject& cut = findings.cut;
    report.set_unit(findings.unit);
    if (!findings.unit.empty()) report("unit", findings.unit);
    report("planes", cut.parallel ? "parallel" : "across a curve")("reversed", cut.reversed);
    if (cut.parallel && !findings.one_plane) report("heights_of_the_mesh", std::vector{cut.lowest, cut.highest});
    for (std::size_t i = 0; i < cut.slices.size(); ++i) add_one_slice(report, cut, i);
    if (!cut.parallel) report.line("height: length along the curve");
    report.line(
        "m/M: sides of the smallest rectangle around the whole slice, loose pieces too (`eccentricity` in files; 1 for a "
        "circle); off circle: mean distance from the best circle, of its radius");
    if (!findings.axes.empty()) report.line("");
    else report.empty_table("axes", false);
    for (const ComparedAxis& axis : findings.axes) add_compared_axis(report, axis);
    add_slice_thickness(report, findings);
    if (!findings.one_plane) add_slice_tube(report, findings);
}

std::string slice_table(const SlicedObject& cut, const std::string& unit) {
    std::vector<std::string> header{"slice",           "unit",          cut.parallel ? "height" : "along_the_curve",
                                    "contours",        "open_contours", "closed_share",
                                    "share",           "share_low",     "share_high",
                                    "share_at_most",   "angle_degrees", "crossing_contours",
                                    "turned_contours", "doubtful_share"};
    for (const auto& entry : list_descriptors({})) header.emplace_back(entry.name);
    std::string text = csv_row(header);
    const auto cell = [](double value) { return std::isfinite(value) ? digits(value, 12) : std::string(); };
    for (std::size_t i = 0; i < cut.slices.size(); ++i) {
        const Slice& slice = cut.slices[i];
        const auto open = std::count_if(slice.contours.begin(), slice.contours.end(), [](const Contour& c) { return !c.closed; });
        const auto cell_or_empty = [&](double value) { return slice.contours.empty() ? std::string() : cell(value); };
        std::vector<std::string> row{std::to_string(i + 1),
                                     unit,
                                     cell(slice.height),
                                     std::to_string(slice.contours.size()),
                                     std::to_string(open),
                                     cell_or_empty(slice.completeness.closed_share),
                                     cell_or_empty(slice.completeness.share),
                                     cell_or_empty(slice.completeness.share_low),
                                     cell_or_empty(slice.completeness.share_high),
                                     cell_or_empty(slice.completeness.share_at_most),
                                     cell_or_empty(slice.completeness.angle() / degree),
                                     cell_or_empty(slice.completeness.crossing),
                                     cell_or_empty(slice.completeness.reversed_contours),
                                     cell_or_empty(slice.completeness.doubtful)};
        for (const auto& entry : list_descriptors(cut.descriptors[i])) row.push_back(cell(entry.value));
        text += csv_row(row);
    }
    return text;
}

std::vector<std::string> slice_quantities() {
    std::vector<std::string> names{"height"};
    for (const auto& entry : list_descriptors({})) names.emplace_back(entry.name);
    return names;
}

std::vector<Colour> slice_colours(const Mesh& mesh, const SlicedObject& cut, const std::string& quantity) {
    std::vector<double> values;
    for (std::size_t i = 0; i < cut.slices.size(); ++i) {
        values.push_back(cut.slices[i].height);
        for (const auto& entry : list_descriptors(cut.descriptors[i]))
            if (quantity == entry.name) values.back() = entry.value;
    }
    const Colour grey{190, 190, 190, 255};
    std::vector<Colour> colours(mesh.number_of_faces(), grey);
    if (std::none_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); })) return colours;
    const ColourScale scale = scale_of({&values}, "slices");
    const auto colour = [&](double value) {
        if (!std::isfinite(value)) return grey;
        const Rgb c = colour_of(scale, value);
        return Colour{c.red, c.green, c.blue, 255};
    };
    if (cut.parallel && cut.slices.size() > 1) {
        std::vector<std::size_t> order(cut.slices.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::sort(order.begin(), order.end(),
                  [&](std::size_t a, std::size_t b) { return cut.slices[a].height < cut.slices[b].height; });
        const auto height = [&](std::size_t k) { return cut.slices[order[k]].height; };
        const std::size_t last = order.size() - 1;
        for (const Face f : mesh.faces()) {
            const double h = cut.frames[0].height(centroid(mesh, f));
            if (h < height(0) - (height(1) - height(0)) / 2 || h > height(last) + (height(last) - height(last - 1)) / 2) continue;
            std::size_t k = 0, above = last;
            while (above - k > 1) {
                const std::size_t half = (k + above) / 2;
                (height(half) <= h ? k : above) = half;
            }
            if (height(above) - h < h - height(k)) k = above;
            colours[f] = colour(values[order[k]]);
        }
    }
    for (std::size_t i = 0; i < cut.slices.size(); ++i)
        for (const auto& contour : cut.slices[i].contours)
            for (const Index f : contour.faces) {
                const Colour c = colour(values[i]);
                const auto dark = [](std::uint8_t part) { return static_cast<std::uint8_t>(part * 3 / 5); };
                colours[f] = {dark(c[0]), dark(c[1]), dark(c[2]), 255};
            }
    return colours;
}

}  // namespace ostraka

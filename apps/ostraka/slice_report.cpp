#include "slice_report.h"

#include "ostraka/core/csv.h"
#include "ostraka/core/error.h"
#include "ostraka/render/colour_scale.h"
#include "ostraka/report/table.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ostraka::app {

namespace {

constexpr double degree = M_PI / 180;

JsonValue list_of(std::initializer_list<double> numbers, JsonAllocator& allocator) {
    JsonValue list(rapidjson::kArrayType);
    for (const double x : numbers) list.PushBack(x, allocator);
    return list;
}
JsonValue list_of(const Vector& v, JsonAllocator& allocator) { return list_of({v.x(), v.y(), v.z()}, allocator); }
JsonValue list_of(const Point& p, JsonAllocator& allocator) { return list_of({p.x(), p.y(), p.z()}, allocator); }

JsonValue points_of(const std::vector<Eigen::Vector2d>& points, JsonAllocator& allocator) {
    JsonValue list(rapidjson::kArrayType);
    for (const auto& p : points) list.PushBack(list_of({p.x(), p.y()}, allocator), allocator);
    return list;
}

/// What is absent is not there.
void add_number(JsonValue& object, std::string_view name, double value, JsonAllocator& allocator) {
    if (std::isfinite(value)) add_member(object, name, JsonValue(value), allocator);
}

bool is_count(std::string_view name) { return name == "components" || name == "holes" || name == "euler_number"; }

JsonValue json_of(const SliceFrame& frame, JsonAllocator& allocator) {
    JsonValue object(rapidjson::kObjectType);
    add_member(object, "origin", list_of(frame.origin, allocator), allocator);
    add_member(object, "u", list_of(frame.u, allocator), allocator);
    add_member(object, "v", list_of(frame.v, allocator), allocator);
    add_member(object, "normal", list_of(frame.normal, allocator), allocator);
    return object;
}

JsonValue json_of(const Contour& contour, JsonAllocator& allocator) {
    JsonValue object(rapidjson::kObjectType);
    add_member(object, "closed", JsonValue(contour.closed), allocator);
    if (contour.closed) {
        add_member(object, "hole", JsonValue(contour.hole), allocator);
        add_member(object, "parent", JsonValue(contour.parent), allocator);
        add_member(object, "depth", JsonValue(contour.depth), allocator);
        add_member(object, "area", JsonValue(contour.area), allocator);
        if (contour.crosses) add_member(object, "crosses", JsonValue(true), allocator);
        if (contour.turned) add_member(object, "turned", JsonValue(true), allocator);
    } else {
        add_member(object, "gap", JsonValue(contour.gap), allocator);
        add_member(object, "share", JsonValue(contour.length / (contour.length + contour.gap)), allocator);
    }
    add_member(object, "length", JsonValue(contour.length), allocator);
    add_member(object, "points", points_of(contour.points, allocator), allocator);
    return object;
}

JsonValue json_of(const MedialAxis& medial, JsonAllocator& allocator) {
    JsonValue levels(rapidjson::kArrayType);
    for (const auto& level : medial.levels) {
        JsonValue object(rapidjson::kObjectType), branches(rapidjson::kArrayType);
        add_member(object, "residue", JsonValue(level.residue), allocator);
        add_member(object, "length", JsonValue(level.length), allocator);
        for (const auto& branch : level.branches) {
            JsonValue entry(rapidjson::kObjectType), radii(rapidjson::kArrayType);
            for (const double r : branch.radii) radii.PushBack(r, allocator);
            add_member(entry, "points", points_of(branch.points, allocator), allocator);
            add_member(entry, "radii", std::move(radii), allocator);
            branches.PushBack(entry, allocator);
        }
        add_member(object, "branches", std::move(branches), allocator);
        levels.PushBack(object, allocator);
    }
    return levels;
}

}  // namespace

std::vector<Point> CutObject::centres() const {
    std::vector<Point> list;
    for (std::size_t i = 0; i < slices.size(); ++i)
        if (descriptors[i].barycentre.allFinite())
            list.push_back(frames[i].point(descriptors[i].barycentre, parallel ? slices[i].height : 0));
    return list;
}

JsonValue json_of(const CutObject& cut, JsonAllocator& allocator) {
    JsonValue slices(rapidjson::kArrayType);
    for (std::size_t i = 0; i < cut.slices.size(); ++i) {
        const Slice& slice = cut.slices[i];
        JsonValue object(rapidjson::kObjectType), completeness(rapidjson::kObjectType), descriptors(rapidjson::kObjectType),
            contours(rapidjson::kArrayType);
        add_member(object, "height", JsonValue(slice.height), allocator);
        add_member(object, "frame", json_of(cut.frames[i], allocator), allocator);
        const bool empty = slice.contours.empty();
        add_member(completeness, "empty", JsonValue(empty), allocator);
        add_member(completeness, "complete", JsonValue(!empty && slice.completeness.complete()), allocator);
        if (!empty) {
            add_member(completeness, "closed_share", JsonValue(slice.completeness.closed_share), allocator);
            add_member(completeness, "share", JsonValue(slice.completeness.share), allocator);
            add_member(completeness, "angle_degrees", JsonValue(slice.completeness.angle / degree), allocator);
            add_member(completeness, "crossing_contours", JsonValue(slice.completeness.crossing), allocator);
            add_member(completeness, "turned_contours", JsonValue(slice.completeness.turned), allocator);
            add_member(completeness, "doubtful_share", JsonValue(slice.completeness.doubtful), allocator);
        }
        add_member(object, "completeness", std::move(completeness), allocator);
        for (const auto& [name, unit, value] : list_descriptors(cut.descriptors[i])) {
            if (is_count(name) && std::isfinite(value))
                add_member(descriptors, name, JsonValue(static_cast<int>(value)), allocator);
            else add_number(descriptors, name, value, allocator);
        }
        add_member(object, "descriptors", std::move(descriptors), allocator);
        if (const auto profile = thickness_profile(slice, 72); !profile.empty()) {
            JsonValue list(rapidjson::kArrayType);
            for (const double t : profile) list.PushBack(std::isfinite(t) ? JsonValue(t) : JsonValue(), allocator);
            add_member(object, "thickness_profile", std::move(list), allocator);
        }
        for (const auto& contour : slice.contours) contours.PushBack(json_of(contour, allocator), allocator);
        add_member(object, "contours", std::move(contours), allocator);
        if (!cut.medial.empty()) add_member(object, "medial_axis", json_of(cut.medial[i], allocator), allocator);
        slices.PushBack(object, allocator);
    }
    return slices;
}

JsonValue json_of(const std::vector<NamedAxis>& axes, JsonAllocator& allocator) {
    JsonValue list(rapidjson::kArrayType);
    for (const auto& axis : axes) {
        JsonValue object(rapidjson::kObjectType);
        add_member(object, "name", axis.name, allocator);
        add_member(object, "found", JsonValue(axis.reason.empty()), allocator);
        if (!axis.reason.empty()) {
            add_member(object, "reason", axis.reason, allocator);
            list.PushBack(object, allocator);
            continue;
        }
        if (axis.polyline.empty()) {
            add_member(object, "point", list_of(axis.line.point, allocator), allocator);
            add_member(object, "direction", list_of(axis.line.direction, allocator), allocator);
        } else {
            JsonValue points(rapidjson::kArrayType);
            for (const auto& p : axis.polyline) points.PushBack(list_of(p, allocator), allocator);
            add_member(object, "polyline", std::move(points), allocator);
        }
        JsonValue straight(rapidjson::kObjectType);
        add_member(straight, "mean_distance", JsonValue(axis.straightness.mean), allocator);
        add_member(straight, "deviation", JsonValue(axis.straightness.deviation), allocator);
        add_member(straight, "largest_distance", JsonValue(axis.straightness.most), allocator);
        add_member(straight, "length", JsonValue(axis.straightness.length), allocator);
        add_member(straight, "relative", JsonValue(axis.straightness.relative), allocator);
        add_member(object, "straightness", std::move(straight), allocator);
        list.PushBack(object, allocator);
    }
    return list;
}

JsonValue json_of(const ThicknessHomogeneity& thickness, JsonAllocator& allocator) {
    JsonValue object(rapidjson::kObjectType);
    add_member(object, "slices", JsonValue(static_cast<std::uint64_t>(thickness.slices)), allocator);
    add_member(object, "slices_with_parts_beside", JsonValue(static_cast<std::uint64_t>(thickness.beside)), allocator);
    add_number(object, "mean", thickness.mean, allocator);
    add_number(object, "variation_within", thickness.within, allocator);
    add_number(object, "variation_across", thickness.across, allocator);
    add_number(object, "variation_overall", thickness.overall, allocator);
    return object;
}

JsonValue json_of(const Tube& tube, const CutObject& cut, JsonAllocator& allocator) {
    JsonValue object(rapidjson::kObjectType), groups(rapidjson::kArrayType);
    add_member(object, "found", JsonValue(tube.found), allocator);
    if (tube.found) {
        std::vector<double> heights;
        for (const auto& slice : cut.slices) heights.push_back(slice.height);
        std::sort(heights.begin(), heights.end());
        add_member(object, "lowest", JsonValue(heights[tube.first]), allocator);
        add_member(object, "highest", JsonValue(heights[tube.last]), allocator);
    } else {
        add_member(object, "reason", tube.reason, allocator);
    }
    for (const int group : tube.cluster) groups.PushBack(group, allocator);
    add_member(object, "groups_by_height", std::move(groups), allocator);
    return object;
}

std::string csv_of(const CutObject& cut, const std::string& unit) {
    std::vector<std::string> header{"slice",           "unit",          cut.parallel ? "height" : "along_the_curve",
                                    "contours",        "open_contours", "closed_share",
                                    "share",           "angle_degrees", "crossing_contours",
                                    "turned_contours", "doubtful_share"};
    for (const auto& entry : list_descriptors({})) header.emplace_back(entry.name);
    std::string text = csv_row(header);
    const auto cell = [](double value) {
        char buffer[32];
        std::snprintf(buffer, sizeof buffer, "%.12g", value);
        return std::isfinite(value) ? std::string(buffer) : std::string();
    };
    for (std::size_t i = 0; i < cut.slices.size(); ++i) {
        const Slice& slice = cut.slices[i];
        const auto open = std::count_if(slice.contours.begin(), slice.contours.end(), [](const Contour& c) { return !c.closed; });
        const auto known = [&](double value) { return slice.contours.empty() ? std::string() : cell(value); };
        std::vector<std::string> row{std::to_string(i + 1),
                                     unit,
                                     cell(slice.height),
                                     std::to_string(slice.contours.size()),
                                     std::to_string(open),
                                     known(slice.completeness.closed_share),
                                     known(slice.completeness.share),
                                     known(slice.completeness.angle / degree),
                                     known(slice.completeness.crossing),
                                     known(slice.completeness.turned),
                                     known(slice.completeness.doubtful)};
        for (const auto& entry : list_descriptors(cut.descriptors[i])) row.push_back(cell(entry.value));
        text += csv_row(row);
    }
    return text;
}

std::vector<Colour> slice_colours(const Mesh& mesh, const CutObject& cut, const std::string& name) {
    std::vector<double> values;
    for (std::size_t i = 0; i < cut.slices.size(); ++i) {
        double value = name == "height" ? cut.slices[i].height : SliceDescriptors::absent;
        bool known = name == "height";
        for (const auto& entry : list_descriptors(cut.descriptors[i]))
            if (name == entry.name) value = entry.value, known = true;
        if (!known) {
            std::string names = "height";
            for (const auto& entry : list_descriptors({})) names += std::string(", ") + entry.name;
            fail_usage("no descriptor is called '" + name + "'", "use one of: " + names);
        }
        values.push_back(value);
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

}  // namespace ostraka::app

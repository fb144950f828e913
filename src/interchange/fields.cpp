#include "interchange/fields.h"

#include "interchange/text.h"

#include <fmt/core.h>

namespace ostraka::interchange {

bool same(const Attribute& a, const Attribute& b) {
    if (a.id != b.id || a.name != b.name || a.type != b.type) return false;
    if (a.type == AttributeType::semantic) return a.note == b.note && a.origin == b.origin;
    return a.type == AttributeType::measure ? a.measure == b.measure : a.descriptor == b.descriptor;
}

bool same_geometry(const Annotation& a, const Annotation& b) {
    return a.type == b.type && a.points == b.points && a.polylines == b.polylines && a.all == b.all && a.faces == b.faces &&
           a.curves == b.curves;
}

bool same(const Annotation& a, const Annotation& b) {
    return a.id == b.id && a.tag == b.tag && a.colour == b.colour && a.note == b.note && a.information == b.information &&
           same_geometry(a, b) &&
           std::equal(a.attributes.begin(), a.attributes.end(), b.attributes.begin(), b.attributes.end(),
                      [](const Attribute& x, const Attribute& y) { return same(x, y); });
}

std::string as_text(const std::string& text) { return one_line(text); }

std::string as_text(const std::array<int, 3>& colour) { return joined_numbers(colour); }

std::string as_text(const std::optional<std::array<double, 3>>& direction) {
    return direction ? joined_numbers(*direction) : std::string();
}

std::string as_text(const std::vector<int>& ids) { return joined_numbers(ids); }

std::string as_text(const Attribute& attribute) {
    if (attribute.type == AttributeType::semantic)
        return as_text(fmt::format("{}: {}{}", attribute.name, attribute.note,
                                   attribute.origin.empty() ? "" : " (inferred: " + attribute.origin + ")"));
    const bool measured = attribute.type == AttributeType::measure;
    std::string text = attribute.name + ":";
    if (measured) {
        text += fmt::format(" {}{}", attribute.measure.tool, attribute.measure.exact ? " (exact)" : "");
        if (attribute.measure.value) text += " " + digits(*attribute.measure.value);
        if (attribute.measure.uncertainty) text += " +- " + digits(*attribute.measure.uncertainty);
    }
    const auto [values, unit, stale] = attribute_values(attribute);
    for (std::size_t i = 0; !measured && i < values.size() && i < 4; ++i) text += " " + digits(values[i]);
    if (!measured && !attribute.descriptor.file.empty()) text += " in " + attribute.descriptor.file;
    if (!unit.empty()) text += " " + unit;
    if (measured) {
        text += " (pins";
        for (std::size_t i = 0; i < attribute.measure.points.size() && i < 4; ++i)
            text += " " + std::to_string(attribute.measure.points[i]);
        text += attribute.measure.points.size() > 4 ? " ..." : "";
        if (!attribute.measure.repeats.empty()) text += fmt::format(", picked {} times", attribute.measure.repeats.size() + 1);
        text += ")";
    }
    return as_text(text + (stale ? " (stale)" : ""));
}

std::string as_text(const std::vector<Information>& entries) {
    std::string text;
    for (const Information& entry : entries)
        text += (text.empty() ? "" : "; ") + to_string(entry.kind) + ' ' +
                (entry.title.empty() ? entry.value : fmt::format("{}: {}", entry.title, entry.value));
    return as_text(text);
}

std::string geometry_as_text(const Annotation& annotation) {
    if (!annotation.curves.empty() && annotation.type != AnnotationType::point) {
        std::size_t point_count = 0;
        for (const auto& curve : annotation.curves) point_count += curve.size();
        return fmt::format("{} points on {} free curves", point_count, annotation.curves.size());
    }
    if (annotation.type == AnnotationType::point) return std::to_string(annotation.points.size()) + " points";
    if (annotation.type == AnnotationType::region)
        return annotation.all ? "the whole mesh" : std::to_string(annotation.faces.size()) + " faces";
    std::size_t edges = 0;
    for (const auto& polyline : annotation.polylines) edges += polyline.size() - 1;
    return fmt::format("{} edges in {}", edges, annotation.polylines.size());
}

std::string as_text(const Annotation& annotation) {
    return as_text(fmt::format("'{}', {}, {}, {} attributes", annotation.tag, to_string(annotation.type),
                               geometry_as_text(annotation), annotation.attributes.size()));
}

}  // namespace ostraka::interchange

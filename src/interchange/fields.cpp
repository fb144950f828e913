#include "interchange/fields.h"

#include "interchange/text.h"

#include <fmt/core.h>

namespace ostraka::interchange {

bool same(const Attribute& a, const Attribute& b) { return a.id == b.id && a.name == b.name && a.value == b.value; }

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
    if (const Note* note = attribute.note())
        return as_text(
            fmt::format("{}: {}{}", attribute.name, note->text, note->origin.empty() ? "" : " (inferred: " + note->origin + ")"));
    const Measure* measure = attribute.measure();
    const Descriptor* descriptor = attribute.descriptor();
    std::string text = attribute.name + ":";
    if (measure != nullptr) text += fmt::format(" {}{}", measure->tool, measure->exact ? " (exact)" : "");
    const auto [values, unit, stale] = attribute_values(attribute);
    for (std::size_t i = 0; i < values.size() && i < 4; ++i) text += " " + digits(values[i]);
    if (measure != nullptr && measure->uncertainty) text += " +- " + digits(*measure->uncertainty);
    if (descriptor != nullptr && !descriptor->file.empty()) text += " in " + descriptor->file;
    if (!unit.empty()) text += " " + unit;
    if (measure != nullptr) {
        text += " (pins";
        for (std::size_t i = 0; i < measure->points.size() && i < 4; ++i) text += " " + std::to_string(measure->points[i]);
        text += measure->points.size() > 4 ? " ..." : "";
        if (!measure->repeats.empty()) text += fmt::format(", picked {} times", measure->repeats.size() + 1);
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

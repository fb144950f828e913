#include "operations/annotation/annotation_report.h"

#include "ostraka/measure/examine.h"

#include <fmt/core.h>

#include <algorithm>

namespace ostraka {

namespace {

std::string attribute_text(const Attribute& attribute) {
    std::string text = attribute.name;
    if (const Note* note = attribute.note()) return text + ": " + note->text;
    const auto [values, unit, stale] = attribute_values(attribute);
    for (std::size_t i = 0; i < std::min<std::size_t>(values.size(), 4); ++i) text += " " + number(values[i]);
    if (values.size() > 4) text += " ...";
    if (const Descriptor* descriptor = attribute.descriptor(); descriptor != nullptr && !descriptor->file.empty())
        text += " in " + descriptor->file;
    if (!unit.empty()) text += " " + unit;
    return text + (stale ? " (stale)" : "");
}

}  // namespace

void declare_annotations(ReportLayout& layout) {
    layout.values(text("class"), text("unit"));
    layout.table("annotations", integer("id", "id"), text("tag", "tag"), text("type", "type"), integer("elements", "elements"),
                 integer("patches", "patches"), integer("outlines", "outlines"), number("area", "area", "length^2"),
                 number("perimeter", "", "length"), number("length", "", "length"),
                 text_only("perimeter / length", FieldType::number, "length"), texts("attributes", "attributes"), text("note"));
}

void report_annotations(Context& context, Report& report, AnnotatedMeshView object) {
    context.notes("", object.annotations.notes);
    report.set_unit(object.annotations.unit);
    report("class", object.annotations.object_class)("unit", object.annotations.unit);
    report.empty_table("annotations");
    for (const Annotation& annotation : object.annotations.annotations) {
        const AnnotationSummary summary = summarise(object.mesh, annotation);
        Report::Row row = report.row("annotations");
        row("id", annotation.id)("tag", annotation.tag)("type", to_string(annotation.type))("elements", summary.elements)(
            "patches", summary.patches);
        if (annotation.type == AnnotationType::region)
            row("outlines", summary.outlines)("area", summary.area)("perimeter", summary.length);
        else row.shown("outlines", "-");
        if (annotation.type == AnnotationType::line) row("length", summary.length);
        if (annotation.type != AnnotationType::point) row.shown("perimeter / length", number(summary.length));
        std::vector<std::string> attributes;
        for (const Attribute& attribute : annotation.attributes) attributes.push_back(attribute_text(attribute));
        row("attributes", attributes,
            joined(attributes, "; ") + (annotation.note.empty() ? "" : fmt::format(" [{}]", annotation.note)));
        if (!annotation.note.empty()) row("note", annotation.note);
    }
}

}  // namespace ostraka

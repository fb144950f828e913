// Shared by the operations that report the contents and defects of a template.
#pragma once

#include "operations/operations.h"

#include "ostraka/template_package/template.h"

#include <string>

namespace ostraka {

/// Declares the contents and defects of a template; `contents`: show the contents to people too.
inline void declare_template(ReportLayout& layout, bool contents) {
    const auto title = [&](const char* text) { return contents ? text : ""; };
    layout.values(text("class"), text("unit"));
    layout.table("parts", text("role", title("part")), text("file", title("file")), integer("bytes", title("bytes")),
                 text("text", title("what")));
    layout.checks = true;
}

/// Reports the contents and defects of a template, as declared by `declare_template`.
inline void add_template(Report& report, const Template& package, bool contents) {
    const std::string &object_class = package.file.object_class, &unit = package.file.unit;
    report("class", object_class)("unit", unit);
    if (contents && (!object_class.empty() || !unit.empty()))
        report.line(printable(object_class + (unit.empty() ? "" : ", in " + unit)));
    report.empty_table("parts");
    for (const TemplateEntry& entry : package.entries)
        report.row("parts")("role", entry.role)("file", entry.name)("bytes", entry.bytes)("text", entry.text);
    if (contents) report.line("");
    report.findings(package.findings, "part");
}

/// Reports the defects of a template file; `contents`: shows its contents to people too.
struct TemplateInspection : Operation {
    explicit TemplateInspection(bool shows_contents) : contents(shows_contents) {}

    void declare(Parameters& p) override {
        p.input("template", Kind::template_package, input, "template (.template.json)");
        declare_template(p.report, contents);
    }

    void run(Context&, Report& report) override { add_template(report, *input, contents); }

    bool contents;
    TemplateInput input;
};

}  // namespace ostraka

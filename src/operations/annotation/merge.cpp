// annotation diff, merge
#include "operations/annotation/differences.h"
#include "operations/operations.h"

#include <fmt/core.h>

#include <algorithm>

namespace ostraka {

void declare_differences(ReportLayout& layout, const std::string& table) {
    layout.table(table, integer("id", "id"), text("tag", "tag"), text("kind", "what"), text("field", "field"),
                 text("before", "before"), text("after", "after"), integer("onlyBefore"), integer("onlyAfter"));
}

namespace {

/// Adds a row for a difference or conflict of an annotation, or of the set as a whole.
template <class Change>
Report::Row named_row(Report& report, const std::string& table, const Change& change) {
    Report::Row row = report.row(table);
    if (change.id) row("id", *change.id)("tag", change.tag);
    else row.shown("id", "set").shown("tag", change.tag);
    return row("field", change.field);
}

}  // namespace

void add_differences(Report& report, const std::string& table, const std::vector<Difference>& changes, const std::string& none) {
    report.empty_table(table, false);
    if (changes.empty()) report.line(none);
    for (const Difference& change : changes) {
        Report::Row row = named_row(report, table, change);
        row("kind", change.kind == Difference::Kind::added     ? "added"
                    : change.kind == Difference::Kind::removed ? "removed"
                                                               : "changed");
        std::string counts;
        if (change.field == "geometry") {
            row("onlyBefore", change.only_before)("onlyAfter", change.only_after);
            counts = fmt::format(" (-{} +{})", change.only_before, change.only_after);
        }
        row("before", change.before)("after", change.after, change.after + counts);
    }
}

namespace {

struct AnnotationDiff final : Operation {
    void describe(Parameters& p) override {
        p.input("mesh", Kind::mesh, mesh, "mesh of both sets");
        p.input("before", Kind::annotations, before, "annotations (.ant.json)");
        p.input("after", Kind::annotations, after, "annotations to compare with them");
        p.report.values(boolean("same"));
        declare_differences(p.report, "differences");
    }

    void run(Context&, Report& report) override {
        const auto changes = differences(before.on(mesh->mesh), after.on(mesh->mesh));
        report("same", changes.empty());
        add_differences(report, "differences", changes, "no difference");
        if (!changes.empty()) report.answer_no();
    }

    MeshInput mesh;
    AnnotationsInput before, after;
};

struct AnnotationMerge final : Operation {
    void describe(Parameters& p) override {
        p.input("mesh", Kind::mesh, mesh, "mesh of all sets");
        p.input("base", Kind::annotations, base, "common ancestor of both sets");
        p.input("ours", Kind::annotations, ours, "first changed set");
        p.input("theirs", Kind::annotations, theirs, "second changed set");
        p.output("output", Kind::annotations, output, "annotations to write");
        options.describe(p.options);
        p.report.values(boolean("merged"), integer("annotations"));
        p.report.table("conflicts", integer("id", "id"), text("tag", "tag"), text("field", "conflict"), text("base", "base"),
                       text("ours", "ours"), text("theirs", "theirs"));
    }

    void run(Context&, Report& report) override {
        const Mesh& surface = mesh->mesh;
        const MergedAnnotations merged = merge_annotations(base.on(surface), ours.on(surface), theirs.on(surface), options);
        const bool resolved = merged.settled(options);
        report.notes(merged.notes);
        report("merged", resolved)("annotations", merged.set.annotations.size());
        report.empty_table("conflicts", false);
        for (const Conflict& conflict : merged.conflicts)
            named_row(report, "conflicts", conflict)("base", conflict.base)("ours", conflict.ours)("theirs", conflict.theirs);
        const std::size_t count = merged.conflicts.size();
        if (resolved) {
            report.line(fmt::format("{} annotations{}", merged.set.annotations.size(),
                                    count == 0 ? "" : ", conflicts resolved for " + option_text(options, "prefer")));
            output.write(merged.set, surface, mesh.file());
            return;
        }
        report.answer_no();
        const auto any_conflict = [&](const std::string& field) {
            return std::any_of(merged.conflicts.begin(), merged.conflicts.end(),
                               [&](const Conflict& conflict) { return conflict.field == field; });
        };
        report.line(fmt::format("{}; nothing written (resolve them in the files, or choose with --prefer{}{})",
                                counted(count, "conflict"),
                                any_conflict("both added") ? "; --renumber keeps both where both added under one id" : "",
                                any_conflict("geometry") ? "; --merge-faces joins regions that both changed" : ""));
    }

    MeshInput mesh;
    AnnotationsInput base, ours, theirs;
    AnnotationsOutput output;
    MergeOptions options;
};

}  // namespace

std::unique_ptr<Operation> make_annotation_diff() { return make<AnnotationDiff>(); }
std::unique_ptr<Operation> make_annotation_merge() { return make<AnnotationMerge>(); }

}  // namespace ostraka

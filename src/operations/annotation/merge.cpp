// annotation merge
#include "operations/annotation/differences.h"
#include "operations/operations.h"

#include <fmt/core.h>

#include <algorithm>

namespace ostraka {

namespace {

struct AnnotationMerge final : Operation {
    void declare(Parameters& p) override {
        p.input("mesh", Kind::mesh, mesh, "mesh to which all three sets of annotations belong");
        p.input("base", Kind::annotations, base,
                "common base: set of annotations from which both changed sets were made (.ant.json)");
        p.input("ours", Kind::annotations, ours, "first changed set of annotations (.ant.json)");
        p.input("theirs", Kind::annotations, theirs, "second changed set of annotations (.ant.json)");
        p.output("output", Kind::annotations, output, "annotations to write (.ant.json)");
        options.declare_options(p.options);
        p.report.values(boolean("merged"), integer("annotations"));
        p.report.table("conflicts", integer("id", "id"), text("tag", "tag"), text("field", "conflict"), text("base", "base"),
                       text("ours", "ours"), text("theirs", "theirs"));
    }

    void run(Context&, Report& report) override {
        const Mesh& surface = mesh->mesh;
        const MergedAnnotations merged = merge_annotations(base.on(surface), ours.on(surface), theirs.on(surface), options);
        const bool resolved = merged.is_resolved(options);
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
        report.line(fmt::format(
            "{}; nothing written (resolve them in the files, or choose with --prefer{}{})", counted(count, "conflict"),
            any_conflict("both added") ? "; --renumber keeps both annotations where both sets added one with the same id" : "",
            any_conflict("geometry") ? "; --merge-faces merges regions that both sets changed" : ""));
    }

    MeshInput mesh;
    AnnotationsInput base, ours, theirs;
    AnnotationsOutput output;
    MergeOptions options;
};

}  // namespace

std::unique_ptr<Operation> make_annotation_merge() { return make<AnnotationMerge>(); }

}  // namespace ostraka

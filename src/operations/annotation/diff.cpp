// annotation diff
#include "operations/annotation/differences.h"
#include "operations/operations.h"

namespace ostraka {

namespace {

struct AnnotationDiff final : Operation {
    void declare(Parameters& p) override {
        p.input("mesh", Kind::mesh, mesh, "mesh to which both sets of annotations belong");
        p.input("before", Kind::annotations, before, "first set of annotations (.ant.json)");
        p.input("after", Kind::annotations, after, "second set of annotations (.ant.json), compared with the first");
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

}  // namespace

std::unique_ptr<Operation> make_annotation_diff() { return make<AnnotationDiff>(); }

}  // namespace ostraka

// annotation survival
#include "operations/operations.h"

#include "ostraka/transfer/survival.h"

namespace ostraka {

namespace {

struct AnnotationSurvival final : Operation {
    void declare(Parameters& p) override {
        p.input("mesh", Kind::mesh, mesh, "annotated mesh");
        p.input("annotations", Kind::annotations, annotations, "annotations of the mesh (.ant.json)");
        options.declare_options(p.options);
        p.report.table("annotations", integer("id", "id"), text("tag", "tag"), integer("vertices", "smallest number of vertices"),
                       text("end", "and below"));
    }

    void run(Context&, Report& report) override {
        report.empty_table("annotations");
        for (const Survival& survival : smallest_resolutions({mesh->mesh, annotations.on(mesh->mesh)}, options)) {
            Report::Row row = report.row("annotations")("id", survival.id)("tag", survival.tag)("vertices", survival.vertices);
            if (survival.end.empty()) row.shown("end", "survived every resolution tried");
            else row("end", survival.end);
        }
    }

    MeshInput mesh;
    AnnotationsInput annotations;
    SurvivalOptions options;
};

}  // namespace

std::unique_ptr<Operation> make_annotation_survival() { return make<AnnotationSurvival>(); }

}  // namespace ostraka

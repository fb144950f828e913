// annotation smooth: smooth outlines and lines that do not follow the mesh edges.
#include "operations/operations.h"

#include "ostraka/annotation/fair_outlines.h"
#include "ostraka/measure/measure.h"

namespace ostraka {

namespace {

struct AnnotationSmooth final : Operation {
    void declare(Parameters& p) override {
        p.input("mesh", Kind::mesh, mesh, "mesh file");
        p.input("annotations", Kind::annotations, annotations, "annotations of the mesh (.ant.json)");
        p.output("output", Kind::annotations, output,
                 "annotations to write (.ant.json), with outlines through the faces of the mesh");
        p.options("annotation", names, "ids or tags of the annotations to smooth; all annotations if left out").words();
        options.declare_options(p.options);
        p.report.table("annotations", integer("id", "id"), text("tag", "tag"), number("length_before", "length before", "length"),
                       number("length_after", "after", "length"), number("area_before", "area before", "length^2"),
                       number("area_after", "after", "length^2"), number("moved", "moved", "length"), text("note", "note"));
    }

    void run(Context&, Report& report) override {
        const Mesh& surface = mesh->mesh;
        AnnotationSet set = annotations.on(surface);
        report.set_unit(set.unit);
        std::vector<int> ids;
        for (const std::string& name : names) {
            const Annotation& annotation = find_annotation(set, name, annotations.file());
            ids.push_back(annotation.id);
            if (annotation.type == AnnotationType::point || annotation.all)
                report.note(name_of(annotation) + " has no outline and no line: it is unchanged");
        }
        report.empty_table("annotations");
        for (const FairedAnnotation& faired :
             in_file(annotations.file(), [&] { return fair_outlines(surface, set, ids, options); }))
            report.row("annotations")("id", faired.id)("tag", set.find(faired.id)->tag)("length_before", faired.length_before)(
                "length_after", faired.length_after)("area_before", faired.area_before)("area_after", faired.area_after)(
                "moved", faired.moved)("note", faired.note);
        report.notes(refresh_measures(surface, set).notes);
        output.write(std::move(set), surface, mesh.file());
    }

    MeshInput mesh;
    AnnotationsInput annotations;
    AnnotationsOutput output;
    std::vector<std::string> names;
    FairOptions options;
};

}  // namespace

std::unique_ptr<Operation> make_annotation_smooth() { return make<AnnotationSmooth>(); }

}  // namespace ostraka

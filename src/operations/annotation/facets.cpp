// annotation facets: outer, inner and fracture surface of a fragment.
#include "operations/operations.h"

#include "ostraka/reconstruction/fragment_file.h"

#include <fmt/core.h>

namespace ostraka {

namespace {

struct AnnotationFacets final : Operation {
    void declare(Parameters& p) override {
        p.input("mesh", Kind::mesh, mesh, "mesh file of the fragment");
        p.input("annotations", Kind::annotations, annotations,
                "annotations (.ant.json) to update or create, with regions \"outer\", \"inner\" and \"fracture\"; 'fit' and "
                "'pair' read the regions of NAME.ply from NAME.ant.json");
        p.output_option("output", Kind::annotations, output,
                        "write the annotations to this file, and leave the input file unchanged")
            .updates(annotations);
        p.output_option("probability", Kind::values, probability,
                        "file to write (.npy, or text): for each face, its probability of being fracture surface, computed from "
                        "the features of the face alone");
        p.options("unit", unit, "unit of the mesh's coordinates for a new file, e.g. mm");
        options.declare_options(p.options);
        p.report.values(text("answer"), boolean("shell"), number("thickness", "", "length"), number("confidence"));
        p.report.table("segments", text("facet", "facet"), integer("faces", "faces"), number("area", "area", "length^2"),
                       number("confidence", "confidence"));
    }

    void run(Context&, Report& report) override {
        const Mesh& surface = mesh->mesh;
        AnnotationSet set;
        if (annotations.exists()) set = annotations.on(surface);
        if (!unit.empty() && !set.unit.empty() && unit != set.unit)
            fail_usage(fmt::format("--unit is '{}', but the unit of {} is '{}'", printable(unit, 60), annotations.file(),
                                   printable(set.unit, 60)),
                       "leave out --unit");
        if (set.unit.empty()) set.unit = unit;
        report.set_unit(set.unit);
        const Facets facets = in_file(mesh.file(), [&] { return find_facets(surface, options); });
        report.notes(facets.notes);
        if (probability) probability.write(facets.probability);
        report.empty_table("segments");
        for (const FacetSegment& segment : facets.segments)
            report.row("segments")("facet", to_string(segment.facet))("faces", segment.faces.size())("area", segment.area)(
                "confidence", segment.confidence, number(segment.confidence, 2));
        report("answer", to_string(facets.answer));
        report("shell", facets.shell);
        if (facets.shell) report("thickness", facets.thickness);
        report("confidence", facets.confidence);
        report.line(!facets.shell ? std::string("the fragment is solid: it has no wall with two sides")
                                  : fmt::format("the fragment has a wall {}{} thick", number(facets.thickness, 3),
                                                set.unit.empty() ? "" : " " + printable(set.unit, 60)));
        if (facets.area(Facet::fracture) > 0) {
            update_facet_annotations(set, facets);
            return output.write(std::move(set), surface, mesh.file());
        }
        report.note(fmt::format("{}, so {} is not written",
                                facets.answer == Facets::Answer::whole ? "there is no fracture" : "no fracture is found",
                                output.file()));
        report.answer_no();
    }

    MeshInput mesh;
    AnnotationsInput annotations;
    AnnotationsOutput output;
    ValuesOutput probability;
    std::string unit;
    FacetOptions options;
};

}  // namespace

std::unique_ptr<Operation> make_annotation_facets() { return make<AnnotationFacets>(); }

}  // namespace ostraka

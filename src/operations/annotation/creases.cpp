// annotation creases: ridges and valleys of the surface as candidates for joints.
#include "operations/operations.h"

#include "ostraka/select/creases.h"

#include <fmt/core.h>

namespace ostraka {

namespace {

struct AnnotationCreases final : Operation {
    void declare(Parameters& p) override {
        p.input("mesh", Kind::mesh, mesh, "mesh file");
        p.output("output", Kind::annotations, output, "annotations to write (.ant.json): lines along the crests");
        p.options("regions", regions, "write the creases as regions instead of lines");
        p.options("unit", unit, "unit of the mesh's coordinates, e.g. mm");
        options.list_options(p.options);
        p.report.table("creases", integer("id", "id"), text("tag", "tag"), boolean("closed", "closed"),
                       number("length", "length", "length"), number("width", "width", "length"),
                       number("mean curvature", "mean curvature", "1/length"), number("strength", "strength"));
    }

    void run(Context&, Report& report) override {
        report.set_unit(unit);
        const Mesh& surface = mesh->mesh;
        const std::vector<Crease> creases = in_file(mesh.file(), [&] { return find_creases(surface, options); });
        AnnotationSet set = annotate_creases(creases, regions, unit);
        report.empty_table("creases");
        for (std::size_t i = 0; i < creases.size(); ++i) {
            const Crease& crease = creases[i];
            report.row("creases")("id", set.annotations[i].id)("tag", set.annotations[i].tag)("closed", crease.closed)(
                "length", crease.length)("width", crease.width)("mean curvature", crease.mean_curvature)(
                "strength", crease.strength, number(crease.strength, 3));
        }
        if (creases.empty()) {
            report.note(fmt::format(
                "no crease was found at this scale, so {} is not written: try another --scale, or lower --weak and --strong",
                output.file()));
            return report.answer_no();
        }
        report.line(
            fmt::format("strength: mean response of the crease filter along the line, in robust standard deviations of its "
                        "response over the surface (--weak {}, --strong {})",
                        number(options.weak), number(options.strong)));
        output.write(std::move(set), surface, mesh.file());
    }

    MeshInput mesh;
    AnnotationsOutput output;
    bool regions = false;
    std::string unit;
    CreaseOptions options;
};

}  // namespace

std::unique_ptr<Operation> make_annotation_creases() { return make<AnnotationCreases>(); }

}  // namespace ostraka

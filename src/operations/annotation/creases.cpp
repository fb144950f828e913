// annotation creases: ridges and valleys of the surface as candidates for joints, and edges of what is painted.
#include "operations/operations.h"

#include "ostraka/select/colour_edges.h"
#include "ostraka/select/creases.h"

#include <fmt/core.h>

namespace ostraka {

namespace {

struct AnnotationCreases final : Operation {
    void declare(Parameters& p) override {
        p.input("mesh", Kind::mesh, mesh, "mesh file");
        p.output("output", Kind::annotations, output, "annotations to write (.ant.json): lines along the crests");
        p.options("of", of, "ridges and hollows of the shape, or edges of what is painted (colour)", Choices{"shape", "colour"});
        p.options("regions", regions, "write the creases as regions instead of lines");
        p.options("unit", unit, "unit of the mesh's coordinates, e.g. mm");
        options.declare_options(p.options);
        p.options.group("With --of colour");
        p.options("contrast", edges.contrast, "difference of the colours of both sides (CIELAB) that each line exceeds somewhere",
                  Range{0.1, 200});
        p.options("min-contrast", edges.min_contrast, "difference of the colours of both sides at which lines end",
                  Range{0.1, 200});
        p.options("texels", edges.texels, "standard deviation of the smoothing", Range{0, 20}, "texels");
        p.report.table("colour edges", integer("id", "id"), text("tag", "tag"), boolean("closed", "closed"),
                       number("length", "length", "length"), number("contrast", "contrast"));
        p.report.table("creases", integer("id", "id"), text("tag", "tag"), boolean("closed", "closed"),
                       number("length", "length", "length"), number("width", "width", "length"),
                       number("mean curvature", "mean curvature", "1/length"), number("strength", "strength"));
    }

    void check() const override {
        if (of == "colour" && regions)
            fail_usage("edges of colour have no regions", "leave out --regions, or select with --painted");
    }

    void run(Context&, Report& report) override {
        report.set_unit(unit);
        if (of == "colour") return find_in_image(report);
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
                        number(options.lower_threshold), number(options.upper_threshold)));
        output.write(std::move(set), surface, mesh.file());
    }

    void find_in_image(Report& report) {
        edges.shortest = options.shortest;
        const Mesh& surface = mesh->mesh;
        const std::vector<ColourEdge> found = find_colour_edges(surface, mesh->extras, edges, mesh.file());
        AnnotationSet set = annotate_colour_edges(surface, found, unit);
        report.empty_table("colour edges");
        for (std::size_t i = 0; i < found.size(); ++i)
            report.row("colour edges")("id", set.annotations[i].id)("tag", set.annotations[i].tag)("closed", found[i].closed)(
                "length", found[i].length)("contrast", found[i].contrast, number(found[i].contrast, 3));
        if (found.empty()) {
            report.note(
                fmt::format("no edge of colour stands out, so {} is not written: try a lower --contrast, --min-contrast or "
                            "--shortest",
                            output.file()));
            return report.answer_no();
        }
        output.write(std::move(set), surface, mesh.file());
    }

    MeshInput mesh;
    AnnotationsOutput output;
    bool regions = false;
    std::string unit, of = "shape";
    ColourEdgeOptions edges;
    CreaseOptions options;
};

}  // namespace

std::unique_ptr<Operation> make_annotation_creases() { return make<AnnotationCreases>(); }

}  // namespace ostraka

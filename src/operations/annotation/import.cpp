// annotation import
#include "operations/annotation/interchange_format.h"
#include "operations/operations.h"

#include "ostraka/interchange/interchange.h"

namespace ostraka {

namespace {

struct AnnotationImport final : Operation {
    void declare(Parameters& p) override {
        p.input("mesh", Kind::mesh, mesh, "mesh file");
        p.input("input", Kind::text, input, "file to read, in the format of another tool");
        p.output("output", Kind::annotations, output, "annotations to write (.ant.json)");
        describe_format(p, format);
        p.input_option("onto", Kind::annotations, onto,
                       "annotations to which the annotations or attributes in the file are added");
        options.list_options(p.options);
        p.report.values(text("format"), integer("annotations"));
        p.report.table("placed", integer("id", "id"), text("tag", "tag"), text("by", "by"), integer("points", "points"),
                       number("toSurface", "to surface", "length"), number("toVertex", "to vertex", "length"));
    }

    void run(Context& context, Report& report) override {
        const auto& bytes = input.load<std::string>(read_file);
        if (!format) format = guess_interchange_format(input.file(), bytes);
        const Mesh& surface = mesh->mesh;
        const AnnotationSet* base = onto ? &onto.on(surface) : nullptr;
        PlacedAnnotations placed = [&] {
            try {
                return import_annotations(surface, bytes, *format, input.file(), base, options);
            } catch (const Error& error) {
                // Errors about the mesh name its file.
                if (error.kind() != ErrorKind::input || error.where() != "mesh") throw;
                fail_input(mesh.file(), error.problem(), error.remedy());
            }
        }();
        context.notes("", placed.set.notes);
        report("format", *format)("annotations", placed.set.annotations.size());
        report.empty_table("placed", false);
        for (const PlacedAnnotation& placement : placed.placements)
            report.row("placed")("id", placement.id)("tag", placement.tag)("by", placement.how)("points", placement.points)(
                "toSurface", placement.to_surface, number(placement.to_surface, 3))("toVertex", placement.to_vertex,
                                                                                    number(placement.to_vertex, 3));
        output.write(std::move(placed.set), surface, mesh.file());
    }

    MeshInput mesh;
    FileInput input;
    AnnotationsInput onto;
    AnnotationsOutput output;
    std::optional<std::string> format;
    ImportOptions options;
};

}  // namespace

std::unique_ptr<Operation> make_annotation_import() { return make<AnnotationImport>(); }

}  // namespace ostraka

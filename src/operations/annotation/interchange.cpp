// annotation export, import
#include "operations/operations.h"

#include "ostraka/interchange/interchange.h"

#include <fmt/core.h>

namespace ostraka {

namespace {

void describe_format(Parameters& p, std::optional<std::string>& format) {
    p.options("format", format, "format of the file, if its extension does not determine it", Choices(interchange_formats()));
}

struct AnnotationExport final : AnnotatedMeshOperation {
    void describe(Parameters& p) override {
        describe_inputs(p);
        p.output("output", Kind::text, output, "file to write");
        describe_format(p, format);
        options.describe(p.options);
        p.report.values(text("format"), integer("annotations"), integer("bytes"), text("sha256"));
    }

    void run(Context& context, Report& report) override {
        if (!format) format = guess_interchange_format(output.file());
        const AnnotationSet& annotation_set = set();
        const ExportedAnnotations exported =
            export_annotations(mesh->mesh, annotation_set, *format, mesh.file(), context.provenance(), options);
        report.notes(exported.notes);
        report("format", *format)("annotations", exported.annotations)("bytes", exported.bytes.size())("sha256",
                                                                                                       sha256(exported.bytes));
        const std::size_t total = annotation_set.annotations.size(), written = exported.annotations;
        report.line(fmt::format("{}{} as {}, {} bytes", written == total ? "" : fmt::format("{} of ", written),
                                counted(total, "annotation"), *format, exported.bytes.size()));
        output.write(exported.bytes);
    }

    FileOutput output;
    std::optional<std::string> format;
    ExportOptions options;
};

struct AnnotationImport final : Operation {
    void describe(Parameters& p) override {
        p.input("mesh", Kind::mesh, mesh, "mesh file");
        p.input("input", Kind::text, input, "file to read");
        p.output("output", Kind::annotations, output, "annotations to write (.ant.json)");
        describe_format(p, format);
        p.input_option("onto", Kind::annotations, onto,
                       "annotations to which those of the file are added, or to which its table of attributes applies");
        options.describe(p.options);
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

std::unique_ptr<Operation> make_annotation_export() { return make<AnnotationExport>(); }
std::unique_ptr<Operation> make_annotation_import() { return make<AnnotationImport>(); }

}  // namespace ostraka

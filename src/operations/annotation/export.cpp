// annotation export
#include "operations/annotation/interchange_format.h"
#include "operations/operations.h"

#include "ostraka/interchange/interchange.h"

#include <fmt/core.h>

namespace ostraka {

namespace {

struct AnnotationExport final : AnnotatedMeshOperation {
    void declare(Parameters& p) override {
        declare_inputs(p);
        p.output("output", Kind::text, output, "file to write, in the format of another tool");
        declare_format(p, format);
        options.declare_options(p.options);
        p.report.values(text("format"), integer("annotations"), integer("bytes"), text("sha256"));
    }

    void run(Context& context, Report& report) override {
        if (!format) format = guess_interchange_format(output.file());
        const AnnotationSet& annotation_set = set();
        const ExportedAnnotations exported =
            export_annotations({mesh->mesh, annotation_set}, *format, mesh.file(), context.provenance(), options);
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

}  // namespace

std::unique_ptr<Operation> make_annotation_export() { return make<AnnotationExport>(); }

}  // namespace ostraka

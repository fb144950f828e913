// annotation import
#include "operations/annotation/interchange_format.h"
#include "operations/annotation/mesh_labels.h"
#include "operations/operations.h"

#include "ostraka/annotation/label_file.h"
#include "ostraka/interchange/interchange.h"

#include <fmt/core.h>

namespace ostraka {

namespace {

struct AnnotationImport final : Operation {
    void declare(Parameters& p) override {
        p.input("mesh", Kind::mesh, mesh, "mesh file");
        p.input("input", Kind::text, input,
                "file to read, in the format of another tool; also a copy of the mesh with labels, such as scalar fields of "
                "CloudCompare (.ply, .obj), or an array of labels (.npy)");
        p.output("output", Kind::annotations, output, "annotations to write (.ant.json)");
        declare_format(p, format);
        p.input_option("onto", Kind::annotations, onto,
                       "annotations to which the annotations or attributes in the file are added");
        p.options("from", source, "source of the labels in a copy of the mesh (see annotation apply)",
                  Words{label_sources(), "values:NAME", {}});
        options.declare_options(p.options);
        p.report.values(text("format"), integer("annotations"));
        p.report.table("placed", integer("id", "id"), text("tag", "tag"), text("by", "by"), integer("points", "points"),
                       number("toSurface", "to surface", "length"), number("toVertex", "to vertex", "length"));
    }

    void run(Context& context, Report& report) override {
        if (!format && holds_labels(input.file())) return import_labels(context, report);
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

    static bool holds_labels(const std::string& file) {
        const std::string ending = extension(file);
        return ending == ".npy" || ending == ".ply" || ending == ".obj" || ending == ".labels" || ending == ".seg";
    }

    void import_labels(Context& context, Report& report) const {
        const MeshFile& target = *mesh;
        const Path path = input.path();
        const std::string ending = extension(path);
        MeshLabels labels;
        context.record([&] {
            if (ending != ".ply" && ending != ".obj") {
                labels = labels_in_file(path, target);
                return;
            }
            const MeshFile copy = read_mesh(path);
            if (copy.mesh.number_of_faces() != target.mesh.number_of_faces() ||
                copy.mesh.number_of_vertices() != target.mesh.number_of_vertices())
                fail_input(
                    input.file(),
                    fmt::format("has {} vertices and {} faces, the mesh {} and {}", copy.mesh.number_of_vertices(),
                                copy.mesh.number_of_faces(), target.mesh.number_of_vertices(), target.mesh.number_of_faces()),
                    "apply its labels to it ('annotation apply'), then 'annotation transfer' them");
            labels = labels_from(copy, path, source, input.file());
        });
        if (!labels.source.empty()) context.note("labels: " + labels.source);
        AnnotationSet set = regions_from_labels(target.mesh, labels.of_face, labels.names);
        if (onto) {
            AnnotationSet sum = onto.on(target.mesh);
            sum.provenance.SetNull();
            for (Annotation& annotation : set.annotations) {
                if (sum.find(annotation.id) != nullptr) annotation.id = free_id(sum);
                sum.annotations.push_back(std::move(annotation));
            }
            set = std::move(sum);
        }
        report("format", "labels")("annotations", set.annotations.size());
        report.empty_table("placed", false);
        output.write(std::move(set), target.mesh, mesh.file());
    }

    MeshInput mesh;
    FileInput input;
    AnnotationsInput onto;
    AnnotationsOutput output;
    std::optional<std::string> format;
    std::string source;
    ImportOptions options;
};

}  // namespace

std::unique_ptr<Operation> make_annotation_import() { return make<AnnotationImport>(); }

}  // namespace ostraka

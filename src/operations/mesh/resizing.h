// The same object at another resolution: bases of the operations that simplify, refine and remesh meshes.
#pragma once

#include "operations/operations.h"

#include "ostraka/annotation/label_file.h"
#include "ostraka/transfer/bound_mesh.h"

#include <fmt/core.h>

#include <tuple>
#include <utility>

namespace ostraka {

/// Declarations and reports of meshes before and after the change.
struct MeshResize : Operation {
    void declare_meshes(Parameters& p) {
        p.input("input", Kind::mesh, input, "mesh to read: .ply, .obj, .glb, .gltf, .stl, .off, .3mf");
        p.output("output", Kind::mesh, output.with_ascii_option(), "mesh to write: .ply, .obj, .off, .stl, .glb");
        for (const std::string mesh : {"input", "output"})
            p.report.values(integer(mesh + ".vertices"), integer(mesh + ".faces"), number(mesh + ".area", "", "length^2"));
        p.report.text_table("", {"mesh", "vertices", "faces", "area"});
    }
    static void report_totals(Report& report, const BoundMesh::Totals& before, const BoundMesh::Totals& after) {
        for (const auto& [mesh, when, totals] : {std::tuple{"input.", "before", before}, {"output.", "after", after}}) {
            report(std::string(mesh) + "vertices", totals.vertices)(std::string(mesh) + "faces", totals.faces)(
                std::string(mesh) + "area", totals.area);
            report.row("", {when, totals.vertices, totals.faces, number(totals.area)});
        }
    }

    MeshInput input;
    MeshOutput output;
};

/// Resizing with annotations, labels and colours transferred to the new mesh.
struct MeshResizeBound : MeshResize {
    void check() const override {
        if (static_cast<bool>(annotations) != static_cast<bool>(annotations_out))
            fail_usage("annotations are read from one file and written to another",
                       "give both --annotations and --annotations-out, or neither");
        const std::string kind = extension(output.file());
        if (annotations_out && (kind == ".stl" || kind == ".glb"))
            fail_usage(fmt::format("a {} file does not keep the vertices that annotations refer to", kind),
                       "write the mesh as .ply, .obj or .off");
    }

    void declare_bound(Parameters& p) {
        declare_meshes(p);
        p.input_option("annotations", Kind::annotations, annotations, "annotations of the input mesh (.ant.json)");
        p.output_option("annotations-out", Kind::annotations, annotations_out,
                        "annotations of the output mesh to write (.ant.json)");
        p.output_option("labels-out", Kind::labels, labels_out,
                        "text file to write: the label of each face of the output mesh, one per line");
        p.report.table(
            "annotations", integer("id", "id"), text("tag", "tag"), text("type", "type"), integer("before.elements", "elements"),
            integer("after.elements", "after"), number("before.area", "area", "length^2"), number("after.area", "", "length^2"),
            text_only("change of area"), number("before.length", "length", "length"), number("after.length", "", "length"),
            text_only("change of length"), boolean("degenerate"), text("note", "note"));
    }

    /// Reads the input, calls `work`, reports the changes and writes the outputs.
    template <class Resize>
    auto resize(Context& context, Report& report, const Resize& work) {
        const AnnotationSet* set = annotations ? &annotations.on(input->mesh) : nullptr;
        if (labels_out && input->extras.face_labels.empty())
            fail_usage(input.file() + " holds no face labels to write", "leave out --labels-out");
        BoundMesh bound(input.take(), set != nullptr ? std::optional(*set) : std::nullopt);
        const Stopwatch stopwatch;
        const auto result = in_file(input.file(), [&] { return work(bound); });
        report.run("seconds", stopwatch.seconds());
        report.notes(bound.notes);
        report_totals(report, bound.before, bound.after);
        if (labels_out) write_labels(labels_out.path(), bound.extras.face_labels);
        if (set != nullptr) {
            report_changes(report, bound.changes);
            context.notes("", bound.annotations->notes);
            annotations_out.write(std::move(*bound.annotations), bound.mesh, output.file_name());
        }
        output.write(std::move(bound.mesh), std::move(bound.extras));
        return result;
    }

    static void report_changes(Report& report, const std::vector<BoundMesh::Change>& changes) {
        const auto percent = [](double before, double after) {
            return before > 0 ? number(100 * (after / before - 1), 3) + " %" : std::string();
        };
        report.line("");
        report.empty_table("annotations");
        for (const BoundMesh::Change& change : changes) {
            Report::Row row = report.row("annotations");
            row("id", change.id)("tag", change.tag)("type", to_string(change.type));
            for (const auto& [when, size] : {std::pair{"before.", change.before}, {"after.", change.after}})
                row(std::string(when) + "elements", size.elements)(std::string(when) + "area", size.area)(
                    std::string(when) + "length", size.length);
            row.shown("change of area", percent(change.before.area, change.after.area));
            row.shown("change of length", percent(change.before.length, change.after.length));
            row("degenerate", change.degenerate)("note", change.note);
        }
    }

    AnnotationsInput annotations;
    AnnotationsOutput annotations_out;
    FileOutput labels_out{".txt"};
};

}  // namespace ostraka

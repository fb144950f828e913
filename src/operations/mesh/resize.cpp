// mesh simplify, refine, remesh: the same object at another resolution.
#include "operations/operations.h"

#include "ostraka/annotation/label_file.h"
#include "ostraka/remesh/remesh.h"
#include "ostraka/transfer/bound_mesh.h"

#include <fmt/core.h>

namespace ostraka {

namespace {

/// Declarations and reports shared by the three operations.
struct MeshResize : Operation {
    void describe_meshes(Parameters& p) {
        p.input("input", Kind::mesh, input, "mesh to read: .ply, .obj, .off, .stl");
        p.output("output", Kind::mesh, output.with_encoding(), "mesh to write: .ply, .obj, .off, .stl, .glb");
        for (const std::string mesh : {"input", "output"})
            p.report.values(integer(mesh + ".vertices"), integer(mesh + ".faces"), number(mesh + ".area", "", "length^2"));
        p.report.people_table("", {"mesh", "vertices", "faces", "area"});
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

    void describe_bound(Parameters& p) {
        describe_meshes(p);
        p.input_option("annotations", Kind::annotations, annotations, "annotations of the input mesh (.ant.json)");
        p.output_option("annotations-out", Kind::annotations, annotations_out,
                        "where to write the annotations of the output mesh");
        p.output_option("labels-out", Kind::labels, labels_out, "where to write the face labels of the input mesh, one per line");
        p.report.table("annotations", integer("id", "id"), text("tag", "tag"), text("type", "type"),
                       integer("before.elements", "elements"), integer("after.elements", "after"),
                       number("before.area", "area", "length^2"), number("after.area", "", "length^2"), people("change of area"),
                       number("before.length", "length", "length"), number("after.length", "", "length"),
                       people("change of length"), boolean("degenerate"), text("note", "note"));
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

struct MeshSimplify final : MeshResizeBound {
    void describe(Parameters& p) override {
        describe_bound(p);
        p.output_option("vertex-map", Kind::index_map, vertex_map, "JSON file to write: the new vertex of each old one");
        p.output_option("face-map", Kind::index_map, face_map,
                        "JSON file to write: the new face of each old one, -1 where it vanished");
        options.describe(p.options);
        p.options.find("vertices")->required();
        outlines = p.options.find("outlines");
        p.options("protect-outlines", protect, "the same as --outlines protect; pins of measures stay too").unrecorded();
        p.report.values(boolean("reached"), text("stop_reason"), integer("collapses"), boolean("outlines_broken"),
                        integer("isolated_dropped"));
    }

    void check() const override {
        MeshResizeBound::check();
        if (protect && outlines->given) fail_usage("--protect-outlines and --outlines", "give one of them");
    }

    void run(Context& context, Report& report) override {
        if (protect) options.outlines = SimplifyOptions::Outlines::protect;
        std::size_t vertices = 0, faces = 0;
        SimplifyResult result = resize(context, report, [&](BoundMesh& bound) {
            SimplifyResult simplified = bound.simplify(options);
            vertices = bound.mesh.number_of_vertices(), faces = bound.mesh.number_of_faces();
            return simplified;
        });
        report("reached", result.reached)("stop_reason", result.stop_reason)("collapses", result.collapses)(
            "outlines_broken", result.outlines_broken)("isolated_dropped", result.isolated_dropped);
        if (!result.reached) {
            report.note("the requested number of vertices could not be reached: " + result.stop_reason);
            report.answer_no();
        }
        if (result.outlines_broken) report.note("outlines or lines had to be merged to reach the number");
        if (result.isolated_dropped > 0) report.note(std::to_string(result.isolated_dropped) + " isolated vertices were dropped");
        if (vertex_map) vertex_map.write({"vertex", std::move(result.vertex_map), vertices});
        if (face_map) face_map.write({"face", std::move(result.face_map), faces});
    }

    IndexMapOutput vertex_map, face_map;
    SimplifyOptions options;
    bool protect = false;
    const Option* outlines = nullptr;
};

struct MeshRefine final : MeshResizeBound {
    void describe(Parameters& p) override {
        describe_bound(p);
        options.describe(p.options);
        p.report.values(integer("levels"), integer("bisections"));
    }

    void run(Context& context, Report& report) override {
        const RefineResult result = resize(context, report, [&](BoundMesh& bound) { return bound.refine(options); });
        report("levels", result.levels)("bisections", result.bisections);
    }

    RefineOptions options;
};

struct MeshRemesh final : MeshResize {
    void describe(Parameters& p) override {
        describe_meshes(p);
        options.describe(p.options);
        p.options.find("vertices")->required();
        p.report.values(boolean("reached"), number("target_edge_length", "", "length"), integer("vertices_before_adjustment"),
                        number("deviation", "", "length"));
    }

    void run(Context&, Report& report) override {
        const Mesh& mesh = input->mesh;
        const MeshExtras& extras = input->extras;
        if (!extras.vertex_colours.empty() || !extras.face_colours.empty() || !extras.vertex_labels.empty() ||
            !extras.face_labels.empty() || !extras.vertex_texture.empty() || !extras.corner_texture.empty())
            report.note("colours, labels and texture coordinates belong to the old mesh and are left out");
        const Stopwatch stopwatch;
        RemeshResult result = in_file(input.file(), [&] { return remesh(mesh, options); });
        report.run("seconds", stopwatch.seconds());
        report_totals(report, {mesh.number_of_vertices(), mesh.number_of_faces(), surface_area(mesh)},
                      {result.mesh.number_of_vertices(), result.mesh.number_of_faces(), surface_area(result.mesh)});
        report("reached", result.reached)("target_edge_length", result.target_edge_length)(
            "vertices_before_adjustment", result.remeshed)("deviation", result.deviation);
        if (!result.reached) {
            report.note(
                fmt::format("the requested number of vertices could not be reached: stopped at {} vertices, fewer would change "
                            "the topology or flip faces",
                            result.mesh.number_of_vertices()));
            report.answer_no();
        }
        output.write(std::move(result.mesh));
    }

    RemeshOptions options;
};

}  // namespace

std::unique_ptr<Operation> make_mesh_simplify() { return make<MeshSimplify>(); }
std::unique_ptr<Operation> make_mesh_refine() { return make<MeshRefine>(); }
std::unique_ptr<Operation> make_mesh_remesh() { return make<MeshRemesh>(); }

}  // namespace ostraka

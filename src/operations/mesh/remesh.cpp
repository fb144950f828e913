// mesh remesh
#include "operations/mesh/resizing.h"
#include "operations/operations.h"

#include "ostraka/remesh/remesh.h"

#include <fmt/core.h>

namespace ostraka {

namespace {

struct MeshRemesh final : MeshResize {
    void declare(Parameters& p) override {
        describe_meshes(p);
        options.list_options(p.options);
        p.options.find("vertices")->required();
        p.report.values(boolean("reached"), number("target_edge_length", "", "length"), integer("vertices_before_adjustment"),
                        number("deviation", "", "length"));
    }

    void run(Context&, Report& report) override {
        const Mesh& mesh = input->mesh;
        const MeshExtras& extras = input->extras;
        if (!extras.vertex_colours.empty() || !extras.face_colours.empty() || !extras.vertex_labels.empty() ||
            !extras.face_labels.empty() || !extras.corner_texture.empty())
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

std::unique_ptr<Operation> make_mesh_remesh() { return make<MeshRemesh>(); }

}  // namespace ostraka

// mesh remesh
#include "operations/mesh/baking.h"
#include "operations/mesh/resizing.h"
#include "operations/operations.h"

#include "ostraka/remesh/remesh.h"

#include <fmt/core.h>

namespace ostraka {

namespace {

struct MeshRemesh final : MeshResize {
    void declare(Parameters& p) override {
        declare_meshes(p);
        options.declare_options(p.options);
        p.options.find("vertices")->required();
        p.options(
            "texture", texture,
            "colours of the new mesh, baked from the input if the input has an image or colours: a new image, colours of the "
            "vertices, or none",
            Choices{"image", "vertices", "none"});
        baking.list_texel(p.options);
        Baking::declare_report(p.report);
        p.report.values(boolean("reached"), number("target_edge_length", "", "length"), integer("vertices_before_adjustment"),
                        number("deviation", "", "length"));
    }

    void run(Context&, Report& report) override {
        const Mesh& mesh = input->mesh;
        const MeshExtras& extras = input->extras;
        if (!extras.vertex_labels.empty() || !extras.face_labels.empty() || !extras.vertex_values.empty() ||
            !extras.face_values.empty())
            report.note("labels and values of the old mesh are not transferred");
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
        MeshExtras baked = baked_extras(result.mesh, report);
        output.write(std::move(result.mesh), std::move(baked));
    }

    /// The texture or the vertex colours of the new mesh.
    MeshExtras baked_extras(const Mesh& mesh, Report& report) const {
        MeshExtras baked;
        if (!has_colours(input->extras)) return baked;
        const bool image = texture == Texture::image && keeps_texture(output);
        if (texture == Texture::none) {
            report.note("colours and texture of the old mesh are not transferred");
        } else if (image) {
            baking.to_image(mesh, baked, *input, input.file(), output.file(), nullptr, report);
        } else {
            if (texture == Texture::image)
                report.note(fmt::format("a {} file keeps no image: colours are baked to the vertices", extension(output.file())));
            baking.to_vertices(mesh, baked, *input, input.file(), report);
        }
        return baked;
    }

    enum class Texture { image, vertices, none };
    RemeshOptions options;
    Baking baking;
    Texture texture = Texture::image;
};

}  // namespace

std::unique_ptr<Operation> make_mesh_remesh() { return make<MeshRemesh>(); }

}  // namespace ostraka

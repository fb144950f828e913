// mesh bake
#include "operations/mesh/baking.h"
#include "operations/operations.h"

#include <fmt/core.h>

namespace ostraka {

namespace {

struct MeshBake final : Operation {
    void declare(Parameters& p) override {
        p.input("target", Kind::mesh, target, "mesh that gets the colours");
        p.input("source", Kind::mesh, source,
                "mesh of the same object, in the same position, with the colours or the geometric detail");
        p.output("output", Kind::mesh, output.with_ascii_option(),
                 "target with its new texture (.obj, .ply, .glb) or vertex colours (.ply, .obj, .off, .glb)");
        p.options("to", to, "destination of the colours: an image, or the vertices", Choices{"image", "vertices"});
        p.options("layout", layout, "texture coordinates of the image: a new atlas, or the target's own", Choices{"new", "own"});
        baking.list_texel(p.options);
        baking.bake.declare_options(p.options);
        p.options.group("Image");
        baking.atlas.declare_options(p.options);
        p.options("format", baking.images.format, "format of the image", Choices{"png", "jpeg", "webp"});
        p.options("quality", baking.images.quality, "quality of JPEG and WebP", Range{1, 100});
        Baking::declare_report(p.report);
    }

    void check() const override {
        if (to == BakeTarget::image && output.has(0) && !keeps_texture(output))
            fail_usage(fmt::format("a {} file does not keep an image", extension(output.file())),
                       "write .obj, .ply or .glb, or bake --to vertices");
        if (to == BakeTarget::vertices && layout == Layout::own)
            fail_usage("--layout cannot be used with --to vertices", "leave out --layout, which applies to images only");
        if (layout == Layout::own && baking.texel > 0)
            fail_usage("--texel cannot be used with --layout own", "leave out --texel: the target's image has its size");
    }

    void run(Context&, Report& report) override {
        const MeshFile& from = *source;
        if (baking.bake.quantity == BakedQuantity::colour && !has_colours(from.extras))
            fail_input(source.file(), "has no image and no colours",
                       "give a source with colours, or bake --of occlusion, curvature or relief");
        MeshFile result = *target;
        const Stopwatch stopwatch;
        if (to == BakeTarget::vertices) {
            baking.to_vertices(result.mesh, result.extras, from, source.file(), report);
        } else {
            std::optional<TextureLayout> own;
            if (layout == Layout::own) own = layout_of(result, target.file());
            baking.to_image(result.mesh, result.extras, from, source.file(), output.file(), own ? &*own : nullptr, report);
        }
        report.run("seconds", stopwatch.seconds());
        output.write(std::move(result.mesh), std::move(result.extras));
    }

    /// An image of 8192 texels and its pyramid, besides the meshes.
    [[nodiscard]] double memory_needed(double input_bytes) const override { return 16 * input_bytes + 6e8; }

    enum class Layout { fresh, own };
    MeshInput target, source;
    MeshOutput output;
    BakeTarget to = BakeTarget::image;
    Layout layout = Layout::fresh;
    Baking baking;
};

}  // namespace

std::unique_ptr<Operation> make_mesh_bake() { return make<MeshBake>(); }

}  // namespace ostraka

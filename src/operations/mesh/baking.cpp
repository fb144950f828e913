#include "operations/mesh/baking.h"

#include <fmt/core.h>

namespace ostraka {

namespace {

void report_counts(Report& report, const BakeCounts& counts) {
    report("by_ray", counts.by_ray)("by_nearest", counts.by_nearest)("without_source", counts.without)(
        "mean_distance", counts.mean_distance)("largest_distance", counts.largest_distance);
    if (counts.total() > 0 && counts.without == counts.total())
        report.note("no part of the source was found near the target: do both have the same position, scale and unit?");
    else if (counts.without > 0)
        report.note(fmt::format("{:.2g} % of the samples lie farther from the source than --distance",
                                100 * static_cast<double>(counts.without) / static_cast<double>(counts.total())));
}

void report_range(Report& report, const BakeOptions& options, double low, double high) {
    if (options.quantity != BakedQuantity::colour) report("black", low)("white", high);
}

}  // namespace

void Baking::list_texel(OptionList& list) {
    list("texel", texel,
         "texel size of a new image: length on the surface; 0: that of the source's image, or half its mean edge length",
         Range{0, 1e60}, "length");
}

void Baking::declare_report(ReportLayout& layout) {
    layout.values(number("texel", "texel size", "length"), integer("image_width", "width of the image", "texels"),
                  integer("image_height", "height of the image", "texels"), integer("images", "images"),
                  integer("charts", "charts"), number("used", "share of the image used"),
                  number("largest_stretch", "largest stretch"), integer("samples", "rays per row of a texel"),
                  integer("by_ray", "samples found by ray"), integer("by_nearest", "samples found as the nearest point"),
                  integer("without_source", "samples without source"), number("mean_distance", "mean distance", "length"),
                  number("largest_distance", "largest distance", "length"), number("black", "value shown as black"),
                  number("white", "value shown as white"));
}

void Baking::to_image(const Mesh& target, MeshExtras& extras, const MeshFile& source, const std::string& source_file,
                      const std::string& output_file, const TextureLayout* layout, Report& report) const {
    Atlas made;
    if (layout == nullptr) {
        AtlasOptions options = atlas;
        options.texel = texel > 0 ? texel : texel_size(source);
        made = make_atlas(target, options);
        if (made.texel > options.texel)
            report.note(
                fmt::format("the surface does not fit into {} images of {} texels: the texel size is {:.4g} instead of {:.4g}",
                            max_atlas_images, options.max_size, made.texel, options.texel));
        layout = &made.layout;
        report("charts", made.charts)("used", made.used)("largest_stretch", made.largest_stretch);
    }
    const BakeResult result = ostraka::bake(target, *layout, source, bake, source_file);
    BakedImageOptions stored = images;
    stored.name = Path(output_file).stem().string();
    if (stored.name.empty()) stored.name = "texture";
    const bool shows_opacity = bake.quantity == BakedQuantity::colour;
    set_texture(extras, *layout, result.images, stored,
                shows_opacity ? alpha_of(source.extras.appearance) : Material::Alpha::opaque);
    report("texel", result.texel)("image_width", layout->width)("image_height", layout->height)("images", layout->images)(
        "samples", result.samples);
    report_counts(report, result.counts);
    report_range(report, bake, result.low, result.high);
}

void Baking::to_vertices(const Mesh& target, MeshExtras& extras, const MeshFile& source, const std::string& source_file,
                         Report& report) const {
    BakedVertices result = bake_vertices(target, source, bake, source_file);
    extras.vertex_colours = std::move(result.colours);
    extras.face_colours.clear();
    extras.corner_texture.clear();
    extras.face_materials.clear();
    extras.appearance = {};
    report_counts(report, result.counts);
    report_range(report, bake, result.low, result.high);
}

bool keeps_texture(const Slot& output) {
    const std::string kind = extension(output.file());
    return kind.empty() || kind == ".ply" || kind == ".obj" || kind == ".glb";
}

}  // namespace ostraka

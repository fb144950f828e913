// mesh simplify
#include "operations/mesh/baking.h"
#include "operations/mesh/resizing.h"
#include "operations/operations.h"

#include "ostraka/measure/appearance_change.h"
#include "ostraka/remesh/simplify.h"

namespace ostraka {

namespace {

struct MeshSimplify final : MeshResizeBound {
    void declare(Parameters& p) override {
        declare_bound(p);
        p.output_option("vertex-map", Kind::index_map, vertex_map,
                        "JSON file to write: for each old vertex, the index of the new vertex");
        p.output_option("face-map", Kind::index_map, face_map,
                        "JSON file to write: new index of each old face, -1 if it vanished");
        options.declare_options(p.options);
        p.options.find("vertices")->required();
        outlines = p.options.find("outlines");
        p.options("protect-outlines", protect, "same as --outlines protect").unrecorded();
        p.report.values(boolean("reached"), text("stop_reason"), integer("collapses"), boolean("outlines_broken"),
                        integer("isolated_dropped"), number("texture_error"), number("resampling_error"));
    }

    void check() const override {
        MeshResizeBound::check();
        if (protect && outlines->given) fail_usage("--protect-outlines and --outlines", "give one of them");
    }

    void run(Context& context, Report& report) override {
        if (protect) options.outlines = SimplifyOptions::Outlines::protect;
        std::size_t vertices = 0, faces = 0;
        SimplifyResult result = resize(context, report, [&](BoundMesh& bound) {
            std::optional<MeshFile> before;
            if (shows_images(bound.extras)) before = MeshFile{bound.mesh, bound.extras, {}, {}};
            SimplifyResult simplified = bound.simplify(options);
            vertices = bound.mesh.number_of_vertices(), faces = bound.mesh.number_of_faces();
            if (before) compare_textures(*before, bound, report);
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

    /// True if the mesh shows images in a file that keeps them.
    [[nodiscard]] bool shows_images(const MeshExtras& extras) const {
        return keeps_texture(output) && !extras.corner_texture.empty() &&
               std::any_of(extras.appearance.images.begin(), extras.appearance.images.end(),
                           [](const auto& image) { return image != nullptr; });
    }

    /// Reports how much the texture changed, and offers a new one where that is much more than a new one changes.
    void compare_textures(const MeshFile& before, const BoundMesh& bound, Report& report) const {
        const AppearanceChange change = appearance_change(before, bound.mesh, bound.extras, input.file());
        report("texture_error", change.mean)("resampling_error", change.resampling);
        if (!(change.mean > max_change && change.mean > max_ratio * change.resampling)) return;
        const std::string kind = extension(output.file()), file = output.file();
        report.note(fmt::format(
            "the charts of the texture are too small for so few vertices: colours differ by {} of 255 on average, {} "
            "times the difference that a new image makes by resampling (make one: ostraka mesh bake {} {} {}-baked{})",
            number(change.mean, 2), number(change.mean / std::max(change.resampling, 0.1), 2), file, input.file(),
            file.substr(0, file.size() - kind.size()), kind));
    }

    static constexpr double max_change = 3;  ///< mean difference of colours below which a change is not noted, of 255
    static constexpr double max_ratio = 2;   ///< likewise, relative to the difference that resampling makes

    IndexMapOutput vertex_map, face_map;
    SimplifyOptions options;
    bool protect = false;
    const Option* outlines = nullptr;
};

}  // namespace

std::unique_ptr<Operation> make_mesh_simplify() { return make<MeshSimplify>(); }

}  // namespace ostraka

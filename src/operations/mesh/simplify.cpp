// mesh simplify
#include "operations/mesh/resizing.h"
#include "operations/operations.h"

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

}  // namespace

std::unique_ptr<Operation> make_mesh_simplify() { return make<MeshSimplify>(); }

}  // namespace ostraka

// mesh repair: makes an oriented manifold from any file with faces.
#include "operations/diagnosis.h"
#include "operations/operations.h"

#include "ostraka/files/file.h"
#include "ostraka/io/repair.h"

#include <algorithm>

namespace ostraka {

namespace {

struct MeshRepair final : Operation {
    void declare(Parameters& p) override {
        p.input("input", Kind::mesh, input, "mesh to read: .ply, .obj, .glb, .gltf, .stl, .off, .3mf");
        p.output("output", Kind::mesh, output, "mesh to write: .ply, .obj, .off, .stl, .glb");
        p.output_option("vertex-map", Kind::index_map, vertex_map,
                        "JSON file to write: new index of each old vertex, -1 if it was dropped");
        p.output_option("face-map", Kind::index_map, face_map,
                        "JSON file to write: new index of each old triangle, -1 if it was dropped");
        p.output_option("report", Kind::report, report_file, "JSON file to write: the report that --json prints");
        options.declare_options(p.options);
        p.report.values(boolean("sound"), text("maps"), any("before"), any("after"));
        p.report.table("steps", text("step"), any("counts"));
        p.report.text_table("", {"step", "what", "count"});
    }

    void run(Context& context, Report& report) override {
        const TriangulatedSoup triangles = triangulate(input.take_polygons());
        RepairResult repaired = in_file(input.file(), [&] { return repair(triangles.soup, triangles.extras, options); });
        if (extension(output.file()) == ".stl") prepare_for_stl(repaired);
        context.notes("", triangles.notes);
        report.notes(repaired.notes);
        const bool sound = repaired.after.defects().empty();
        if (!sound) report.answer_no();
        report("sound", sound)("maps", repaired.maps_by_distance ? "nearest" : "exact")(
            "after", to_json(repaired.after, report.allocator()));
        if (repaired.before) report("before", to_json(*repaired.before, report.allocator()));
        report.empty_table("steps");
        for (const RepairStep& step : repaired.steps) report_result(report, step);
        const std::vector<std::string> shown{"vertices", "triangles", "components", "genus", "border loops", "area", "volume"};
        if (repaired.before) show(report, "before intersections were removed", *repaired.before, shown);
        show(report, "after", repaired.after, shown);
        report.text_only("verdict", rows_of(repaired.after).back().second);

        output.write(repaired.mesh, repaired.extras);
        const auto map = [&](const char* kind, const std::vector<Index>& indices, std::size_t count) {
            return IndexMap{kind, indices, count, {}, repaired.maps_by_distance};
        };
        if (vertex_map) vertex_map.write(map("vertex", repaired.vertex_map, repaired.mesh.number_of_vertices()));
        if (face_map) face_map.write(map("face", repaired.face_map, repaired.mesh.number_of_faces()));
        if (!report_file) return;
        report.set_provenance(context.provenance());
        report_file.write(report.to_json());
    }

    static void show(Report& report, const char* title, const MeshDiagnosis& diagnosis, const std::vector<std::string>& shown) {
        report.line(title);
        for (const auto& [quantity, value] : rows_of(diagnosis))
            if (std::find(shown.begin(), shown.end(), quantity) != shown.end()) report.text_only(quantity, value);
    }

    static void report_result(Report& report, const RepairStep& step) {
        JsonValue counts(rapidjson::kObjectType);
        std::string name = step.name;  // shown once, beside its first count
        for (const auto& [quantity, count] : step.counts) {
            add_members(counts, report.allocator(), quantity, count);
            if (count == 0) continue;
            report.row("", {name, quantity, count});
            name.clear();
        }
        if (!name.empty()) report.row("", {name, "nothing to do", "-"});
        report.row("steps")("step", step.name)("counts", std::move(counts));
    }

    MeshInput input;
    MeshOutput output;
    IndexMapOutput vertex_map, face_map;
    JsonOutput report_file;
    RepairOptions options;
};

}  // namespace

std::unique_ptr<Operation> make_mesh_repair() { return make<MeshRepair>(); }

}  // namespace ostraka

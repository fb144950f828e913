// import: a scan as it comes becomes an object that every operation accepts.
#include "operations/diagnosis.h"
#include "operations/operations.h"

#include "ostraka/io/repair.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

struct Import final : Operation {
    void declare(Parameters& p) override {
        p.input("scan", Kind::mesh, scan, "mesh to import: .obj, .ply, .glb, .gltf, .stl, .off, .3mf");
        p.output("object", Kind::folder, object,
                 "folder for the object: the mesh, its annotations with unit and upward direction, index maps from the raw "
                 "file, and the raw files; created if missing");
        p.input_option("image", Kind::picture, image, "image for a mesh that has texture coordinates but names no image");
        p.options("unit", unit, "unit of the coordinates (any text, such as mm)");
        up.declare(p, "upward direction of the object; without it that of glTF, which has y upwards, else none");
        p.options("scraps", scraps, "pieces with a smaller share of the area are dropped; 0: none", Range{0, 0.5});
        p.options("keep-holes", keep_holes, "do not fill holes");
        p.options("no-raw", no_raw, "do not copy the raw files");
        p.report.values(boolean("sound"), text("mesh"), integer("vertices"), integer("triangles"), integer("materials"),
                        integer("images"), texts("raw_files"), texts("defects_of_raw_file"), any("after"));
        p.report.table("steps", text("step"), any("counts"));
        p.report.people_table("", {"step", "what", "count"});
    }

    void run(Context& context, Report& report) override {
        object.open();
        PolygonSoup polygons = scan.take_polygons();
        if (image) add_given_image(polygons, context);
        const std::vector<Index> file_vertices = polygons.vertex_of_file_vertex;
        report.line(state_in_words(polygons));
        const TriangulatedSoup triangles = triangulate(std::move(polygons));
        context.notes("", triangles.notes);
        if (triangles.soup.triangles.empty())
            fail_input(scan.file(), "has no faces", "make a surface of its points: ostraka mesh surface");
        const MeshDiagnosis before = in_file(scan.file(), [&] { return diagnose(triangles.soup); });
        for (const std::string& defect : before.defects()) report.line("  " + defect);

        RepairOptions options;
        options.min_component_share = scraps;
        if (keep_holes) options.fill_holes = 0;
        const RepairResult repaired = in_file(scan.file(), [&] { return repair(triangles.soup, triangles.extras, options); });
        report.notes(repaired.notes);
        for (const RepairStep& step : repaired.steps) report_step(report, step);
        const bool sound = repaired.after.defects().empty();
        if (!sound) report.answer_no();
        const std::string name = Path(scan.file()).stem().string();
        write_object(name, repaired, file_vertices);
        const std::vector<std::string> copies = no_raw ? std::vector<std::string>() : copy_raw(context.files_so_far());
        note_far_coordinates(repaired.after, report);
        report("sound", sound)("mesh", name + ".ply")("vertices", repaired.after.vertices)("triangles", repaired.after.triangles)(
            "materials", repaired.extras.appearance.materials.size())("images", repaired.extras.appearance.images.size())(
            "raw_files", copies)("defects_of_raw_file", before.defects())("after", to_json(repaired.after, report.allocator()));
        report.line(fmt::format("{}: {}, {}; {}", object.in(name + ".ply").string(),
                                fmt::format("{} vertices", repaired.after.vertices),
                                counted(repaired.after.triangles, "triangle"),
                                sound ? "closed, oriented and free of intersections" : joined(repaired.after.defects())));
    }

    /// The image that a person names for a mesh whose file names none.
    void add_given_image(PolygonSoup& polygons, Context& context) const {
        MeshExtras& extras = polygons.extras;
        if (extras.corner_texture.empty())
            fail_input(scan.file(), "has no texture coordinates, so that no image fits it", "leave out --image");
        for (const Material& material : extras.appearance.materials)
            if (material.image != no_index && extras.appearance.images[material.image] != nullptr)
                fail_input(scan.file(), "names an image of its own", "leave out --image");
        SharedImage given;
        context.record([&] { given = std::make_shared<const Image>(read_image(image.path())); });
        const auto index = static_cast<Index>(extras.appearance.images.size());
        extras.appearance.images.push_back(std::move(given));
        if (extras.appearance.materials.empty()) {
            extras.appearance.materials.emplace_back();
            extras.face_materials.assign(polygons.polygon_count(), 0);
        }
        for (Material& material : extras.appearance.materials) material.image = index;
    }

    static std::string state_in_words(const PolygonSoup& polygons) {
        std::vector<std::string> parts{fmt::format("{} vertices", polygons.points.size()),
                                       counted(polygons.polygon_count(), "face")};
        for (std::string& text : attributes_in_words(polygons.extras)) parts.push_back(std::move(text));
        return "read: " + joined(parts);
    }

    void write_object(const std::string& name, const RepairResult& repaired, const std::vector<Index>& file_vertices) const {
        object.write(name + ".ply", repaired.mesh, repaired.extras);
        AnnotationSet set;
        set.unit = unit;
        set.up = up.value();
        const std::string ending = extension(scan.file());
        if (!set.up && (ending == ".glb" || ending == ".gltf")) set.up = std::array<double, 3>{0, 1, 0};
        ensure_root(set, repaired.mesh);
        object.write(name + ".ant.json", {repaired.mesh, set}, name + ".ply");
        IndexMap vertices{"vertex", repaired.vertex_map, repaired.mesh.number_of_vertices(), "from vertices of the raw file",
                          repaired.maps_by_distance};
        if (!file_vertices.empty()) {
            vertices.map.clear();
            for (const Index v : file_vertices) vertices.map.push_back(v == no_index ? no_index : repaired.vertex_map[v]);
        }
        object.write(name + ".vertices.map.json", to_json(vertices));
        object.write(name + ".faces.map.json", to_json(IndexMap{"face", repaired.face_map, repaired.mesh.number_of_faces(),
                                                                "from triangles of the raw file", repaired.maps_by_distance}));
    }

    /// Copies the files that were read to the folder "raw"; files in subfolders keep their place below it.
    std::vector<std::string> copy_raw(const std::vector<Path>& raw_files) const {
        std::vector<std::string> names;
        const Path folder = Path(scan.file()).parent_path();
        for (const Path& file : raw_files) {
            Path inside = file.lexically_relative(folder.empty() ? Path(".") : folder);
            if (inside.empty() || *inside.begin() == "..") inside = file.filename();
            make_folder((object.path() / "raw" / inside).parent_path());
            const Path copy = object.in((Path("raw") / inside).string());
            write_file(copy, read_file(file));
            names.push_back((Path("raw") / inside).string());
        }
        return names;
    }

    void note_far_coordinates(const MeshDiagnosis& diagnosis, Report& report) const {
        const CGAL::Bbox_3& box = diagnosis.box;
        const double largest = std::max({std::fabs(box.xmin()), std::fabs(box.xmax()), std::fabs(box.ymin()),
                                         std::fabs(box.ymax()), std::fabs(box.zmin()), std::fabs(box.zmax())});
        constexpr double single_precision = 6e-8;  // half a unit in the last place of a float32, relative
        if (diagnosis.shortest_edge > 0 && largest * single_precision > 0.01 * diagnosis.shortest_edge)
            report.note(
                fmt::format("the coordinates are up to {} from the origin: files of single precision round them by {}; the "
                            "files written here have double precision ('ostraka mesh move' moves an object to the origin)",
                            number(largest, 3), number(largest * single_precision, 2)));
    }

    static void report_step(Report& report, const RepairStep& step) {
        JsonValue counts(rapidjson::kObjectType);
        for (const auto& [quantity, count] : step.counts) {
            add_members(counts, report.allocator(), quantity, count);
            if (count > 0) report.row("", {step.name, quantity, count});
        }
        report.row("steps")("step", step.name)("counts", std::move(counts));
    }

    MeshInput scan;
    FileInput image;
    FolderOutput object;
    DirectionOption up;
    std::string unit;
    double scraps = 0.001;
    bool keep_holes = false, no_raw = false;
};

}  // namespace

std::unique_ptr<Operation> make_import() { return make<Import>(); }

}  // namespace ostraka

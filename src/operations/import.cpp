// import: scans as they come become objects that every operation accepts.
#include "operations/diagnosis.h"
#include "operations/operations.h"

#include "ostraka/framework/input_path.h"
#include "ostraka/io/repair.h"
#include "ostraka/point_cloud/cloud_surface.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <new>

namespace ostraka {

namespace {

/// The triangles of a scan, and where they come from.
struct RawScan {
    TriangulatedSoup triangles;
    /// Vertex of each vertex of the file, as in PolygonSoup; of a point cloud, the vertex of each point.
    std::vector<Index> vertex_of_file_vertex;
    bool from_points = false;  ///< the surface was made of points
};

struct Import final : Operation {
    void declare(Parameters& p) override {
        p.input("scan", Kind::mesh, scan,
                "scans to import: meshes (.obj, .ply, .glb, .gltf, .stl, .off, .3mf) and point clouds (.e57, .las, .pts, .ptx, "
                ".pcd, .xyz and others); several become one object each")
            .many();
        p.output("object", Kind::folder, object,
                 "folder for the objects: for each the mesh, its annotations with unit and upward direction, index maps from the "
                 "raw file, and the raw files; created if missing");
        p.input_option("image", Kind::picture, image, "image for a mesh that has texture coordinates but names no image");
        p.options("unit", unit, "unit of the coordinates (any text, such as mm)");
        up.declare(p, "upward direction of the object; without it that of glTF, which has y upwards, else none");
        p.options("scraps", scraps, "pieces with a smaller share of the area are dropped; 0: none", Range{0, 0.5});
        p.options("keep-holes", keep_holes, "do not fill holes");
        p.options("no-raw", no_raw, "do not copy the raw files");
        p.report.values(boolean("sound"), integer("refused"), text("mesh"), integer("vertices"), integer("triangles"),
                        integer("materials"), integer("images"), texts("raw_files"), texts("defects_of_raw_file"), any("after"));
        p.report.table("steps", text("file"), text("step"), any("counts"));
        p.report.table("objects", text("file", "file"), text("mesh", "object"), text("state", "state"),
                       integer("vertices", "vertices"), integer("triangles", "triangles"), text("remarks", "remarks"),
                       integer("materials"), integer("images"), texts("raw_files"), texts("defects_of_raw_file"), any("after"));
    }

    void check() const override {
        if (image && scan.size() > 1) fail_usage("--image with several scans", "import the scan that the image belongs to alone");
    }

    void run(Context& context, Report& report) override {
        object.open();
        common_folder_ = common_folder();
        const std::vector<std::string> names = object_names();
        std::vector<std::string> problems;
        bool sound = true;
        for (std::size_t i = 0; i < scan.size(); ++i) {
            const std::string problem = scan.size() == 1
                                            ? import_scan(i, names[i], context, report, sound)
                                            : problem_of([&] { return import_scan(i, names[i], context, report, sound); });
            if (problem.empty()) continue;
            problems.push_back(problem);
            rows_.emplace_back([&report, file = scan.file(i), problem] {
                report.row("objects")("file", file)("state", "refused")("remarks", problem);
            });
        }
        for (const auto& add_row : rows_) add_row();
        if (problems.size() == scan.size())
            fail_input(counted(scan.size(), "scan"), "none of them can be imported: " + joined(problems, "; "));
        sound = sound && problems.empty();
        if (!sound) report.answer_no();
        report("sound", sound)("refused", problems.size());
    }

    /// Runs `work`; the text of its error, so that one scan that cannot be read stops no other.
    template <class Work>
    static std::string problem_of(const Work& work) {
        try {
            return work();
        } catch (const Error& error) {
            if (error.kind() == ErrorKind::cancelled) throw;
            return error.what();
        } catch (const std::bad_alloc&) {
            return "there is not enough memory";
        }
    }

    /// Imports one scan. Returns an empty text; problems are thrown.
    std::string import_scan(std::size_t i, const std::string& name, Context& context, Report& report, bool& sound) {
        const std::size_t files_before = context.files_so_far().size();
        const std::string file = scan.file(i), label = scan.size() > 1 ? scan.file_name(i) : std::string();
        const RawScan raw = read(i, label, context, report);
        const MeshDiagnosis before = in_file(file, [&] { return diagnose(raw.triangles.soup); });
        for (const std::string& defect : before.defects()) report.line("  " + defect);
        RepairOptions options;
        options.min_component_share = scraps;
        if (keep_holes) options.fill_holes = 0;
        RepairResult repaired = in_file(file, [&] { return repair(raw.triangles.soup, raw.triangles.extras, options); });
        context.notes(label, repaired.notes);
        for (const RepairStep& step : repaired.steps) report_step(report, file, step);
        rename_images(repaired.extras.appearance, name);
        write_object(i, name, repaired, raw);
        const std::vector<std::string> copies = no_raw ? std::vector<std::string>() : copy_raw(i, files_before, context);
        note_far_coordinates(repaired.after, label, context);
        const bool is_sound = repaired.after.defects().empty();
        sound = sound && is_sound;
        if (scan.size() == 1)
            report("mesh", name + ".ply")("vertices", repaired.after.vertices)("triangles", repaired.after.triangles)(
                "materials", repaired.extras.appearance.materials.size())("images", repaired.extras.appearance.images.size())(
                "raw_files", copies)("defects_of_raw_file", before.defects())("after",
                                                                              to_json(repaired.after, report.allocator()));
        rows_.emplace_back([&report, file, name, is_sound, copies, defects = before.defects(), after = repaired.after,
                            materials = repaired.extras.appearance.materials.size(),
                            images = repaired.extras.appearance.images.size()] {
            report.row("objects")("file", file)("mesh", name + ".ply")("state", is_sound ? "sound" : "open")(
                "vertices", after.vertices)("triangles", after.triangles)(
                "remarks", is_sound ? "closed, oriented and free of intersections" : joined(after.defects()))(
                "materials", materials)("images", images)("raw_files", copies)("defects_of_raw_file", defects)(
                "after", to_json(after, report.allocator()));
        });
        return {};
    }

    // ---- reading ----

    /// Reads a scan, and reports what it contains.
    RawScan read(std::size_t i, const std::string& label, Context& context, Report& report) {
        const std::string before = label.empty() ? "read: " : label + ": ";
        const auto& endings = point_cloud_endings();
        if (std::find(endings.begin(), endings.end(), extension(scan.file(i))) != endings.end())
            return read_points(i, before, label, context, report);
        PolygonSoup polygons = scan.take_polygons(i);
        if (polygons.polygon_count() == 0) return read_points(i, before, label, context, report);
        if (image) add_given_image(polygons, context);
        report.line(before + state_in_words(polygons));
        RawScan raw;
        raw.vertex_of_file_vertex = polygons.vertex_of_file_vertex;
        raw.triangles = triangulate(std::move(polygons));
        context.notes(label, raw.triangles.notes);
        if (raw.triangles.soup.triangles.empty())
            fail_input(scan.file(i), "has no face with three distinct corners",
                       "leave out its faces to have a surface made of its points (ostraka mesh surface)");
        return raw;
    }

    /// Reads a point cloud and makes a surface of it, as `mesh surface` does without options.
    RawScan read_points(std::size_t i, const std::string& before, const std::string& label, Context& context,
                        Report& report) const {
        if (image) fail_usage("--image for a point cloud", "leave it out");
        const std::string file = scan.file(i);
        std::optional<PointCloud> cloud;
        context.record([&] { cloud = read_point_cloud(path_of(scan, i)); });
        if (!cloud || cloud->points.empty()) fail_input(file, "has neither faces nor points", "export it again");
        context.notes(label, cloud->notes);
        CloudOptions options;
        options.close_holes = 0.02;
        constexpr const char* remedy = "make a surface of its points by other settings: ostraka mesh surface";
        CloudSurface surface = in_file(file, [&] {
            try {
                return reconstruct_surface(*cloud, options);
            } catch (const Error& error) {
                if (error.kind() != ErrorKind::input) throw;
                throw Error(error.kind(), error.where(), error.problem(), error.remedy().empty() ? remedy : error.remedy());
            }
        });
        context.notes(label, surface.notes);
        RawScan raw;
        raw.from_points = true;
        raw.triangles.extras = carried_to_vertices(*cloud, surface.mesh);
        raw.vertex_of_file_vertex.assign(cloud->points.size(), no_index);
        for (std::size_t v = 0; v < surface.sources.size(); ++v)
            if (surface.sources[v] != no_index) raw.vertex_of_file_vertex[surface.sources[v]] = static_cast<Index>(v);
        raw.triangles.soup = to_soup(surface.mesh);
        report.line(fmt::format(
            "{}{}{}{}; their surface has {} (made as by 'ostraka mesh surface', whose method poisson suits "
            "noisy points better)",
            before, counted(cloud->points.size(), "point"), cloud->colours.empty() ? "" : ", colours",
            cloud->intensities.empty() ? "" : ", intensities", counted(raw.triangles.soup.triangles.size(), "triangle")));
        return raw;
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
        return joined(parts);
    }

    // ---- writing ----

    /// Names of the objects: those of the files without extension, with a number where several scans have the same.
    [[nodiscard]] std::vector<std::string> object_names() const {
        std::vector<std::string> names;
        for (std::size_t i = 0; i < scan.size(); ++i) {
            const std::string stem = Path(scan.file(i)).stem().string();
            std::string name = stem;
            for (int k = 2; std::find(names.begin(), names.end(), name) != names.end(); ++k) name = fmt::format("{}-{}", stem, k);
            names.push_back(std::move(name));
        }
        return names;
    }

    /// Renames images whose name an earlier scan of this call uses for another image.
    void rename_images(Appearance& appearance, const std::string& name) {
        for (SharedImage& picture : appearance.images) {
            if (picture == nullptr) continue;
            const std::string file_name = lower_case(Path(picture->name).filename().string());
            const auto [known, is_new] = images_.try_emplace(file_name, picture);
            if (is_new || known->second->bytes == picture->bytes) continue;
            Image renamed = *picture;
            renamed.name = name + "_" + Path(picture->name).filename().string();
            picture = std::make_shared<const Image>(std::move(renamed));
            images_.try_emplace(lower_case(picture->name), picture);
        }
    }

    void write_object(std::size_t i, const std::string& name, const RepairResult& repaired, const RawScan& raw) const {
        object.write(name + ".ply", repaired.mesh, repaired.extras);
        AnnotationSet set;
        set.unit = unit;
        set.up = up.value();
        const std::string ending = extension(scan.file(i));
        if (!set.up && (ending == ".glb" || ending == ".gltf")) set.up = std::array<double, 3>{0, 1, 0};
        ensure_root(set, repaired.mesh);
        object.write(name + ".ant.json", {repaired.mesh, set}, name + ".ply");
        IndexMap vertices{"vertex", repaired.vertex_map, repaired.mesh.number_of_vertices(),
                          raw.from_points ? "from points of the raw file, as they were read" : "from vertices of the raw file",
                          repaired.maps_by_distance};
        if (!raw.vertex_of_file_vertex.empty()) {
            vertices.map.clear();
            for (const Index v : raw.vertex_of_file_vertex)
                vertices.map.push_back(v == no_index ? no_index : repaired.vertex_map[v]);
        }
        object.write(name + ".vertices.map.json", to_json(vertices));
        if (raw.from_points) return;
        object.write(name + ".faces.map.json", to_json(IndexMap{"face", repaired.face_map, repaired.mesh.number_of_faces(),
                                                                "from triangles of the raw file", repaired.maps_by_distance}));
    }

    /// The folder that contains all scans, directly or below.
    [[nodiscard]] Path common_folder() const {
        Path common;
        for (const Source& source : scan.sources) {
            if (source.file.empty() || is_memory(source.file)) continue;
            const Path folder = absolute_path(source.file).parent_path();
            if (common.empty()) common = folder;
            while (is_outside(folder.lexically_relative(common))) common = common.parent_path();
        }
        return common;
    }
    static Path absolute_path(const Path& file) { return std::filesystem::absolute(file).lexically_normal(); }
    static bool is_outside(const Path& relative) { return relative.empty() || *relative.begin() == ".."; }

    /// Copies the files that were read for a scan to the folder "raw", where they keep their places in the folder of the scans.
    [[nodiscard]] std::vector<std::string> copy_raw(std::size_t i, std::size_t files_before, const Context& context) const {
        std::vector<Path> files;
        if (!scan.sources[i].file.empty()) files.push_back(scan.sources[i].file);
        const std::vector<Path> read = context.files_so_far();
        for (std::size_t k = std::min(files_before, read.size()); k < read.size(); ++k)
            if (std::find(files.begin(), files.end(), read[k]) == files.end()) files.push_back(read[k]);
        std::vector<std::string> names;
        for (const Path& file : files) {
            Path inside = is_memory(file) ? Path() : absolute_path(file).lexically_relative(common_folder_);
            if (is_outside(inside)) inside = file.filename();
            make_folder((object.path() / "raw" / inside).parent_path());
            const Path copy = object.in((Path("raw") / inside).string());
            write_file(copy, read_file(file));
            names.push_back((Path("raw") / inside).string());
        }
        return names;
    }

    // ---- remarks ----

    static void note_far_coordinates(const MeshDiagnosis& diagnosis, const std::string& label, Context& context) {
        const CGAL::Bbox_3& box = diagnosis.box;
        const double largest = std::max({std::fabs(box.xmin()), std::fabs(box.xmax()), std::fabs(box.ymin()),
                                         std::fabs(box.ymax()), std::fabs(box.zmin()), std::fabs(box.zmax())});
        constexpr double single_precision = 6e-8;  // half a unit in the last place of a float32, relative
        if (diagnosis.shortest_edge > 0 && largest * single_precision > 0.01 * diagnosis.shortest_edge)
            context.notes(label,
                          {fmt::format("the coordinates are up to {} from the origin: files of single precision round them "
                                       "by {}; the files written here have double precision ('ostraka mesh move' moves an "
                                       "object to the origin)",
                                       number(largest, 3), number(largest * single_precision, 2))});
    }

    static void report_step(Report& report, const std::string& file, const RepairStep& step) {
        JsonValue counts(rapidjson::kObjectType);
        for (const auto& [quantity, count] : step.counts) {
            add_members(counts, report.allocator(), quantity, count);
            if (count > 0) report.line(fmt::format("  {}: {}: {}", step.name, quantity, count));
        }
        report.row("steps")("file", file)("step", step.name)("counts", std::move(counts));
    }

    MeshInput scan;
    FileInput image;
    FolderOutput object;
    DirectionOption up;
    std::string unit;
    double scraps = 0.001;
    bool keep_holes = false, no_raw = false;
    Path common_folder_;
    std::vector<std::function<void()>> rows_;    ///< add the rows of the table, below all lines
    std::map<std::string, SharedImage> images_;  ///< images written so far, by their names in lower case
};

}  // namespace

std::unique_ptr<Operation> make_import() { return make<Import>(); }

}  // namespace ostraka

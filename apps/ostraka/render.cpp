#include "ostraka/render/render.h"

#include "command.h"
#include "render_annotations.h"

#include "ostraka/core/parallel.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/render/values.h"

#include <chrono>
#include <iostream>
#include <map>
#include <memory>
#include <set>

namespace ostraka::app {

namespace {
struct RenderInput {
    std::vector<Path> files;  ///< the meshes, then the picture
    std::vector<std::string> annotations, maps, titles;
    std::string map_on = "auto", map_label, map_range, colour_by = "auto", unit;
    RenderOptions options;
};

/// A scene on its way to the picture.
struct Object {
    Scene scene;
    MeshExtras extras;
    std::vector<Index> triangle_polygon;
    std::optional<Mesh> mesh;  ///< where annotations need one
};

Object read_object(const Path& file, bool annotated, const Session& session) {
    Object object;
    std::vector<std::string> notes;
    if (annotated) {
        MeshFile read = read_mesh(file);
        object.scene.mesh = to_soup(read.mesh);
        object.mesh = std::move(read.mesh);
        object.extras = std::move(read.extras);
        object.triangle_polygon = std::move(read.triangle_polygon);
        notes = std::move(read.notes);
    } else {  // a picture needs no manifold
        TriangulatedSoup read = triangulate(read_polygons(file));
        object.scene.mesh = std::move(read.soup);
        object.extras = std::move(read.extras);
        object.triangle_polygon = std::move(read.triangle_polygon);
        notes = std::move(read.notes);
    }
    for (const auto& note : notes) session.note(file.string() + ": " + note);
    return object;
}

Rgb opaque(const Colour& colour) { return {colour[0], colour[1], colour[2]}; }

void colour_by_labels(Scene& scene, const MeshExtras& extras) {
    std::vector<std::int32_t> labels = extras.face_labels;
    if (labels.empty())
        for (const auto& [a, b, c] : scene.mesh.triangles) {  // the label of most corners, else of the first
            const auto& of = extras.vertex_labels;
            labels.push_back(of[b] == of[c] ? of[b] : of[a]);
        }
    std::map<std::int32_t, Rgb> colours;
    for (const auto label : labels) colours[label];
    std::size_t index = 0;
    for (auto& [label, colour] : colours) {
        colour = category_colour(index++);
        scene.legend.push_back({"label " + std::to_string(label), colour, LegendMark::area});
    }
    for (const auto label : labels) scene.face_colours.push_back(colours[label]);
}

/// The colours that the file itself gives, if any are wanted.
void colour_by_file(Scene& scene, const MeshExtras& extras, const std::string& colour_by, const Path& file) {
    const bool labels = !extras.face_labels.empty() || !extras.vertex_labels.empty();
    const bool colours = !extras.face_colours.empty() || !extras.vertex_colours.empty();
    if (colour_by == "labels" && !labels) fail_input(file.string(), "holds no labels", "leave out --colour-by");
    if (colour_by == "colours" && !colours) fail_input(file.string(), "holds no colours", "leave out --colour-by");
    if (colour_by == "labels" || (colour_by == "auto" && labels)) {
        colour_by_labels(scene, extras);
    } else if (colour_by != "none" && colours) {
        for (const auto& colour : extras.face_colours) scene.face_colours.push_back(opaque(colour));
        if (extras.face_colours.empty())
            for (const auto& colour : extras.vertex_colours) scene.vertex_colours.push_back(opaque(colour));
    }
}

void colour_by_map(Object& object, const Path& map, const std::string& map_on) {
    std::vector<double> values = read_values(map);
    const std::size_t vertices = object.scene.mesh.points.size(), triangles = object.scene.mesh.triangles.size();
    const auto& polygon = object.triangle_polygon;
    const std::size_t polygons = polygon.empty() ? triangles : polygon.back() + std::size_t{1};
    if (map_on != "face" && values.size() == vertices) {
        object.scene.vertex_values = std::move(values);
    } else if (map_on != "vertex" && values.size() == triangles) {
        object.scene.face_values = std::move(values);
    } else if (map_on != "vertex" && values.size() == polygons) {
        for (const Index p : polygon) object.scene.face_values.push_back(values[p]);
    } else {
        const std::string wanted = map_on == "vertex" ? std::to_string(vertices) + " vertices"
                                   : map_on == "face"
                                       ? std::to_string(triangles) + " faces"
                                       : std::to_string(vertices) + " vertices and " + std::to_string(triangles) + " faces";
        fail_input(map.string(), "holds " + std::to_string(values.size()) + " values for a mesh of " + wanted,
                   "give one value an element");
    }
}

ColourScale common_scale(const std::vector<Scene>& scenes, const RenderInput& input) {
    std::vector<const std::vector<double>*> lists;
    for (const Scene& scene : scenes) {
        lists.push_back(&scene.vertex_values);
        lists.push_back(&scene.face_values);
    }
    ColourScale scale = scale_of(lists, input.maps.front());
    if (!input.map_range.empty()) {
        char comma = 0, rest = 0;
        if (std::sscanf(input.map_range.c_str(), "%lf%c%lf%c", &scale.minimum, &comma, &scale.maximum, &rest) != 3 ||
            comma != ',' || !std::isfinite(scale.minimum) || !std::isfinite(scale.maximum) || !(scale.minimum < scale.maximum))
            fail_usage("map range '" + input.map_range + "' is not possible", "use SMALLEST,LARGEST such as 0,2.5");
        scale.diverging = scale.minimum < 0 && scale.maximum > 0;
    }
    scale.label = input.map_label;
    return scale;
}

/// The k-th of a list that is given for all meshes or for none; "none" stands for an empty place.
std::string item(const std::vector<std::string>& list, std::size_t k) { return list.empty() || list[k] == "none" ? "" : list[k]; }

void check_lists(const RenderInput& input, std::size_t meshes) {
    const auto check = [&](const char* flag, const std::vector<std::string>& list) {
        if (!list.empty() && list.size() != meshes)
            fail_usage("--" + std::string(flag) + " is given " + std::to_string(list.size()) + " times for " +
                           std::to_string(meshes) + " meshes",
                       "give it once a mesh, in their order; 'none' for a mesh that has none");
    };
    check("annotations", input.annotations);
    check("map", input.maps);
    check("title", input.titles);
}

/// Of the units that are known.
bool units_differ(const std::vector<Scene>& scenes) {
    std::set<std::string> units;
    for (const Scene& scene : scenes)
        if (!scene.unit.empty()) units.insert(scene.unit);
    return units.size() > 1;
}

/// As recipes take it, so that pixels of this picture can be picked.
JsonValue camera_json(const Pane& pane, const Rendering& rendering, JsonAllocator& allocator) {
    const PictureCamera& camera = pane.camera;
    const auto list = [&](std::initializer_list<double> numbers) {
        JsonValue array(rapidjson::kArrayType);
        for (const double x : numbers) array.PushBack(x, allocator);
        return array;
    };
    const bool parallel = camera.distance == 0;
    const Point eye =
        camera.centre + (parallel ? std::max(pane.width, pane.height) / camera.scale : camera.distance) * camera.toward;
    JsonValue result(rapidjson::kObjectType);
    add_member(result, "frame", "mesh", allocator);
    add_member(result, "eye", list({eye.x(), eye.y(), eye.z()}), allocator);
    add_member(result, "target", list({camera.centre.x(), camera.centre.y(), camera.centre.z()}), allocator);
    add_member(result, "up", list({camera.up.x(), camera.up.y(), camera.up.z()}), allocator);
    add_member(result, "projection", parallel ? "orthographic" : "perspective", allocator);
    add_member(result, "pixelsPerUnit", JsonValue(camera.scale), allocator);
    JsonValue size(rapidjson::kArrayType);
    size.PushBack(rendering.picture.width, allocator).PushBack(rendering.picture.height, allocator);
    add_member(result, "picture", std::move(size), allocator);
    JsonValue box(rapidjson::kArrayType);
    for (const int x : {pane.left, pane.top, pane.width, pane.height}) box.PushBack(x, allocator);
    add_member(result, "pane", std::move(box), allocator);
    return result;
}

JsonValue report(const std::vector<Scene>& scenes, const Rendering& rendering, const Path& picture, JsonAllocator& allocator) {
    JsonValue result(rapidjson::kObjectType);
    add_member(result, "picture", picture.filename().string(), allocator);
    add_member(result, "width", JsonValue(rendering.picture.width), allocator);
    add_member(result, "height", JsonValue(rendering.picture.height), allocator);
    JsonValue panes(rapidjson::kArrayType);
    for (const Pane& pane : rendering.panes) {
        JsonValue entry(rapidjson::kObjectType);
        const Scene& scene = scenes[pane.scene];
        add_member(entry, "object", JsonValue(static_cast<std::uint64_t>(pane.scene)), allocator);
        add_member(entry, "view", pane.view, allocator);
        add_member(entry, "vertices", JsonValue(static_cast<std::uint64_t>(scene.mesh.points.size())), allocator);
        add_member(entry, "faces", JsonValue(static_cast<std::uint64_t>(scene.mesh.triangles.size())), allocator);
        add_member(entry, "pixelsPerUnit", JsonValue(pane.pixels_per_unit), allocator);
        if (pane.bar_length > 0) add_member(entry, "scaleBar", JsonValue(pane.bar_length), allocator);
        add_member(entry, "markers", JsonValue(static_cast<std::uint64_t>(scene.markers.size())), allocator);
        add_member(entry, "markersShown", JsonValue(static_cast<std::uint64_t>(pane.markers_shown)), allocator);
        add_member(entry, "camera", camera_json(pane, rendering, allocator), allocator);
        panes.PushBack(entry, allocator);
    }
    add_member(result, "panes", std::move(panes), allocator);
    return result;
}

int run_render(const RenderInput& input, const Session& session) {
    if (input.files.size() < 2) fail_usage("a mesh and a picture are needed", "run: ostraka render mesh.ply picture.png");
    const std::vector<Path> meshes(input.files.begin(), input.files.end() - 1);
    const Path& picture = input.files.back();
    if (extension(picture) != ".png")
        fail_usage("picture '" + picture.string() + "' does not end in .png", "name the picture last, as PNG");
    check_lists(input, meshes.size());
    RenderOptions options = input.options;
    check_render_options(options);
    Provenance provenance;
    provenance.command = "render";
    std::vector<Path> inputs = meshes;
    for (std::size_t k = 0; k < meshes.size(); ++k)
        for (const std::string& file : {item(input.annotations, k), item(input.maps, k)})
            if (!file.empty()) inputs.emplace_back(file);
    check_outputs(inputs, {picture});

    using Clock = std::chrono::steady_clock;
    const auto since = [](Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); };
    const auto reading = Clock::now();
    std::vector<Scene> scenes;
    for (std::size_t k = 0; k < meshes.size(); ++k) {
        const std::string annotations = item(input.annotations, k), map = item(input.maps, k);
        Object object = read_object(meshes[k], !annotations.empty(), session);
        Scene& scene = object.scene;
        scene.title = !input.titles.empty() ? item(input.titles, k) : meshes.size() > 1 ? meshes[k].filename().string() : "";
        if (!map.empty()) colour_by_map(object, map, input.map_on);
        if (!annotations.empty()) {
            add_annotations(scene, options, *object.mesh, annotations);
        } else if (map.empty()) {
            colour_by_file(scene, object.extras, input.colour_by, meshes[k]);
        }
        if (!input.unit.empty()) scene.unit = input.unit;
        scenes.push_back(std::move(scene));
    }
    if (!input.maps.empty()) options.scale = common_scale(scenes, input);
    if (options.fit == "all" && units_differ(scenes)) {
        session.note("the objects have different units: each is drawn at a scale of its own");
        options.fit = "each";
    }
    const double read_seconds = since(reading);
    const Rendering rendering = render(scenes, options);
    const auto writing = Clock::now();
    write_png(picture, rendering.picture);
    if (!session.json) return done;

    Json document;
    auto& allocator = document.GetAllocator();
    for (const Path& file : inputs) provenance.add_input(file);
    provenance.options = list_options(options);
    JsonValue result = report(scenes, rendering, picture, allocator), run(rapidjson::kObjectType);
    add_member(run, "readSeconds", JsonValue(read_seconds), allocator);
    add_member(run, "buildSeconds", JsonValue(rendering.build_seconds), allocator);
    add_member(run, "drawSeconds", JsonValue(rendering.draw_seconds), allocator);
    add_member(run, "writeSeconds", JsonValue(since(writing)), allocator);
    add_member(run, "threads", JsonValue(threads()), allocator);
    session.print_report(provenance, document, result, &run);
    return done;
}
}  // namespace

void add_render(CLI::App& tool, Session& session) {
    const auto input = std::make_shared<RenderInput>();
    CLI::App* command = session.add(tool, "render", "make a picture of meshes, their annotations and maps",
                                    [input, &session] { return run_render(*input, session); });
    command->add_option("files", input->files, "one or more meshes, then the picture (PNG)")->required();
    const auto repeated = [&](const char* flag, std::vector<std::string>& list, const char* help) {
        command->add_option(flag, list, help)
            ->expected(1)
            ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
            ->allow_extra_args(false);
    };
    repeated("--annotations", input->annotations, "annotation file; once a mesh, 'none' for a mesh without");
    repeated("--map", input->maps, "one number a vertex or face (.npy, or text with a number a line); once a mesh, or 'none'");
    repeated("--title", input->titles, "written under the object; once a mesh");
    command->add_option("--map-on", input->map_on, "what the map's numbers belong to; auto: as their count says")
        ->check(CLI::IsMember({"auto", "vertex", "face"}))
        ->capture_default_str();
    command->add_option("--map-label", input->map_label, "written beside the colour bar, with the unit");
    command->add_option("--map-range", input->map_range, "SMALLEST,LARGEST value of the colour bar instead of those met");
    command->add_option("--colour-by", input->colour_by, "the file's labels or colours; auto: what there is")
        ->check(CLI::IsMember({"auto", "labels", "colours", "none"}))
        ->capture_default_str();
    command->add_option("--unit", input->unit, "unit of the mesh, for the scale bar");
    add_flags(command, input->options);
}

}  // namespace ostraka::app

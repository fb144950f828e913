// render: a picture of meshes, their annotations and maps.
#include "operations/annotated_scene.h"
#include "operations/operations.h"
#include "operations/scene_colours.h"

#include "ostraka/annotation/colouring.h"
#include "ostraka/core/message_text.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/render/render.h"
#include "ostraka/vocabulary/text_match.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace ostraka {

namespace {

struct Render final : Operation {
    void declare(Parameters& p) override {
        p.input("meshes", Kind::mesh, meshes, "mesh to draw; several are drawn in one picture").many();
        p.output("picture", Kind::picture, picture, "picture to write (.png, .svg or .pdf)");
        p.order({"meshes", "picture"});
        p.input_option("annotations", Kind::annotations, annotations,
                       "annotations to draw (.ant.json); given once per mesh; 'none' for a mesh without annotations")
            .many_or_none();
        p.input_option("map", Kind::values, maps,
                       "map: one number per vertex or face (.npy, or text with one number per line); given once per mesh; 'none' "
                       "for a mesh without a map")
            .many_or_none();
        p.input_option("cage", Kind::mesh, cages, "cage to draw around an object; once per mesh; 'none' for no cage")
            .many_or_none();
        p.options("measures", measures, "draw measures of the annotations with their pins and values");
        p.options("outlines", outlines, "course of drawn lines and borders of regions: along mesh edges (exact) or smoothed",
                  Choices{"exact", "smooth"});
        p.output_option("turntable", Kind::folder, turntable,
                        "folder to write: pictures of the object during a full turn (0001.png, ...)");
        p.options("frames", frames, "number of pictures of a full turn, for --turntable", Range{2, 3600});
        p.options("title", titles, "title under the object; given once per mesh; 'none' for a mesh without a title");
        p.options("map-on", map_on,
                  "elements to which the values of a map belong: vertices or faces; auto: decided by the number of values",
                  Choices{"auto", "vertex", "face"});
        p.options("property", property,
                  "name of a property of vertices or faces in the mesh file (PLY), which is shown as a map");
        p.options("map-label", map_label, "label of the colour bar, including the unit");
        p.options("map-range", map_range, "MIN,MAX: range of the colour bar, instead of the minimum and maximum of the map");
        p.options(
            "colour", colouring,
            "source of the surface colours. texture: the image in the file. own: colours of vertices or faces in the file. "
            "labels: "
            "labels in the file. annotations: colours of annotations. values: a map. clay: one neutral colour. auto: values "
            "or annotations if they are given, otherwise the texture, labels or colours in the file, otherwise clay",
            colouring_names());
        p.options("unit", unit, "unit of the mesh's coordinates, for the scale bar");
        options.declare_options(p.options);
        p.report.values(text("picture"));
        for (const char* side : {"width", "height"}) p.report.values(integer(side, "", "pixels"));
        p.report.values(number("dpi"), text("scale"));
        p.report.table("panes", integer("object"), text("view"), integer("vertices"), integer("faces"),
                       number("pixelsPerUnit", "", "pixels"), number("scaleBar", "", "length"), integer("markers"),
                       integer("markersShown"), any("camera"));
    }

    void check() const override {
        if (!picture.file().empty()) static_cast<void>(picture_kind(picture.file()));
        if (options.sixteen_bit && !picture.file().empty() && picture_kind(picture.file()) != PictureKind::pixels)
            fail_usage(fmt::format("--sixteen-bit with '{}'", picture.file()), "16 bits per channel need a .png picture");
        if (turntable.size() > 0 && !options.views.empty())
            fail_usage("--turntable with --views", "give one view, with which the turn begins");
        for (const auto& [flag, count] : {std::pair{"annotations", annotations.size()}, std::pair{"map", maps.size()},
                                          std::pair{"cage", cages.size()}, std::pair{"title", titles.size()}})
            if (count != 0 && count != meshes.size())
                fail_usage(fmt::format("--{} is given {} times for {} meshes", flag, count, meshes.size()),
                           "give it once per mesh, in their order; 'none' for a mesh that has none");
        const bool is_range =
            map_range.size() == 2 && std::isfinite(map_range[0]) && std::isfinite(map_range[1]) && map_range[0] < map_range[1];
        if (!map_range.empty() && !is_range)
            fail_usage("the map range is not valid", "use SMALLEST,LARGEST such as --map-range 0,2.5");
        check_render_options(options);
    }

    void run(Context& context, Report& report) override {
        RenderOptions render_options = options;
        const Stopwatch reading;
        std::vector<Scene> scenes;
        for (std::size_t k = 0; k < meshes.size(); ++k) scenes.push_back(read(context, k, render_options));
        const bool shows_values = std::any_of(scenes.begin(), scenes.end(), [](const Scene& scene) {
            return !scene.vertex_values.empty() || !scene.face_values.empty();
        });
        if (shows_values) render_options.scale = common_scale(scenes, property.empty() ? first_map() : property);
        if (render_options.fit == RenderOptions::Fit::all && units_differ(scenes)) {
            report.note("the objects have different units: each is drawn at its own scale");
            render_options.fit = RenderOptions::Fit::each;
        }
        report.run("readSeconds", reading.seconds());
        // If there are labels, the values of measures are placed beside the object instead of between the pins.
        if (render_options.labels)
            for (Scene& scene : scenes)
                for (SceneMarker& marker : scene.markers)
                    if (marker.through) marker.label.clear();
        const PictureKind kind = picture.file().empty() ? PictureKind::pixels : picture_kind(picture.file());
        const Rendering rendering = render(scenes, render_options, kind);
        report.run("buildSeconds", rendering.build_seconds);
        report.run("drawSeconds", rendering.draw_seconds);
        const Stopwatch writing;
        write(picture.path(), rendering);
        if (turntable.size() > 0) write_turn(scenes, render_options, kind);
        report.run("writeSeconds", writing.seconds());
        report.run("threads", threads());
        report("picture", picture.file_name())("width", rendering.width)("height", rendering.height);
        if (rendering.pixels_per_metre > 0) report("dpi", rendering.pixels_per_metre * 0.0254);
        if (!options.print_scale.empty()) report("scale", options.print_scale);
        report.empty_table("panes");
        for (const Pane& pane : rendering.panes) {
            const Scene& scene = scenes[pane.scene];
            const auto bar = pane.bar_length > 0 ? std::optional(pane.bar_length) : std::nullopt;
            report.row("panes")("object", pane.scene)("view", pane.view)("vertices", scene.mesh.points.size())(
                "faces", scene.mesh.triangles.size())("pixelsPerUnit", pane.pixels_per_unit)("scaleBar", bar)(
                "markers", scene.markers.size())("markersShown", pane.markers_shown)(
                "camera", camera_json(pane, rendering, report.allocator()));
        }
    }

    static void write(const Path& file, const Rendering& rendering) {
        if (!rendering.document.empty()) write_file(file, rendering.document);
        else if (!rendering.deep.rgba.empty()) write_png(file, rendering.deep, rendering.pixels_per_metre);
        else write_png(file, rendering.picture, rendering.pixels_per_metre);
    }

    /// Renders one full revolution of the camera, starting at the view of the picture.
    void write_turn(const std::vector<Scene>& scenes, RenderOptions render_options, PictureKind kind) const {
        turntable.open();
        const View begin = parse_view(render_options.view);
        const std::string ending = kind == PictureKind::pixels ? ".png" : kind == PictureKind::svg ? ".svg" : ".pdf";
        for (std::uint64_t i = 0; i < frames; ++i) {
            render_options.view =
                fmt::format("{},{}", number(begin.azimuth + 360.0 * double(i) / double(frames), 17), number(begin.elevation, 17));
            write(turntable.in(padded(i + 1, std::max<std::uint64_t>(9999, frames)) + ending),
                  render(scenes, render_options, kind));
        }
    }

    enum class MapOn { automatic, vertex, face };

    /// Reads the k-th object; its annotations give the up direction unless the options do.
    Scene read(Context& context, std::size_t k, RenderOptions& render_options) const {
        Scene scene;
        MeshExtras extras;
        std::vector<Index> polygon_of_triangle;
        if (annotations.has(k)) {
            const MeshFile& file = meshes.get(k);
            scene.mesh = to_soup(file.mesh);
            extras = file.extras;
            polygon_of_triangle = file.polygon_of_triangle;
        } else {  // rendering needs no manifold
            TriangulatedSoup triangles = triangulate(meshes.take_polygons(k));
            context.notes(meshes.size() > 1 ? meshes.file(k) : std::string(), triangles.notes);
            scene.mesh = std::move(triangles.soup);
            extras = std::move(triangles.extras);
            polygon_of_triangle = std::move(triangles.polygon_of_triangle);
        }
        if (!titles.empty()) scene.title = titles[k] == "none" ? "" : titles[k];
        else if (meshes.size() > 1) scene.title = meshes.file_name(k);
        const bool has_values = maps.has(k) || has_property(extras);
        if (!property.empty() && !has_values && meshes.size() == 1)
            fail_input(meshes.file(k), no_property(extras), "leave out --property");
        // Of several meshes, those that do not have the colours show what they have.
        const bool has_colours = is_available(colouring, extras, has_values, annotations.has(k));
        const SurfaceColouring wanted = has_colours || meshes.size() == 1 ? colouring : SurfaceColouring::automatic;
        const bool automatic = wanted == SurfaceColouring::automatic;
        SurfaceColouring colours =
            chosen_colouring(wanted, extras, has_values, automatic ? has_parts(k) : annotations.has(k), meshes.file(k));
        if (automatic && colours == SurfaceColouring::plain && annotations.has(k)) colours = SurfaceColouring::annotations;
        const bool coloured =
            render_options.drawing == RenderOptions::Drawing::surface || render_options.drawing == RenderOptions::Drawing::points;
        if (coloured) {
            const std::string hidden = hidden_colours(colours, extras);
            if (!hidden.empty()) context.notes(meshes.size() > 1 ? meshes.file(k) : std::string(), {hidden});
        }
        if (colours == SurfaceColouring::values && maps.has(k)) colour_by_map(scene, polygon_of_triangle, k);
        else if (colours == SurfaceColouring::values) colour_by_property(scene, extras);
        else if (colours == SurfaceColouring::texture && coloured) show_texture(scene, extras, meshes.file(k));
        else if (colours == SurfaceColouring::own && coloured) show_own_colours(scene, extras);
        else if (colours == SurfaceColouring::labels && coloured) colour_by_labels(scene, extras);
        if (annotations.has(k)) {
            const Mesh& mesh = meshes.get(k).mesh;
            const AnnotationSet& set = annotations.on(mesh, k);
            AnnotationStyle style;
            style.smooth = outlines == Outlines::smooth;
            style.measures = measures;
            style.painted = coloured && colours == SurfaceColouring::annotations;
            draw_annotations(scene, {mesh, set}, style);
            if (render_options.up == "auto" && set.up) render_options.up = up_words(set);
        }
        if (cages.has(k)) draw_cage(scene, cages.get(k).mesh);
        if (!unit.empty()) scene.unit = unit;
        scene.unit_metres = converted(1, scene.unit, "m").value_or(0);
        return scene;
    }

    /// True if the k-th object has annotations of parts, not only of the whole object.
    [[nodiscard]] bool has_parts(std::size_t k) const {
        if (!annotations.has(k)) return false;
        const auto& list = annotations.on(meshes.get(k).mesh, k).annotations;
        return std::any_of(list.begin(), list.end(), [](const Annotation& annotation) { return !annotation.all; });
    }

    static void colour_by_labels(Scene& scene, const MeshExtras& extras) {
        std::vector<std::int32_t> labels = extras.face_labels;
        if (labels.empty())
            for (const auto& [a, b, c] : scene.mesh.triangles) {  // majority label of the corners, else the label of the first
                const auto& corner_labels = extras.vertex_labels;
                labels.push_back(corner_labels[b] == corner_labels[c] ? corner_labels[b] : corner_labels[a]);
            }
        std::map<std::int32_t, Rgb> colours;
        for (const auto label : labels) colours[label];
        std::size_t index = 0;
        for (auto& [label, colour] : colours) {
            // A single label does not distinguish parts.
            colour = colours.size() > 1 ? category_colour(index) : Rgb{neutral_colour[0], neutral_colour[1], neutral_colour[2]};
            ++index;
            scene.legend.push_back({"label " + std::to_string(label), colour, LegendMark::area});
            SceneLabel& label_entry = scene.labels.emplace_back(SceneLabel{scene.legend.back().text, colour});
            for (std::size_t face = 0; face < labels.size(); ++face)
                if (labels[face] == label) label_entry.faces.push_back(static_cast<Index>(face));
        }
        for (const auto label : labels) scene.face_colours.push_back(colours[label]);
    }

    [[nodiscard]] const NamedValues* property_in(const std::vector<NamedValues>& values) const {
        const auto named =
            std::find_if(values.begin(), values.end(), [&](const NamedValues& one) { return one.name == property; });
        return property.empty() || named == values.end() ? nullptr : &*named;
    }
    [[nodiscard]] bool has_property(const MeshExtras& extras) const {
        return property_in(extras.vertex_values) != nullptr || property_in(extras.face_values) != nullptr;
    }
    [[nodiscard]] std::string no_property(const MeshExtras& extras) const {
        std::vector<std::string> names;
        for (const auto* values : {&extras.vertex_values, &extras.face_values})
            for (const NamedValues& named : *values) names.push_back(named.name);
        return fmt::format("has no property '{}'{}", property,
                           names.empty() ? "" : "; its properties are " + joined(names, ", "));
    }
    void colour_by_property(Scene& scene, const MeshExtras& extras) const {
        if (const NamedValues* values = property_in(extras.vertex_values)) scene.vertex_values = values->values;
        else scene.face_values = property_in(extras.face_values)->values;
    }

    void colour_by_map(Scene& scene, const std::vector<Index>& polygon, std::size_t k) const {
        const std::vector<double>& values = maps.get(k);
        const std::size_t vertices = scene.mesh.points.size(), triangles = scene.mesh.triangles.size();
        const std::size_t polygons = polygon.empty() ? triangles : polygon.back() + std::size_t{1};
        if (map_on != MapOn::face && values.size() == vertices) {
            scene.vertex_values = values;
        } else if (map_on != MapOn::vertex && values.size() == triangles) {
            scene.face_values = values;
        } else if (map_on != MapOn::vertex && values.size() == polygons) {
            for (const Index p : polygon) scene.face_values.push_back(values[p]);
        } else {
            const std::string points = std::to_string(vertices) + " vertices", faces = std::to_string(triangles) + " faces";
            fail_input(maps.file(k),
                       fmt::format("holds {} values for a mesh of {}", values.size(),
                                   map_on == MapOn::vertex ? points
                                   : map_on == MapOn::face ? faces
                                                           : fmt::format("{} and {}", points, faces)),
                       "give one value per element");
        }
    }

    /// File of the first map; empty if there is none.
    [[nodiscard]] std::string first_map() const {
        for (std::size_t k = 0; k < maps.size(); ++k)
            if (maps.has(k)) return maps.file(k);
        return {};
    }

    [[nodiscard]] ColourScale common_scale(const std::vector<Scene>& scenes, const std::string& map) const {
        std::vector<const std::vector<double>*> value_lists;
        for (const Scene& scene : scenes) {
            value_lists.push_back(&scene.vertex_values);
            value_lists.push_back(&scene.face_values);
        }
        ColourScale scale = scale_of(value_lists, map);
        if (!map_range.empty()) {
            scale.minimum = map_range[0];
            scale.maximum = map_range[1];
            scale.diverging = scale.minimum < 0 && scale.maximum > 0;
        }
        scale.label = map_label;
        return scale;
    }

    /// Whether the known units differ.
    static bool units_differ(const std::vector<Scene>& scenes) {
        std::set<std::string> units;
        for (const Scene& scene : scenes)
            if (!scene.unit.empty()) units.insert(scene.unit);
        return units.size() > 1;
    }

    /// The camera in the form of recipes, so that pixels of this picture can be selected.
    static JsonValue camera_json(const Pane& pane, const Rendering& picture, JsonAllocator& allocator) {
        const PictureCamera& camera = pane.camera;
        const auto triple = [](const auto& v) { return std::array{v.x(), v.y(), v.z()}; };
        const bool parallel = camera.distance == 0;
        const double distance = parallel ? std::max(pane.width, pane.height) / camera.scale : camera.distance;
        return json_object(allocator, "frame", "mesh", "eye", triple(camera.centre + distance * camera.toward), "target",
                           triple(camera.centre), "up", triple(camera.up), "projection",
                           parallel ? "orthographic" : "perspective", "pixelsPerUnit", camera.scale, "picture",
                           std::array{picture.width, picture.height}, "pane",
                           std::array{pane.left, pane.top, pane.width, pane.height});
    }

    MeshInput meshes;
    FileOutput picture{".png"};
    FolderOutput turntable;
    MeshInput cages;
    bool measures = false;
    enum class Outlines { exact, smooth } outlines = Outlines::exact;
    std::uint64_t frames = 72;
    AnnotationsInput annotations;
    ValuesInput maps;
    std::vector<std::string> titles;
    std::vector<double> map_range;
    std::string map_label, unit, property;
    MapOn map_on = MapOn::automatic;
    SurfaceColouring colouring = SurfaceColouring::automatic;
    RenderOptions options;
};

}  // namespace

std::unique_ptr<Operation> make_render() { return make<Render>(); }

}  // namespace ostraka

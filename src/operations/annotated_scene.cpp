#include "operations/annotated_scene.h"
#include "operations/scene_colours.h"

#include "ostraka/annotation/colouring.h"
#include "ostraka/annotation/curves.h"
#include "ostraka/annotation/smooth_regions.h"
#include "ostraka/core/message_text.h"
#include "ostraka/core/text.h"
#include "ostraka/framework/report.h"
#include "ostraka/geom/shortest_path.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/measure/measure.h"

#include <algorithm>
#include <map>

namespace ostraka {

namespace {

constexpr Rgb region_outline_colour{40, 40, 43};

Rgb annotation_colour(const Annotation& annotation) {
    const auto channel = [&](std::size_t i) { return static_cast<std::uint8_t>(std::clamp(annotation.colour[i], 0, 255)); };
    return {channel(0), channel(1), channel(2)};
}

LegendEntry annotation_legend(const Annotation& annotation, bool on_map) {
    const LegendMark mark = annotation.type == AnnotationType::point            ? LegendMark::point
                            : annotation.type == AnnotationType::line || on_map ? LegendMark::line
                                                                                : LegendMark::area;
    return {annotation.tag.empty() ? "annotation " + std::to_string(annotation.id) : annotation.tag,
            annotation_colour(annotation), mark};
}

class AnnotationDrawing {
public:
    AnnotationDrawing(Scene& scene, AnnotatedMeshView object, const AnnotationStyle& style)
        : scene_(scene),
          mesh_(object.mesh),
          style_(style),
          on_map_(!style.painted || !scene.vertex_values.empty() || !scene.face_values.empty()) {
        if (!on_map_) paint(object.annotations);
        if (!on_map_ && style.smooth) smooth();
    }

    void draw(const Annotation& annotation) {
        const Rgb colour = annotation_colour(annotation);
        switch (annotation.type) {
            case AnnotationType::region:
                if (style_.smooth) {
                    if (on_map_) outline_smoothly(annotation, colour);
                    break;
                }
                for (const Outline& outline : extract_outlines(mesh_, annotation.faces))
                    for (const auto& line : visible_parts(outline)) {
                        if (on_map_) add_line(line, colour, 3, true);
                        else add_line(line, region_outline_colour, 1.5, false);
                    }
                break;
            case AnnotationType::line:
                for (const auto& polyline : annotation.polylines) {
                    add_line(polyline, colour, 3.5, true);
                    if (style_.smooth) smooth_line(scene_.lines.back().points);
                }
                break;
            case AnnotationType::point:
                for (const Index v : annotation.points) scene_.markers.push_back({scene_.mesh.points[v], colour, 6, ""});
                break;
        }
    }

    void add_to_legend(const Annotation& annotation) {
        scene_.legend.push_back(annotation_legend(annotation, on_map_));
        const LegendEntry& entry = scene_.legend.back();
        SceneLabel& label = scene_.labels.emplace_back(SceneLabel{entry.text, entry.colour});
        label.faces = annotation.faces;
        for (const auto& polyline : annotation.polylines)
            if (label.points.empty() || polyline.size() > label.points.size()) {
                label.points.clear();
                for (const Index v : polyline) label.points.push_back(scene_.mesh.points[v]);
            }
        if (!annotation.points.empty()) label.points = {scene_.mesh.points[annotation.points.front()]};
        if (annotation.type != AnnotationType::region) label.faces.clear();
        if (label.faces.empty() && label.points.empty()) scene_.labels.pop_back();
    }

    void draw_measures(PathSearch& search, const Mesh& mesh, const Annotation& annotation, const std::string& unit) {
        constexpr Rgb ink{30, 30, 34}, white{255, 255, 255};
        for (const Attribute& attribute : annotation.attributes) {
            if (attribute.measure() == nullptr) continue;
            const Measure& measure = *attribute.measure();
            std::vector<Point> line = path_of_measure(search, mesh, measure);
            if (line.empty()) line = pins_of(mesh, measure);
            if (line.empty()) continue;
            SceneLine& drawn = scene_.lines.emplace_back();
            for (const Point& p : line) drawn.points.push_back({p.x(), p.y(), p.z()});
            drawn.colour = ink;
            drawn.width = 1.8;
            drawn.through = true;
            for (const Point& p : pins_of(mesh, measure)) scene_.markers.push_back({{p.x(), p.y(), p.z()}, white, 3.5, "", true});
            const std::string shown_unit = !measure.unit.empty() ? measure.unit : unit;
            std::string text = attribute.name;
            if (measure.value) text += ": " + digits(*measure.value, 4) + (shown_unit.empty() ? "" : " " + shown_unit);
            scene_.labels.push_back({text, ink, {}, drawn.points, true});
            if (!measure.value) continue;
            // Without labels beside the object, the value is drawn at the middle of the line.
            const std::array<double, 3>&a = drawn.points[(drawn.points.size() - 1) / 2],
                                     &b = drawn.points[drawn.points.size() / 2];
            scene_.markers.push_back({{(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2}, ink, 0, text, true});
        }
    }

private:
    void paint(const AnnotationSet& set) {
        scene_.face_colours.assign(mesh_.number_of_faces(), clay);
        top_.assign(mesh_.number_of_faces(), nullptr);
        for (const Annotation* region : regions_largest_first({mesh_, set}))
            for (const Index face : region->faces) {
                scene_.face_colours[face] = annotation_colour(*region);
                top_[face] = region;
            }
    }

    /// Colours and outlines that follow the regions smoothly instead of along mesh edges.
    void smooth() {
        std::vector<int> labels;
        for (const Annotation* region : top_) labels.push_back(region == nullptr ? -1 : region->id);
        std::map<int, Rgb> colours{{-1, clay}};
        for (const Annotation* region : top_)
            if (region != nullptr) colours[region->id] = annotation_colour(*region);
        const SmoothRegions regions = smooth_regions(mesh_, labels);
        for (const auto& patch : regions.patches) scene_.patches.push_back({patch.face, colours[patch.label], patch.weights});
        add_outlines(regions, region_outline_colour, 1.5, false);
    }

    void outline_smoothly(const Annotation& region, const Rgb& colour) {
        std::vector<int> labels(mesh_.number_of_faces(), 0);
        for (const Index face : region.faces) labels[face] = 1;
        add_outlines(smooth_regions(mesh_, labels), colour, 3, true);
    }

    void add_outlines(const SmoothRegions& regions, const Rgb& colour, double width, bool cased) {
        for (const auto& outline : regions.outlines) {
            SceneLine& line = scene_.lines.emplace_back();
            for (const Point& p : outline) line.points.push_back({p.x(), p.y(), p.z()});
            line.colour = colour;
            line.width = width;
            line.cased = cased;
        }
    }

    /// Smooths a line: four rounds of averaging each point with the midpoint of its neighbours, end points fixed; then
    /// subdivides it and projects it onto the surface.
    void smooth_line(std::vector<std::array<double, 3>>& points) {
        const bool closed = points.size() > 3 && points.front() == points.back();
        if (closed) points.pop_back();
        const std::size_t n = points.size();
        if (n < 3) return;
        for (int round = 0; round < 4; ++round) {
            const auto before = points;
            for (std::size_t i = closed ? 0 : 1; i < (closed ? n : n - 1); ++i)
                for (std::size_t k = 0; k < 3; ++k)
                    points[i][k] = 0.5 * before[i][k] + 0.25 * (before[(i + n - 1) % n][k] + before[(i + 1) % n][k]);
        }
        if (closed) points.push_back(points.front());
        if (!surface_) surface_.emplace(mesh_);
        std::vector<std::array<double, 3>> dense;
        constexpr int parts = 4;
        for (std::size_t i = 0; i + 1 < points.size(); ++i)
            for (int part = 0; part < parts; ++part) {
                std::array<double, 3> at{};
                for (std::size_t k = 0; k < 3; ++k) at[k] = points[i][k] + part * (points[i + 1][k] - points[i][k]) / parts;
                const Point p = surface_->closest(Point(at[0], at[1], at[2])).point;
                dense.push_back({p.x(), p.y(), p.z()});
            }
        dense.push_back(closed ? dense.front() : points.back());
        points = std::move(dense);
    }

    void add_line(const std::vector<Index>& vertices, const Rgb& colour, double width, bool cased) {
        SceneLine& line = scene_.lines.emplace_back();
        for (const Index v : vertices) line.points.push_back(scene_.mesh.points[v]);
        line.colour = colour;
        line.width = width;
        line.cased = cased;
    }

    /// Whether the smallest region is the same on both sides of the edge.
    [[nodiscard]] bool covered(Index from, Index to) const {
        if (on_map_) return false;
        const Halfedge edge = mesh_.halfedge(Vertex(from), Vertex(to));
        const Face left = mesh_.face(edge), right = mesh_.face(mesh_.opposite(edge));
        return left != Mesh::null_face() && right != Mesh::null_face() && top_[left.idx()] == top_[right.idx()];
    }

    /// The closed outline, or its parts between covered edges.
    [[nodiscard]] std::vector<std::vector<Index>> visible_parts(const Outline& outline) const {
        const std::size_t n = outline.size();
        const auto corner = [&](std::size_t i) { return outline[i % n]; };
        std::size_t begin = 0;  // index after a covered edge, if there is one
        for (std::size_t i = 0; i < n && begin == 0; ++i)
            if (covered(corner(i), corner(i + 1))) begin = i + 1;
        std::vector<std::vector<Index>> lines;
        bool drawing = false;
        for (std::size_t i = begin; i < begin + n; ++i) {
            const bool hidden = covered(corner(i), corner(i + 1));
            if (!hidden && !drawing) lines.push_back({corner(i)});
            if (!hidden) lines.back().push_back(corner(i + 1));
            drawing = !hidden;
        }
        return lines;
    }

    Scene& scene_;
    const Mesh& mesh_;
    AnnotationStyle style_;
    bool on_map_;
    std::optional<SurfaceSearch> surface_;  ///< created when a line needs it
    std::vector<const Annotation*> top_;    ///< the smallest region on each face, or null; empty if the scene shows values
};

}  // namespace

void draw_annotations(Scene& scene, AnnotatedMeshView given, const AnnotationStyle& given_style) {
    // Free outlines are drawn exactly, on the mesh cut along them.
    const EdgeAlignedAnnotations along_edges(given);
    const auto& [mesh, set] = along_edges.object();
    AnnotationStyle style = given_style;
    if (const auto& cut = along_edges.cut()) {
        scene.mesh = to_soup(mesh);
        if (!scene.vertex_values.empty()) scene.vertex_values = cut->vertex_values(given.mesh, scene.vertex_values);
        if (!scene.face_values.empty()) scene.face_values = cut->face_values(scene.face_values);
        cut_scene_colours(scene, *cut, given.mesh);
        style.smooth = false;
    }
    AnnotationDrawing drawing(scene, {mesh, set}, style);
    // Outlines come first, so that lines are drawn on top of them.
    for (const bool regions : {true, false})
        for (const Annotation& annotation : set.annotations)
            if ((annotation.type == AnnotationType::region) == regions) drawing.draw(annotation);
    for (const Annotation& annotation : set.annotations) drawing.add_to_legend(annotation);
    if (style.measures) {
        PathSearch search(given.mesh);  // tapes follow edges of the original mesh
        for (const Annotation& annotation : given.annotations.annotations)
            drawing.draw_measures(search, given.mesh, annotation, set.unit);
    }
    scene.unit = set.unit;
}

std::string up_words(const AnnotationSet& set) {
    return set.up ? joined(*set.up, ",", [](double x) { return number(x, 17); }) : "auto";
}

Picture thumbnail(const Mesh& mesh, const AnnotationSet* set, const MeshExtras& extras, const std::string& size) {
    Scene scene;
    scene.mesh = to_soup(mesh);
    RenderOptions options;
    options.size = size;
    options.no_scale_bar = options.no_legend = true;
    AnnotationStyle style;
    style.painted = !has_texture(extras) && !has_own_colours(extras);
    if (has_texture(extras)) show_texture(scene, extras, "the picture");
    else show_own_colours(scene, extras);
    if (set != nullptr) {
        draw_annotations(scene, {mesh, *set}, style);
        options.up = up_words(*set);
    }
    return render({scene}, options).picture;
}

void draw_cage(Scene& scene, const Mesh& cage) {
    constexpr Rgb wire{70, 90, 130}, point{240, 170, 60};
    const auto at = [&](Vertex v) {
        const Point& p = cage.point(v);
        return std::array{p.x(), p.y(), p.z()};
    };
    for (const Edge edge : cage.edges()) {
        SceneLine& line = scene.lines.emplace_back();
        line.points = {at(cage.vertex(edge, 0)), at(cage.vertex(edge, 1))};
        line.colour = wire;
        line.width = 1.2;
        line.through = true;
    }
    for (const Vertex v : cage.vertices()) {
        scene.markers.push_back({at(v), point, 3.5, "", true});
        scene.around.push_back(at(v));
    }
}

}  // namespace ostraka

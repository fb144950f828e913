#include "render_annotations.h"

#include "ostraka/annotation/outline.h"

#include <algorithm>
#include <numeric>

namespace ostraka {

namespace {
constexpr Rgb region_outline_colour{40, 40, 43};

Rgb annotation_colour(const Annotation& annotation) {
    const auto channel = [&](std::size_t i) { return static_cast<std::uint8_t>(std::clamp(annotation.colour[i], 0, 255)); };
    return {channel(0), channel(1), channel(2)};
}

SceneLine scene_line(const Scene& scene, const std::vector<Index>& vertices, bool closed) {
    SceneLine line;
    for (const Index v : vertices) line.points.push_back(scene.mesh.points[v]);
    if (closed && !vertices.empty()) line.points.push_back(line.points.front());
    return line;
}

void draw_region_outlines(Scene& scene, const Mesh& mesh, const Annotation& annotation, bool on_map) {
    for (const Outline& outline : extract_outlines(mesh, annotation.faces)) {
        SceneLine line = scene_line(scene, outline, true);
        line.colour = on_map ? annotation_colour(annotation) : region_outline_colour;
        line.width = on_map ? 3 : 1.5;
        line.cased = on_map;
        scene.lines.push_back(std::move(line));
    }
}

/// Larger regions first, so that a part lies on top of the whole that contains it.
void paint_annotated_regions(Scene& scene, const std::vector<Annotation>& annotations) {
    std::vector<std::size_t> order(annotations.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return annotations[a].faces.size() > annotations[b].faces.size(); });
    scene.face_colours.assign(scene.mesh.triangles.size(), clay);
    for (const std::size_t i : order)
        for (const Index face : annotations[i].faces) scene.face_colours[face] = annotation_colour(annotations[i]);
}

void draw_annotation(Scene& scene, const Mesh& mesh, const Annotation& annotation, bool on_map) {
    const Rgb colour = annotation_colour(annotation);
    switch (annotation.type) {
        case AnnotationType::region:
            draw_region_outlines(scene, mesh, annotation, on_map);
            break;
        case AnnotationType::line:
            for (const auto& polyline : annotation.polylines) {
                SceneLine line = scene_line(scene, polyline, false);
                line.colour = colour;
                line.width = 3.5;
                line.cased = true;
                scene.lines.push_back(std::move(line));
            }
            break;
        case AnnotationType::point:
            for (const Index v : annotation.points) scene.markers.push_back({scene.mesh.points[v], colour, 6, ""});
            break;
    }
}

LegendEntry annotation_legend(const Annotation& annotation, bool on_map) {
    const LegendMark mark = annotation.type == AnnotationType::point            ? LegendMark::point
                            : annotation.type == AnnotationType::line || on_map ? LegendMark::line
                                                                                : LegendMark::area;
    return {annotation.tag.empty() ? "annotation " + std::to_string(annotation.id) : annotation.tag,
            annotation_colour(annotation), mark};
}
}  // namespace

void draw_annotations(Scene& scene, const Mesh& mesh, const AnnotationSet& set) {
    const bool on_map = !scene.vertex_values.empty() || !scene.face_values.empty();
    if (!on_map) paint_annotated_regions(scene, set.annotations);
    // Outlines come first, so that lines lie on top of them.
    for (const bool regions : {true, false})
        for (const Annotation& annotation : set.annotations)
            if ((annotation.type == AnnotationType::region) == regions) draw_annotation(scene, mesh, annotation, on_map);
    for (const Annotation& annotation : set.annotations) scene.legend.push_back(annotation_legend(annotation, on_map));
    scene.unit = set.unit;
}

}  // namespace ostraka

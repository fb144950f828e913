#include "annotated_scene.h"

#include "ostraka/annotation/colouring.h"
#include "ostraka/annotation/outline.h"

#include <algorithm>

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
    AnnotationDrawing(Scene& scene, const Mesh& mesh, const AnnotationSet& set)
        : scene_(scene), mesh_(mesh), on_map_(!scene.vertex_values.empty() || !scene.face_values.empty()) {
        if (!on_map_) paint(set);
    }

    void draw(const Annotation& annotation) {
        const Rgb colour = annotation_colour(annotation);
        switch (annotation.type) {
            case AnnotationType::region:
                for (const Outline& outline : extract_outlines(mesh_, annotation.faces))
                    for (const auto& line : seen_of(outline)) {
                        if (on_map_) add_line(line, colour, 3, true);
                        else add_line(line, region_outline_colour, 1.5, false);
                    }
                break;
            case AnnotationType::line:
                for (const auto& polyline : annotation.polylines) add_line(polyline, colour, 3.5, true);
                break;
            case AnnotationType::point:
                for (const Index v : annotation.points) scene_.markers.push_back({scene_.mesh.points[v], colour, 6, ""});
                break;
        }
    }

    void add_to_legend(const Annotation& annotation) { scene_.legend.push_back(annotation_legend(annotation, on_map_)); }

private:
    void paint(const AnnotationSet& set) {
        scene_.face_colours.assign(mesh_.number_of_faces(), clay);
        top_.assign(mesh_.number_of_faces(), nullptr);
        for (const Annotation* region : regions_largest_first(mesh_, set))
            for (const Index face : region->faces) {
                scene_.face_colours[face] = annotation_colour(*region);
                top_[face] = region;
            }
    }

    void add_line(const std::vector<Index>& vertices, const Rgb& colour, double width, bool cased) {
        SceneLine& line = scene_.lines.emplace_back();
        for (const Index v : vertices) line.points.push_back(scene_.mesh.points[v]);
        line.colour = colour;
        line.width = width;
        line.cased = cased;
    }

    /// An edge with one smaller region on both sides.
    [[nodiscard]] bool covered(Index from, Index to) const {
        if (on_map_) return false;
        const Halfedge edge = mesh_.halfedge(Vertex(from), Vertex(to));
        const Face left = mesh_.face(edge), right = mesh_.face(mesh_.opposite(edge));
        return left != Mesh::null_face() && right != Mesh::null_face() && top_[left.idx()] == top_[right.idx()];
    }

    /// The outline, closed, or what is left of it between its covered edges.
    [[nodiscard]] std::vector<std::vector<Index>> seen_of(const Outline& outline) const {
        const std::size_t n = outline.size();
        const auto corner = [&](std::size_t i) { return outline[i % n]; };
        std::size_t begin = 0;  // where a covered edge ends, if any is
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
    bool on_map_;
    std::vector<const Annotation*> top_;  ///< the smallest region on each face, null where none is; empty on a map
};

}  // namespace

void draw_annotations(Scene& scene, const Mesh& mesh, const AnnotationSet& set) {
    AnnotationDrawing drawing(scene, mesh, set);
    // Outlines come first, so that lines lie on top of them.
    for (const bool regions : {true, false})
        for (const Annotation& annotation : set.annotations)
            if ((annotation.type == AnnotationType::region) == regions) drawing.draw(annotation);
    for (const Annotation& annotation : set.annotations) drawing.add_to_legend(annotation);
    scene.unit = set.unit;
}

}  // namespace ostraka

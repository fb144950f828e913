#include "ostraka/annotation/colouring.h"

#include "ostraka/annotation/curves.h"

#include "ostraka/render/colour_scale.h"

#include <algorithm>
#include <set>

namespace ostraka {

namespace {

Colour opaque(const std::array<int, 3>& colour) {
    return {static_cast<std::uint8_t>(colour[0]), static_cast<std::uint8_t>(colour[1]), static_cast<std::uint8_t>(colour[2]),
            255};
}

/// Pairs of annotations (positions in the set, smaller first) whose regions share an edge.
std::set<std::pair<std::size_t, std::size_t>> neighbours_of(const Mesh& mesh, const AnnotationSet& set) {
    const std::size_t nobody = set.annotations.size();
    std::vector<std::size_t> owner(mesh.number_of_faces(), nobody);
    for (std::size_t i = 0; i < nobody; ++i)
        for (const Index face : set.annotations[i].faces) owner[face] = i;
    std::set<std::pair<std::size_t, std::size_t>> pairs;
    for (const auto edge : mesh.edges()) {
        const Face left = mesh.face(mesh.halfedge(edge, 0)), right = mesh.face(mesh.halfedge(edge, 1));
        if (left == Mesh::null_face() || right == Mesh::null_face()) continue;
        const auto [low, high] = std::minmax(owner[left.idx()], owner[right.idx()]);
        if (low != high && high != nobody) pairs.emplace(low, high);
    }
    return pairs;
}

}  // namespace

std::array<int, 3> distinct_colour(std::size_t index) {
    const Rgb colour = category_colour(index);
    return {colour.red, colour.green, colour.blue};
}

bool covers_nearly_all(const Mesh& mesh, const Annotation& annotation) {
    if (annotation.type != AnnotationType::region) return false;
    return annotation.all || 20 * annotation.faces.size() >= 19 * mesh.number_of_faces();
}

std::array<int, 3> fresh_colour(const Mesh& mesh, const AnnotationSet& set, const Annotation& joining) {
    if (covers_nearly_all(mesh, joining)) return neutral_colour;
    std::set<std::array<int, 3>> taken;
    for (const Annotation& annotation : set.annotations) taken.insert(annotation.colour);
    for (std::size_t index = 0; index < category_count; ++index)
        if (!taken.contains(distinct_colour(index))) return distinct_colour(index);
    return distinct_colour(set.annotations.size());
}

void colour_regions(const Mesh& mesh, AnnotationSet& set) {
    std::vector<std::vector<std::size_t>> before(set.annotations.size());  // neighbours that already have a colour
    for (const auto& [low, high] : neighbours_of(mesh, set)) before[high].push_back(low);
    std::array<std::size_t, category_hues> next{};  // the first unused colour of each hue
    for (std::size_t hue = 0; hue < category_hues; ++hue) next.at(hue) = hue;
    std::vector<std::size_t> hues(set.annotations.size(), category_hues);
    for (std::size_t i = 0; i < set.annotations.size(); ++i) {
        Annotation& annotation = set.annotations[i];
        if (covers_nearly_all(mesh, annotation)) {
            annotation.colour = neutral_colour;
            continue;
        }
        std::array<bool, category_hues + 1> beside{};
        for (const std::size_t neighbour : before[i]) beside.at(hues[neighbour]) = true;
        // If neighbours have all the hues, any hue may be used.
        const auto worse = [&](std::size_t a, std::size_t b) {
            return beside.at(a) != beside.at(b) ? beside.at(a) : next.at(a) > next.at(b);
        };
        std::size_t best = 0;
        for (std::size_t hue = 1; hue < category_hues; ++hue)
            if (worse(best, hue)) best = hue;
        hues[i] = best;
        annotation.colour = distinct_colour(next.at(best));
        next.at(best) += category_hues;
    }
}

std::vector<const Annotation*> regions_largest_first(const Mesh& mesh, const AnnotationSet& set) {
    std::vector<std::pair<double, const Annotation*>> regions;
    for (auto annotation = set.annotations.rbegin(); annotation != set.annotations.rend(); ++annotation) {
        if (annotation->type != AnnotationType::region) continue;
        regions.emplace_back(area_of(mesh, *annotation), &*annotation);
    }
    std::stable_sort(regions.begin(), regions.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    std::vector<const Annotation*> order;
    order.reserve(regions.size());
    for (const auto& [area, annotation] : regions) order.push_back(annotation);
    return order;
}

MeshExtras colour_by_annotation(const Mesh& mesh, const AnnotationSet& set) {
    const Colour grey{200, 200, 200, 255};
    MeshExtras extras;
    extras.face_colours.assign(mesh.number_of_faces(), grey);
    extras.vertex_colours.assign(mesh.number_of_vertices(), grey);
    for (const Annotation* region : regions_largest_first(mesh, set))
        for (const Index face : region->faces) {
            extras.face_colours[face] = opaque(region->colour);
            for (const Vertex corner : corners(mesh, Face(face))) extras.vertex_colours[corner] = opaque(region->colour);
        }
    for (const AnnotationType type : {AnnotationType::line, AnnotationType::point})
        for (const Annotation& annotation : set.annotations)
            if (annotation.type == type)
                for (const Index vertex : touched_vertices(mesh, annotation))
                    extras.vertex_colours[vertex] = opaque(annotation.colour);
    return extras;
}

}  // namespace ostraka

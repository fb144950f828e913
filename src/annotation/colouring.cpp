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
std::set<std::pair<std::size_t, std::size_t>> neighbours_of(AnnotatedMeshView object) {
    const std::size_t nobody = object.annotations.annotations.size();
    std::vector<std::size_t> owner(object.mesh.number_of_faces(), nobody);
    for (std::size_t i = 0; i < nobody; ++i)
        for (const Index face : object.annotations.annotations[i].faces) owner[face] = i;
    std::set<std::pair<std::size_t, std::size_t>> pairs;
    for (const auto edge : object.mesh.edges()) {
        const Face left = object.mesh.face(object.mesh.halfedge(edge, 0)),
                   right = object.mesh.face(object.mesh.halfedge(edge, 1));
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

std::array<int, 3> unused_colour(AnnotatedMeshView object, const Annotation& joining) {
    if (covers_nearly_all(object.mesh, joining)) return neutral_colour;
    std::set<std::array<int, 3>> taken;
    for (const Annotation& annotation : object.annotations.annotations) taken.insert(annotation.colour);
    for (std::size_t index = 0; index < category_count; ++index)
        if (!taken.contains(distinct_colour(index))) return distinct_colour(index);
    return distinct_colour(object.annotations.annotations.size());
}

void colour_regions(const Mesh& mesh, AnnotationSet& set) {
    std::vector<std::vector<std::size_t>> before(set.annotations.size());  // neighbours that already have a colour
    for (const auto& [low, high] : neighbours_of({mesh, set})) before[high].push_back(low);
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

std::vector<const Annotation*> regions_largest_first(AnnotatedMeshView object) {
    std::vector<std::pair<double, const Annotation*>> regions;
    for (auto annotation = object.annotations.annotations.rbegin(); annotation != object.annotations.annotations.rend();
         ++annotation) {
        if (annotation->type != AnnotationType::region) continue;
        regions.emplace_back(area_of(object.mesh, *annotation), &*annotation);
    }
    std::stable_sort(regions.begin(), regions.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    std::vector<const Annotation*> order;
    order.reserve(regions.size());
    for (const auto& [area, annotation] : regions) order.push_back(annotation);
    return order;
}

MeshExtras colour_by_annotation(AnnotatedMeshView object) {
    const Colour grey{200, 200, 200, 255};
    MeshExtras extras;
    extras.face_colours.assign(object.mesh.number_of_faces(), grey);
    extras.vertex_colours.assign(object.mesh.number_of_vertices(), grey);
    for (const Annotation* region : regions_largest_first(object))
        for (const Index face : region->faces) {
            extras.face_colours[face] = opaque(region->colour);
            for (const Vertex corner : corners(object.mesh, Face(face))) extras.vertex_colours[corner] = opaque(region->colour);
        }
    for (const AnnotationType type : {AnnotationType::line, AnnotationType::point})
        for (const Annotation& annotation : object.annotations.annotations)
            if (annotation.type == type)
                for (const Index vertex : touched_vertices(object.mesh, annotation))
                    extras.vertex_colours[vertex] = opaque(annotation.colour);
    return extras;
}

}  // namespace ostraka

#include "ostraka/annotation/colouring.h"

#include "region_order.h"

namespace ostraka {

namespace {

Colour opaque(const std::array<int, 3>& colour) {
    return {static_cast<std::uint8_t>(colour[0]), static_cast<std::uint8_t>(colour[1]), static_cast<std::uint8_t>(colour[2]),
            255};
}

}  // namespace

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

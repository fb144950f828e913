#include "ostraka/fracture/fragment.h"

#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"
#include "ostraka/geom/eigen.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>

namespace ostraka {

std::string to_string(Facet facet) { return enum_name(facet, {"outer", "inner", "fracture"}); }

std::optional<Facet> named_facet(const Annotation& annotation) {
    if (annotation.type != AnnotationType::region) return std::nullopt;
    std::string tag = annotation.tag;
    std::transform(tag.begin(), tag.end(), tag.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    for (const Facet facet : {Facet::outer, Facet::inner, Facet::fracture})
        if (tag == to_string(facet)) return facet;
    return std::nullopt;
}

std::vector<Facet> facets_of(AnnotatedMeshView object, Facet other) {
    std::vector<Facet> facets(object.mesh.number_of_faces(), other);
    std::vector<int> owner(facets.size(), -1);
    for (const Annotation& annotation : object.annotations.annotations) {
        const std::optional<Facet> facet = named_facet(annotation);
        if (!facet) continue;
        for (const Index face : annotation.faces) {
            if (owner[face] >= 0 && facets[face] != *facet)
                fail_input(fmt::format("annotation {}", annotation.id),
                           fmt::format("classifies face {} as {}, but annotation {} classifies it as {}", face, to_string(*facet),
                                       owner[face], to_string(facets[face])),
                           "remove the face from one of them");
            facets[face] = *facet;
            owner[face] = annotation.id;
        }
    }
    return facets;
}

Mesh moved(const Mesh& mesh, const Motion& motion) {
    Mesh result = mesh;
    for (const Vertex v : result.vertices()) result.point(v) = point_of(motion(eigen(mesh.point(v))));
    return result;
}

std::vector<bool> intact_faces(const std::vector<Facet>& facets) {
    std::vector<bool> marks(facets.size());
    for (std::size_t f = 0; f < marks.size(); ++f) marks[f] = facets[f] != Facet::fracture;
    return marks;
}

Mesh scaled_by(const Mesh& mesh, double scale) {
    Motion motion;
    motion.scale = scale;
    return moved(mesh, motion);
}

}  // namespace ostraka

#include "ostraka/semantic/cage_density.h"

#include "ostraka/core/error.h"
#include "ostraka/geom/point_tree.h"
#include "ostraka/relation/geometric.h"
#include "ostraka/semantic/edit.h"

#include <memory>

namespace ostraka {

CageDensity annotation_density(AnnotatedMeshView object, const std::vector<std::pair<int, double>>& factors) {
    std::map<Index, double> at;
    const auto mark = [&](Index v, double factor) {
        double& entry = at.try_emplace(v, factor).first->second;
        entry = std::max(entry, factor);
    };
    const auto lines = [&](const Annotation& annotation, double factor) {
        for (const Index v : annotation.points) mark(v, factor);
        for (const auto& polyline : annotation.polylines)
            for (const Index v : polyline) mark(v, factor);
    };
    if (factors.empty()) {
        for (const Annotation& annotation : object.annotations.annotations) {
            lines(annotation, 4);
            if (is_whole(object.mesh, annotation)) continue;
            std::vector<bool> inside(object.mesh.number_of_faces(), false);
            for (const Index f : annotation.faces) inside[f] = true;
            for (const Index f : annotation.faces)
                for (const Halfedge h : object.mesh.halfedges_around_face(object.mesh.halfedge(Face(f)))) {
                    const Face other = object.mesh.face(object.mesh.opposite(h));
                    if (other == Mesh::null_face() || !inside[other])
                        mark(object.mesh.target(h).idx(), 4), mark(object.mesh.source(h).idx(), 4);
                }
        }
    }
    for (const auto& [id, factor] : factors) {
        const Annotation* annotation = object.annotations.find(id);
        if (annotation == nullptr)
            fail_input("annotations", "there is no annotation " + std::to_string(id), "use an id that is there");
        lines(*annotation, factor);
        for (const Index f : annotation->faces)
            for (const Vertex v : corners(object.mesh, Face(f))) mark(v.idx(), factor);
    }
    if (at.empty()) return {};
    std::vector<Point> places;
    std::vector<double> marked;
    for (const auto& [v, factor] : at) {
        places.push_back(object.mesh.point(Vertex(v)));
        marked.push_back(factor);
    }
    const auto tree = std::make_shared<PointTree>(places);
    const double search_radius = box_diagonal(object.mesh) / 20;
    return [tree, marked, search_radius](const Point& p) {
        double factor = 0;
        std::vector<Index> near;
        tree->within(p, search_radius, near);
        for (const Index i : near) factor = std::max(factor, marked[i]);
        return factor > 0 ? factor : 1.0;
    };
}

MirrorPlane find_mirror_plane(const Mesh& mesh, AnnotationSet set, const std::string& where) {
    Relationship stated;
    stated.type = "mirror symmetry";
    stated.annotations = {ensure_root(set, mesh).id};
    const RelationCheck check = RelationMeter({mesh, set}).measure(stated);
    if (check.verdict != Verdict::holds || !check.parameters.plane)
        throw Error(ErrorKind::failure, where, "is not mirror-symmetric: " + check.text, "give the plane, or leave --mirror out");
    const auto& [p, n] = *check.parameters.plane;
    return {Point(p[0], p[1], p[2]), Vector(n[0], n[1], n[2])};
}

}  // namespace ostraka

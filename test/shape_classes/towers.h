// A synthetic class: towers of two halves with random heights and width, as a template with measures and a proportion.
#pragma once

#include "meshes.h"

#include "ostraka/shape_classes/classify.h"
#include "ostraka/shape_classes/sample.h"

namespace ostraka::test {

struct Tower : AnnotatedMesh {
    RelationGraph graph;
    [[nodiscard]] ClassTemplate known() const { return {*this, graph}; }
};

/// A class's answer about an object.
inline ClassAnswer ask_class(const ShapeClass& learnt, const ClassTemplate& class_template, const WholeObject& object) {
    LearnOptions options;
    options.modes.sizes = learnt.sizes;
    return compare_with(learnt, learn_member(class_template, object, options));
}

inline Annotation half(const Mesh& mesh, int id, const std::string& tag, bool upper) {
    Annotation annotation;
    annotation.id = id;
    annotation.tag = tag;
    for (const Face face : mesh.faces())
        if ((centroid(mesh, face).z() > 0.5) == upper) annotation.faces.push_back(face.idx());
    Attribute height;
    height.name = "height";
    height.value = Measure();
    height.measure()->tool = "bounding";
    height.measure()->direction = {0, 0, 1};
    Index low = no_index, top = no_index;
    for (const Index v : touched_vertices(mesh, annotation)) {
        const double z = mesh.point(Vertex(v)).z();
        if (low == no_index || z < mesh.point(Vertex(low)).z()) low = v;
        if (top == no_index || z > mesh.point(Vertex(top)).z()) top = v;
    }
    height.measure()->points = {low, top};
    annotation.attributes.push_back(height);
    return annotation;
}

/// A box of 6 x 6 x 6 cells; the permitted proportion of its halves is 0.2 to `maximum`.
inline Tower tower(double maximum = 5) {
    Tower tower;
    TriangleSoup soup = box(6);
    tower.mesh = build_mesh(soup);
    double low = 1e9, high = -1e9;
    for (const Point& p : tower.mesh.points()) low = std::min(low, p.z()), high = std::max(high, p.z());
    for (const Vertex v : tower.mesh.vertices()) {
        const Point p = tower.mesh.point(v);
        tower.mesh.point(v) = Point((p.x() - low) / (high - low), (p.y() - low) / (high - low), (p.z() - low) / (high - low));
    }
    tower.annotations.unit = "mm";
    tower.annotations.annotations.push_back(half(tower.mesh, 1, "base", false));
    tower.annotations.annotations.push_back(half(tower.mesh, 2, "top", true));
    Relationship proportion;
    proportion.id = 7;
    proportion.type = "proportion";
    proportion.annotations = {2, 1};
    proportion.is_constraint = true;
    proportion.constraint =
        R"({"measure1": "height", "measure2": "height", "minValue": 0.2, "maxValue": )" + std::to_string(maximum) + "}";
    tower.graph.relationships.push_back(proportion);
    return tower;
}

/// The tower with the given width and heights of its halves, moved by `motion`.
inline WholeObject member_of(const Tower& tower, const std::string& name, double base, double top, double width,
                             const Motion& motion = {}) {
    WholeObject member;
    member.name = name;
    member.mesh = tower.mesh;
    for (const Vertex v : member.mesh.vertices()) {
        const Point p = tower.mesh.point(v);
        const double z = p.z() < 0.5 ? 2 * base * p.z() : base + 2 * top * (p.z() - 0.5);
        const Eigen::Vector3d q = motion(Eigen::Vector3d(width * p.x(), width * p.y(), z));
        member.mesh.point(v) = Point(q.x(), q.y(), q.z());
    }
    return member;
}

inline ShapeClass class_of(const Tower& tower, const std::vector<WholeObject>& members, const LearnOptions& options = {}) {
    std::vector<LearntMember> learnt;
    for (const WholeObject& member : members) learnt.push_back(learn_member(tower.known(), member, options));
    ShapeClass result = learn_class(tower.known(), learnt, options);
    result.name = "tower";
    return result;
}

}  // namespace ostraka::test

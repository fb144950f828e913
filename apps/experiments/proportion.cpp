#include "proportion.h"

#include "ostraka/core/error.h"

#include <algorithm>
#include <set>

namespace ostraka::experiments {

using Eigen::Vector3d;

const Measure& measure_of(const Annotation& part) {
    for (const Attribute& attribute : part.attributes)
        if (attribute.type == AttributeType::measure && attribute.name == "length") return attribute.measure;
    fail_input(part.tag, "has no measure called length", "see the recipe that the experiment names");
}

double length(const Measure& measure, const std::vector<Point>& points) {
    const Vector3d edge = eigen(points[measure.points[1]] - points[measure.points[0]]);
    if (!measure.direction) return edge.norm();
    const Vector3d direction((*measure.direction)[0], (*measure.direction)[1], (*measure.direction)[2]);
    return std::abs(direction.normalized().dot(edge));
}

double value_of(const Subject& subject, const Ratio& ratio, const std::vector<Point>& points) {
    return length(measure_of(subject.part(ratio.part)), points) / length(measure_of(subject.part(ratio.reference)), points);
}

Constraints thesis_proportions(const Subject& subject, const std::vector<Point>& edited, const std::vector<Ratio>& ratios,
                               bool anchored) {
    Constraints list;
    add_closeness(list, subject, edited, closeness_weight);
    for (const Ratio& ratio : ratios) {
        const Annotation& part = subject.part(ratio.part);
        const Measure &first = measure_of(part), &second = measure_of(subject.part(ratio.reference));
        const std::vector<Index> joint = joint_of(subject.mesh, part);
        std::set<Index> around(joint.begin(), joint.end());
        for (const Index v : joint)
            for (const Vertex w : subject.mesh.vertices_around_target(subject.mesh.halfedge(Vertex(v)))) around.insert(w.idx());
        add_laplacians(list, subject, {around.begin(), around.end()}, 1);
        const std::vector<Index> own = vertices_of(subject.mesh, part);
        std::vector<int> ids(own.begin(), own.end());
        const auto place = [&](Index v) {
            const auto found = std::find(ids.begin(), ids.end(), static_cast<int>(v));
            if (found != ids.end()) return static_cast<int>(found - ids.begin());
            ids.push_back(static_cast<int>(v));
            return static_cast<int>(ids.size() - 1);
        };
        kinds::Proportion kind{{ratio.min, ratio.max}, {{place(first.points[0]), place(first.points[1])}}};
        kind.part = static_cast<int>(ids.size());
        if (anchored)
            for (const Index v : joint) kind.anchors.push_back(place(v));
        kind.second = kinds::PinnedMeasure{{place(second.points[0]), place(second.points[1])}};
        const auto vector = [](const std::optional<std::array<double, 3>>& d) {
            return d ? std::optional(Vector3d((*d)[0], (*d)[1], (*d)[2])) : std::nullopt;
        };
        kind.measure.direction = vector(first.direction);
        kind.second->direction = vector(second.direction);
        list.push_back(make_constraint(kind, ids, 1, columns_of(subject.mesh)));
    }
    return list;
}

RelationGraph proportion_graph(const Subject& subject, const std::vector<Ratio>& ratios, bool hard) {
    RelationGraph graph;
    for (const Ratio& ratio : ratios)
        graph.relationships.push_back(constraint(
            static_cast<int>(graph.relationships.size()), "proportion", {subject.id(ratio.part), subject.id(ratio.reference)},
            fmt::format(R"({{"measure1": "length", "measure2": "length", "minValue": {:f}, "maxValue": {:f}{}}})", ratio.min,
                        ratio.max, hard ? R"(, "hard": true)" : ""),
            1));
    return graph;
}

}  // namespace ostraka::experiments

#include "revolution/stages.h"

#include <algorithm>
#include <functional>

namespace ostraka {

void annotate_revolution(RevolutionTemplate& result, const AxisFrame& frame, double lowest, const ProfileRings& profile_rings) {
    const std::vector<std::vector<Vertex>>& rings = profile_rings.vertices;
    const std::vector<std::size_t>& ring_of = profile_rings.of_vertex;
    AnnotationSet& set = result.annotations;
    set.object_class = "turned vessel";
    set.up = {frame.up.x(), frame.up.y(), frame.up.z()};
    const auto& line = result.profile;
    const auto higher = [](const Vector2d& a, const Vector2d& b) { return a.y() < b.y(); };
    const auto top = static_cast<std::size_t>(std::max_element(line.begin(), line.end(), higher) - line.begin());
    // The profile runs from the foot up the outside, then down the inside.
    std::size_t widest = 0, foot = 0;
    const double height = line[top].y();
    for (std::size_t i = 0; i <= top; ++i) {
        if (line[i].x() > line[widest].x()) widest = i;
        if (line[i].y() < 0.015 * height) foot = i;
    }
    std::vector<bool> outer(result.mesh.number_of_faces()), base(outer.size(), false);
    for (const Face f : result.mesh.faces()) {
        std::size_t low = line.size(), high = 0;
        for (const Vertex v : corners(result.mesh, f)) {
            low = std::min(low, ring_of[v]);
            high = std::max(high, ring_of[v]);
        }
        outer[f] = high <= top;
        base[f] = result.base && high <= foot;
    }
    ensure_root(set, result.mesh);
    Attribute axis;
    axis.name = "axis";
    auto& axis_line = axis.value.emplace<Descriptor>();
    axis_line.is_list = true;
    for (const Vector3d& v : {Vector3d(frame.foot + lowest * frame.up), frame.up})
        for (int k = 0; k < 3; ++k) axis_line.values.push_back(v[k]);
    set.annotations.front().attributes.push_back(axis);
    const auto new_annotation = [&](const std::string& tag, const std::array<int, 3>& colour) {
        Annotation annotation;
        annotation.id = free_id(set);
        annotation.tag = tag;
        annotation.colour = colour;
        return annotation;
    };
    const auto region = [&](const std::string& tag, std::array<int, 3> colour, const std::function<bool(Index)>& in) {
        Annotation annotation = new_annotation(tag, colour);
        for (Index f = 0; f < outer.size(); ++f)
            if (in(f)) annotation.faces.push_back(f);
        if (!annotation.faces.empty()) set.annotations.push_back(std::move(annotation));
    };
    region("outer", {186, 120, 82}, [&](Index f) { return outer[f]; });
    region("inner", {150, 110, 90}, [&](Index f) { return !outer[f]; });
    region("base", {90, 70, 60}, [&](Index f) { return base[f]; });
    const auto ring = [&](const std::string& tag, std::size_t i, std::array<int, 3> colour) {
        if (rings[i].size() < 3) return;
        Annotation annotation = new_annotation(tag, colour);
        annotation.type = AnnotationType::line;
        auto& polyline = annotation.polylines.emplace_back();
        for (const Vertex v : rings[i]) polyline.push_back(Index(v));
        polyline.push_back(Index(rings[i].front()));
        Measure ruler;
        ruler.tool = "ruler";
        ruler.points = {Index(rings[i].front()), Index(rings[i][rings[i].size() / 2])};
        ruler.value =
            (eigen(result.mesh.point(rings[i].front())) - eigen(result.mesh.point(rings[i][rings[i].size() / 2]))).norm();
        annotation.attributes.push_back({0, "diameter", std::move(ruler)});
        set.annotations.push_back(std::move(annotation));
    };
    ring(result.rim ? "rim" : "upper end", top, {40, 60, 120});
    ring("widest girth", widest, {40, 120, 60});
    if (result.base) ring("foot", foot, {60, 40, 40});
    const auto pole = [&](const std::string& tag, std::size_t i) {
        if (rings[i].size() != 1) return;
        Annotation annotation = new_annotation(tag, {30, 30, 30});
        annotation.type = AnnotationType::point;
        annotation.points = {Index(rings[i].front())};
        set.annotations.push_back(std::move(annotation));
    };
    pole("base centre", 0);
    pole("floor centre", line.size() - 1);
}

}  // namespace ostraka

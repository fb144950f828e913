#include "ostraka/io/bodies.h"

#include "io/soup_edges.h"
#include "io/soup_geometry.h"
#include "ostraka/core/progress.h"
#include "ostraka/mesh/disjoint_sets.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace ostraka {

namespace {

using BodyRole = SolidBodies::Role;

struct Component {
    bool closed = true;
    double volume = 0;  ///< signed
    Vector3d moment = Vector3d::Zero();
    CGAL::Bbox_3 box;
    std::vector<Index> triangles;
    bool repeated = false;
    std::size_t depth = 0;  ///< number of components that enclose it
    std::size_t group = 0;  ///< lowest index of the components that intersect it, directly or through others
    bool inward = false;    ///< true: oriented inwards
    bool cavity = false;    ///< true: bounds a cavity
};

Vector3d place(const TriangleSoup& soup, Index v) { return {soup.points[v][0], soup.points[v][1], soup.points[v][2]}; }

/// The component of each triangle, numbered by smallest vertex; no_index for triangles that repeat a corner.
std::vector<Index> component_of_triangles(const TriangleSoup& soup, std::size_t& count) {
    DisjointSets sets(soup.points.size());
    std::vector<std::uint8_t> used(soup.points.size(), 0);
    for (const auto& t : soup.triangles) {
        if (detail::repeats_corner(t)) continue;
        sets.unite(t[0], t[1]), sets.unite(t[0], t[2]);
        for (const Index v : t) used[v] = 1;
    }
    std::vector<Index> number(soup.points.size(), no_index), result(soup.triangles.size(), no_index);
    count = 0;
    for (Index v = 0; v < soup.points.size(); ++v)
        if (used[v] != 0 && sets.find(v) == v) number[v] = static_cast<Index>(count++);
    for (std::size_t t = 0; t < result.size(); ++t)
        if (!detail::repeats_corner(soup.triangles[t])) result[t] = number[sets.find(soup.triangles[t][0])];
    return result;
}

std::vector<Component> measured_components(const TriangleSoup& soup, const std::vector<Index>& component, std::size_t count) {
    std::vector<Component> parts(count);
    const CGAL::Bbox_3 box = detail::box_of_triangles(soup);
    const Vector3d centre(box.xmin() / 2 + box.xmax() / 2, box.ymin() / 2 + box.ymax() / 2, box.zmin() / 2 + box.zmax() / 2);
    const detail::SoupEdges edges = detail::group_edges(soup);
    for (std::size_t e = 0; e < edges.count(); ++e) {
        const Index* h = edges.first(e);
        if (edges.valence(e) == 2 && detail::origin(soup, h[0]) != detail::origin(soup, h[1])) continue;
        parts[component[h[0] / 3]].closed = false;
    }
    for (Index t = 0; t < soup.triangles.size(); ++t) {
        if (component[t] == no_index) continue;
        Component& part = parts[component[t]];
        part.triangles.push_back(t);
        const auto& corners = soup.triangles[t];
        const Vector3d a = place(soup, corners[0]) - centre, b = place(soup, corners[1]) - centre,
                       c = place(soup, corners[2]) - centre;
        const double volume = a.cross(b).dot(c) / 6;
        part.volume += volume;
        part.moment += volume * (a + b + c) / 4;
        for (const Index v : corners) part.box += detail::point(soup, v).bbox();
    }
    return parts;
}

/// Marks components with the points of an earlier component.
void find_repeated(const TriangleSoup& soup, std::vector<Component>& parts, const std::vector<Index>& closed) {
    const auto points = [&](const Component& part) {
        std::vector<std::array<double, 3>> list;
        for (const Index t : part.triangles)
            for (const Index v : soup.triangles[t]) list.push_back(soup.points[v]);
        std::sort(list.begin(), list.end());
        return list;
    };
    std::vector<Index> order = closed;
    const auto key = [&](Index c) {
        return std::tuple(parts[c].triangles.size(), parts[c].box.xmin(), parts[c].box.ymin(), parts[c].box.zmin(),
                          parts[c].box.xmax(), parts[c].box.ymax(), parts[c].box.zmax());
    };
    std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return key(a) < key(b); });
    for (std::size_t i = 1; i < order.size(); ++i) {
        if (key(order[i]) != key(order[i - 1])) continue;
        parts[order[i]].repeated = points(parts[order[i]]) == points(parts[order[i - 1]]);
    }
}

/// Joins components that intersect each other into groups; returns the number of components in groups of several.
std::size_t find_groups(const TriangleSoup& soup, const std::vector<Index>& component, std::vector<Component>& parts,
                        const std::vector<Index>& closed) {
    DisjointSets groups(parts.size());
    for (std::size_t c = 0; c < parts.size(); ++c) parts[c].group = c;
    // Components whose box meets another box.
    std::vector<Index> order = closed;
    std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return parts[a].box.xmin() < parts[b].box.xmin(); });
    std::vector<std::uint8_t> meets(parts.size(), 0);
    for (std::size_t i = 0; i < order.size(); ++i)
        for (std::size_t k = i + 1; k < order.size() && parts[order[k]].box.xmin() <= parts[order[i]].box.xmax(); ++k)
            if (CGAL::do_overlap(parts[order[i]].box, parts[order[k]].box)) meets[order[i]] = meets[order[k]] = 1;
    TriangleSoup near;
    near.points = soup.points;
    std::vector<Index> origin;
    for (const Index c : closed)
        if (meets[c] != 0)
            for (const Index t : parts[c].triangles) near.triangles.push_back(soup.triangles[t]), origin.push_back(t);
    if (near.triangles.empty()) return 0;
    check_cancelled();
    for (const auto& [a, b] : self_intersections(near, 1'000'000).pairs) groups.unite(component[origin[a]], component[origin[b]]);
    std::vector<std::size_t> members(parts.size(), 0);
    for (const Index c : closed) ++members[parts[c].group = groups.find(c)];
    std::size_t count = 0;
    for (const Index c : closed) count += members[parts[c].group] > 1 ? 1 : 0;
    return count;
}

/// Volume of one group: a body or a cavity alone, or bodies and cavities that intersect each other.
struct GroupVolume {
    double bodies = 0, cavities = 0, largest = 0;
    std::size_t members = 0;
    Vector3d moment = Vector3d::Zero();
};

void add_up(const std::vector<Component>& parts, const std::vector<Index>& closed, SolidBodies& result, const Vector3d& centre) {
    std::vector<GroupVolume> groups(parts.size());
    for (const Index c : closed) {
        GroupVolume& group = groups[parts[c].group];
        const double volume = std::abs(parts[c].volume), sign = parts[c].cavity ? -1 : 1;
        ++group.members;
        (sign > 0 ? group.bodies : group.cavities) += volume;
        if (sign > 0) group.largest = std::max(group.largest, volume);
        group.moment += (parts[c].volume < 0 ? -sign : sign) * parts[c].moment;
    }
    Vector3d moment = Vector3d::Zero();
    double mass = 0;
    for (const GroupVolume& group : groups) {
        if (group.members == 0) continue;
        moment += group.moment, mass += group.bodies - group.cavities;
        if (group.members == 1 || group.cavities > 0) {
            result.volume += group.bodies - group.cavities;
            if (group.members > 1) result.bound += std::min(group.bodies, group.cavities);
        } else {
            result.volume += (group.bodies + group.largest) / 2;
            result.bound += (group.bodies - group.largest) / 2;
        }
    }
    const Vector3d centroid = mass > 0 ? Vector3d(centre + moment / mass) : centre;
    result.centroid = {centroid.x(), centroid.y(), centroid.z()};
}

}  // namespace

SolidBodies solid_bodies(const TriangleSoup& soup) {
    detail::check_soup(soup);
    std::size_t count = 0;
    const std::vector<Index> component = component_of_triangles(soup, count);
    std::vector<Component> parts = measured_components(soup, component, count);
    SolidBodies result;
    result.roles.assign(count, BodyRole::open);
    std::vector<Index> all_closed, closed;
    for (Index c = 0; c < count; ++c)
        if (parts[c].closed) all_closed.push_back(c);
    find_repeated(soup, parts, all_closed);
    std::vector<bool> is_closed(count, false);
    for (const Index c : all_closed) {
        result.signed_volume += parts[c].volume;
        if (!parts[c].repeated) closed.push_back(c), is_closed[c] = true;
        else ++result.repeated;
    }
    result.closed = all_closed.size();
    if (closed.size() > 1) {
        result.overlapping = find_groups(soup, component, parts, closed);
        const auto enclosing = detail::enclosing_components(soup, component, is_closed, closed);
        for (const Index c : closed) parts[c].depth = enclosing[c].size();
    } else
        for (const Index c : closed) parts[c].group = c;
    const CGAL::Bbox_3 box = detail::box_of_triangles(soup);
    const double diagonal = detail::diagonal(box);
    // A component that is oriented inwards and breaks through the wall of a body is a cavity of it.
    std::vector<std::uint8_t> has_outward(count, 0);
    for (const Index c : closed) {
        // The sign of a volume below its rounding error is meaningless.
        parts[c].inward = parts[c].volume < -1e-15 * diagonal * diagonal * diagonal;
        if (!parts[c].inward) has_outward[parts[c].group] = 1;
    }
    for (const Index c : closed) {
        const bool inward = parts[c].inward;
        const bool cavity = parts[c].cavity = parts[c].depth % 2 == 1 || (inward && has_outward[parts[c].group] != 0);
        result.roles[c] =
            cavity ? (inward ? BodyRole::cavity : BodyRole::turned_cavity) : (inward ? BodyRole::inside_out : BodyRole::body);
        result.cavities += cavity ? 1 : 0;
        result.turned_cavities += cavity && !inward ? 1 : 0;
        result.inside_out += !cavity && inward ? 1 : 0;
    }
    for (const Index c : all_closed)
        if (parts[c].repeated) result.roles[c] = parts[c].volume < 0 ? BodyRole::inside_out : BodyRole::body;
    add_up(parts, closed, result,
           {box.xmin() / 2 + box.xmax() / 2, box.ymin() / 2 + box.ymax() / 2, box.zmin() / 2 + box.zmax() / 2});
    return result;
}

std::vector<std::string> SolidBodies::remarks() const {
    std::vector<std::string> texts;
    const auto add = [&](std::size_t number, const char* one, const char* several) {
        if (number > 0) texts.push_back(fmt::format("{} {}", number, number == 1 ? one : several));
    };
    add(inside_out, "body is inside out: its volume counts as positive",
        "bodies are inside out: their volumes count as positive");
    add(turned_cavities, "component inside a body is oriented outwards: it counts as a cavity",
        "components inside bodies are oriented outwards: they count as cavities");
    add(repeated, "body is there twice: it counts once", "bodies are there more than once: they count once");
    if (overlapping > 0)
        texts.push_back(
            fmt::format("{} bodies overlap: the volume is known to {:.6g} +- {:.6g} only (ostraka mesh repair --wrap "
                        "makes one surface of them)",
                        overlapping, volume, bound));
    return texts;
}

}  // namespace ostraka

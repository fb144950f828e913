#include "ostraka/revolution/group_axes.h"

#include "revolution/stages.h"

#include "ostraka/core/angles.h"
#include "ostraka/core/error.h"
#include "ostraka/core/text.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

JoinAxes compare_axes(const GroupAxis& group, const std::vector<Vector3d>& middles, std::size_t first, std::size_t second) {
    constexpr double degrees = 10, share = 0.1;
    JoinAxes join{first, second, AxesAgree::unknown, 0, 0};
    const Axis &a = group.fragments[first].axis, &b = group.fragments[second].axis;
    if (!a.found || !b.found) return join;
    const Vector3d u = eigen(a.direction);
    Vector3d v = eigen(b.direction);
    if (u.dot(v) < 0) v = -v;
    join.angle = 180 / pi * std::acos(std::min(1.0, u.dot(v)));
    const Vector3d middle = 0.5 * (middles[first] + middles[second]), mean = (u + v).normalized();
    const auto point_on = [&](const Axis& axis, const Vector3d& d) -> Vector3d {
        const Vector3d p = eigen(axis.point);
        return p + d * ((middle - p).dot(mean) / d.dot(mean));
    };
    join.offset = (point_on(a, u) - point_on(b, v)).norm() / group.diagonal;
    const auto error = [&](const char* name) { return 3 * std::hypot(a.figure(name)->value, b.figure(name)->value); };
    join.agree =
        join.angle > degrees + error("direction error") || join.offset > share + 0.5 * error("diameter error") / group.diagonal
            ? AxesAgree::no
            : AxesAgree::yes;
    return join;
}

}  // namespace

std::string to_string(AxesAgree agree) {
    switch (agree) {
        case AxesAgree::yes:
            return "agree";
        case AxesAgree::no:
            return "contradict";
        case AxesAgree::unknown:
            break;
    }
    return "cannot be told";
}

GroupAxis axis_of_group(const std::vector<Fragment>& placed, const std::vector<std::pair<std::size_t, std::size_t>>& joins,
                        const RevolutionOptions& options) {
    check_options(options, "surface of revolution");
    GroupAxis group;
    RevolutionTemplate revolution;
    std::vector<PlacedSherd> sherds;
    std::vector<Vector3d> middles;
    std::vector<double> areas;
    CGAL::Bbox_3 box;
    for (const Fragment& fragment : placed) {
        sherds.emplace_back().fragment = &fragment;
        revolution.sherds.emplace_back().name = fragment.name;
        Vector3d middle = Vector3d::Zero();
        double area = 0;
        for (const Face f : fragment.mesh.faces()) {
            if (!fragment.facets.empty() && fragment.facets[f] == Facet::fracture) continue;
            const double weight = face_area(fragment.mesh, f);
            area += weight, middle += weight * eigen(centroid(fragment.mesh, f));
        }
        for (const Vertex v : fragment.mesh.vertices()) box += fragment.mesh.point(v).bbox();
        areas.push_back(area);
        middles.push_back(area > 0 ? Vector3d(middle / area) : middle);
        if (fragment.mesh.number_of_faces() == 0) leave_out(revolution.sherds.back(), "has no faces");
    }
    group.diagonal = placed.empty() ? 0 : std::hypot(box.xmax() - box.xmin(), box.ymax() - box.ymin(), box.zmax() - box.zmin());
    try {
        find_common_axis(sherds, options, revolution);
        group.axis = revolution.axis;
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::input) throw;
        group.axis.reason = "no axis of revolution is common to its fragments";
    }
    group.direction_error = revolution.direction_error, group.place_error = revolution.place_error;
    group.fragments = std::move(revolution.sherds);
    double total_area = 0, round = 0;
    for (std::size_t k = 0; k < placed.size(); ++k) {
        total_area += areas[k];
        const SherdOnProfile& sherd = group.fragments[k];
        if (sherd.use == SherdUse::left_out) continue;
        round += areas[k];
        if (sherd.axis.found) group.diameter = std::max(group.diameter, sherd.axis.figure("largest diameter")->value);
    }
    group.round = total_area > 0 ? round / total_area : 0;
    if (group.axis.found && group.round < options.axis.min_quality) {
        group.axis.found = false;
        group.axis.reason =
            fmt::format("only fragments with {} % of its area are round about one axis", digits(100 * group.round, 2));
    }
    for (const auto& [first, second] : joins) group.joins.push_back(compare_axes(group, middles, first, second));
    return group;
}

}  // namespace ostraka

#include "ostraka/axis/object_slices.h"

#include "ostraka/core/error.h"

#include <fmt/core.h>

#include <numeric>

namespace ostraka {

namespace {

Axis axis_by(AxisMethod method, const Mesh& mesh, std::vector<Index> faces, AxisOptions options) {
    if (faces.empty()) {
        faces.resize(mesh.number_of_faces());
        std::iota(faces.begin(), faces.end(), Index{0});
    }
    options.method = method;
    return find_axis(mesh, faces, options);
}

/// The axis to slice along; reports in errors that it is this axis that is missing.
Axis axis_to_cut_along(const Mesh& mesh, const std::vector<Index>& faces, const CutOptions& options) {
    try {
        return axis_by(*options.direction, mesh, faces, options.axis);
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::input) throw;
        fail_input(
            "mesh",
            fmt::format("no {} axis to slice along: the mesh (or part) {}", to_string(*options.direction), error.problem()),
            "repair or simplify it (ostraka mesh), or slice along another --direction, such as up or 0,0,1");
    }
}

}  // namespace

SlicedObject cut_object(const Mesh& mesh, const std::vector<Index>& faces, const CutOptions& options) {
    require_surface(mesh, faces);
    const auto box = bounding_box(mesh);
    Point through((box.xmin() + box.xmax()) / 2, (box.ymin() + box.ymax()) / 2, (box.zmin() + box.zmax()) / 2);
    Vector along = options.up;
    if (options.direction) {
        const Axis axis = axis_to_cut_along(mesh, faces, options);
        if (!axis.found) {
            SlicedObject unsliced;
            unsliced.reason = fmt::format("no {} axis to slice along: {}", to_string(*options.direction), axis.reason);
            return unsliced;
        }
        if (options.direction == AxisMethod::skeleton) return slice_across(mesh, axis.lines.at(0), options.places.count, faces);
        along = axis.direction * along < 0 ? -axis.direction : axis.direction;
        through = axis.point;
    }
    SliceFrame frame = slice_frame(through, along);
    const auto [low, high] = height_range(mesh, frame, faces);
    frame.origin = through + low * frame.normal;
    SlicedObject cut = slice_parallel(mesh, frame, options.places.in(high - low), faces);
    cut.lowest = 0, cut.highest = high - low;  // without the rounding of the origin
    return cut;
}

std::vector<ComparedAxis> compared_axes(const Mesh& mesh, const std::vector<Index>& faces, const SlicedObject& cut, bool by_shape,
                                        const AxisOptions& options) {
    std::vector<ComparedAxis> axes;
    const std::vector<Point> centres = cut.centres();
    if (centres.size() < 2) return axes;
    const auto add_line = [&](const std::string& name, const SliceLine& line) {
        axes.push_back({name, {}, line, {}, straightness(centres, line)});
    };
    const auto add_curve = [&](const std::string& name, const std::vector<Point>& curve) {
        axes.push_back({name, {}, {}, curve, straightness(centres, curve)});
    };
    const auto add_none = [&](const std::string& name, const std::string& reason) { axes.push_back({name, reason, {}, {}, {}}); };
    const auto attempt = [&](const std::string& name, const auto& add) {
        try {
            add();
        } catch (const Error& error) {
            if (error.kind() == ErrorKind::cancelled) throw;
            add_none(name, error.problem());
        }
    };
    const std::string regression = "regression of barycentres";
    if (cut.parallel) add_line("mean of barycentres", mean_line(cut.frames[0], centres));
    if (centres.size() == 2) add_none(regression, "two barycentres are always collinear");
    else attempt(regression, [&] { add_line(regression, regression_line(cut.frames[0], centres)); });
    if (!cut.curve.empty()) add_curve("skeleton", cut.curve);
    if (!by_shape) return axes;
    for (const AxisMethod method : {AxisMethod::rotation, AxisMethod::principal, AxisMethod::slices, AxisMethod::skeleton}) {
        if (method == AxisMethod::skeleton && !cut.curve.empty()) continue;
        const std::string name = to_string(method);
        attempt(name, [&] {
            const Axis axis = axis_by(method, mesh, faces, options);
            const bool straight = method == AxisMethod::rotation || method == AxisMethod::principal;
            if (!axis.found) add_none(name, axis.reason);
            else if (straight) add_line(name, {axis.point, axis.direction});
            else add_curve(name, axis.lines.at(0));
        });
    }
    return axes;
}

}  // namespace ostraka

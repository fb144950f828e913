// Creates constraints by name.
#include "kinds.h"

#include "ostraka/core/words.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace solver {

void Making::fail(const std::string& what, const std::string& remedy) const {
    throw Error(ErrorKind::usage, "constraint " + std::string(kind), what, remedy);
}

Eigen::Vector3d Making::direction() const {
    if (!parameters.direction) fail("the direction is missing");
    const Eigen::Vector3d& d = *parameters.direction;
    if (!d.allFinite()) fail("the direction is not finite");
    const double size = d.cwiseAbs().maxCoeff();
    if (!(size > 0)) fail("the direction has no length");
    return (d / size).normalized();
}

Eigen::Vector3d Making::point() const {
    if (!parameters.point) fail("the point is missing");
    if (!parameters.point->allFinite()) fail("the point is not finite");
    return *parameters.point;
}

Making::Interval Making::range(double default_min, double default_max, double minimum) const {
    const Interval interval{parameters.min.value_or(default_min), parameters.max.value_or(default_max)};
    if (std::isnan(interval.min) || std::isnan(interval.max)) fail("the range is not a number");
    if (interval.min > interval.max)
        fail("the range's min, " + std::to_string(interval.min) + ", is above its max, " + std::to_string(interval.max));
    if (interval.min < minimum) fail("the range begins below " + std::to_string(minimum));
    if (std::isinf(interval.min)) fail("the range's min is infinite");
    return interval;
}

Making::Interval Making::range_of(double rest_measure) const {
    if (parameters.absolute && !parameters.min && !parameters.max) fail("the absolute range is missing");
    const bool absolute = parameters.absolute;
    Interval interval = range(absolute ? 0 : 1, absolute ? std::numeric_limits<double>::infinity() : 1);
    if (!absolute) {
        interval.min *= rest_measure;
        interval.max = std::isinf(interval.max) ? interval.max : interval.max * rest_measure;
    }
    return interval;
}

Points Making::target_or(const Points& rest_rows) const {
    if (!parameters.target) return rest_rows;
    if (parameters.target->cols() != rest_rows.cols())
        fail("the target has " + std::to_string(parameters.target->cols()) + " columns for " + std::to_string(rest_rows.cols()) +
             " points");
    check_points(*parameters.target, "target of constraint " + std::string(kind));
    return *parameters.target;
}

namespace {

struct Entry {
    ConstraintKind kind;
    Maker make;
};

const std::vector<Entry>& table() {
    static const std::vector<Entry> entries = {
        {{"Closeness", 1, 0}, make_closeness},
        {{"OnSurface", 1, 0}, make_on_surface},
        {{"EdgeStrain", 2, 2}, make_edge_strain},
        {{"TriangleStrain", 3, 3}, make_triangle_strain},
        {{"TetrahedronStrain", 4, 4}, make_tetrahedron_strain},
        {{"Area", 3, 3}, make_area},
        {{"Volume", 4, 4}, make_volume},
        {{"Bending", 4, 4}, make_bending},
        {{"Line", 2, 0}, make_line},
        {{"Plane", 3, 0}, make_plane},
        {{"Orientation", 2, 0}, make_orientation},
        {{"Circle", 3, 0}, make_circle},
        {{"Sphere", 4, 0}, make_sphere},
        {{"Similarity", 2, 0}, make_similarity},
        {{"Rigid", 2, 0}, make_rigid},
        {{"NonUniformScaling", 2, 0}, make_non_uniform_scaling},
        {{"Equilateral", 3, 0}, make_equilateral},
        {{"Parallelogram", 4, 4}, make_parallelogram},
        {{"Rectangle", 4, 4}, make_rectangle},
        {{"Laplacian", 2, 0}, make_laplacian},
        {{"LaplacianDisplacement", 2, 0}, make_laplacian_displacement},
        {{"CotangentLaplacian", 2, 0}, make_cotangent_laplacian},
        {{"CotangentLaplacianDisplacement", 2, 0}, make_cotangent_laplacian_displacement},
        {{"FittedPlaneOrientation", 3, 0}, make_fitted_plane_orientation},
        {{"CoAxiality", 2, 0}, make_co_axiality},
        {{"AxisDirection", 2, 0}, make_axis_direction},
        {{"AxisOnLine", 1, 0}, make_axis_on_line},
        {{"MeansOnLevel", 2, 0}, make_means_on_level},
        {{"MeanPosition", 1, 0}, make_mean_position},
        {{"MirrorSymmetry", 2, 0}, make_mirror_symmetry},
        {{"Proportion", 2, 0}, make_proportion},
        {{"Angle", 3, 3}, make_angle},
        {{"Parallel", 4, 0}, make_parallel},
        {{"Perpendicular", 4, 4}, make_perpendicular},
        {{"PolylineLength", 2, 0}, make_polyline_length},
        {{"EqualLengths", 4, 0}, make_equal_lengths},
        {{"EqualLength", 4, 0}, make_equal_length},
    };
    return entries;
}

}  // namespace

}  // namespace solver

const std::vector<ConstraintKind>& constraint_kinds() {
    static const std::vector<ConstraintKind> kinds = [] {
        std::vector<ConstraintKind> list;
        for (const auto& entry : solver::table()) list.push_back(entry.kind);
        return list;
    }();
    return kinds;
}

std::unique_ptr<Constraint> make_constraint(std::string_view kind, std::vector<int> ids, double weight,
                                            const ConstraintParameters& parameters, const Points& rest) {
    const auto& table = solver::table();
    const auto found = std::find_if(table.begin(), table.end(), [&](const auto& entry) { return entry.kind.name == kind; });
    if (found == table.end())
        throw Error(ErrorKind::usage, "constraint " + std::string(kind), "there is no such kind",
                    "use one of: " + joined(table, ", ", [](const auto& entry) { return std::string(entry.kind.name); }));
    const int count = static_cast<int>(ids.size());
    solver::Making making{found->kind.name, std::move(ids), weight, parameters, Points(3, count)};
    if (count < found->kind.min_ids || (found->kind.max_ids > 0 && count > found->kind.max_ids))
        making.fail("there are " + std::to_string(count) + " points",
                    found->kind.min_ids == found->kind.max_ids ? "give " + std::to_string(found->kind.min_ids)
                                                               : "give at least " + std::to_string(found->kind.min_ids));
    for (int i = 0; i < count; ++i) {
        const int id = making.ids[i];
        if (id < 0 || id >= rest.cols())
            making.fail("point " + std::to_string(id) + " does not exist",
                        "there are " + std::to_string(rest.cols()) + " points");
        making.rest.col(i) = rest.col(id);
    }
    check_points(making.rest, "rest points of constraint " + std::string(kind));
    return found->make(std::move(making));
}

}  // namespace ostraka

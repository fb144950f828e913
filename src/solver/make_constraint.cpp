#include "ostraka/solver/make_constraint.h"

#include "solver/create.h"

#include <fmt/core.h>

#include <cmath>

namespace ostraka {

namespace solver {

void ConstraintArguments::fail(const std::string& what, const std::string& remedy) const {
    throw Error(ErrorKind::usage, fmt::format("constraint {}", kind), what, remedy);
}

Eigen::Vector3d ConstraintArguments::unit(const Eigen::Vector3d& direction, const char* name) const {
    if (!direction.allFinite()) fail(fmt::format("the {} is not finite", name));
    const double size = direction.cwiseAbs().maxCoeff();
    if (!(size > 0)) fail(fmt::format("the {} has no length", name));
    return (direction / size).normalized();
}

Eigen::Vector3d ConstraintArguments::finite(const Eigen::Vector3d& point, const char* name) const {
    if (!point.allFinite()) fail(fmt::format("the {} is not finite", name));
    return point;
}

Interval ConstraintArguments::checked(const Interval& range) const {
    if (std::isnan(range.min) || std::isnan(range.max)) fail("the range is not a number");
    if (range.min > range.max)
        fail(fmt::format("the range's min, {}, is above its max, {}", std::to_string(range.min), std::to_string(range.max)));
    if (range.min < 0) fail("the range begins below 0");
    if (std::isinf(range.min)) fail("the range's min is infinite");
    return range;
}

Interval ConstraintArguments::range_of(const Interval& range, bool absolute, double rest_measure) const {
    Interval interval = checked(range);
    if (absolute) return interval;
    interval.min *= rest_measure;
    interval.max = std::isinf(interval.max) ? interval.max : interval.max * rest_measure;
    return interval;
}

Points ConstraintArguments::given_or_rest(const std::optional<Points>& points) const {
    if (!points) return rest;
    if (points->cols() != rest.cols()) fail(fmt::format("{} positions are given for {} points", points->cols(), rest.cols()));
    check_points(*points, fmt::format("positions given to constraint {}", kind));
    return *points;
}

}  // namespace solver

const kinds::KindInfo& info_of(const ConstraintKind& kind) {
    return std::visit([](const auto& parameters) -> const kinds::KindInfo& { return parameters.kind; }, kind);
}

std::unique_ptr<Constraint> make_constraint(const ConstraintKind& kind, std::vector<int> ids, double weight, const Points& rest) {
    const auto& [name, min_points, max_points] = info_of(kind);
    const int count = static_cast<int>(ids.size());
    solver::ConstraintArguments arguments{name, std::move(ids), weight, Points(3, count)};
    if (count < min_points || (max_points > 0 && count > max_points))
        arguments.fail(fmt::format("there are {} points", count),
                       fmt::format("give {}{}", min_points == max_points ? "" : "at least ", min_points));
    for (int i = 0; i < count; ++i) {
        const int id = arguments.ids[i];
        if (id < 0 || id >= rest.cols())
            arguments.fail(fmt::format("point {} does not exist", id), fmt::format("there are {} points", rest.cols()));
        arguments.rest.col(i) = rest.col(id);
    }
    check_points(arguments.rest, fmt::format("rest points of constraint {}", name));
    return std::visit([&](const auto& parameters) { return solver::create(parameters, arguments); }, kind);
}

}  // namespace ostraka

// How well a constraint holds, in its own unit.
#include "reader.h"

#include "ostraka/relation/geometric.h"

namespace ostraka::semantic {

namespace {

/// Means of the stations on deformed points.
std::vector<Vector3d> station_means(const AxisSegment& segment, const Points& points) {
    std::vector<Vector3d> means(static_cast<std::size_t>(segment.count), Vector3d::Zero());
    std::vector<double> sizes(means.size(), 0);
    for (std::size_t i = 0; i < segment.vertices.size(); ++i) {
        const auto s = static_cast<std::size_t>(segment.stations[i]);
        means[s] += points.col(segment.vertices[i]);
        sizes[s] += 1;
    }
    for (std::size_t s = 0; s < means.size(); ++s) means[s] /= sizes[s];
    return means;
}

double percent_out(double value, const Range& range) {
    if (value < range.min) return 100 * (range.min - value) / range.min;
    return value > range.max ? 100 * (value - range.max) / range.max : 0;
}

Measured verdict_of(std::vector<Deviation> deviations) {
    Measured result;
    result.verdict =
        std::all_of(deviations.begin(), deviations.end(), [](const Deviation& d) { return *d.value <= *d.tolerance; })
            ? Verdict::holds
            : Verdict::fails;
    result.deviations = std::move(deviations);
    return result;
}

using Measuring = std::function<Measured(const Mesh& deformed, const Points& points)>;

Measuring shape_kept(const Reader& read, const Shape& shape, double length, const std::string& where) {
    const auto parts = std::make_shared<Lowered>(lower(shape, read.relationship(), where));
    return [parts, length, unit = shape.set.unit](const Mesh&, const Points& points) {
        double worst = 0;
        for (const auto& part : parts->constraints)
            worst = std::max(worst, std::sqrt(part->squared_distance(points) / static_cast<double>(part->ids().size())));
        return verdict_of({{"rms distance from its shape", worst, length, unit}});
    };
}

Measuring in_range(const Reader& read, bool two) {
    const Range range = read.range();
    const Pins first = pins_of(read, read.measure(two ? "measure1" : "measure", read.member(0)));
    const Pins second = two ? pins_of(read, read.measure("measure2", read.member(1))) : Pins{};
    return [=](const Mesh&, const Points& points) {
        const double value = length_of(first, points) / (two ? length_of(second, points) : 1);
        Measured result = verdict_of({{"out of range", std::isfinite(value) ? percent_out(value, range) : 1e9, 0.1, "%"}});
        result.text = std::to_string(value) + " in " + std::to_string(range.min) + " to " + std::to_string(range.max);
        return result;
    };
}

Measuring continued(const Reader& read, const RelationOptions& tolerances, double length) {
    return [segment = continuity_of(read).segment, faces = read.member(1).faces, angle = tolerances.angle, length,
            unit = read.shape().set.unit](const Mesh& deformed, const Points& points) -> Measured {
        const Axis reference = find_axis(deformed, faces);
        if (!reference.found) return {Verdict::unknown, {}, "the reference has no axis any more: " + reference.reason};
        const auto means = station_means(segment, points);
        const Vector3d direction = eigen(reference.direction), along = means.back() - means.front();
        double off = 0;
        for (const Vector3d& mean : means) off = std::max(off, direction.cross(mean - eigen(reference.point)).norm());
        const double turned = std::atan2(direction.cross(along).norm(), std::abs(direction.dot(along))) * 180 / M_PI;
        return verdict_of({{"angle", turned, angle, "degree"}, {"distance", off, length, unit}});
    };
}

}  // namespace

std::vector<Measured> measure(const Shape& shape, const std::vector<const Mesh*>& deformed, const Relationship& relationship,
                              const RelationOptions& tolerances, const std::string& where) {
    const Reader read(shape, relationship, where);
    const double length = tolerances.distance * box_diagonal(shape.mesh);
    Measuring measuring;
    if (relationship.type == "keep shape") measuring = shape_kept(read, shape, length, where);
    else if (relationship.type == "proportion" || relationship.type == "keep measure")
        measuring = in_range(read, relationship.type == "proportion");
    else if (relationship.type == "structural continuity") measuring = continued(read, tolerances, length);
    else
        measuring = [&](const Mesh& mesh,
                        const Points&) -> Measured {  // what relations measure holds for constraints of their name
            Relationship stated = relationship;
            stated.is_constraint = false;
            const RelationCheck check = RelationMeter(mesh, shape.set, tolerances).measure(stated);
            return {check.verdict, check.parameters.deviations, check.text};
        };
    std::vector<Measured> results;
    for (const Mesh* mesh : deformed) results.push_back(measuring(*mesh, columns_of(*mesh)));
    return results;
}

}  // namespace ostraka::semantic

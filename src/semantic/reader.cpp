#include "reader.h"

namespace ostraka::semantic {

Pins pins_of(const Reader& read, const Measure& measure) {
    if (measure.tool != "ruler" && measure.tool != "bounding")
        read.fail("a " + measure.tool + " cannot be constrained", "take a ruler or a bounding measure");
    Pins pins{measure.points.front(), measure.points.back(), {}};
    if (measure.direction) {
        pins.direction = Vector3d((*measure.direction)[0], (*measure.direction)[1], (*measure.direction)[2]).normalized();
        // Its extremes on the shape as it is.
        const auto height = [&](Index v) { return pins.direction->dot(read.shape().rest.col(v)); };
        for (const Index v : measure.points) {
            if (height(v) < height(pins.from)) pins.from = v;
            if (height(v) > height(pins.to)) pins.to = v;
        }
    }
    return pins;
}

double length_of(const Pins& pins, const Points& points) {
    const Vector3d d = points.col(pins.to) - points.col(pins.from);
    return pins.direction ? std::abs(pins.direction->dot(d)) : d.norm();
}

Continuity continuity_of(const Reader& read) {
    read.need(2, 2);
    for (const std::size_t i : {0, 1})
        if (read.member(i).faces.empty())
            read.fail("annotation " + std::to_string(read.member(i).id) + " is no region", "use regions");
    Axis reference = find_axis(read.shape().mesh, read.member(1).faces);
    if (!reference.found)
        read.fail("annotation " + std::to_string(read.member(1).id) + " has no axis: " + reference.reason, "use another part");
    AxisSegment segment = continuing_segment(read.shape().mesh, read.member(0), read.member(1), reference.direction,
                                             read.number("angle", 10, 0.1, 90));
    if (!segment.reason.empty())
        read.fail("annotation " + std::to_string(read.member(0).id) + " " + segment.reason, "raise angle, or state co-axiality");
    return {std::move(segment), std::move(reference)};
}

}  // namespace ostraka::semantic

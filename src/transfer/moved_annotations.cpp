#include "ostraka/transfer/moved_annotations.h"

#include "ostraka/measure/descriptors.h"
#include "ostraka/vocabulary/text_match.h"

#include <cmath>

namespace ostraka {

std::string unit_scaled(const std::string& unit, double scale) {
    constexpr double tolerance = 0.01;
    if (std::abs(scale - 1) < tolerance) return unit;
    for (const char* other : {"mm", "cm", "m", "um", "in", "ft", "dm", "km"})
        if (const auto ratio = converted(1, unit, other); ratio && std::abs(scale / *ratio - 1) < tolerance) return other;
    return {};
}

AnnotationSet moved_annotations(AnnotatedMeshView object, const Motion& motion, const std::string& unit) {
    AnnotationSet result = object.annotations;
    const auto turn = [&](std::optional<std::array<double, 3>>& direction) {
        if (!direction) return;
        const Eigen::Vector3d d = motion.rotation * Eigen::Vector3d((*direction)[0], (*direction)[1], (*direction)[2]);
        direction = {d.x(), d.y(), d.z()};
    };
    turn(result.up);
    result.unit = unit;
    DescriptorSearch descriptors(object.mesh);
    descriptors.expect(object.annotations);
    for (Annotation& annotation : result.annotations)
        for (Attribute& attribute : annotation.attributes) {
            turn(attribute.measure.direction);
            if (attribute.type == AttributeType::measure && attribute.measure.unit == object.annotations.unit)
                attribute.measure.unit = result.unit;
            if (attribute.type != AttributeType::descriptor || unit == object.annotations.unit) continue;
            if (const auto known = descriptors.find(annotation, attribute.name))
                attribute.descriptor.unit = unit_of(*known, unit);
        }
    return result;
}

}  // namespace ostraka

#include "ostraka/transfer/moved_annotations.h"

#include "ostraka/annotation/curves.h"
#include "ostraka/measure/descriptors.h"
#include "ostraka/mesh/orientation.h"
#include "ostraka/vocabulary/text_match.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

std::string unit_scaled(const std::string& unit, double scale) {
    constexpr double tolerance = 0.01;
    if (std::abs(scale - 1) < tolerance) return unit;
    for (const char* other : {"mm", "cm", "m", "um", "in", "ft", "dm", "km"})
        if (const auto ratio = converted(1, unit, other); ratio && std::abs(scale / *ratio - 1) < tolerance) return other;
    return {};
}

namespace {

/// Exponent of the unit of length in statistics of fields, by their names (DescriptorSearch::describe); 0 for other names.
int power_of_statistic(const std::string& name) {
    if (name.starts_with("thickness ")) return 1;
    if (name.starts_with("mean curvature ")) return -1;
    return name.starts_with("Gaussian curvature ") ? -2 : 0;
}

/// Adapts a point on the surface to the exchange of the second and the third corner of each face.
void exchange_corners(const Mesh& mesh, SurfacePoint& p) {
    if (p.is_in_face()) p = stored_point(mesh, face_point(p.element[0], {p.weights[0], p.weights[2], p.weights[1]}));
}

void mirror_curves(const Mesh& mesh, Annotation& annotation) {
    for (auto& curve : annotation.curves) {
        for (SurfacePoint& p : curve) exchange_corners(mesh, p);
        if (annotation.type == AnnotationType::region) std::reverse(curve.begin(), curve.end());
    }
    for (Attribute& attribute : annotation.attributes)
        if (Measure* measure = attribute.measure())
            for (SurfacePoint& p : measure->locations) exchange_corners(mesh, p);
}

/// Moves the descriptors of a set from one unit of coordinates to another.
class DescriptorMover {
public:
    DescriptorMover(AnnotatedMeshView object, const Motion& motion, std::string unit)
        : search_(object.mesh),
          motion_(motion),
          old_unit_(object.annotations.unit),
          unit_(std::move(unit)),
          keeps_sizes_(motion.scale == 1 && old_unit_ == unit_) {
        search_.prepare(object.annotations);
        const auto factor = old_unit_.empty() || unit_.empty() ? std::nullopt : converted(1, old_unit_, unit_);
        only_other_unit_ = factor && std::abs(motion.scale / *factor - 1) < 1e-12;
    }

    void move(const Annotation& annotation, const std::string& name, Descriptor& descriptor) {
        if (!descriptor.file.empty()) return move_file(descriptor);
        if (keeps_sizes_) return;
        if (const int power = power_of_statistic(name); power != 0) {
            const auto unit_in = [&](const std::string& length) { return unit_of(Quantity{name, {}, false, power, {}}, length); };
            if (descriptor.unit != unit_in(old_unit_)) return;
            for (double& value : descriptor.values) value *= std::pow(motion_.scale, power);
            descriptor.unit = unit_in(unit_);
        } else if (unit_ != old_unit_) {
            if (const auto computed = search_.find(annotation, name)) descriptor.unit = unit_of(*computed, unit_);
        }
    }

private:
    /// Values in a file that state their unit stay true if only the unit of the coordinates changes.
    void move_file(Descriptor& descriptor) const {
        const bool moves = motion_.scale != 1 || motion_.rotation != Eigen::Matrix3d::Identity() ||
                           motion_.translation != Eigen::Vector3d::Zero();
        if (descriptor.file.ends_with(".json")) descriptor.stale = descriptor.stale || moves;
        const bool is_length = descriptor.unit.empty() || converted(1, descriptor.unit, "mm") ||
                               converted(1, descriptor.unit, "1/mm") || converted(1, descriptor.unit, "1/mm^2");
        const bool stays_true = motion_.scale == 1 || (only_other_unit_ && !descriptor.unit.empty());
        if (is_length && !stays_true) descriptor.stale = true;
    }

    DescriptorSearch search_;
    const Motion& motion_;
    std::string old_unit_, unit_;
    bool keeps_sizes_ = false, only_other_unit_ = false;
};

}  // namespace

AnnotationSet moved_annotations(AnnotatedMeshView object, const Motion& motion, const std::string& unit) {
    AnnotationSet result = object.annotations;
    const auto turn = [&](std::optional<std::array<double, 3>>& direction) {
        if (!direction) return;
        const Eigen::Vector3d d = motion.rotation * Eigen::Vector3d((*direction)[0], (*direction)[1], (*direction)[2]);
        direction = {d.x(), d.y(), d.z()};
    };
    turn(result.up);
    result.unit = unit;
    DescriptorMover descriptors(object, motion, unit);
    for (Annotation& annotation : result.annotations) {
        for (Attribute& attribute : annotation.attributes) {
            if (Measure* measure = attribute.measure()) {
                turn(measure->direction);
                if (measure->unit == object.annotations.unit) measure->unit = unit;
            }
            if (Descriptor* descriptor = attribute.descriptor()) descriptors.move(annotation, attribute.name, *descriptor);
        }
        if (motion.mirrors()) mirror_curves(object.mesh, annotation);
    }
    return result;
}

AnnotatedMesh turned_over(AnnotatedMeshView object) {
    AnnotatedMesh result{turned_over(object.mesh), object.annotations};
    for (Annotation& annotation : result.annotations.annotations) mirror_curves(object.mesh, annotation);
    return result;
}

}  // namespace ostraka

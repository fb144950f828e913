#include "ostraka/registration/slippable_motions.h"
#include "ostraka/algebra/dense.h"
#include "ostraka/core/message_text.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

using Eigen::Matrix3d;
using Eigen::Vector3d;

std::string to_string(SlippableKind kind) {
    return enum_name(kind, {"none", "turn", "shift", "screw", "tube", "ball", "plane", "more"});
}

std::string SlippableMotions::text() const {
    return enum_name(kind, {"none", "rotation about a line", "translation along a line", "screw motion along a line",
                            "rotation about a line and translation along it", "rotation about a point",
                            "translation in a plane and rotation about its normal", "nearly any motion"});
}

namespace {

Motion rotation_about(const Vector3d& point, const Vector3d& direction, double angle, double along = 0) {
    Motion motion;
    motion.rotation = Eigen::AngleAxisd(angle, direction).toRotationMatrix();
    motion.translation = point - motion.rotation * point + along * direction;
    return motion;
}

Vector3d across(const Vector3d& direction) {
    return direction.cross(std::abs(direction.x()) < 0.6 ? Vector3d::UnitX() : Vector3d::UnitY()).normalized();
}

}  // namespace

std::vector<std::vector<SlippableMotions::Step>> SlippableMotions::sampled_motions(double radians, double length,
                                                                                   int steps) const {
    std::vector<std::vector<Step>> result;
    const auto add_rotation = [&](const Vector3d& axis, double sign, double along) {
        auto& way = result.emplace_back();
        for (int k = 1; k <= steps; ++k) {
            const double angle = sign * radians * k / steps;
            way.push_back({true, rotation_about(point, axis, angle, along * angle), angle});
        }
    };
    const auto add_translation = [&](const Vector3d& axis, double sign) {
        auto& way = result.emplace_back();
        for (int k = 1; k <= steps; ++k) {
            const double amount = sign * length * k / steps;
            Motion motion;
            motion.translation = amount * axis;
            way.push_back({false, motion, amount});
        }
    };
    const Vector3d u = across(direction), w = direction.cross(u);
    for (const double sign : {1.0, -1.0}) {
        switch (kind) {
            case SlippableKind::rotation:
                add_rotation(direction, sign, 0);
                break;
            case SlippableKind::helix:
                add_rotation(direction, sign, pitch);
                break;
            case SlippableKind::translation:
                add_translation(direction, sign);
                break;
            case SlippableKind::cylinder:
                add_rotation(direction, sign, 0);
                add_translation(direction, sign);
                break;
            case SlippableKind::sphere:
                for (const Vector3d& axis : {direction, u, w}) add_rotation(axis, sign, 0);
                break;
            case SlippableKind::plane:
                add_rotation(direction, sign, 0);
                for (const Vector3d& axis : {u, w}) add_translation(axis, sign);
                break;
            default:
                break;
        }
    }
    return result;
}

bool SlippableMotions::contains(const Motion& motion, const Vector3d& around, double angle, double length) const {
    const Vector3d moved = motion(point) - point, image = motion.rotation * direction;
    const double lean = std::acos(std::clamp(image.dot(direction), -1.0, 1.0)), along = moved.dot(direction);
    const Eigen::AngleAxisd rotation(motion.rotation);
    switch (kind) {
        case SlippableKind::rotation:
            return lean < angle && moved.norm() < length;
        case SlippableKind::cylinder:
            return lean < angle && (moved - along * direction).norm() < length;
        case SlippableKind::translation:
            return rotation.angle() < angle && [&] {
                const Vector3d displacement = motion(around) - around;
                return (displacement - displacement.dot(direction) * direction).norm() < length;
            }();
        case SlippableKind::helix: {
            const double rotated = rotation.angle() * (rotation.axis().dot(direction) < 0 ? -1 : 1);
            return lean < angle && (moved - pitch * rotated * direction).norm() < length;
        }
        case SlippableKind::sphere:
            return moved.norm() < length;
        case SlippableKind::plane:
            return lean < angle && std::abs((motion(around) - around).dot(image)) < length;
        default:
            return false;
    }
}

SlippableMotions slippable_motions_of(const std::vector<Vector3d>& places, const std::vector<Vector3d>& normals,
                                      double tolerance) {
    SlippableMotions slippable;
    if (places.size() < 6) {
        slippable.kind = SlippableKind::more;
        return slippable;
    }
    const auto count = static_cast<double>(places.size());
    Vector3d middle = Vector3d::Zero();
    for (const Vector3d& p : places) middle += p / count;
    double size = 0;
    for (const Vector3d& p : places) size += (p - middle).squaredNorm() / count;
    size = std::sqrt(size);
    slippable.point = middle;
    if (!(size > 0)) {
        slippable.kind = SlippableKind::more;
        return slippable;
    }
    // Generalised eigenvalue problem: square of the motion along the normals against that of the whole motion.
    using Matrix6 = Eigen::Matrix<double, 6, 6>;
    Matrix6 along = Matrix6::Zero(), motion_squares = Matrix6::Zero();
    for (std::size_t i = 0; i < places.size(); ++i) {
        const Vector3d p = (places[i] - middle) / size;
        Eigen::Matrix<double, 6, 1> row;
        row << p.cross(normals[i]), normals[i];
        along += row * row.transpose() / count;
        Eigen::Matrix<double, 3, 6> move;
        move.leftCols<3>() << 0, p.z(), -p.y(), -p.z(), 0, p.x(), p.y(), -p.x(), 0;
        move.rightCols<3>() = Matrix3d::Identity();
        motion_squares += move.transpose() * move / count;
    }
    motion_squares.diagonal().array() += 1e-9;
    const SymmetricEigenX solver = generalised_eigen(along, motion_squares);
    int slippable_count = 0;
    while (slippable_count < 6 && solver.eigenvalues()[slippable_count] < tolerance * tolerance) ++slippable_count;
    if (slippable_count == 0) return slippable;
    const auto motions = solver.eigenvectors().leftCols(slippable_count).eval();
    // Translations among the slippable motions are those without a rotational part.
    const SvdX rotational(motions.topRows(3), true);
    const auto& singular = rotational.singularValues();
    const double threshold = 0.15 * motions.colwise().norm().maxCoeff();
    const int rotations = static_cast<int>((singular.array() > threshold).count()), translations = slippable_count - rotations;
    const auto motion_of = [&](int k) -> Eigen::Matrix<double, 6, 1> { return motions * rotational.matrixV().col(k); };
    // The axis of a motion: w about it, v at the middle.
    const auto line_of = [&](const Eigen::Matrix<double, 6, 1>& motion) {
        const Vector3d w = motion.head<3>(), v = motion.tail<3>();
        slippable.direction = w.normalized();
        slippable.point = middle + size * w.cross(v) / w.squaredNorm();
        slippable.pitch = size * w.dot(v) / w.squaredNorm();
    };
    if (slippable_count == 1 && rotations == 0) {
        slippable.kind = SlippableKind::translation;
        slippable.direction = motion_of(0).tail<3>().normalized();
    } else if (slippable_count == 1) {
        line_of(motion_of(0));
        slippable.kind = std::abs(slippable.pitch) < 0.1 * size ? SlippableKind::rotation : SlippableKind::helix;
        if (slippable.kind == SlippableKind::rotation) slippable.pitch = 0;
    } else if (slippable_count == 2 && rotations == 1 && translations == 1) {
        line_of(motion_of(0));
        slippable.kind = SlippableKind::cylinder;
        slippable.pitch = 0;
    } else if (slippable_count == 3 && rotations == 3) {
        // The centre is fixed: v + w x c = 0 for each of the three.
        Eigen::Matrix<double, 9, 3> A;
        Eigen::Matrix<double, 9, 1> b;
        for (int k = 0; k < 3; ++k) {
            const Vector3d w = motion_of(k).head<3>(), v = motion_of(k).tail<3>();
            A.block<3, 3>(3 * k, 0) << 0, -w.z(), w.y(), w.z(), 0, -w.x(), -w.y(), w.x(), 0;
            b.segment<3>(3 * k) = -v;
        }
        slippable.point = middle + size * Vector3d(solve_full_rank(A, b));
        slippable.kind = SlippableKind::sphere;
    } else if (slippable_count == 3 && rotations == 1) {
        line_of(motion_of(0));
        slippable.point = middle;
        slippable.pitch = 0;
        slippable.kind = SlippableKind::plane;
    } else {
        slippable.kind = SlippableKind::more;
    }
    return slippable;
}

}  // namespace ostraka

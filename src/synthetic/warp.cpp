#include "synthetic/warp.h"
#include "ostraka/algebra/dense.h"
#include "ostraka/core/angles.h"

namespace ostraka::shapes {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

WaveSum sum_of(const std::vector<Wave>& waves, double angle, double height) {
    WaveSum sum;
    for (const Wave& wave : waves) {
        const double argument = wave.around * angle + wave.upward * height + wave.phase;
        const double slope = -wave.amplitude * std::sin(argument);
        sum.value += wave.amplitude * std::cos(argument);
        sum.by_angle += wave.around * slope;
        sum.by_height += wave.upward * slope;
    }
    return sum;
}

Vector2d Warp::centre(double height) const {
    const double z = std::clamp(height, low, high);
    return offset + Vector2d(sum_of(centre_x, 0, z).value, sum_of(centre_y, 0, z).value);
}

double Warp::displacement(double angle, double height) const {
    const double z = std::clamp(height, low, high);
    return size.at(z).value[0] * sum_of(relative, angle, z).value + sum_of(absolute, angle, z).value;
}

namespace {

class Warped final : public Solid {
public:
    Warped(SolidPointer solid, std::shared_ptr<const Warp> warp) : solid_(std::move(solid)), warp_(std::move(warp)) {
        const Eigen::AlignedBox3d inner = solid_->box();
        double max_displacement = 0, minimum = 1, sway = 0;
        steepest_ = 1;
        const double widest = inner.max().cwiseAbs().cwiseMax(inner.min().cwiseAbs()).head<2>().norm();
        for (int up = 0; up <= samples_up; ++up) {
            const double z = warp_->low + (warp_->high - warp_->low) * up / samples_up;
            const Vector2d centre = warp_->centre(z);
            sway = std::max(sway, centre.norm());
            for (int turn = 0; turn < samples_around; ++turn) {
                const double angle = 2 * pi * turn / samples_around;
                max_displacement = std::max(max_displacement, std::abs(warp_->displacement(angle, z)));
                for (const double distance : {0.25 * warp_->core, 0.5 * warp_->core, 0.75 * warp_->core, warp_->core, widest}) {
                    const Vector3d p(centre.x() + distance * std::cos(angle), centre.y() + distance * std::sin(angle), z);
                    const Matrix3d change = moved_back(p).second;
                    const Vector3d squares = symmetric_eigenvalues(change.transpose() * change);
                    steepest_ = std::max(steepest_, std::sqrt(squares[2]));
                    minimum = std::min(minimum, std::sqrt(std::max(squares[0], 0.0)));
                }
            }
        }
        steepest_ *= margin;
        flatness_ = std::max(minimum / margin, 0.05) / steepest_ * solid_->flatness();
        const Vector3d grown((margin * (max_displacement + sway)), (margin * (max_displacement + sway)), 0);
        box_ = {inner.min() - grown, inner.max() + grown};
    }
    [[nodiscard]] Sample sample(const Vector3d& p) const override {
        const auto [q, change] = moved_back(p);
        const Sample inner = solid_->sample(q);
        return {inner.value / steepest_, change.transpose() * inner.gradient / steepest_};
    }
    [[nodiscard]] double parameter(const Vector3d& p) const override { return solid_->parameter(moved_back(p).first); }
    [[nodiscard]] Eigen::AlignedBox3d box() const override { return box_; }
    [[nodiscard]] double flatness() const override { return flatness_; }

private:
    static constexpr int samples_up = 60, samples_around = 36;
    static constexpr double margin = 1.15;

    /// Preimage of a point of the warped body, and its derivative with respect to the point.
    [[nodiscard]] std::pair<Vector3d, Matrix3d> moved_back(const Vector3d& p) const {
        const Warp& warp = *warp_;
        const double z = std::clamp(p.z(), warp.low, warp.high);
        const double rises = z == p.z() ? 1 : 0;
        const WaveSum x = sum_of(warp.centre_x, 0, z), y = sum_of(warp.centre_y, 0, z);
        const Vector2d offset = p.head<2>() - warp.offset - Vector2d(x.value, y.value);
        const Vector2d centre_slope = rises * Vector2d(x.by_height, y.by_height);
        const double distance = offset.norm();
        Matrix3d change = Matrix3d::Identity();
        change.topRightCorner<2, 1>() = -centre_slope;
        if (distance < 1e-12 * warp.core) return {{offset.x(), offset.y(), p.z()}, change};
        const double angle = std::atan2(offset.y(), offset.x());
        const WaveSum relative = sum_of(warp.relative, angle, z), absolute = sum_of(warp.absolute, angle, z);
        const auto size = warp.size.at(z);
        const double moved = size.value[0] * relative.value + absolute.value;
        const double by_angle = size.value[0] * relative.by_angle + absolute.by_angle;
        const double by_height =
            rises * (size.value[0] * relative.by_height + size.first[0] * relative.value + absolute.by_height);
        // The displacement fades in from the axis: 3 t^2 - 2 t^3.
        const double t = std::min(distance / warp.core, 1.0);
        const double fade = t * t * (3 - 2 * t), fade_slope = t < 1 ? 6 * t * (1 - t) / warp.core : 0;
        // Polar frame: radial and tangential derivatives of the preimage's radius.
        const Vector2d radial = offset / distance, tangent(-radial.y(), radial.x());
        const double radius = distance - moved * fade;
        const Eigen::RowVector2d radius_change =
            (1 - moved * fade_slope) * radial.transpose() - by_angle * fade / distance * tangent.transpose();
        const Eigen::Matrix2d flat = radial * radius_change + radius / distance * tangent * tangent.transpose();
        change.topLeftCorner<2, 2>() = flat;
        change.topRightCorner<2, 1>() = -flat * centre_slope - by_height * fade * radial;
        return {{radius * radial.x(), radius * radial.y(), p.z()}, change};
    }

    SolidPointer solid_;
    std::shared_ptr<const Warp> warp_;
    double steepest_ = 1, flatness_ = 1;
    Eigen::AlignedBox3d box_;
};

class Below final : public Solid {
public:
    Below(SolidPointer solid, double height) : solid_(std::move(solid)), height_(height) {}
    [[nodiscard]] Sample sample(const Vector3d& p) const override {
        const Sample inner = solid_->sample(p);
        return inner.value >= p.z() - height_ ? inner : Sample{p.z() - height_, Vector3d::UnitZ()};
    }
    [[nodiscard]] double parameter(const Vector3d& p) const override { return solid_->parameter(p); }
    [[nodiscard]] Eigen::AlignedBox3d box() const override {
        Eigen::AlignedBox3d box = solid_->box();
        box.max().z() = std::min(box.max().z(), height_);
        return box;
    }
    // If both are outside, the distance to the nearest point is at most the root of the sum of squares.
    [[nodiscard]] double flatness() const override { return solid_->flatness() * std::sqrt(0.5); }

private:
    SolidPointer solid_;
    double height_;
};

}  // namespace

SolidPointer make_below(SolidPointer solid, double height) { return std::make_unique<Below>(std::move(solid), height); }

SolidPointer make_warped(SolidPointer solid, std::shared_ptr<const Warp> warp) {
    return std::make_unique<Warped>(std::move(solid), std::move(warp));
}

}  // namespace ostraka::shapes

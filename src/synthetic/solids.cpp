#include "ostraka/synthetic/solid.h"

#include "synthetic/spline.h"

#include "ostraka/core/error.h"

#include <functional>

namespace ostraka {

using Eigen::AlignedBox3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

/// A solid in its own frame, with a pose in space.
class PlacedSolid : public Solid {
public:
    explicit PlacedSolid(const SolidPose& pose) : pose_(pose), back_(pose.rotation.transpose()) {}
    [[nodiscard]] Sample sample(const Vector3d& p) const final {
        Sample s = local(to_local(p));
        s.gradient = pose_.rotation * s.gradient;
        return s;
    }
    [[nodiscard]] AlignedBox3d box() const final {
        const Vector3d half = pose_.rotation.cwiseAbs() * half_extents();
        return {pose_.centre - half, pose_.centre + half};
    }

protected:
    [[nodiscard]] virtual Sample local(const Vector3d& p) const = 0;
    [[nodiscard]] virtual Vector3d half_extents() const = 0;
    [[nodiscard]] Vector3d to_local(const Vector3d& p) const { return back_ * (p - pose_.centre); }

private:
    SolidPose pose_;
    Eigen::Matrix3d back_;
};

/// Converts value and gradient in (distance from the vertical axis, height) to space.
Sample revolve(const Vector3d& p, double distance, double value, const Vector2d& gradient) {
    if (distance < 1e-300) return {value, {0, 0, gradient.y()}};
    return {value, {gradient.x() * p.x() / distance, gradient.x() * p.y() / distance, gradient.y()}};
}

/// A solid defined by a formula in its own frame.
class FormulaSolid final : public PlacedSolid {
public:
    using Formula = std::function<Sample(const Vector3d& p)>;
    FormulaSolid(const SolidPose& pose, const Vector3d& half_extents, Formula formula, double flatness = 1)
        : PlacedSolid(pose), half_extents_(half_extents), formula_(std::move(formula)), flatness_(flatness) {}
    [[nodiscard]] double flatness() const override { return flatness_; }

protected:
    [[nodiscard]] Sample local(const Vector3d& p) const override { return formula_(p); }
    [[nodiscard]] Vector3d half_extents() const override { return half_extents_; }

private:
    Vector3d half_extents_;
    Formula formula_;
    double flatness_;
};

class Tube final : public Solid {
public:
    explicit Tube(const std::vector<Bead>& beads) : path_(path(beads)), radius_(radii(beads)) {
        for (const double t : path_.samples(samples_per_piece)) {
            const Vector3d centre = path_.at(t).value;
            const double radius = radius_.at(t).value[0];
            samples_.push_back({t, centre, radius});
            // Margin for the bulge of the tube between two samples.
            const Vector3d margin = Vector3d::Constant(radius * 1.02 + path_.length() * 1e-3);
            box_.extend(centre - margin);
            box_.extend(centre + margin);
        }
        for (std::size_t piece = 0; piece + 1 < beads.size(); ++piece) {
            Ball& ball = balls_.emplace_back(samples_[piece * samples_per_piece + samples_per_piece / 2]);
            double max_distance = 0;
            for (int k = 0; k <= samples_per_piece; ++k) {
                const Ball& sample = samples_[piece * samples_per_piece + static_cast<std::size_t>(k)];
                max_distance = std::max(max_distance, (sample.centre - ball.centre).norm() + sample.radius);
            }
            ball.radius = max_distance;
        }
    }
    [[nodiscard]] Sample sample(const Vector3d& p) const override {
        const double t = parameter(p);
        const Vector3d offset = p - path_.at(t).value;
        const double distance = offset.norm();
        return {distance - radius_.at(t).value[0], distance < 1e-300 ? Vector3d(Vector3d::UnitX()) : Vector3d(offset / distance)};
    }
    [[nodiscard]] double parameter(const Vector3d& p) const override {
        const auto ball_distance = [&p](const Ball& ball) { return (p - ball.centre).norm() - ball.radius; };
        const std::size_t best = shapes::SampleGroups{samples_per_piece, samples_.size()}.minimum(
            [&](std::size_t piece) { return ball_distance(balls_[piece]); },
            [&](std::size_t i) { return ball_distance(samples_[i]); });
        const double low = samples_[best == 0 ? 0 : best - 1].t, high = samples_[std::min(best + 1, samples_.size() - 1)].t;
        return shapes::bracketed_root(low, high, samples_[best].t, [&](double t) {
            const auto c = path_.at(t);
            const auto r = radius_.at(t);
            const Vector3d offset = c.value - p;
            const double distance = std::max(offset.norm(), 1e-300), along = offset.dot(c.first) / distance;
            return std::pair(along - r.first[0],
                             (c.first.squaredNorm() - along * along + offset.dot(c.second)) / distance - r.second[0]);
        });
    }
    [[nodiscard]] AlignedBox3d box() const override { return box_; }

private:
    static constexpr int samples_per_piece = 8;
    struct Ball {
        double t;
        Vector3d centre;
        double radius;
    };
    static shapes::Spline<3> path(const std::vector<Bead>& beads) {
        std::vector<Vector3d> points;
        for (const auto& bead : beads) points.push_back(bead.centre);
        return {chord_lengths(beads), points};
    }
    static shapes::Spline<1> radii(const std::vector<Bead>& beads) {
        using Scalar = shapes::Spline<1>::Vec;
        std::vector<Scalar> values;
        for (const auto& bead : beads) values.push_back(Scalar(bead.radius));
        // Zero slope at the ends, so that the tube continues smoothly into the end balls.
        return {chord_lengths(beads), values, Scalar(0.0), Scalar(0.0)};
    }
    shapes::Spline<3> path_;
    shapes::Spline<1> radius_;
    std::vector<Ball> samples_, balls_;  ///< on the path; bounding balls of the pieces
    AlignedBox3d box_;
};

class RevolvedSolid final : public PlacedSolid {
public:
    RevolvedSolid(const SolidPose& pose, const std::vector<Vector2d>& profile)
        : PlacedSolid(pose), curve_(chord_lengths(profile), profile, Vector2d(1, 0), Vector2d(-1, 0)) {
        for (const double t : curve_.samples(samples_per_piece)) {
            samples_.emplace_back(t, curve_.at(t).value);
            extents_ = extents_.cwiseMax(samples_.back().second.cwiseAbs() * 1.01 + Vector2d::Constant(curve_.length() * 1e-3));
        }
        for (std::size_t piece = 0; piece + 1 < profile.size(); ++piece) {
            const Vector2d middle = samples_[piece * samples_per_piece + samples_per_piece / 2].second;
            double max_distance = 0;
            for (int k = 0; k <= samples_per_piece; ++k) {
                max_distance = std::max(
                    max_distance, (samples_[piece * samples_per_piece + static_cast<std::size_t>(k)].second - middle).norm());
            }
            discs_.emplace_back(middle, max_distance);
        }
    }
    [[nodiscard]] double parameter(const Vector3d& p) const override {
        const Vector3d q = to_local(p);
        return closest({std::hypot(q.x(), q.y()), q.z()});
    }

protected:
    [[nodiscard]] Sample local(const Vector3d& p) const override {
        const double axis_distance = std::hypot(p.x(), p.y());
        const Vector2d q(axis_distance, p.z());
        const auto c = curve_.at(closest(q));
        const Vector2d outward = Vector2d(c.first.y(), -c.first.x()).normalized();
        const Vector2d offset = q - c.value;
        const double distance = offset.norm(), side = offset.dot(outward) < 0 ? -1 : 1;
        return revolve(p, axis_distance, side * distance, distance < 1e-9 ? outward : Vector2d(side / distance * offset));
    }
    [[nodiscard]] Vector3d half_extents() const override { return {extents_.x(), extents_.x(), extents_.y()}; }

private:
    static constexpr int samples_per_piece = 8;
    [[nodiscard]] double closest(const Vector2d& q) const {
        const std::size_t best = shapes::SampleGroups{samples_per_piece, samples_.size()}.minimum(
            [&](std::size_t piece) { return (q - discs_[piece].first).norm() - discs_[piece].second; },
            [&](std::size_t i) { return (q - samples_[i].second).norm(); });
        const double low = samples_[best == 0 ? 0 : best - 1].first,
                     high = samples_[std::min(best + 1, samples_.size() - 1)].first;
        return shapes::bracketed_root(low, high, samples_[best].first, [&](double t) {
            const auto c = curve_.at(t);
            const Vector2d offset = c.value - q;
            return std::pair(offset.dot(c.first), c.first.squaredNorm() + offset.dot(c.second));
        });
    }
    shapes::Spline<2> curve_;
    std::vector<std::pair<double, Vector2d>> samples_;
    std::vector<std::pair<Vector2d, double>> discs_;  ///< bounding discs of the samples of each piece
    Vector2d extents_ = Vector2d::Zero();
};

template <class Items, class Position>
std::vector<double> cumulative(const Items& items, Position position) {
    std::vector<double> lengths{0};
    for (std::size_t i = 1; i < items.size(); ++i)
        lengths.push_back(lengths.back() + (position(items[i]) - position(items[i - 1])).norm());
    return lengths;
}

[[noreturn]] void refuse(const char* solid, const char* problem) {
    std::string text = solid;
    text += ' ';
    text += problem;
    fail_usage(text);
}

template <class Items>
void check_path(const Items& items, const char* solid_name) {
    if (items.size() < 2) refuse(solid_name, "needs at least two points");
    const auto lengths = chord_lengths(items);
    for (std::size_t i = 1; i < lengths.size(); ++i) {
        if (!(lengths[i] > lengths[i - 1])) refuse(solid_name, "has two equal points in a row");
    }
}

void check_sizes(const char* solid_name, std::initializer_list<double> sizes, double rounding = 0,
                 double maximum = std::numeric_limits<double>::infinity()) {
    for (const double size : sizes) {
        if (!(size > 0 && std::isfinite(size))) refuse(solid_name, "has a size that is not positive");
    }
    if (!(rounding >= 0 && rounding <= maximum)) refuse(solid_name, "has a rounding that does not fit its size");
}

}  // namespace

SolidPointer make_ellipsoid(const SolidPose& pose, const Vector3d& radii) {
    check_sizes("an ellipsoid", {radii.x(), radii.y(), radii.z()});
    const double smallest = radii.minCoeff();
    const auto formula = [radii, smallest](const Vector3d& p) -> Sample {
        const Vector3d q = p.cwiseQuotient(radii);
        const double length = q.norm();
        if (length < 1e-300) return {-smallest, Vector3d::UnitX()};
        return {smallest * (length - 1), smallest / length * q.cwiseQuotient(radii)};
    };
    return std::make_unique<FormulaSolid>(pose, radii, formula, smallest / radii.maxCoeff());
}
SolidPointer make_box(const SolidPose& pose, const Vector3d& half, double rounding) {
    check_sizes("a box", {half.x(), half.y(), half.z()}, rounding, half.minCoeff());
    const Vector3d core = half - Vector3d::Constant(rounding);
    const auto formula = [core, rounding](const Vector3d& p) -> Sample {
        const Vector3d q = p.cwiseAbs() - core;
        const Vector3d sign(p.x() < 0 ? -1 : 1, p.y() < 0 ? -1 : 1, p.z() < 0 ? -1 : 1);
        int side = 0;
        if (q.maxCoeff(&side) <= 0) return {q[side] - rounding, sign[side] * Vector3d::Unit(side)};
        const Vector3d outside = q.cwiseMax(0.0);
        const double distance = outside.norm();
        return {distance - rounding, outside.cwiseProduct(sign) / distance};
    };
    return std::make_unique<FormulaSolid>(pose, half, formula);
}
SolidPointer make_cylinder(const SolidPose& pose, double radius, double half_height, double rounding) {
    check_sizes("a cylinder", {radius, half_height}, rounding, std::min(radius, half_height));
    const Vector2d core = Vector2d(radius, half_height) - Vector2d::Constant(rounding);
    const auto formula = [core, rounding](const Vector3d& p) {
        const double axis_distance = std::hypot(p.x(), p.y());
        const double up = p.z() < 0 ? -1 : 1;
        const Vector2d q(axis_distance - core.x(), std::abs(p.z()) - core.y());
        if (q.maxCoeff() <= 0) {
            const bool lid = q.y() > q.x();
            return revolve(p, axis_distance, q.maxCoeff() - rounding, lid ? Vector2d(0, up) : Vector2d(1, 0));
        }
        const Vector2d outside = q.cwiseMax(0.0);
        const double distance = outside.norm();
        return revolve(p, axis_distance, distance - rounding, Vector2d(outside.x(), outside.y() * up) / distance);
    };
    return std::make_unique<FormulaSolid>(pose, Vector3d(radius, radius, half_height), formula);
}
SolidPointer make_torus(const SolidPose& pose, double ring_radius, double tube_radius) {
    check_sizes("a torus", {ring_radius, tube_radius, ring_radius - tube_radius});
    const auto formula = [ring_radius, tube_radius](const Vector3d& p) {
        const double axis_distance = std::hypot(p.x(), p.y());
        const Vector2d q(axis_distance - ring_radius, p.z());
        const double distance = q.norm();
        return revolve(p, axis_distance, distance - tube_radius, distance < 1e-300 ? Vector2d(1, 0) : Vector2d(q / distance));
    };
    const double outer_radius = ring_radius + tube_radius;
    return std::make_unique<FormulaSolid>(pose, Vector3d(outer_radius, outer_radius, tube_radius), formula);
}
SolidPointer make_tube(const std::vector<Bead>& beads) {
    check_path(beads, "a tube");
    for (const auto& bead : beads) check_sizes("a tube", {bead.radius});
    return std::make_unique<Tube>(beads);
}
SolidPointer make_revolved(const SolidPose& pose, const std::vector<Vector2d>& profile) {
    check_path(profile, "a lathe's profile");
    if (profile.front().x() != 0 || profile.back().x() != 0) fail_usage("a lathe's profile must start and end on the axis");
    return std::make_unique<RevolvedSolid>(pose, profile);
}
std::vector<double> chord_lengths(const std::vector<Bead>& beads) {
    return cumulative(beads, [](const Bead& bead) { return bead.centre; });
}
std::vector<double> chord_lengths(const std::vector<Vector2d>& profile) {
    return cumulative(profile, [](const Vector2d& point) { return point; });
}

}  // namespace ostraka

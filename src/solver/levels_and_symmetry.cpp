// Constraints on stations of an axis, levels, mirrored pairs and proportions.
#include "solver/create.h"

#include <fmt/core.h>

#include <cmath>

namespace ostraka::solver {

namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Rows are the means of groups of points. With shares, a point counts for the next station by its share and for its own
/// station by the rest: hat functions, which avoid waves of the length of a group between moved stations.
class StationMeans : public Constraint {
protected:
    StationMeans(const ConstraintArguments& a, std::vector<int> stations, const std::vector<double>& shares,
                 const std::vector<double>& weights)
        : Constraint(a.kind, a.ids, a.weight) {
        if (stations.empty())
            for (std::size_t i = 0; i < ids().size(); ++i) stations.push_back(static_cast<int>(i));
        if (stations.size() != ids().size()) a.fail("there must be a station for each point");
        for (const auto& [values, name] : {std::pair(&shares, "shares"), std::pair(&weights, "weights")})
            if (!values->empty() && values->size() != ids().size())
                a.fail(fmt::format("there are {} {} for {} points", values->size(), name, ids().size()));
        int count = 0;
        for (const int station : stations)
            if (station < 0 || station >= static_cast<int>(stations.size()))
                a.fail(fmt::format("station {} is out of range", station));
        for (std::size_t i = 0; i < stations.size(); ++i)
            count = std::max(count, stations[i] + (!shares.empty() && shares[i] > 0 ? 2 : 1));
        std::vector<std::vector<std::pair<std::int32_t, double>>> members(static_cast<std::size_t>(count));
        for (std::size_t i = 0; i < stations.size(); ++i) {
            const double share = shares.empty() ? 0.0 : shares[i];
            if (!(share >= 0 && share <= 1))
                a.fail(fmt::format("share {} is {}", i, std::to_string(share)), "shares are from 0 to 1");
            const double weight = weights.empty() ? 1.0 : weights[i];
            if (!(weight > 0 && weight < 1e60))
                a.fail(fmt::format("weight {} is {}", i, std::to_string(weight)), "weights are positive");
            if (share < 1) members[stations[i]].emplace_back(static_cast<std::int32_t>(i), weight * (1 - share));
            if (share > 0) members[stations[i] + 1].emplace_back(static_cast<std::int32_t>(i), share);
        }
        for (int s = 0; s < count; ++s) {
            double sum = 0;
            for (const auto& [i, weight] : members[s]) sum += weight;
            if (!(sum > 0)) a.fail(fmt::format("station {} has no point", s));
            for (const auto& [i, weight] : members[s]) map_.entries.push_back({s, i, weight / sum});
        }
        map_.rows = count;
    }
};

class AxisOnLine final : public StationMeans {
public:
    AxisOnLine(const ConstraintArguments& a, const kinds::AxisOnLine& kind)
        : StationMeans(a, kind.stations, kind.shares, {}), direction_(a.unit(kind.direction)), point_(a.finite(kind.point)) {}
    void project(const RowsIn& rows, RowsOut projected) const override {
        for (Index i = 0; i < rows.cols(); ++i) projected.col(i) = point_ + direction_ * direction_.dot(rows.col(i) - point_);
    }
    [[nodiscard]] std::optional<Components> given_components() const override {
        const Vector3d u = any_perpendicular(direction_), w = direction_.cross(u).normalized();
        Components given;
        given.directions.resize(2, 3);
        given.directions << u.transpose(), w.transpose();
        given.values = (given.directions * point_).replicate(1, map_.rows);
        return given;
    }

private:
    Vector3d direction_, point_;
};

class MeansOnLevel final : public StationMeans {
public:
    MeansOnLevel(const ConstraintArguments& a, const kinds::MeansOnLevel& kind)
        : StationMeans(a, kind.groups, {}, kind.weights), up_(a.unit(kind.up)) {
        heights_ = Eigen::VectorXd::Zero(map_.rows);
        if (!kind.places) return;
        const Points& places = *kind.places;
        if (places.cols() != map_.rows) a.fail(fmt::format("there are {} places for {} groups", places.cols(), map_.rows));
        if (!places.allFinite()) a.fail("the places are not finite");
        for (Index i = 0; i < places.cols(); ++i) heights_[i] = up_.dot(places.col(i) - places.col(0));
        heights_.array() -= heights_.mean();
    }
    void project(const RowsIn& rows, RowsOut projected) const override {
        const double level = up_.dot(rows.rowwise().mean());
        for (Index i = 0; i < rows.cols(); ++i)
            projected.col(i) = rows.col(i) + up_ * (level + heights_[i] - up_.dot(rows.col(i)));
    }

private:
    Vector3d up_;
    Eigen::VectorXd heights_;  ///< height of each group relative to the mean of all
};

class MeanPosition final : public StationMeans {
public:
    MeanPosition(const ConstraintArguments& a, const kinds::MeanPosition& kind)
        : StationMeans(a, std::vector<int>(a.ids.size(), 0), {}, kind.weights), place_(a.finite(kind.place)) {}
    void project(const RowsIn& rows, RowsOut projected) const override { projected = place_.replicate(1, rows.cols()); }
    [[nodiscard]] bool constant() const override { return true; }
    [[nodiscard]] std::optional<Components> given_components() const override {
        Components given;
        given.directions = Matrix3d::Identity();
        given.values = place_.replicate(1, map_.rows);
        return given;
    }

private:
    Vector3d place_;
};

class MirrorSymmetry final : public Constraint {
public:
    MirrorSymmetry(const ConstraintArguments& a, const kinds::MirrorSymmetry& kind)
        : Constraint(a.kind, a.ids, a.weight), given_(kind.plane) {
        map_.direct = map_.rows = static_cast<Index>(ids().size());
        map_.centred = !given_;
        if (!given_) return;
        normal_ = a.unit(kind.plane->normal, "normal");
        point_ = a.finite(kind.plane->point);
    }
    void project(const RowsIn& rows, RowsOut projected) const override {
        Vector3d n = normal_;
        if (!given_) {
            Matrix3d k = Matrix3d::Zero();
            for (Index i = 0; i + 1 < rows.cols(); i += 2) k += rows.col(i) * rows.col(i + 1).transpose();
            n = principal((k + k.transpose()) / 2).eigenvectors().col(0);
        }
        for (Index i = 0; i + 1 < rows.cols(); i += 2) {
            const Vector3d p = rows.col(i) - point_, q = rows.col(i + 1) - point_;
            const Vector3d mean = (p + q - 2 * n.dot(q) * n) / 2;
            projected.col(i) = mean + point_;
            projected.col(i + 1) = mean - 2 * n.dot(mean) * n + point_;
        }
    }

private:
    bool given_;
    Vector3d normal_ = Vector3d::UnitZ(), point_ = Vector3d::Zero();
};

class MirrorInTriangles final : public Constraint {
public:
    MirrorInTriangles(const ConstraintArguments& a, const kinds::MirrorInTriangles& kind)
        : Constraint(a.kind, a.ids, a.weight), normal_(a.unit(kind.plane.normal, "normal")), point_(a.finite(kind.plane.point)) {
        if (ids().size() % 4 != 0)
            a.fail(fmt::format("there are {} points", ids().size()),
                   "give groups of four: a point and the corners that its partner lies between");
        const std::size_t groups = ids().size() / 4;
        const std::vector<double>& shares = kind.barycentric;
        if (shares.size() != 3 * groups)
            a.fail(fmt::format("there are {} coordinates for {} groups", shares.size(), groups), "give three per group");
        for (std::size_t g = 0; g < groups; ++g) {
            const double sum = shares[3 * g] + shares[3 * g + 1] + shares[3 * g + 2];
            if (!(std::abs(sum - 1) <= 1e-6))
                a.fail(fmt::format("the coordinates of group {} add up to {}", g, std::to_string(sum)),
                       "barycentric coordinates add up to 1");
            const auto row = static_cast<std::int32_t>(2 * g), first = static_cast<std::int32_t>(4 * g);
            map_.entries.push_back({row, first, 1.0});
            for (int k = 0; k < 3; ++k) map_.entries.push_back({row + 1, first + 1 + k, shares[3 * g + k]});
        }
        map_.rows = static_cast<Index>(2 * groups);
        discrepancy_.setZero(3, static_cast<Index>(groups));
        if (kind.discrepancies) MirrorInTriangles::set_target(*kind.discrepancies);
    }
    void set_target(const Points& target) override {
        if (target.cols() != discrepancy_.cols())
            fail_usage(
                fmt::format("the target of {} must have a discrepancy for each of {} groups", kind(), discrepancy_.cols()));
        check_points(target, fmt::format("target of {}", kind()));
        discrepancy_ = target;
    }
    void project(const RowsIn& rows, RowsOut projected) const override {
        for (Index g = 0; g < discrepancy_.cols(); ++g) {
            const Vector3d p = rows.col(2 * g) - point_, q = rows.col(2 * g + 1) + discrepancy_.col(g) - point_;
            const Vector3d mean = (p + q - 2 * normal_.dot(q) * normal_) / 2;
            projected.col(2 * g) = mean + point_;
            projected.col(2 * g + 1) = mean - 2 * normal_.dot(mean) * normal_ + point_ - discrepancy_.col(g);
        }
    }

private:
    Vector3d normal_, point_;
    Points discrepancy_;
};

class Proportion final : public Constraint {
public:
    Proportion(const ConstraintArguments& a, const kinds::Proportion& kind)
        : Constraint(a.kind, a.ids, a.weight), range_(a.checked(kind.range)), anchors_(kind.anchors) {
        const int count = static_cast<int>(ids().size()), part = kind.part > 0 ? kind.part : count;
        if (part < 2 || part > count) a.fail(fmt::format("the part has {} points", part), "it needs two points at least");
        if (!kind.second && part != count) a.fail("there are points beyond the part", "give a second measure, or leave them out");
        first_ = kind.measure;
        if (first_.direction) first_.direction = a.unit(*first_.direction);
        check(a, first_, part, "first measure");
        second_ = kind.second;
        if (second_ && second_->direction) {
            a.unit(*second_->direction, "second direction");
            second_->direction->normalize();
        }
        if (second_) check(a, *second_, count, "second measure");
        for (const int anchor : anchors_)
            if (anchor < 0 || anchor >= part) a.fail(fmt::format("anchor {} is out of range", anchor));
        map_.direct = map_.rows = part;
        map_.centred = anchors_.empty() || kind.shape.has_value();
        if (kind.shape) set_reference(a, *kind.shape, kind.uniform);
        if (!second_) return;
        map_.entries = {{0, second_->pins[0], -1.0}, {0, second_->pins[1], 1.0}};
        map_.rows = part + 1;
        map_.observed = 1;
    }
    void project(const RowsIn& rows, RowsOut projected) const override {
        projected = rows;
        if (reference_.cols() > 0) {
            project_copy(rows, projected);
            return;
        }
        const Vector3d first = rows.col(first_.pins[1]) - rows.col(first_.pins[0]);
        const double l1 = length(first, first_.direction), unit = unit_of(rows);
        if (!(l1 > 0)) return;  // a measure of zero length cannot be stretched
        const double wanted =
            std::isinf(range_.max) ? std::max(l1, unit * range_.min) : Interval{unit * range_.min, unit * range_.max}.clamp(l1);
        if (wanted == l1) return;
        const Vector3d axis = first_.direction ? *first_.direction : Vector3d(first / l1);
        Vector3d fixed = Vector3d::Zero();
        for (const int anchor : anchors_) fixed += (rows.col(anchor) - rows.col(0)) / static_cast<double>(anchors_.size());
        if (!anchors_.empty()) fixed += rows.col(0);
        for (Index i = 0; i < map_.direct; ++i)
            projected.col(i) = rows.col(i) + (wanted / l1 - 1) * axis.dot(rows.col(i) - fixed) * axis;
    }

private:
    static double length(const Vector3d& edge, const std::optional<Vector3d>& along) {
        return along ? std::abs(along->dot(edge)) : edge.norm();
    }
    /// The length of the second measure; 1 if there is none.
    [[nodiscard]] double unit_of(const RowsIn& rows) const {
        return second_ ? length(rows.col(rows.cols() - 1), second_->direction) : 1.0;
    }
    /// The pins are among the first `count` points and apart from each other.
    static void check(const ConstraintArguments& a, const kinds::PinnedMeasure& measure, int count, const char* name) {
        for (const int pin : measure.pins)
            if (pin < 0 || pin >= count) a.fail(fmt::format("pin {} is out of range", pin));
        if (!(length(a.rest.col(measure.pins[1]) - a.rest.col(measure.pins[0]), measure.direction) > 0))
            a.fail(fmt::format("the {} has no length", name), "move its pins apart");
    }
    void set_reference(const ConstraintArguments& a, const Points& shape, bool uniform) {
        if (shape.cols() != map_.direct) a.fail(fmt::format("the shape has {} points instead of {}", shape.cols(), map_.direct));
        if (!shape.allFinite()) a.fail("the shape is not finite");
        const Vector3d mean = shape.col(0) + (shape.colwise() - shape.col(0).eval()).rowwise().mean();
        reference_ = shape.colwise() - mean;
        whole_ = uniform;
        const Vector3d edge = reference_.col(first_.pins[1]) - reference_.col(first_.pins[0]);
        if (!(length(edge, first_.direction) > 0)) a.fail("the first measure of the shape has no length", "move its pins apart");
        axis_ = first_.direction ? *first_.direction : Vector3d(edge.normalized());
    }

    /// The copy R S q closest to the rows, where S is a stretch by s along the axis or a scaling by s, with its measure in
    /// range. Alternates between R and s, from the unrotated copy.
    void project_copy(const RowsIn& rows, RowsOut projected) const {
        const double unit = unit_of(rows);
        const Points part = rows.leftCols(map_.direct);
        const Vector3d edge = reference_.col(first_.pins[1]) - reference_.col(first_.pins[0]);
        const Matrix3d along = whole_ ? Matrix3d(Matrix3d::Identity()) : Matrix3d(axis_ * axis_.transpose());
        const Matrix3d rest = Matrix3d::Identity() - along;
        const Matrix3d moment = outer_sum(part, reference_), own = outer_sum(reference_, reference_);
        Matrix3d rotation = Matrix3d::Identity();
        double s = 1;
        for (int round = 0; round < 30; ++round) {
            // |R (rest + s along) q - r|^2 is minimal at the zero of its derivative by s; rest and along are orthogonal.
            const double size = (along * own).trace();
            if (size > 0) s = ((rotation.transpose() * moment * along).trace()) / size;
            s = within(s, unit, rotation * (rest * edge), rotation * (along * edge));
            const Matrix3d next = best_rotation(moment * (rest + s * along));
            const double change = (next - rotation).norm();
            rotation = next;
            if (change < 1e-14) break;
        }
        s = within(s, unit, rotation * (rest * edge), rotation * (along * edge));
        projected.leftCols(map_.direct) = rotation * (rest + s * along) * reference_;
    }

    /// The factor closest to s for which the measure is in range. The measure is that of constant + s growing, along the
    /// direction or as a length.
    [[nodiscard]] double within(double s, double unit, const Vector3d& constant, const Vector3d& growing) const {
        const double low = range_.min * unit, high = std::isinf(range_.max) ? range_.max : range_.max * unit;
        constexpr double minimum = 1e-3;  // prevents a part from vanishing or inverting
        s = std::max(s, minimum);
        const double now = length(constant + s * growing, first_.direction);
        const double wanted = now < low ? low : now > high ? high : now;
        if (wanted == now) return s;
        const auto& along = first_.direction;
        double a = along ? along->dot(growing) : growing.norm(), b = along ? along->dot(constant) : 0;
        if (a < 0) a = -a, b = -b;
        return a > 0 ? std::max((wanted - b) / a, minimum) : s;
    }

    Interval range_;
    kinds::PinnedMeasure first_{};
    std::optional<kinds::PinnedMeasure> second_;
    bool whole_ = false;
    Points reference_;  ///< centred; empty: the points keep their shape
    Vector3d axis_ = Vector3d::UnitZ();
    std::vector<int> anchors_;
};

}  // namespace

ConstraintPtr create(const kinds::AxisOnLine& kind, const ConstraintArguments& a) {
    return std::make_unique<AxisOnLine>(a, kind);
}
ConstraintPtr create(const kinds::MeansOnLevel& kind, const ConstraintArguments& a) {
    return std::make_unique<MeansOnLevel>(a, kind);
}
ConstraintPtr create(const kinds::MeanPosition& kind, const ConstraintArguments& a) {
    return std::make_unique<MeanPosition>(a, kind);
}
ConstraintPtr create(const kinds::MirrorSymmetry& kind, const ConstraintArguments& a) {
    if (a.ids.size() % 2 != 0) a.fail("there is an odd number of points", "give pairs; a point of the plane is its own partner");
    return std::make_unique<MirrorSymmetry>(a, kind);
}
ConstraintPtr create(const kinds::MirrorInTriangles& kind, const ConstraintArguments& a) {
    return std::make_unique<MirrorInTriangles>(a, kind);
}
ConstraintPtr create(const kinds::Proportion& kind, const ConstraintArguments& a) {
    return std::make_unique<Proportion>(a, kind);
}

}  // namespace ostraka::solver

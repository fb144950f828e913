// Constraints on stations of an axis, levels, mirrored pairs and proportions.
#include "kinds.h"

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
    StationMeans(const Making& m, const std::vector<double>& shares, const std::vector<double>& weights = {})
        : Constraint(m.kind, m.ids, m.weight) {
        std::vector<int> stations = m.parameters.stations;
        if (m.kind == "MeanPosition") stations.assign(ids().size(), 0);
        if (stations.empty())
            for (std::size_t i = 0; i < ids().size(); ++i) stations.push_back(static_cast<int>(i));
        if (stations.size() != ids().size()) m.fail("there must be a station for each point");
        if (!shares.empty() && shares.size() != ids().size())
            m.fail("there are " + std::to_string(shares.size()) + " coefficients for " + std::to_string(ids().size()) +
                   " points");
        if (!weights.empty() && weights.size() != ids().size())
            m.fail("there are " + std::to_string(weights.size()) + " coefficients for " + std::to_string(ids().size()) +
                   " points");
        int count = 0;
        for (const int station : stations) {
            if (station < 0 || station >= static_cast<int>(stations.size()))
                m.fail("station " + std::to_string(station) + " is out of range");
        }
        for (std::size_t i = 0; i < stations.size(); ++i)
            count = std::max(count, stations[i] + (!shares.empty() && shares[i] > 0 ? 2 : 1));
        std::vector<std::vector<std::pair<std::int32_t, double>>> members(static_cast<std::size_t>(count));
        for (std::size_t i = 0; i < stations.size(); ++i) {
            const double share = shares.empty() ? 0.0 : shares[i];
            if (!(share >= 0 && share <= 1))
                m.fail("coefficient " + std::to_string(i) + " is " + std::to_string(share), "shares are from 0 to 1");
            const double weight = weights.empty() ? 1.0 : weights[i];
            if (!(weight > 0 && weight < 1e60))
                m.fail("coefficient " + std::to_string(i) + " is " + std::to_string(weight), "weights are positive");
            if (share < 1) members[stations[i]].emplace_back(static_cast<std::int32_t>(i), weight * (1 - share));
            if (share > 0) members[stations[i] + 1].emplace_back(static_cast<std::int32_t>(i), share);
        }
        for (int s = 0; s < count; ++s) {
            double sum = 0;
            for (const auto& [i, weight] : members[s]) sum += weight;
            if (!(sum > 0)) m.fail("station " + std::to_string(s) + " has no point");
            for (const auto& [i, weight] : members[s]) map_.entries.push_back({s, i, weight / sum});
        }
        map_.rows = count;
    }
};

/// The stations of an axis lie on a given line: constrains the axis, and the surface follows.
class AxisOnLine final : public StationMeans {
public:
    AxisOnLine(const Making& m, const Vector3d& direction, const Vector3d& point)
        : StationMeans(m, m.parameters.coefficients), direction_(direction), point_(point) {}
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

/// The means of the groups have the same height; the closest is the mean of their heights. With a target (one point per group)
/// their height differences are those of the target's points.
class MeansOnLevel final : public StationMeans {
public:
    MeansOnLevel(const Making& m, const Vector3d& up) : StationMeans(m, {}, m.parameters.coefficients), up_(up) {
        heights_ = Eigen::VectorXd::Zero(map_.rows);
        if (!m.parameters.target) return;
        const Points& target = *m.parameters.target;
        if (target.cols() != map_.rows)
            m.fail("the target has " + std::to_string(target.cols()) + " points instead of " + std::to_string(map_.rows));
        if (!target.allFinite()) m.fail("the target is not finite");
        for (Index i = 0; i < target.cols(); ++i) heights_[i] = up.dot(target.col(i) - target.col(0));
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

/// The mean of all points is at a given position.
class MeanPosition final : public StationMeans {
public:
    MeanPosition(const Making& m, const Vector3d& place) : StationMeans(m, {}, m.parameters.coefficients), place_(place) {}
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

/// Pairs of points that mirror each other in a given plane (rows: the points) or in the best plane (rows: the centred points),
/// whose normal is the last eigenvector of the symmetric part of sum p q^T.
class MirrorSymmetry final : public Constraint {
public:
    MirrorSymmetry(Making&& m, const Vector3d& normal, const Vector3d& point)
        : Constraint(m.kind, std::move(m.ids), m.weight), given_(true), normal_(normal), point_(point) {
        map_.direct = map_.rows = static_cast<Index>(ids().size());
    }
    explicit MirrorSymmetry(Making&& m) : Constraint(m.kind, std::move(m.ids), m.weight) {
        map_.direct = map_.rows = static_cast<Index>(ids().size());
        map_.centred = true;
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
    bool given_ = false;
    Vector3d normal_ = Vector3d::UnitZ(), point_ = Vector3d::Zero();
};

/// Pairs of a point and a partner, a combination of three other points, that mirror each other in a given plane up to a
/// constant discrepancy per pair. Rows: the point and the combination.
class MirroredInTriangles final : public Constraint {
public:
    MirroredInTriangles(const Making& m, const Vector3d& normal, const Vector3d& point)
        : Constraint(m.kind, m.ids, m.weight), normal_(normal), point_(point) {
        if (ids().size() % 4 != 0)
            m.fail("there are " + std::to_string(ids().size()) + " points",
                   "with coefficients, give groups of four: a point and the corners that its partner lies between");
        const std::size_t groups = ids().size() / 4;
        const std::vector<double>& shares = m.parameters.coefficients;
        if (shares.size() != 3 * groups)
            m.fail("there are " + std::to_string(shares.size()) + " coefficients for " + std::to_string(groups) + " groups",
                   "give three a group");
        for (std::size_t g = 0; g < groups; ++g) {
            const double sum = shares[3 * g] + shares[3 * g + 1] + shares[3 * g + 2];
            if (!(std::abs(sum - 1) <= 1e-6))
                m.fail("the coefficients of group " + std::to_string(g) + " add up to " + std::to_string(sum),
                       "barycentric coordinates add up to 1");
            const auto row = static_cast<std::int32_t>(2 * g), first = static_cast<std::int32_t>(4 * g);
            map_.entries.push_back({row, first, 1.0});
            for (int k = 0; k < 3; ++k) map_.entries.push_back({row + 1, first + 1 + k, shares[3 * g + k]});
        }
        map_.rows = static_cast<Index>(2 * groups);
        discrepancy_.setZero(3, static_cast<Index>(groups));
        if (m.parameters.target) MirroredInTriangles::set_target(*m.parameters.target);
    }
    void set_target(const Points& target) override {
        if (target.cols() != discrepancy_.cols())
            fail_usage("the target of MirrorSymmetry must have a discrepancy for each of " + std::to_string(discrepancy_.cols()) +
                       " groups");
        check_points(target, "target of MirrorSymmetry");
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

/// The first part, stretched along its measure so that the measure, or its ratio to a second measure, is within a range (the
/// thesis, section 5.3.2). It is stretched about its mean (rows: the centred points of the part) or about the mean of its
/// anchors (rows: the points). The second measure, if any, is one more row, which is only observed. With a target the part is a
/// rotated copy of that shape instead, stretched along the measure or scaled uniformly (rows: the centred points). The set of
/// such copies does not depend on the points, so that conflicting constraints cannot degrade the shape over the iterations.
class Proportion final : public Constraint {
public:
    Proportion(Making&& m, Making::Interval range)
        : Constraint(m.kind, m.ids, m.weight),
          range_(range),
          single_(m.parameters.absolute),
          pins_(m.parameters.pins),
          anchors_(m.parameters.anchors) {
        const int count = static_cast<int>(ids().size()), part = m.parameters.split > 0 ? m.parameters.split : count;
        if (part < 2 || part > count) m.fail("split is " + std::to_string(part), "the first part needs two points at least");
        if (single_ && part != count) m.fail("there are points beyond the part", "an absolute range has no second measure");
        if (pins_.size() != (single_ ? 2 : 4))
            m.fail("there are " + std::to_string(pins_.size()) + " pins",
                   single_ ? "give two: an absolute range has one measure" : "give two of each measure");
        for (std::size_t i = 0; i < pins_.size(); ++i)
            if (pins_[i] < 0 || pins_[i] >= (i < 2 ? part : count))
                m.fail("pin " + std::to_string(pins_[i]) + " is out of range");
        for (const int anchor : anchors_)
            if (anchor < 0 || anchor >= part) m.fail("anchor " + std::to_string(anchor) + " is out of range");
        if (m.parameters.direction) along_first_ = m.direction();
        if (m.parameters.second_direction) {
            along_second_ = *m.parameters.second_direction;
            if (!along_second_->allFinite() || !(along_second_->norm() > 0)) m.fail("the second direction has no length");
            along_second_->normalize();
        }
        if (!(length(m.rest.col(pins_[1]) - m.rest.col(pins_[0]), along_first_) > 0))
            m.fail("the first measure has no length", "move its pins apart");
        map_.direct = map_.rows = part;
        map_.centred = anchors_.empty() || m.parameters.target.has_value();
        if (m.parameters.target) set_reference(m, *m.parameters.target);
        if (single_) return;
        if (!(length(m.rest.col(pins_[3]) - m.rest.col(pins_[2]), along_second_) > 0))
            m.fail("the second measure has no length", "move its pins apart");
        map_.entries = {{0, pins_[2], -1.0}, {0, pins_[3], 1.0}};
        map_.rows = part + 1;
        map_.observed = 1;
    }
    void project(const RowsIn& rows, RowsOut projected) const override {
        projected = rows;
        if (reference_.cols() > 0) {
            project_copy(rows, projected);
            return;
        }
        const Vector3d first = rows.col(pins_[1]) - rows.col(pins_[0]);
        const double l1 = length(first, along_first_), unit = single_ ? 1.0 : length(rows.col(rows.cols() - 1), along_second_);
        if (!(l1 > 0)) return;  // a measure of zero length cannot be stretched
        const double wanted = std::isinf(range_.max) ? std::max(l1, unit * range_.min)
                                                     : Making::Interval{unit * range_.min, unit * range_.max}.clamp(l1);
        if (wanted == l1) return;
        const Vector3d axis = along_first_ ? *along_first_ : Vector3d(first / l1);
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
    void set_reference(const Making& m, const Points& target) {
        if (target.cols() != map_.direct)
            m.fail("the target has " + std::to_string(target.cols()) + " points instead of " + std::to_string(map_.direct));
        if (!target.allFinite()) m.fail("the target is not finite");
        const Vector3d mean = target.col(0) + (target.colwise() - target.col(0).eval()).rowwise().mean();
        reference_ = target.colwise() - mean;
        whole_ = m.parameters.uniform;
        const Vector3d edge = reference_.col(pins_[1]) - reference_.col(pins_[0]);
        if (!(length(edge, along_first_) > 0)) m.fail("the first measure of the target has no length", "move its pins apart");
        axis_ = along_first_ ? *along_first_ : Vector3d(edge.normalized());
    }

    /// The copy R S q closest to the rows, where S is a stretch by s along the axis or a scaling by s, with its measure in
    /// range. Alternates between R and s, from the unrotated copy.
    void project_copy(const RowsIn& rows, RowsOut projected) const {
        const double unit = single_ ? 1.0 : length(rows.col(rows.cols() - 1), along_second_);
        const Points part = rows.leftCols(map_.direct);
        const Vector3d edge = reference_.col(pins_[1]) - reference_.col(pins_[0]);
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
        const double now = length(constant + s * growing, along_first_);
        const double wanted = now < low ? low : now > high ? high : now;
        if (wanted == now) return s;
        double a = along_first_ ? along_first_->dot(growing) : growing.norm(), b = along_first_ ? along_first_->dot(constant) : 0;
        if (a < 0) a = -a, b = -b;
        return a > 0 ? std::max((wanted - b) / a, minimum) : s;
    }

    Making::Interval range_;
    bool single_;  ///< the range applies to the first measure alone
    bool whole_ = false;
    Points reference_;  ///< centred; empty: the points keep their shape
    Vector3d axis_ = Vector3d::UnitZ();
    std::vector<int> pins_, anchors_;
    std::optional<Vector3d> along_first_, along_second_;
};

}  // namespace

std::unique_ptr<Constraint> make_axis_on_line(Making&& m) {
    const Vector3d direction = m.direction(), point = m.point();
    return std::make_unique<AxisOnLine>(m, direction, point);
}

std::unique_ptr<Constraint> make_means_on_level(Making&& m) { return std::make_unique<MeansOnLevel>(m, m.direction()); }

std::unique_ptr<Constraint> make_mean_position(Making&& m) {
    const Vector3d place = m.point();
    return std::make_unique<MeanPosition>(m, place);
}

std::unique_ptr<Constraint> make_mirror_symmetry(Making&& m) {
    if (!m.parameters.coefficients.empty()) {
        const Vector3d normal = m.direction(), point = m.point();
        return std::make_unique<MirroredInTriangles>(m, normal, point);
    }
    if (m.ids.size() % 2 != 0) m.fail("there is an odd number of points", "give pairs; a point of the plane is its own partner");
    if (!m.parameters.direction) return std::make_unique<MirrorSymmetry>(std::move(m));
    const Vector3d normal = m.direction(), point = m.point();
    return std::make_unique<MirrorSymmetry>(std::move(m), normal, point);
}

std::unique_ptr<Constraint> make_proportion(Making&& m) {
    if (!m.parameters.min && !m.parameters.max) m.fail("the range is missing");
    const auto range = m.range(0, std::numeric_limits<double>::infinity());
    return std::make_unique<Proportion>(std::move(m), range);
}

}  // namespace ostraka::solver

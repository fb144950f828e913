// Groups that turn, stretch or mirror as they are: towards a normal, an axis, a proportion, a plane of symmetry.
#include "kinds.h"

#include <cmath>

namespace ostraka::solver {

namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d cross_matrix(const Vector3d& n) {
    Matrix3d m;
    m << 0, -n.z(), n.y(), n.z(), 0, -n.x(), -n.y(), n.x(), 0;
    return m;
}

/// The rotation R with R a = d or R a = -d that maximises tr(R m): the turn from a to +-d, then a spin about d, whose angle has a
/// closed form.
Matrix3d turn_to(const Vector3d& a, const Vector3d& d, const Matrix3d& m) {
    Matrix3d best = Matrix3d::Identity();
    double most = -std::numeric_limits<double>::infinity();
    for (const double side : {1.0, -1.0}) {
        const Matrix3d turn = Eigen::Quaterniond::FromTwoVectors(a, side * d).toRotationMatrix();
        const Matrix3d turned = turn * m;
        const double along = d.dot(turned * d), c = turned.trace() - along, s = (cross_matrix(d) * turned).trace();
        const double value = along + std::hypot(c, s);
        if (value > most) {
            most = value;
            best = Eigen::AngleAxisd(c == 0 && s == 0 ? 0.0 : std::atan2(s, c), d).toRotationMatrix() * turn;
        }
    }
    return best;
}

/// The points as they are, turned about their mean so that their fitted plane has the given normal, either way round.
class FittedPlaneOrientation final : public MomentConstraint {
public:
    FittedPlaneOrientation(Making&& m, const Vector3d& normal)
        : MomentConstraint(m.kind, std::move(m.ids), m.weight), normal_(normal) {
        map_.direct = map_.rows = static_cast<Index>(ids().size());
        map_.centred = true;
    }
    [[nodiscard]] LinearProjection project_moments(const Moments& moments) const override {
        const Vector3d fitted = principal(moments.rows).eigenvectors().col(0);
        return {turn_to(fitted, normal_, moments.rows), Matrix3d::Zero()};
    }

private:
    Vector3d normal_;
};

/// The points as they are, moved rigidly so that their axis lies on a line (the thesis, section 5.2.2). The axis is given in the
/// rest state and carried along by the best rigid motion from there. Rows: the points.
class CoAxiality final : public Constraint {
public:
    CoAxiality(Making&& m, const Vector3d& direction, const Vector3d& point)
        : Constraint(m.kind, m.ids, m.weight), direction_(direction), point_(point) {
        map_.direct = map_.rows = static_cast<Index>(ids().size());
        const Vector3d mean = m.rest.col(0) + (m.rest.colwise() - m.rest.col(0).eval()).rowwise().mean();
        shape_ = m.rest.colwise() - mean;
        if (m.parameters.rest_direction) {
            rest_axis_ = *m.parameters.rest_direction;
            if (!rest_axis_.allFinite() || !(rest_axis_.cwiseAbs().maxCoeff() > 0)) m.fail("the rest axis has no direction");
            rest_axis_ = (rest_axis_ / rest_axis_.cwiseAbs().maxCoeff()).normalized();
        } else {
            rest_axis_ = principal(outer_sum(shape_, shape_)).eigenvectors().col(2);
        }
        if (m.parameters.rest_point) {
            if (!m.parameters.rest_point->allFinite()) m.fail("the rest axis's point is not finite");
            to_mean_ = mean - *m.parameters.rest_point;
        }
    }
    void project(const RowsIn& rows, RowsOut projected) const override {
        const Vector3d first = rows.col(0);
        Points z = rows.colwise() - first;
        const Vector3d offset = z.rowwise().mean();
        z.colwise() -= offset;
        const Vector3d mean = first + offset;
        const Matrix3d carried = best_rotation(outer_sum(z, shape_));
        const Vector3d axis = carried * rest_axis_, b = carried * to_mean_;
        const Matrix3d across = Matrix3d::Identity() - direction_ * direction_.transpose();
        const Vector3d gap = across * (point_ - mean);
        const auto count = static_cast<double>(rows.cols());
        const Matrix3d turn = turn_to(axis, direction_, outer_sum(z, z) - count * b * gap.transpose());
        const Vector3d to = mean + across * (turn * b) + gap;
        for (Index i = 0; i < rows.cols(); ++i) projected.col(i) = turn * z.col(i) + to;
    }

private:
    Vector3d direction_, point_, rest_axis_, to_mean_ = Vector3d::Zero();
    Points shape_;
};

/// Rows are the means of groups of points.
class StationMeans : public Constraint {
protected:
    explicit StationMeans(const Making& m) : Constraint(m.kind, m.ids, m.weight) {
        std::vector<int> stations = m.parameters.stations;
        if (stations.empty())
            for (std::size_t i = 0; i < ids().size(); ++i) stations.push_back(static_cast<int>(i));
        if (stations.size() != ids().size()) m.fail("there must be a station for each point");
        int count = 0;
        for (const int station : stations) {
            if (station < 0 || station >= static_cast<int>(stations.size()))
                m.fail("station " + std::to_string(station) + " is out of range");
            count = std::max(count, station + 1);
        }
        std::vector<std::vector<std::int32_t>> members(static_cast<std::size_t>(count));
        for (std::size_t i = 0; i < stations.size(); ++i) members[stations[i]].push_back(static_cast<std::int32_t>(i));
        for (int s = 0; s < count; ++s) {
            if (members[s].empty()) m.fail("station " + std::to_string(s) + " has no point");
            for (const std::int32_t i : members[s]) map_.entries.push_back({s, i, 1.0 / static_cast<double>(members[s].size())});
        }
        map_.rows = count;
    }
};

/// The stations of an axis on a given line: the axis is constrained, and the surface follows.
class AxisOnLine final : public StationMeans {
public:
    AxisOnLine(const Making& m, const Vector3d& direction, const Vector3d& point)
        : StationMeans(m), direction_(direction), point_(point) {}
    void project(const RowsIn& rows, RowsOut projected) const override {
        for (Index i = 0; i < rows.cols(); ++i) projected.col(i) = point_ + direction_ * direction_.dot(rows.col(i) - point_);
    }

private:
    Vector3d direction_, point_;
};

/// The closest common height of the means is the mean of theirs.
class MeansOnLevel final : public StationMeans {
public:
    MeansOnLevel(const Making& m, const Vector3d& up) : StationMeans(m), up_(up) {}
    void project(const RowsIn& rows, RowsOut projected) const override {
        const double level = up_.dot(rows.rowwise().mean());
        for (Index i = 0; i < rows.cols(); ++i) projected.col(i) = rows.col(i) + up_ * (level - up_.dot(rows.col(i)));
    }

private:
    Vector3d up_;
};

/// Pairs of points that mirror each other: in a given plane (rows: the points), or in the best one (rows: the centred points),
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

/// The first part, as it is, stretched along its measure so that first / second measure is within a range (the thesis, section
/// 5.3.2): about its mean (rows: the centred points of the part), or about the mean of its anchors (rows: the points). One more
/// row, which is only observed, is the second measure.
class Proportion final : public Constraint {
public:
    Proportion(Making&& m, Making::Interval range)
        : Constraint(m.kind, m.ids, m.weight), range_(range), pins_(m.parameters.pins), anchors_(m.parameters.anchors) {
        const int count = static_cast<int>(ids().size()), part = m.parameters.split > 0 ? m.parameters.split : count;
        if (part < 2 || part > count) m.fail("split is " + std::to_string(part), "the first part needs two points at least");
        if (pins_.size() != 4) m.fail("there are " + std::to_string(pins_.size()) + " pins", "give two of each measure");
        for (std::size_t i = 0; i < 4; ++i)
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
        const auto measure = [&](int a, int b, const std::optional<Vector3d>& along) {
            const Vector3d edge = m.rest.col(b) - m.rest.col(a);
            return along ? std::abs(along->dot(edge)) : edge.norm();
        };
        if (!(measure(pins_[0], pins_[1], along_first_) > 0)) m.fail("the first measure has no length", "move its pins apart");
        if (!(measure(pins_[2], pins_[3], along_second_) > 0)) m.fail("the second measure has no length", "move its pins apart");
        map_.direct = part;
        map_.centred = anchors_.empty();
        map_.entries = {{0, pins_[2], -1.0}, {0, pins_[3], 1.0}};
        map_.rows = part + 1;
        map_.observed = 1;
    }
    void project(const RowsIn& rows, RowsOut projected) const override {
        projected = rows;
        const Vector3d first = rows.col(pins_[1]) - rows.col(pins_[0]), second = rows.col(rows.cols() - 1);
        const double l1 = along_first_ ? std::abs(along_first_->dot(first)) : first.norm();
        const double l2 = along_second_ ? std::abs(along_second_->dot(second)) : second.norm();
        if (!(l1 > 0)) return;  // there is nothing to stretch
        const double wanted =
            std::isinf(range_.max) ? std::max(l1, l2 * range_.min) : Making::Interval{l2 * range_.min, l2 * range_.max}.clamp(l1);
        if (wanted == l1) return;
        const Vector3d axis = along_first_ ? *along_first_ : Vector3d(first / l1);
        Vector3d fixed = Vector3d::Zero();
        for (const int anchor : anchors_) fixed += (rows.col(anchor) - rows.col(0)) / static_cast<double>(anchors_.size());
        if (!anchors_.empty()) fixed += rows.col(0);
        for (Index i = 0; i < map_.direct; ++i)
            projected.col(i) = rows.col(i) + (wanted / l1 - 1) * axis.dot(rows.col(i) - fixed) * axis;
    }

private:
    Making::Interval range_;
    std::vector<int> pins_, anchors_;
    std::optional<Vector3d> along_first_, along_second_;
};

}  // namespace

std::unique_ptr<Constraint> make_fitted_plane_orientation(Making&& m) {
    const Vector3d normal = m.direction();
    return std::make_unique<FittedPlaneOrientation>(std::move(m), normal);
}

std::unique_ptr<Constraint> make_co_axiality(Making&& m) {
    const Vector3d direction = m.direction(), point = m.point();
    return std::make_unique<CoAxiality>(std::move(m), direction, point);
}

std::unique_ptr<Constraint> make_axis_on_line(Making&& m) {
    const Vector3d direction = m.direction(), point = m.point();
    return std::make_unique<AxisOnLine>(m, direction, point);
}

std::unique_ptr<Constraint> make_means_on_level(Making&& m) {
    const Vector3d up = m.direction();
    return std::make_unique<MeansOnLevel>(m, up);
}

std::unique_ptr<Constraint> make_mirror_symmetry(Making&& m) {
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

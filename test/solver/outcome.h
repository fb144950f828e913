// Results of constraints for given points.
#pragma once

#include "examples.h"

namespace ostraka {

using Eigen::Matrix3d;
using Eigen::Vector3d;

struct Outcome {
    Points rows, projected;
};

inline Outcome outcome(const Constraint& c, const Points& points) {
    Outcome o;
    c.rows_of(points, o.rows);
    o.projected.resize(3, o.rows.cols());
    c.project(o.rows, o.projected);
    return o;
}

inline Points again(const Constraint& c, const Points& rows) {
    Points projected(3, rows.cols());
    c.project(rows, projected);
    return projected;
}

inline double squared_distance(const Constraint& c, const Points& a, const Points& b) {
    return (a - b).leftCols(c.map().rows - c.map().observed).squaredNorm();
}

/// B restricted to the constraint's own ids, dense.
inline Eigen::MatrixXd matrix_of(const Constraint& c) {
    const auto& map = c.map();
    Eigen::MatrixXd b = Eigen::MatrixXd::Zero(map.rows, static_cast<Eigen::Index>(c.ids().size()));
    for (Eigen::Index i = 0; i < map.direct; ++i) {
        b(i, i) += 1;
        if (map.centred) b.row(i).head(map.direct).array() -= 1.0 / static_cast<double>(map.direct);
    }
    for (const auto& e : map.entries) b(map.direct + e.row, e.position) += e.value;
    return b;
}

inline Matrix3d some_rotation() { return Eigen::AngleAxisd(1.1, Vector3d(1, 2, -2).normalized()).toRotationMatrix(); }
inline double angle(const Vector3d& a, const Vector3d& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

}  // namespace ostraka

// Kinds of constraints on the parts of an object: axes, levels, mirror images, proportions (thesis, sections 5.2 and 5.3.2).
// The projections of some kinds move or stretch the current points, so that the set of admissible rows depends on the points.
// kinds.h explains rows and ids.
#pragma once

#include "ostraka/solver/kinds.h"

#include <array>

namespace ostraka::kinds {

/// The plane fitted to the points has a given normal, up to sign. The projection rotates the current points about their mean.
/// Rows: the centred points.
struct FittedPlaneOrientation {
    static constexpr KindInfo kind{"FittedPlaneOrientation", 3};  ///< name of the kind, and min number of points
    Eigen::Vector3d normal;                                       ///< normal of any length
};

/// The axis of the points lies on a line (section 5.2.2): the projection moves the current points rigidly. The axis is given in
/// the rest state and is mapped to the current points by the best-fitting rigid motion. The closest admissible motion has a
/// closed form. Rows: the points.
struct CoAxiality {
    static constexpr KindInfo kind{"CoAxiality", 2};  ///< name of the kind, and min number of points
    Eigen::Vector3d direction, point;                 ///< direction and a point of the line
    /// The axis at rest; empty: the longest principal axis of the rest positions, through their mean.
    std::optional<Eigen::Vector3d> rest_direction = {}, rest_point = {};
};

/// The angle between the axis of the points (mapped as for CoAxiality, without sign) and a direction is in a range. The
/// projection rotates the current points about their mean. The closest rotation, as a unit quaternion, is the eigenvector of a
/// largest eigenvalue, because the joint range of the two quadratic forms is convex (Brickman 1961). Rows: the centred points.
struct AxisDirection {
    static constexpr KindInfo kind{"AxisDirection", 2};  ///< name of the kind, and min number of points
    Eigen::Vector3d direction;                           ///< direction of any length
    Interval angle{0, 0};                                ///< range of the angle, radians, at most pi / 2
    /// Direction of the axis at rest; empty: the longest principal axis of the rest positions.
    std::optional<Eigen::Vector3d> rest_direction = {};
    /// Lower bound of size: the points keep at least half the size of this shape, so that contradictory constraints cannot
    /// shrink them to a point. Empty: no bound.
    std::optional<Points> min_size = {};
};

/// The means of groups of points lie on a given line. Each group is a station along the axis of a part. Rows: the means.
struct AxisOnLine {
    static constexpr KindInfo kind{"AxisOnLine", 1};  ///< name of the kind, and min number of points
    Eigen::Vector3d direction, point;                 ///< direction and a point of the line
    std::vector<int> stations = {};  ///< for each point, the index of its station; empty: each point is a separate station
    /// For each point, its weight (0 to 1) in the mean of the next station; its weight in its own station is 1 minus this
    /// weight. Together the weights form hat functions along the axis, which avoid waves of the length of a group. Empty: 0.
    std::vector<double> shares = {};
};

/// The means of groups of points have the same height or given differences of height. Rows: the means.
struct MeansOnLevel {
    static constexpr KindInfo kind{"MeansOnLevel", 2};  ///< name of the kind, and min number of points
    Eigen::Vector3d up;                                 ///< upward direction of any length
    std::vector<int> groups = {};      ///< for each point, the index of its group; empty: each point is a separate group
    std::vector<double> weights = {};  ///< for each point, its weight in the mean of its group; empty: 1
    /// One position per group, whose heights define the required differences of height. Empty: all groups have the same height.
    std::optional<Points> places = {};
};

/// The weighted mean of the points is at a given position. Row: the mean.
struct MeanPosition {
    static constexpr KindInfo kind{"MeanPosition", 1};  ///< name of the kind, and min number of points
    Eigen::Vector3d place;                              ///< position of the mean
    std::vector<double> weights = {};                   ///< weight of each point; empty: 1
};

/// A plane of reflection.
struct MirrorPlane {
    Eigen::Vector3d normal, point;  ///< normal of any length; a point of the plane
};

/// The points p and q of each pair (two ids) are mirror images of each other. The projection replaces p by the mean of p and
/// the mirror image of q, and q by the mirror image of this mean. Rows: the points. Without a given plane, the rows are the
/// centred points, and the normal of the optimal plane is the eigenvector of the smallest eigenvalue of the symmetric part of
/// sum p q^T.
struct MirrorSymmetry {
    static constexpr KindInfo kind{"MirrorSymmetry", 2};  ///< name of the kind, and min number of points
    std::optional<MirrorPlane> plane = {};                ///< plane of reflection; empty: the optimal plane
};

/// Each point is the mirror image of a partner that lies within a triangle. Ids: for each group, the point and the three
/// corners of its partner's triangle. The rows of a group are the point and its partner.
struct MirrorInTriangles {
    static constexpr KindInfo kind{"MirrorInTriangles", 4};  ///< name of the kind, and min number of points
    MirrorPlane plane;                                       ///< plane of reflection
    std::vector<double> barycentric;                         ///< for each group, three barycentric coordinates of the partner
    /// For each group, the required difference between the mirrored point and its partner. Empty: zero.
    std::optional<Points> discrepancies = {};
};

/// A measure of a part: the distance of two points, or the component of their difference along a direction.
struct PinnedMeasure {
    std::array<int, 2> pins;                        ///< positions of the two points in ids()
    std::optional<Eigen::Vector3d> direction = {};  ///< direction of any length; empty: the distance of the points is measured
};

/// The measure of a part, or its ratio to a second measure, is in a range (section 5.3.2). The projection stretches the current
/// part along the direction of its measure, about the mean of the part (rows: the centred points of the part) or about the mean
/// of its anchors (rows: the points). The second measure enters as an additional row, which has no weight in the objective. If
/// `shape` is given, the part becomes a rotated copy of this shape, stretched along the measure or scaled uniformly. The set of
/// these copies does not depend on the current points, so that conflicting constraints cannot degrade the shape over the
/// iterations.
struct Proportion {
    static constexpr KindInfo kind{"Proportion", 2};  ///< name of the kind, and min number of points
    Interval range;  ///< range of the ratio measure / second or, without a second measure, of the measure in the points' unit
    PinnedMeasure measure;                     ///< measure of the part; its pins belong to the part
    std::optional<PinnedMeasure> second = {};  ///< second measure; empty: the measure itself is in the range
    int part = 0;                              ///< number of leading ids that form the part; 0: all
    std::vector<int> anchors = {};     ///< positions in ids() of the anchors, within the part; empty: the mean of the part
    std::optional<Points> shape = {};  ///< shape of the part; empty: the current points
    bool uniform = false;              ///< true: the shape is scaled uniformly; false: stretched along the measure
};

}  // namespace ostraka::kinds

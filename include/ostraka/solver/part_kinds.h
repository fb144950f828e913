// Kinds of constraints on the parts of an object: axes, levels, mirror images, proportions (the thesis, sections 5.2 and 5.3.2).
// Some of them admit the points "as they are": the projection moves or stretches the current points, so that what is admitted
// depends on them. See kinds.h for the convention.
#pragma once

#include "ostraka/solver/kinds.h"

#include <array>

namespace ostraka::kinds {

/// The points as they are, rotated about their mean so that their fitted plane has a given normal, up to sign. Rows: the centred
/// points.
struct FittedPlaneOrientation {
    static constexpr KindInfo kind{"FittedPlaneOrientation", 3};
    Eigen::Vector3d normal;  ///< of any length
};

/// The points as they are, moved rigidly so that their axis lies on a line (section 5.2.2). The axis is given in the rest state
/// and carried by the best rigid motion; the closest motion has a closed form. Rows: the points.
struct CoAxiality {
    static constexpr KindInfo kind{"CoAxiality", 2};
    Eigen::Vector3d direction, point;  ///< the line
    /// The axis at rest; default: the longest principal axis of the rest points, through their mean.
    std::optional<Eigen::Vector3d> rest_direction = {}, rest_point = {};
};

/// The points as they are, rotated about their mean so that the angle between their axis (carried as for CoAxiality, without
/// sign) and a direction is in a range. The closest rotation is a top eigenvector in unit quaternions: the joint range of the
/// two quadratic forms is convex (Brickman 1961). Rows: the centred points.
struct AxisDirection {
    static constexpr KindInfo kind{"AxisDirection", 2};
    Eigen::Vector3d direction;  ///< of any length
    Interval angle{0, 0};       ///< radians, at most pi / 2
    std::optional<Eigen::Vector3d> rest_direction = {};
    /// The points are kept at least half as large as this shape, so that contradictory constraints do not shrink them to a point.
    std::optional<Points> min_size = {};
};

/// The means of groups of points, the stations of an axis, lie on a given line; the surface follows. Rows: the means.
struct AxisOnLine {
    static constexpr KindInfo kind{"AxisOnLine", 1};
    Eigen::Vector3d direction, point;  ///< the line
    std::vector<int> stations = {};    ///< station of each point, from 0 on; default: a separate one for each
    /// Share of each point that counts for the next station, 0 to 1, the rest for its own: hat functions, which avoid waves of
    /// the length of a group. Default: 0.
    std::vector<double> shares = {};
};

/// The means of groups of points have one height, the mean of theirs, or given differences of height. Rows: the means.
struct MeansOnLevel {
    static constexpr KindInfo kind{"MeansOnLevel", 2};
    Eigen::Vector3d up;                 ///< of any length
    std::vector<int> groups = {};       ///< group of each point, from 0 on; default: a separate one for each
    std::vector<double> weights = {};   ///< weights of the points in the means of their groups; default: 1
    std::optional<Points> places = {};  ///< one per group, whose differences of height are kept; default: none
};

/// The mean of the points is at a given place. Row: the mean.
struct MeanPosition {
    static constexpr KindInfo kind{"MeanPosition", 1};
    Eigen::Vector3d place;
    std::vector<double> weights = {};  ///< weights of the points; default: 1
};

struct MirrorPlane {
    Eigen::Vector3d normal, point;  ///< the normal of any length
};

/// Pairs p, q of points (two ids each) that mirror each other: both are replaced by the mean of p and the image of q, and its
/// image. Rows: the points; without a plane the centred points, and the best plane's normal is the last eigenvector of the
/// symmetric part of sum p q^T.
struct MirrorSymmetry {
    static constexpr KindInfo kind{"MirrorSymmetry", 2};
    std::optional<MirrorPlane> plane = {};
};

/// The same for points whose partners lie within triangles. Ids: for each group a point and the corners of the triangle. Rows:
/// the point and its partner.
struct MirrorInTriangles {
    static constexpr KindInfo kind{"MirrorInTriangles", 4};
    MirrorPlane plane;
    std::vector<double> barycentric;           ///< three coordinates for each group
    std::optional<Points> discrepancies = {};  ///< for each group the mirrored point minus its partner, preserved; default: zero
};

/// A measure of a part: the distance of two points, or the component of their difference along a direction.
struct PinnedMeasure {
    std::array<int, 2> pins;                        ///< positions in ids
    std::optional<Eigen::Vector3d> direction = {};  ///< of any length
};

/// A part as it is, stretched along its measure so that the measure, or its ratio to a second measure, is in a range (section
/// 5.3.2). It is stretched about its mean (rows: the centred points of the part) or about the mean of its anchors (rows: the
/// points). The second measure is one more row, which is only observed. With a shape the part is a rotated copy of that shape
/// instead, stretched along the measure or scaled uniformly; the set of such copies does not depend on the points, so that
/// conflicting constraints cannot degrade the shape over the iterations.
struct Proportion {
    static constexpr KindInfo kind{"Proportion", 2};
    Interval range;         ///< range of measure / second or, without a second measure, of the measure in the points' unit
    PinnedMeasure measure;  ///< pins within the part
    std::optional<PinnedMeasure> second = {};
    int part = 0;                      ///< number of leading ids that form the part; 0: all
    std::vector<int> anchors = {};     ///< positions in ids, within the part
    std::optional<Points> shape = {};  ///< shape of the part
    bool uniform = false;              ///< the shape is scaled instead of stretched
};

}  // namespace ostraka::kinds

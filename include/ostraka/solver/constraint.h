// Low-level geometric constraints: what a set of points should be, and the closest way to be it.
//
// A constraint C over points x_1 ... x_k has a linear map B from its points to rows (B acts on the three coordinates alike), and
// a projection P from rows to the closest rows that C admits. A solver minimises the sum of w |B x - P(B x)|^2 over its
// constraints: the shape proximity function of ShapeUp (Bouaziz et al. 2012; the thesis, equation 4.7), where the weight w
// multiplies the SQUARED norm; the rows of Q in equation 4.8 are sqrt(w) B. Names and the order of ids are those of ShapeOp
// (Deuss et al. 2015) where it has the constraint. doc/solver.md tells of each what it admits.
#pragma once

#include "ostraka/core/error.h"

#include <Eigen/Geometry>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ostraka {

/// A point a column.
using Points = Eigen::Matrix<double, 3, Eigen::Dynamic>;
using RowsIn = Eigen::Ref<const Points>;
using RowsOut = Eigen::Ref<Points>;

/// Throws Error (usage) on points that are not finite.
void check_points(const Points& points, const std::string& what);

class Constraint {
public:
    /// An entry of B: row, position in ids(), value. The direct rows (see below) are not listed.
    struct Entry {
        std::int32_t row, position;
        double value;
    };
    /// B. Its first `direct` rows are the first `direct` points themselves, in their order; when `centred`, less their mean: N_i
    /// of equation 4.7, kept as what it is and never as a dense block. Then come rows with entries. The last `observed` of
    /// those are read by the projection but weigh nothing.
    struct Map {
        Eigen::Index direct = 0;
        bool centred = false;
        std::vector<Entry> entries;  ///< by row, rows counted from `direct` on
        Eigen::Index rows = 0;       ///< all of them
        Eigen::Index observed = 0;
    };
    /// Sums over rows r_i and reference points q_i, from which alone some constraints find their projection.
    struct Moments {
        Eigen::Matrix3d rows;       ///< sum of r_i r_i^T
        Eigen::Matrix3d reference;  ///< sum of r_i q_i^T
    };
    /// A projection P(r_i) = of_rows r_i + of_reference q_i.
    struct LinearProjection {
        Eigen::Matrix3d of_rows, of_reference;
    };

    virtual ~Constraint() = default;
    Constraint(const Constraint&) = delete;
    Constraint& operator=(const Constraint&) = delete;

    [[nodiscard]] std::string_view kind() const { return kind_; }
    [[nodiscard]] const std::vector<int>& ids() const { return ids_; }
    [[nodiscard]] double weight() const { return weight_; }
    [[nodiscard]] const Map& map() const { return map_; }
    /// Throws Error (usage) unless finite and not negative. Solvers have their own set_weight, which also renews their matrices.
    void set_weight(double weight);

    /// Closest admissible rows; rows are unweighted. Never NaN for finite rows. Both have map().rows columns; they may not
    /// overlap.
    virtual void project(const RowsIn& rows, RowsOut projected) const = 0;

    /// Components of rows that are given, whatever their others: those along `directions`, orthonormal rows, are `values`, a
    /// column for each row of B. The projection sets them and leaves the others.
    struct Components {
        Eigen::Matrix<double, Eigen::Dynamic, 3> directions;
        Eigen::MatrixXd values;
    };
    /// None where the projection is not of this kind.
    [[nodiscard]] virtual std::optional<Components> given_components() const { return {}; }

    /// Whether the projection is the same whatever the rows are.
    [[nodiscard]] virtual bool constant() const { return false; }
    /// New target positions (Closeness), displacements (LaplacianDisplacement, one column) or reference shape (Rigid ...).
    /// Throws Error (usage) where the kind has none, or the number of columns is wrong.
    virtual void set_target(const Points& target);

    /// Whether project_moments says all; then reference() has a column for each row, or none where it is not needed.
    [[nodiscard]] virtual bool by_moments() const { return false; }
    [[nodiscard]] virtual const Points& reference() const;
    [[nodiscard]] virtual LinearProjection project_moments(const Moments& moments) const;

    /// B x, for all points of the shape (not only this constraint's).
    void rows_of(const Points& points, Points& rows) const;

    /// Sum over the rows of |row - projected row|, in the points' unit, unweighted and the same wherever the shape stands in the
    /// world (thesis, section 4.2.3).
    [[nodiscard]] double residual(const Points& points) const;
    /// The residual divided by the number of points.
    [[nodiscard]] double normalised_residual(const Points& points) const;
    /// |B x - P(B x)|^2: what the solver multiplies by the weight.
    [[nodiscard]] double squared_distance(const Points& points) const;
    /// Greatest distance of a weighing row from its projection.
    [[nodiscard]] double greatest_distance(const Points& points) const;

protected:
    Constraint(std::string_view kind, std::vector<int> ids, double weight);
    Map map_;

private:
    std::string_view kind_;  ///< of static storage
    std::vector<int> ids_;
    double weight_ = 1;
};

/// What a kind may need besides ids, weight and rest points; doc/solver.md tells which reads what.
struct ConstraintParameters {
    /// Range. Of EdgeStrain, TriangleStrain, TetrahedronStrain, Area, Volume, Bending, PolylineLength: as a share of the rest
    /// state's, or in the measure's own unit with `absolute`. Of Similarity and NonUniformScaling: the factor. Of Angle and
    /// AxisDirection: radians. Of Proportion: first measure / second, or with `absolute` the first measure.
    std::optional<double> min, max;
    bool absolute = false;
    /// Positions or displacements aimed at, reference shape; without it, the rest points'. Of MirrorSymmetry with coefficients:
    /// for each group the mirrored point less its partner, zero without it. Of MeansOnLevel: a point for each group, whose
    /// differences of height the means keep; without it, none. Of AxisDirection: a shape that the points become no smaller than
    /// half of; without it, nothing keeps them from shrinking where others contradict.
    std::optional<Points> target;
    /// Normal of planes, direction of axes and measures; need not have unit length.
    std::optional<Eigen::Vector3d> direction;
    /// A point of an axis or plane.
    std::optional<Eigen::Vector3d> point;
    /// Axis in the rest state, of CoAxiality and (direction only) AxisDirection; without it, the rest points' longest principal
    /// axis.
    std::optional<Eigen::Vector3d> rest_direction, rest_point;
    /// Weights of the neighbours in cotangent Laplacians; without them, the neighbours must be the closed ring in order. Shares
    /// of each point that count for the next station (AxisOnLine). Weights of the points in the means of their groups
    /// (MeansOnLevel). Three barycentric coordinates of each partner (MirrorSymmetry).
    std::vector<double> coefficients;
    /// Positions in ids: where the second part begins (EqualLength, Proportion); the ends of the first and of the second measure
    /// (Proportion: the first two lie in the first part; with `absolute` there are no others); points whose mean stays
    /// (Proportion).
    int split = 0;
    std::vector<int> pins, anchors;
    /// Direction along which the second measure is taken (Proportion); without it, the distance of its ends.
    std::optional<Eigen::Vector3d> second_direction;
    /// Of Proportion with a target: its copies are scaled as a whole instead of stretched along the measure.
    bool uniform = false;
    /// For each id, the station of the axis that it belongs to, from 0 on (AxisOnLine), or the group (MeansOnLevel); without
    /// them, each is its own.
    std::vector<int> stations;
    /// Closest point of a surface (OnSurface). Called from several threads at once.
    std::function<Eigen::Vector3d(const Eigen::Vector3d&)> closest_point;
};

/// One kind that make_constraint knows.
struct ConstraintKind {
    std::string_view name;
    int min_ids, max_ids;  ///< max_ids 0: any number
};
const std::vector<ConstraintKind>& constraint_kinds();

/// A constraint of a kind. `rest` holds all points of the shape in their rest state. Throws Error (usage) for an unknown kind,
/// ids out of range, too few or too many, weights negative or not finite, min > max, values that are not finite, a direction of
/// no length, a missing parameter, and where the rest state is degenerate in a way that leaves the kind without meaning.
std::unique_ptr<Constraint> make_constraint(std::string_view kind, std::vector<int> ids, double weight,
                                            const ConstraintParameters& parameters, const Points& rest);

}  // namespace ostraka

// Low-level geometric constraints: sets of admissible configurations of points, and projections onto them.
//
// A constraint C over points x_1 ... x_k has a linear map B from its points to rows (B acts on the three coordinates alike), and
// a projection P from rows to the closest rows that C admits. A solver minimises the sum of w |B x - P(B x)|^2 over its
// constraints: the shape proximity function of ShapeUp (Bouaziz et al. 2012; thesis, equation 4.7), where the weight w multiplies
// the SQUARED norm; the rows of Q in equation 4.8 are sqrt(w) B. Where ShapeOp (Deuss et al. 2015) has a constraint, its name and
// order of ids are used. kinds.h and part_kinds.h describe the rows that each kind admits.
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

/// Points, one per column.
using Points = Eigen::Matrix<double, 3, Eigen::Dynamic>;
using RowsIn = Eigen::Ref<const Points>;
using RowsOut = Eigen::Ref<Points>;

/// Throws Error (usage) if a point is not finite; `what` names the points in the message.
void check_points(const Points& points, const std::string& what);

/// A low-level constraint on some points of a shape.
class Constraint {
public:
    /// An entry of the matrix B. The direct rows of B are implicit and have no entries.
    struct Entry {
        std::int32_t row, position;  ///< row of B; column of B, as position of the point in ids()
        double value;                ///< coefficient in B
    };
    /// The matrix B. The first `direct` rows of B x are the first `direct` points, in order; if `centred`, the mean of these
    /// points is subtracted (N_i of equation 4.7, stored implicitly and never as a dense block). Then follow the rows given by
    /// `entries`. The last `observed` rows are inputs of the projection but have weight zero in the objective.
    struct Map {
        Eigen::Index direct = 0;     ///< number of direct rows
        bool centred = false;        ///< true: the mean is subtracted from the direct rows
        std::vector<Entry> entries;  ///< entries ordered by row; rows are counted from the first row after the direct rows
        Eigen::Index rows = 0;       ///< number of all rows
        Eigen::Index observed = 0;   ///< number of rows that have no weight
    };
    /// Sums over the rows r_i of a constraint and their reference points q_i, which suffice for the projection of some
    /// constraints.
    struct Moments {
        Eigen::Matrix3d rows;       ///< sum of r_i r_i^T
        Eigen::Matrix3d reference;  ///< sum of r_i q_i^T
    };
    /// A linear projection: P(r_i) = of_rows r_i + of_reference q_i.
    struct LinearProjection {
        Eigen::Matrix3d of_rows, of_reference;  ///< matrices that multiply the row and its reference point
    };

    virtual ~Constraint() = default;
    Constraint(const Constraint&) = delete;
    Constraint& operator=(const Constraint&) = delete;

    /// Name of the kind of constraint.
    [[nodiscard]] std::string_view kind() const { return kind_; }
    /// Indices of the constrained points in the shape.
    [[nodiscard]] const std::vector<int>& ids() const { return ids_; }
    [[nodiscard]] double weight() const { return weight_; }  ///< weight in the solver's objective
    [[nodiscard]] const Map& map() const { return map_; }    ///< the matrix B
    /// Changes the weight. Throws Error (usage) unless the weight is finite and not negative. For a constraint in a solver use
    /// Solver::set_weight, which also updates the solver's matrices.
    void set_weight(double weight);

    /// Projects `rows` (the rows of B x, not multiplied by the weight) to the closest rows that satisfy the constraint. The
    /// result is never NaN for finite rows. Both arguments have map().rows columns and must not overlap.
    virtual void project(const RowsIn& rows, RowsOut projected) const = 0;

    /// Prescribed components of rows: the components along `directions` (orthonormal rows) are equal to `values`, which has one
    /// column for each row of B. The projection sets these components and leaves the others unchanged.
    struct Components {
        Eigen::Matrix<double, Eigen::Dynamic, 3> directions;  ///< the prescribed directions, one per row
        Eigen::MatrixXd values;  ///< prescribed component along each direction (rows) for each row of B (columns)
    };
    /// The prescribed components, if the projection only sets components; empty for other projections.
    [[nodiscard]] virtual std::optional<Components> given_components() const { return {}; }

    /// True if the projection does not depend on the rows.
    [[nodiscard]] virtual bool constant() const { return false; }
    /// Sets the target of the projection: target positions (Closeness), displacements (LaplacianDisplacement, one column) or the
    /// reference shape (Rigid ...). Throws Error (usage) if the kind has no target or the number of columns is wrong.
    virtual void set_target(const Points& target);

    /// True if project_moments defines the projection; then reference() has one column per row, or no column if it is not needed.
    [[nodiscard]] virtual bool by_moments() const { return false; }
    /// Reference points q_i of the rows.
    [[nodiscard]] virtual const Points& reference() const;
    /// The projection for these moments, if by_moments().
    [[nodiscard]] virtual LinearProjection project_moments(const Moments& moments) const;

    /// Computes the rows B x; `points` are all points of the shape (not only the constrained points).
    void rows_of(const Points& points, Points& rows) const;

    /// Sum over the rows of the distance |row - projected row|, in the points' unit, unweighted and invariant to rigid motions of
    /// the shape (thesis, section 4.2.3).
    [[nodiscard]] double residual(const Points& points) const;
    /// The residual divided by the number of constrained points.
    [[nodiscard]] double normalised_residual(const Points& points) const;
    /// The squared distance |B x - P(B x)|^2, the term that the solver multiplies by the weight.
    [[nodiscard]] double squared_distance(const Points& points) const;
    /// Largest distance of a row from its projection, over the rows that have a weight.
    [[nodiscard]] double greatest_distance(const Points& points) const;

protected:
    Constraint(std::string_view kind, std::vector<int> ids, double weight);
    Map map_;  ///< the matrix B

private:
    std::string_view kind_;  ///< refers to static storage
    std::vector<int> ids_;   ///< indices of the constrained points in the shape
    double weight_ = 1;      ///< weight of the constraint in the solver's objective
};

}  // namespace ostraka

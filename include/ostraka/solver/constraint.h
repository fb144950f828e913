// Low-level geometric constraints: sets of admissible configurations of points, and projections onto them.
//
// A constraint C over points x_1 ... x_k has a linear map B from its points to rows (B acts on the three coordinates alike),
// and a projection P from rows to the closest rows that C admits. A solver minimises the sum of w |B x - P(B x)|^2 over its
// constraints: the shape proximity function of ShapeUp (Bouaziz et al. 2012; the thesis, equation 4.7), where the weight w
// multiplies the SQUARED norm; the rows of Q in equation 4.8 are sqrt(w) B. Where ShapeOp (Deuss et al. 2015) has the
// constraint, its name and order of ids are used. kinds.h and part_kinds.h describe what each kind admits.
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

/// One point per column.
using Points = Eigen::Matrix<double, 3, Eigen::Dynamic>;
using RowsIn = Eigen::Ref<const Points>;
using RowsOut = Eigen::Ref<Points>;

/// Throws Error (usage) on points that are not finite.
void check_points(const Points& points, const std::string& what);

class Constraint {
public:
    /// An entry of B: row, position in ids(), value. The direct rows (see below) are implicit.
    struct Entry {
        std::int32_t row, position;
        double value;
    };
    /// The matrix B. Its first `direct` rows are the first `direct` points in their order; if `centred`, minus their mean (N_i
    /// of equation 4.7, stored implicitly and never as a dense block). Rows with entries follow. The last `observed` of those
    /// are read by the projection but have no weight.
    struct Map {
        Eigen::Index direct = 0;
        bool centred = false;
        std::vector<Entry> entries;  ///< by row; rows are counted from `direct` on
        Eigen::Index rows = 0;       ///< number of all rows
        Eigen::Index observed = 0;
    };
    /// Sums over rows r_i and reference points q_i, which suffice for the projection of some constraints.
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
    /// Throws Error (usage) unless the weight is finite and not negative. Solvers have their own set_weight, which also updates
    /// their matrices.
    void set_weight(double weight);

    /// Closest admissible rows; rows are unweighted. Never NaN for finite rows. Both arguments have map().rows columns and must
    /// not overlap.
    virtual void project(const RowsIn& rows, RowsOut projected) const = 0;

    /// Prescribed components of rows: the components along `directions` (orthonormal rows) are `values`, one column for each
    /// row of B. The projection sets these components and leaves the others unchanged.
    struct Components {
        Eigen::Matrix<double, Eigen::Dynamic, 3> directions;
        Eigen::MatrixXd values;
    };
    /// The prescribed components, if the projection is of this form.
    [[nodiscard]] virtual std::optional<Components> given_components() const { return {}; }

    /// True if the projection does not depend on the rows.
    [[nodiscard]] virtual bool constant() const { return false; }
    /// Sets target positions (Closeness), displacements (LaplacianDisplacement, one column) or the reference shape (Rigid ...).
    /// Throws Error (usage) if the kind has no target or the number of columns is wrong.
    virtual void set_target(const Points& target);

    /// True if project_moments defines the projection; reference() then has one column per row, or none if it is not needed.
    [[nodiscard]] virtual bool by_moments() const { return false; }
    [[nodiscard]] virtual const Points& reference() const;
    [[nodiscard]] virtual LinearProjection project_moments(const Moments& moments) const;

    /// Computes B x; `points` are all points of the shape (not only this constraint's).
    void rows_of(const Points& points, Points& rows) const;

    /// Sum over the rows of |row - projected row|, in the points' unit, unweighted and invariant to rigid motions of the shape
    /// (thesis, section 4.2.3).
    [[nodiscard]] double residual(const Points& points) const;
    /// The residual divided by the number of points.
    [[nodiscard]] double normalised_residual(const Points& points) const;
    /// |B x - P(B x)|^2, the term that the solver multiplies by the weight.
    [[nodiscard]] double squared_distance(const Points& points) const;
    /// Greatest distance of a weighted row from its projection.
    [[nodiscard]] double greatest_distance(const Points& points) const;

protected:
    Constraint(std::string_view kind, std::vector<int> ids, double weight);
    Map map_;

private:
    std::string_view kind_;  ///< points to static storage
    std::vector<int> ids_;
    double weight_ = 1;
};

}  // namespace ostraka

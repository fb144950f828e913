#include "reconstruction/level_system.h"

#include "ostraka/algebra/dense.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/solver/make_constraint.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

double cotangent(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
    const double sine = (a - c).cross(b - c).norm();
    return sine > 0 ? (a - c).dot(b - c) / sine : 0;
}

Rings rings_of(const Mesh& mesh, const Points& rest) {
    Rings rings;
    rings.area.assign(mesh.number_of_vertices(), 0);
    rings.sum.assign(mesh.number_of_vertices(), 0);
    for (const Face face : mesh.faces()) {
        const double area = face_area(mesh, face) / 3;
        for (const Vertex v : corners(mesh, face)) rings.area[v] += area;
    }
    for (const Vertex v : mesh.vertices()) {
        rings.begin.push_back(rings.neighbour.size());
        if (mesh.is_isolated(v)) continue;
        for (const Halfedge h : mesh.halfedges_around_target(mesh.halfedge(v))) {
            const Vertex n = mesh.source(h);
            double weight = 0;
            for (const Halfedge side : {h, mesh.opposite(h)})
                if (!mesh.is_border(side))
                    weight += 0.5 * cotangent(rest.col(static_cast<Eigen::Index>(v)), rest.col(static_cast<Eigen::Index>(n)),
                                              rest.col(static_cast<Eigen::Index>(mesh.target(mesh.next(side)))));
            rings.neighbour.push_back(static_cast<int>(n.idx()));
            // Obtuse angles would make the displacement unstable; needle triangles would make the weights unbounded.
            rings.weight.push_back(std::clamp(weight, 0.05, 20.0));
            rings.sum[v] += rings.weight.back();
        }
    }
    rings.begin.push_back(rings.neighbour.size());
    return rings;
}

/// The rotation nearest to a matrix: its polar factor by Newton's iteration (Higham 1986), or, if the matrix is nearly a
/// reflection or nearly singular, by its singular values.
Matrix3d nearest_rotation(const Matrix3d& matrix) {
    constexpr double flat = 1e-8, max_change = 1e-9;  // the iteration converges quadratically: the remaining error is rounding
    constexpr int max_steps = 30;
    const double size = matrix.norm();
    Matrix3d current = size > 0 ? Matrix3d(matrix / size) : Matrix3d(matrix);
    if (current.determinant() > flat)
        for (int step = 0; step < max_steps; ++step) {
            const Matrix3d inverse = current.inverse().transpose();
            const double balance = std::sqrt(inverse.norm() / current.norm());
            const Matrix3d next = 0.5 * (balance * current + inverse / balance);
            const double change = (next - current).norm();
            current = next;
            if (change < max_change) return current;
        }
    const Svd3 svd(matrix);
    Vector3d signs(1, 1, 1);
    if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0) signs.z() = -1;
    return svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
}

}  // namespace

std::vector<Matrix3d> local_rotations(const Rings& rings, const Points& rest, const Points& current) {
    const auto n = static_cast<std::size_t>(rest.cols());
    std::vector<Matrix3d> covariances(n), rotations(n);
    parallel_for(n, [&](std::size_t i) {
        const auto v = static_cast<Eigen::Index>(i);
        Matrix3d sum = Matrix3d::Zero();
        for (std::size_t k = rings.begin[i]; k < rings.begin[i + 1]; ++k) {
            const int j = rings.neighbour[k];
            sum += rings.weight[k] * (current.col(j) - current.col(v)) * (rest.col(j) - rest.col(v)).transpose();
        }
        covariances[i] = sum;
    });
    parallel_for(n, [&](std::size_t i) {
        Matrix3d sum = covariances[i];
        for (std::size_t k = rings.begin[i]; k < rings.begin[i + 1]; ++k)
            sum += covariances[static_cast<std::size_t>(rings.neighbour[k])];
        rotations[i] = nearest_rotation(sum);
    });
    return rotations;
}

std::vector<double> local_scales(const Rings& rings, const Points& rest, const Points& current,
                                 const std::vector<bool>& observed) {
    constexpr int extra_rings = 2;  // rings around the first
    const auto n = static_cast<std::size_t>(rest.cols());
    // Sums of squares at rest and now.
    std::vector<Eigen::Vector2d> sums(n), sums_before;
    parallel_for(n, [&](std::size_t i) {
        const auto v = static_cast<Eigen::Index>(i);
        sums[i].setZero();
        for (std::size_t k = rings.begin[i]; k < rings.begin[i + 1]; ++k) {
            const int j = rings.neighbour[k];
            sums[i] += rings.weight[k] * Eigen::Vector2d((rest.col(j) - rest.col(v)).squaredNorm(),
                                                         (current.col(j) - current.col(v)).squaredNorm());
        }
    });
    Eigen::Vector2d observed_sums = Eigen::Vector2d::Zero();
    for (std::size_t i = 0; i < n; ++i)
        if (observed[i]) observed_sums += sums[i];
    const double observed_ratio = observed_sums[0] > 0 ? observed_sums[1] / observed_sums[0] : 1;
    for (std::size_t i = 0; i < n; ++i)
        if (!observed[i]) sums[i][1] = observed_ratio * sums[i][0];
    for (int ring = 0; ring < extra_rings; ++ring) {
        sums_before = sums;
        parallel_for(n, [&](std::size_t i) {
            for (std::size_t k = rings.begin[i]; k < rings.begin[i + 1]; ++k)
                sums[i] += sums_before[static_cast<std::size_t>(rings.neighbour[k])];
        });
    }
    std::vector<double> scales(n, 1);
    for (std::size_t i = 0; i < n; ++i)
        if (sums[i][0] > 0) scales[i] = std::clamp(std::sqrt(sums[i][1] / sums[i][0]), 0.5, 2.0);
    return scales;
}

LevelSystem::LevelSystem(const Mesh& template_mesh) : mesh(template_mesh) {
    rest = columns_of(mesh);
    rings = rings_of(mesh, rest);
    double sum = 0;
    for (const double area : rings.area) sum += area;
    mean_area = sum / static_cast<double>(std::max<std::size_t>(1, rings.area.size()));
}

std::vector<std::unique_ptr<Constraint>> LevelSystem::constraints() {
    std::vector<std::unique_ptr<Constraint>> result;
    match_.clear();
    stay_.clear();
    laplacian_.clear();
    for (const Vertex v : mesh.vertices()) {
        const int i = static_cast<int>(v.idx());
        const kinds::Closeness at_rest{rest.col(i)};
        match_.push_back(result.size());
        result.push_back(make_constraint(at_rest, {i}, 0, rest));
        stay_.push_back(result.size());
        result.push_back(make_constraint(at_rest, {i}, 1, rest));
        laplacian_.push_back(no_constraint);
        if (mesh.is_isolated(v)) continue;
        std::vector<int> ids{i};
        kinds::CotangentLaplacianDisplacement ring;
        for (std::size_t k = rings.begin[v]; k < rings.begin[v + 1]; ++k) {
            ids.push_back(rings.neighbour[k]);
            ring.weights.push_back(rings.weight[k]);
        }
        laplacian_.back() = result.size();
        result.push_back(make_constraint(ring, std::move(ids), 1, rest));
    }
    return result;
}

Solver& LevelSystem::renewed_solver() {
    // With so many changed weights the factors are recomputed, without any remainder of the old ones; a small system is rebuilt
    // completely.
    constexpr std::size_t min_reused = 2000;
    if (!solver_ || match_.size() < min_reused) {
        solver_ = std::make_unique<MeshSpaceSolver>(constraints(), rest);
        return *solver_;
    }
    for (std::size_t c = 0; c < solver_->size(); ++c) solver_->set_weight(c, 0);
    return *solver_;
}

}  // namespace ostraka

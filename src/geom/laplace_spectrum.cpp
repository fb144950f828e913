#include "ostraka/geom/laplace_spectrum.h"

#include "geom/cotangent.h"
#include "ostraka/algebra/dense.h"
#include "ostraka/algebra/sparse.h"
#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"
#include "ostraka/mesh/flood.h"

#include <cmath>
#include <random>

namespace ostraka {

namespace {

std::vector<Face> largest_part(const Mesh& mesh) {
    std::vector<Face> largest;
    double most = 0;
    std::vector<bool> seen(mesh.number_of_faces());
    for (const Face start : mesh.faces()) {
        if (seen[start]) continue;
        std::vector<Face> part = flood_faces(mesh, start, seen);
        double area = 0;
        for (const Face face : part) area += face_area(mesh, face);
        if (area > most) most = area, largest = std::move(part);
    }
    return largest;
}

/// Stiffness and mass matrix of a component scaled to unit area, with its own vertex numbers.
struct System {
    Eigen::SparseMatrix<double> stiffness;
    Eigen::VectorXd mass;
};

System system_of(const Mesh& mesh, const std::vector<Face>& part) {
    std::vector<int> row(mesh.number_of_vertices(), -1);
    std::vector<double> mass;
    double area = 0;
    for (const Face face : part) {
        area += face_area(mesh, face);
        for (const Vertex v : corners(mesh, face)) {
            if (row[v] < 0) row[v] = static_cast<int>(mass.size()), mass.push_back(0);
            mass[static_cast<std::size_t>(row[v])] += face_area(mesh, face) / 3;
        }
    }
    std::vector<Eigen::Triplet<double>> entries;
    std::vector<bool> in_part(mesh.number_of_faces());
    for (const Face face : part) in_part[face] = true;
    for (const Edge edge : mesh.edges()) {
        const Halfedge h = mesh.halfedge(edge);
        const Face face = mesh.is_border(h) ? mesh.face(mesh.opposite(h)) : mesh.face(h);
        if (face == Mesh::null_face() || !in_part[face]) continue;
        const double weight = cotangent_weight(mesh, edge);
        const int i = row[mesh.source(h)], j = row[mesh.target(h)];
        entries.emplace_back(i, i, weight);
        entries.emplace_back(j, j, weight);
        entries.emplace_back(i, j, -weight);
        entries.emplace_back(j, i, -weight);
    }
    System system;
    const auto n = static_cast<Eigen::Index>(mass.size());
    system.stiffness.resize(n, n);
    system.stiffness.setFromTriplets(entries.begin(), entries.end());
    // Vertices without area (of degenerate faces only) get a very small mass.
    constexpr double least = 1e-9;
    system.mass.resize(n);
    for (Eigen::Index i = 0; i < n; ++i) system.mass[i] = std::max(mass[static_cast<std::size_t>(i)] / area, least);
    return system;
}

}  // namespace

std::vector<double> laplace_spectrum(const Mesh& mesh, int count) {
    if (count < 1) fail_usage("the number of eigenvalues is " + std::to_string(count), "ask for one or more");
    const std::vector<Face> part = largest_part(mesh);
    if (part.empty()) return {};
    const System system = system_of(mesh, part);
    const Eigen::Index n = system.mass.size(), wanted = count + 1;
    if (n < 4 * wanted) return {};
    // Shifted by one, which is below the eigenvalues of a surface of unit area, so that the constant is no longer in the null
    // space.
    Eigen::SparseMatrix<double> shifted = system.stiffness;
    for (Eigen::Index i = 0; i < n; ++i) shifted.coeffRef(i, i) += system.mass[i];
    const SparseLdlt solver(shifted);
    if (!solver.succeeded()) return {};
    // Per iteration, the errors of the eigenvalues decrease by the square of the ratio of the last requested eigenvalue to the
    // first one outside the subspace, which is near 1/2 (Weyl).
    constexpr int rounds = 20;
    Eigen::MatrixXd x(n, 2 * wanted);
    std::mt19937_64 random(1);
    for (Eigen::Index j = 0; j < x.cols(); ++j)
        for (Eigen::Index i = 0; i < n; ++i) x(i, j) = static_cast<double>(random() >> 11) * 0x1p-53 - 0.5;
    Eigen::VectorXd values;
    for (int round = 0; round < rounds; ++round) {
        check_cancelled();
        x = solver.solve(system.mass.asDiagonal() * x);
        const Eigen::MatrixXd inner = x.transpose() * (system.mass.asDiagonal() * x), outer = x.transpose() * (shifted * x);
        const SymmetricEigenX ritz = generalised_eigen(outer, inner);
        if (!ritz.succeeded()) return {};
        values = ritz.eigenvalues();
        x = (x * ritz.eigenvectors()).eval();
    }
    if (!values.allFinite()) return {};
    std::vector<double> result;
    for (Eigen::Index i = 1; i < wanted; ++i) result.push_back(std::max(0.0, values[i] - 1));
    return result;
}

}  // namespace ostraka

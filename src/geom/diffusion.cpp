#include "ostraka/geom/diffusion.h"

#include "geom/cotangent.h"

#include "ostraka/algebra/sparse.h"
#include "ostraka/core/error.h"
#include "ostraka/geom/eigen.h"

#include <cmath>

namespace ostraka {

struct Diffusion::System {
    std::vector<Eigen::Triplet<double>> laplacian;  ///< rows and columns among the free vertices
    Eigen::VectorXd mass;                           ///< of the free vertices
    std::vector<Eigen::Triplet<double>> to_fixed;   ///< row of a free vertex, fixed vertex, weight
    std::vector<Index> free;                        ///< the free vertices
    std::vector<int> row;                           ///< row of each vertex; -1 if it is fixed
    std::size_t vertices = 0;
};

Diffusion::Diffusion(const Mesh& mesh) : system_(std::make_unique<System>()) {
    System& s = *system_;
    s.vertices = mesh.number_of_vertices();
    s.row.assign(s.vertices, -1);
    std::vector<double> mass(s.vertices, 0);
    for (const Face face : mesh.faces()) {
        const double third = face_area(mesh, face) / 3;
        for (const Vertex v : corners(mesh, face)) mass[v] += third;
    }
    for (const Vertex v : mesh.vertices()) {
        if (mesh.is_isolated(v) || mesh.is_border(v) || !(mass[v] > 0)) continue;
        s.row[v] = static_cast<int>(s.free.size());
        s.free.push_back(v);
    }
    s.mass.resize(static_cast<Eigen::Index>(s.free.size()));
    for (std::size_t i = 0; i < s.free.size(); ++i) s.mass[static_cast<Eigen::Index>(i)] = mass[s.free[i]];
    for (const Edge edge : mesh.edges()) {
        const Halfedge h = mesh.halfedge(edge);
        const double weight = cotangent_weight(mesh, edge);
        const Vertex ends[2] = {mesh.source(h), mesh.target(h)};
        for (int k = 0; k < 2; ++k) {
            const int i = s.row[ends[k]], j = s.row[ends[1 - k]];
            if (i < 0) continue;
            s.laplacian.emplace_back(i, i, weight);
            if (j >= 0) s.laplacian.emplace_back(i, j, -weight);
            else s.to_fixed.emplace_back(i, static_cast<int>(ends[1 - k]), weight);
        }
    }
}

Diffusion::~Diffusion() = default;
Diffusion::Diffusion(Diffusion&&) noexcept = default;

Eigen::MatrixXd Diffusion::smoothed(const Eigen::MatrixXd& values, double sigma, int steps) const {
    const System& s = *system_;
    if (values.rows() != static_cast<Eigen::Index>(s.vertices))
        fail_usage(std::to_string(values.rows()) + " values for " + std::to_string(s.vertices) + " vertices",
                   "give one a vertex");
    if (!(sigma >= 0 && std::isfinite(sigma)) || steps < 1)
        fail_usage("surfaces are smoothed by a length that is not negative, in at least one step");
    if (sigma == 0 || s.free.empty()) return values;
    const auto count = static_cast<Eigen::Index>(s.free.size());
    const double time = sigma * sigma / 2 / steps;
    Eigen::SparseMatrix<double> a(count, count);
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(s.laplacian.size() + s.free.size());
    for (const auto& e : s.laplacian) entries.emplace_back(e.row(), e.col(), time * e.value());
    for (Eigen::Index i = 0; i < count; ++i) entries.emplace_back(static_cast<int>(i), static_cast<int>(i), s.mass[i]);
    a.setFromTriplets(entries.begin(), entries.end());
    const SparseLdlt solver(a);
    if (!solver.succeeded())
        throw Error(ErrorKind::failure, "mesh", "the surface cannot be smoothed", "repair it: are there faces without area?");
    Eigen::MatrixXd pull = Eigen::MatrixXd::Zero(count, values.cols()), x(count, values.cols());
    for (const auto& e : s.to_fixed) pull.row(e.row()) += time * e.value() * values.row(e.col());
    for (Eigen::Index i = 0; i < count; ++i)
        x.row(i) = values.row(static_cast<Eigen::Index>(s.free[static_cast<std::size_t>(i)]));
    for (int step = 0; step < steps; ++step) x = solver.solve(s.mass.asDiagonal() * x + pull);
    Eigen::MatrixXd result = values;
    for (Eigen::Index i = 0; i < count; ++i)
        result.row(static_cast<Eigen::Index>(s.free[static_cast<std::size_t>(i)])) = x.row(i);
    return result;
}

Eigen::MatrixXd positions(const Mesh& mesh) {
    Eigen::MatrixXd places(static_cast<Eigen::Index>(mesh.number_of_vertices()), 3);
    for (const Vertex v : mesh.vertices()) places.row(static_cast<Eigen::Index>(v.idx())) = eigen(mesh.point(v)).transpose();
    return places;
}

void set_positions(Mesh& mesh, const Eigen::MatrixXd& places) {
    for (const Vertex v : mesh.vertices()) mesh.point(v) = point_of(places.row(static_cast<Eigen::Index>(v.idx())).transpose());
}

}  // namespace ostraka

#include "level_system.h"

#include "ostraka/geom/eigen.h"

#include <algorithm>

namespace ostraka {

using Eigen::Vector3d;

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
            // Obtuse angles would make the displacement unstable; needles, the weights endless.
            rings.weight.push_back(std::clamp(weight, 0.05, 20.0));
            rings.sum[v] += rings.weight.back();
        }
    }
    rings.begin.push_back(rings.neighbour.size());
    return rings;
}

}  // namespace

LevelSystem::LevelSystem(const Mesh& of) : mesh(of) {
    rest = columns_of(mesh);
    rings = rings_of(mesh, rest);
    double sum = 0;
    for (const double area : rings.area) sum += area;
    mean_area = sum / static_cast<double>(std::max<std::size_t>(1, rings.area.size()));
}

std::vector<std::unique_ptr<Constraint>> LevelSystem::constraints() {
    std::vector<std::unique_ptr<Constraint>> list;
    match_.clear();
    stay_.clear();
    laplacian_.clear();
    for (const Vertex v : mesh.vertices()) {
        const int i = static_cast<int>(v.idx());
        ConstraintParameters here;
        here.target = rest.col(i);
        match_.push_back(list.size());
        list.push_back(make_constraint("Closeness", {i}, 0, here, rest));
        stay_.push_back(list.size());
        list.push_back(make_constraint("Closeness", {i}, 1, here, rest));
        laplacian_.push_back(no_constraint);
        if (mesh.is_isolated(v)) continue;
        std::vector<int> ids{i};
        ConstraintParameters ring;
        for (std::size_t k = rings.begin[v]; k < rings.begin[v + 1]; ++k) {
            ids.push_back(rings.neighbour[k]);
            ring.coefficients.push_back(rings.weight[k]);
        }
        laplacian_.back() = list.size();
        list.push_back(make_constraint("CotangentLaplacianDisplacement", std::move(ids), 1, ring, rest));
    }
    return list;
}

Solver& LevelSystem::renewed_solver() {
    // Where so many weights change the factors are made anew, and nothing is left of what they were; a small system is made
    // anew as a whole.
    constexpr std::size_t many = 2000;
    if (!solver_ || match_.size() < many) {
        solver_ = std::make_unique<MeshSpaceSolver>(constraints(), rest);
        return *solver_;
    }
    for (std::size_t c = 0; c < solver_->size(); ++c) solver_->set_weight(c, 0);
    return *solver_;
}

}  // namespace ostraka

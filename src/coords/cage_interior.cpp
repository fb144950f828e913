#include "coords/cage_interior.h"

#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"
#include "ostraka/geom/eigen.h"

#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Polyhedral_mesh_domain_with_features_3.h>
#include <CGAL/Random.h>
#include <CGAL/make_mesh_3.h>
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace ostraka::coords {

namespace {

using Domain = CGAL::Polyhedral_mesh_domain_with_features_3<Kernel, Mesh>;

/// A domain that checks for cancellation (watch) whenever the mesher queries it, which is at every step.
class WatchedDomain : public Domain {
public:
    using Domain::Domain;
    [[nodiscard]] Is_in_domain is_in_domain_object() const {
        check_();
        return Domain::is_in_domain_object();
    }
    [[nodiscard]] Do_intersect_surface do_intersect_surface_object() const {
        check_();
        return Domain::do_intersect_surface_object();
    }

private:
    mutable CancelCheck check_;
};

using Triangulation = CGAL::Mesh_triangulation_3<Domain>::type;
using Complex = CGAL::Mesh_complex_3_in_triangulation_3<Triangulation, Domain::Corner_index, Domain::Curve_index>;
using Criteria = CGAL::Mesh_criteria_3<Triangulation>;
using VertexHandle = Triangulation::Vertex_handle;
using CellHandle = Triangulation::Cell_handle;

Vector3d place_of(VertexHandle v) {
    const auto& p = v->point().point();
    return {p.x(), p.y(), p.z()};
}

/// Barycentric coordinates in a tetrahedron.
std::array<double, 4> weights_in(CellHandle cell, const Vector3d& p) {
    const Vector3d a = place_of(cell->vertex(0));
    Eigen::Matrix3d m;
    for (int k = 0; k < 3; ++k) m.col(k) = place_of(cell->vertex(k + 1)) - a;
    const Vector3d w = m.partialPivLu().solve(p - a);
    return {1 - w.sum(), w[0], w[1], w[2]};
}

/// A regular tetrahedron of edge s has the volume 0.118 s^3. There are about six tetrahedra per node, and those with bounded
/// circumradius are smaller.
constexpr double cell_volume = 6 * 0.118;
constexpr int attempts = 5;

}  // namespace

struct CageInterior::Mesher {
    Complex complex;
    std::unordered_map<VertexHandle, Index> number;
};

bool CageInterior::fill(const Mesh& cage, double size, Mesher& mesher) {
    namespace params = CGAL::parameters;
    const Criteria criteria(params::edge_size = size, params::facet_angle = 25, params::facet_size = size,
                            params::facet_distance = 0.1 * size, params::cell_radius_edge_ratio = 2.5, params::cell_size = size);
    CGAL::Random random(1);
    WatchedDomain domain(cage, &random);
    std::vector<std::vector<Point>> edges;
    for (const Edge e : cage.edges()) edges.push_back({cage.point(cage.vertex(e, 0)), cage.point(cage.vertex(e, 1))});
    domain.add_features(edges.begin(), edges.end());
    try {
        mesher.complex = CGAL::make_mesh_3<Complex>(domain, criteria, params::no_perturb(), params::no_exude());
    } catch (const CGAL::Failure_exception&) {
        return false;
    }
    return true;
}

UnitCage::UnitCage(const Mesh& cage) : mesh(cage) {
    const CGAL::Bbox_3 box = [&] {
        CGAL::Bbox_3 sum;
        for (const Vertex v : cage.vertices())
            if (!cage.is_isolated(v)) sum += cage.point(v).bbox();
        return sum;
    }();
    middle = Point(0.5 * box.xmin() + 0.5 * box.xmax(), 0.5 * box.ymin() + 0.5 * box.ymax(), 0.5 * box.zmin() + 0.5 * box.zmax());
    diagonal = std::hypot(box.xmax() - box.xmin(), box.ymax() - box.ymin(), box.zmax() - box.zmin());
    if (!(diagonal > 0) || !std::isfinite(diagonal)) fail_input("cage", "has no extent", "give a cage with a volume");
    for (const Vertex v : mesh.vertices()) mesh.point(v) = point_of(unit(cage.point(v)));
    for (const Vertex v : mesh.vertices()) corners.push_back(eigen(mesh.point(v)));
}

Vector3d UnitCage::unit(const Point& p) const {
    return {(p.x() - middle.x()) / diagonal, (p.y() - middle.y()) / diagonal, (p.z() - middle.z()) / diagonal};
}

CageInterior::CageInterior(const Mesh& cage, std::size_t nodes, const std::string& kind) : mesher_(std::make_unique<Mesher>()) {
    if (CGAL::Polygon_mesh_processing::does_self_intersect(cage))
        fail_input("cage", fmt::format("intersects itself, so that it has no interior for {} coordinates", kind),
                   "repair the cage ('ostraka cage check' names the faces), or use mean-value coordinates");
    const double volume = std::fabs(CGAL::Polygon_mesh_processing::volume(cage));
    if (!(volume > 1e-12))
        fail_input("cage", fmt::format("has almost no volume, so that it has no interior for {} coordinates", kind),
                   "use mean-value coordinates");
    const double size = std::cbrt(volume / (static_cast<double>(nodes) * cell_volume));
    // On very regular cages the mesher may fail an internal check; another cell size avoids that.
    for (int attempt = 0; !fill(cage, size * (1 - 0.07 * attempt), *mesher_); ++attempt)
        if (attempt == attempts)
            throw Error(ErrorKind::failure, "cage", fmt::format("could not be filled with tetrahedra for {} coordinates", kind),
                        "choose another number of nodes, or use mean-value coordinates");
    const Complex& complex = mesher_->complex;
    const SurfaceSearch search(cage);
    const auto number_of = [&](VertexHandle v) {
        const auto [entry, added] = mesher_->number.try_emplace(v, static_cast<Index>(nodes_.size()));
        if (!added) return entry->second;
        nodes_.push_back(place_of(v));
        on_cage_.emplace_back();
        if (v->in_dimension() < 3) on_cage_.back() = search.closest(point_of(nodes_.back()));
        return entry->second;
    };
    for (auto cell = complex.cells_in_complex_begin(); cell != complex.cells_in_complex_end(); ++cell) {
        std::array<Index, 4> corners{};
        for (int k = 0; k < 4; ++k) corners[static_cast<std::size_t>(k)] = number_of(cell->vertex(k));
        cells_.push_back(corners);
    }
    if (cells_.empty())
        fail_input("cage", fmt::format("could not be filled with tetrahedra for {} coordinates", kind),
                   "use mean-value coordinates");
}

CageInterior::~CageInterior() = default;

InteriorPlace CageInterior::locate(const Vector3d& p) const {
    const Complex& complex = mesher_->complex;
    const Triangulation& triangulation = complex.triangulation();
    CellHandle best = triangulation.locate(Triangulation::Weighted_point(point_of(p)));
    std::array<double, 4> weights{};
    if (!triangulation.is_infinite(best) && complex.is_in_complex(best)) {
        weights = weights_in(best, p);
    } else {
        // The point lies between the tetrahedra and the cage: take the best tetrahedron around the cell found.
        double maximum = -std::numeric_limits<double>::infinity();
        const CellHandle start = best;
        std::vector<CellHandle> incident_cells;
        for (int k = 0; k < 4; ++k)
            if (!triangulation.is_infinite(start->vertex(k)))
                triangulation.incident_cells(start->vertex(k), std::back_inserter(incident_cells));
        CellHandle candidate;
        for (const CellHandle cell : incident_cells) {
            if (triangulation.is_infinite(cell) || !complex.is_in_complex(cell)) continue;
            const std::array<double, 4> w = weights_in(cell, p);
            const double smallest_weight = *std::min_element(w.begin(), w.end());
            if (smallest_weight > maximum || (smallest_weight == maximum && w < weights))
                maximum = smallest_weight, candidate = cell, weights = w;
        }
        if (candidate == CellHandle()) {  // no tetrahedron near: take the nearest node
            const auto v = triangulation.nearest_power_vertex(Triangulation::Weighted_point(point_of(p)).point());
            const auto numbered_node = mesher_->number.find(v);
            const Index node = numbered_node == mesher_->number.end() ? 0 : numbered_node->second;
            return {{node, node, node, node}, {1, 0, 0, 0}};
        }
        best = candidate;
    }
    InteriorPlace place;
    double sum = 0;
    for (std::size_t k = 0; k < 4; ++k) {
        place.nodes[k] = mesher_->number.at(best->vertex(static_cast<int>(k)));
        sum += place.weights[k] = std::max(weights[k], 0.0);
    }
    for (double& weight : place.weights) weight /= sum;
    return place;
}

}  // namespace ostraka::coords

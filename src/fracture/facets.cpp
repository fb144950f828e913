#include "ostraka/fracture/facets.h"

#include "facet_evidence.h"
#include "ostraka/axis/axis.h"
#include "ostraka/core/angles.h"
#include "ostraka/core/dense.h"
#include "ostraka/core/error.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/submesh.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

using Eigen::Vector3d;

namespace {

/// 0 below `low`, 1 above `high`, straight between.
double ramp(double x, double low, double high) { return std::clamp((x - low) / (high - low), 0.0, 1.0); }

double weighted_median(std::vector<std::pair<double, double>> values) {
    std::sort(values.begin(), values.end());
    double half = 0;
    for (const auto& [value, weight] : values) half += weight / 2;
    for (const auto& [value, weight] : values)
        if ((half -= weight) <= 0) return value;
    return 0;
}

class Finder {
public:
    Finder(const Mesh& mesh, const FacetOptions& options) : mesh_(mesh), options_(options), areas_(mesh.number_of_faces()) {
        for (const Face face : mesh.faces()) total_ += areas_[face] = face_area(mesh, face);
        if (!(total_ > 0)) fail_input("fragment", "has no area whose facets could be told", "look at its faces");
        size_ = std::sqrt(total_);
        double border = 0;
        for (const Edge e : mesh.edges())
            if (mesh.is_border(e))
                border += std::sqrt(CGAL::squared_distance(mesh.point(mesh.vertex(e, 0)), mesh.point(mesh.vertex(e, 1))));
        closed_ = border < 0.05 * size_;  // a pinhole lets few rays out
        normals_ = filtered_normals(mesh, 0.02 * size_);
        turns_ = turns(mesh, normals_);
    }

    Facets run() {
        // Some faces tell whether there is a wall.
        constexpr std::size_t enough = 2000;
        const std::size_t step = areas_.size() / enough + 1;
        if (closed_ && is_shell(walls_under(mesh_, normals_, step), step)) {
            walls_ = walls_under(mesh_, normals_);
            is_shell(walls_, 1);
            shell();
        } else {
            if (!closed_) result_.notes.emplace_back("the mesh is open: walls are not looked for");
            solid();
        }
        finish();
        return std::move(result_);
    }

private:
    /// More than half of the area lies over a thin wall; its thickness is the median.
    bool is_shell(const Walls& walls, std::size_t step) {
        std::vector<std::pair<double, double>> depths;
        double thin = 0, all = 0;
        for (std::size_t f = 0; f < areas_.size(); f += step) {
            all += areas_[f];
            if (!(walls.opposite[f] > 0.7 && walls.depth[f] < options_.wall * size_)) continue;
            thin += areas_[f];
            depths.emplace_back(walls.depth[f], areas_[f]);
        }
        if (!(thin > 0.5 * all)) return false;
        result_.shell = true;
        result_.thickness = weighted_median(depths);
        return true;
    }

    /// How far a face lies over a wall of the usual thickness, 0 to 1.
    [[nodiscard]] double over_wall(std::size_t f) const {
        return ramp(walls_.opposite[f], 0.3, 0.8) * (1 - ramp(walls_.depth[f] / result_.thickness, 1.6, 2.6));
    }

    /// Cost of a boundary along each edge: its length, less where the surface turns sharply outward.
    [[nodiscard]] std::vector<double> boundary(double width) const {
        std::vector<double> costs(mesh_.number_of_edges());
        for (const Edge e : mesh_.edges()) {
            const double turn = std::max(0.0, turns_[e]) / (options_.edge * degree);
            const double length =
                std::sqrt(CGAL::squared_distance(mesh_.point(mesh_.vertex(e, 0)), mesh_.point(mesh_.vertex(e, 1))));
            costs[e] = options_.coherence * width * length * (0.03 + std::exp(-turn * turn));
        }
        return costs;
    }

    void shell() {
        const std::size_t n = areas_.size();
        std::vector<double> wall(n);
        std::vector<Index> sides;
        for (std::size_t f = 0; f < n; ++f) {
            wall[f] = over_wall(f);
            if (wall[f] > 0.7) sides.push_back(static_cast<Index>(f));
        }
        const std::vector<double> outward = outwardness(sides);
        std::vector<std::vector<double>> costs(3, std::vector<double>(n));
        for (std::size_t f = 0; f < n; ++f) {
            const double o = ramp(outward[f], -0.3, 0.3);
            costs[0][f] = areas_[f] * ((1 - wall[f]) + 0.5 * (1 - o));
            costs[1][f] = areas_[f] * ((1 - wall[f]) + 0.5 * o);
            costs[2][f] = areas_[f] * (wall[f] + 0.25);
        }
        labels_ = min_labels(mesh_, costs, boundary(result_.thickness));
        shown_.resize(n);
        for (std::size_t f = 0; f < n; ++f) {
            const double o = ramp(outward[f], -0.3, 0.3);
            shown_[f] = labels_[f] == 0 ? std::min(wall[f], o) : labels_[f] == 1 ? std::min(wall[f], 1 - o) : 1 - wall[f];
        }
    }

    /// Cosine of the angle between each normal and the direction away from the object's axis or middle.
    std::vector<double> outwardness(const std::vector<Index>& sides) {
        std::vector<double> result(areas_.size(), 0);
        if (sides.empty()) return result;
        AxisOptions how;
        how.tolerance = 0.03;
        how.min_quality = 0.5;
        const Axis axis = find_axis(mesh_, sides, how);
        if (axis.found) {
            result_.notes.emplace_back("outer and inner are told by an axis of rotation");
            const Vector3d place = eigen(axis.point), along = eigen(axis.direction);
            for (const Face face : mesh_.faces()) {
                Vector3d away = eigen(centroid(mesh_, face)) - place;
                away -= along.dot(away) * along;
                if (away.norm() > 0) result[face] = away.normalized().dot(eigen(normals_[face]));
            }
            return result;
        }
        // The point nearest to all lines along normals; held to the centroid where they do not say.
        Vector3d middle = Vector3d::Zero();
        double area = 0;
        for (const Index f : sides) {
            middle += areas_[f] * eigen(centroid(mesh_, Face(f)));
            area += areas_[f];
        }
        middle /= area;
        Eigen::Matrix3d matrix = 1e-4 * area * Eigen::Matrix3d::Identity();
        Vector3d right = Vector3d::Zero();
        for (const Index f : sides) {
            const Vector3d normal = eigen(normals_[f]);
            const Eigen::Matrix3d across = areas_[f] * (Eigen::Matrix3d::Identity() - normal * normal.transpose());
            matrix += across;
            right += across * (eigen(centroid(mesh_, Face(f))) - middle);
        }
        const Vector3d focus = middle + solve_ldlt<3>(matrix, right);
        result_.notes.emplace_back("outer and inner are told by where normals meet: there is no axis of rotation");
        for (const Face face : mesh_.faces()) {
            const Vector3d away = eigen(centroid(mesh_, face)) - focus;
            if (away.norm() > 0) result[face] = away.normalized().dot(eigen(normals_[face]));
        }
        return result;
    }

    void solid() {
        const std::vector<std::size_t> part = convex_parts(mesh_, areas_, turns_, options_.edge * degree);
        std::size_t count = 0;
        for (const std::size_t p : part) count = std::max(count, p + 1);
        std::vector<std::vector<Index>> faces(count);
        std::vector<double> area(count, 0);
        for (std::size_t f = 0; f < part.size(); ++f) {
            faces[part[f]].push_back(static_cast<Index>(f));
            area[part[f]] += areas_[f];
        }
        const auto largest = static_cast<std::size_t>(std::max_element(area.begin(), area.end()) - area.begin());
        labels_.assign(areas_.size(), 0);
        shown_.assign(areas_.size(), 0.5);
        constexpr double minimum = 0.003;  // of the area: less tells nothing
        for (std::size_t p = 0; p < count; ++p) {
            if (p == largest || area[p] < minimum * total_) continue;
            const double rough = unevenness(faces[p], area[p]);
            const bool broken = rough > options_.rough;
            for (const Index f : faces[p]) {
                labels_[f] = broken ? 2 : 0;
                shown_[f] = options_.rough > 0
                                ? std::clamp(0.5 + 0.5 * std::log2(rough / options_.rough) * (broken ? 1 : -1), 0.0, 1.0)
                                : 1;
            }
        }
    }

    /// Root mean square distance from the quadric over the mean plane, as a share of the square root of the area; 0 for what
    /// does not lie over a plane.
    [[nodiscard]] double unevenness(const std::vector<Index>& faces, double area) const {
        Vector3d normal = Vector3d::Zero(), middle = Vector3d::Zero();
        for (const Index f : faces) {
            normal += areas_[f] * eigen(normals_[f]);
            middle += areas_[f] / area * eigen(centroid(mesh_, Face(f)));
        }
        if (normal.norm() < 0.6 * area) return 0;
        normal.normalize();
        const Vector3d u = normal.unitOrthogonal(), w = normal.cross(u);
        using Row = Eigen::Matrix<double, 6, 1>;
        Eigen::Matrix<double, 6, 6> matrix = Eigen::Matrix<double, 6, 6>::Zero();
        Row right = Row::Zero();
        double square = 0;
        for (const Index f : faces) {
            const Vector3d d = (eigen(centroid(mesh_, Face(f))) - middle) / std::sqrt(area);
            const double x = u.dot(d), y = w.dot(d), z = normal.dot(d);
            Row row;
            row << 1, x, y, x * x, x * y, y * y;
            matrix += areas_[f] / area * row * row.transpose();
            right += areas_[f] / area * z * row;
            square += areas_[f] / area * z * z;
        }
        matrix.diagonal().array() += 1e-9;
        return std::sqrt(std::max(0.0, square - right.dot(solve_ldlt<6>(matrix, right))));
    }

    void finish() {
        const FacePieces pieces = face_pieces(
            mesh_, [](Face) { return true; },
            [&](Halfedge h) { return labels_[mesh_.face(h)] == labels_[mesh_.face(mesh_.opposite(h))]; });
        result_.segments.resize(pieces.count);
        for (std::size_t f = 0; f < labels_.size(); ++f) {
            FacetSegment& segment = result_.segments[pieces.of_face[f]];
            segment.facet = static_cast<Facet>(labels_[f]);
            segment.faces.push_back(static_cast<Index>(f));
            segment.area += areas_[f];
            segment.confidence += areas_[f] * shown_[f];
            result_.of_face.push_back(segment.facet);
            result_.confidence += areas_[f] * shown_[f] / total_;
        }
        for (FacetSegment& segment : result_.segments) segment.confidence /= segment.area > 0 ? segment.area : 1;
        std::stable_sort(result_.segments.begin(), result_.segments.end(),
                         [](const FacetSegment& a, const FacetSegment& b) { return a.area > b.area; });
    }

    const Mesh& mesh_;
    const FacetOptions& options_;
    std::vector<double> areas_;
    double total_ = 0, size_ = 0;
    bool closed_ = false;
    std::vector<Vector> normals_;
    std::vector<double> turns_;
    Walls walls_;
    std::vector<std::size_t> labels_;  ///< of each face: a Facet
    std::vector<double> shown_;        ///< how far each face shows its label by itself
    Facets result_;
};

}  // namespace

double Facets::area(Facet facet) const {
    double sum = 0;
    for (const FacetSegment& segment : segments)
        if (segment.facet == facet) sum += segment.area;
    return sum;
}

Facets find_facets(const Mesh& mesh, const FacetOptions& options) {
    check_options(options, "facets");
    return Finder(mesh, options).run();
}

void FacetOptions::describe(OptionList& visit) {
    visit("facet-edge", edge, "turn of the surface over an edge where a break may begin", Range{5, 120}, "degrees");
    visit("facet-wall", wall, "walls are thinner than this share of the square root of the area", Range{0.01, 1});
    visit("facet-coherence", coherence, "weight of neighbours against what a face shows by itself", Range{0, 100});
    visit("facet-rough", rough, "solids: a break deviates from a smooth surface by more than this share of its size",
          Range{0, 1});
}

}  // namespace ostraka

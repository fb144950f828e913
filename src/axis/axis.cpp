// Moments, principal axes, circles, and the selection of the method.
#include "ostraka/axis/axis.h"

#include "axis/axis_methods.h"

#include "ostraka/algebra/dense.h"
#include "ostraka/core/error.h"

#include <cstdio>

namespace ostraka {

using namespace detail;

const AxisFigure* Axis::figure(const std::string& name) const {
    for (const auto& entry : figures)
        if (entry.name == name) return &entry;
    return nullptr;
}

namespace detail {

AreaMoments part_moments(const Mesh& mesh, const std::vector<Index>& faces, const AxisOptions& options) {
    check_options(options, "axis");
    const AreaMoments moments = area_moments(mesh, faces);
    if (!(moments.area > 0)) fail_input("part", "has no faces with area", "choose another part");
    return moments;
}

double part_diagonal(const Mesh& mesh, const std::vector<Index>& faces) {
    CGAL::Bbox_3 box;
    for (const Index f : faces)
        for (const Vertex v : corners(mesh, Face(f))) box += mesh.point(v).bbox();
    return std::hypot(box.xmax() - box.xmin(), box.ymax() - box.ymin(), box.zmax() - box.zmin());
}

std::pair<double, double> extent_along(const Mesh& mesh, const std::vector<Index>& faces, const Vector3d& place,
                                       const Vector3d& direction) {
    double minimum = 0, maximum = 0;
    for (const Index f : faces)
        for (const Vertex v : corners(mesh, Face(f))) {
            const double h = direction.dot(eigen(mesh.point(v)) - place);
            minimum = std::min(minimum, h), maximum = std::max(maximum, h);
        }
    return {minimum, maximum};
}

void set_line(Axis& axis, const Vector3d& point, const Vector3d& direction, const Vector3d& centre) {
    const Vector3d a = oriented(direction.normalized());
    axis.direction = vector_of(a);
    axis.point = point_of(point + a.dot(centre - point) * a);
}

}  // namespace detail

AreaMoments area_moments(const Mesh& mesh, const std::vector<Index>& faces) {
    AreaMoments moments;
    if (faces.empty()) return moments;
    const Vector3d origin = eigen(mesh.point(corners(mesh, Face(faces.front()))[0]));
    Vector3d first = Vector3d::Zero();
    Matrix3d second = Matrix3d::Zero();
    for (const Index f : faces) {
        const double area = face_area(mesh, Face(f));
        Vector3d sum = Vector3d::Zero();
        Matrix3d squares = Matrix3d::Zero();
        for (const Vertex v : corners(mesh, Face(f))) {
            const Vector3d p = eigen(mesh.point(v)) - origin;
            sum += p;
            squares += p * p.transpose();
        }
        // Integral of p p^T over a triangle: area / 12 (sum of p_i p_i^T + s s^T), s the sum of the corners.
        moments.area += area;
        first += area / 3 * sum;
        second += area / 12 * (squares + sum * sum.transpose());
    }
    if (!(moments.area > 0)) return moments;
    const Vector3d mean = first / moments.area;
    const SymmetricEigen3 solver(second / moments.area - mean * mean.transpose());
    moments.centroid = point_of(origin + mean);
    for (int k = 0; k < 3; ++k) {
        moments.variances.at(static_cast<std::size_t>(k)) = std::max(0.0, solver.eigenvalues()[2 - k]);
        moments.directions.at(static_cast<std::size_t>(k)) = vector_of(oriented(solver.eigenvectors().col(2 - k)));
    }
    moments.directions[2] = CGAL::cross_product(moments.directions[0], moments.directions[1]);
    return moments;
}

Axis principal_axis(const Mesh& mesh, const std::vector<Index>& faces, const AxisOptions& options) {
    const AreaMoments moments = part_moments(mesh, faces, options);
    Axis axis;
    const Vector3d centre = eigen(moments.centroid);
    for (std::size_t k = 0; k < 3; ++k) {
        const Vector3d d = eigen(moments.directions[k]);
        const auto [minimum, maximum] = extent_along(mesh, faces, centre, d);
        axis.lines.push_back({point_of(centre + minimum * d), point_of(centre + maximum * d)});
        axis.figures.push_back({"extent " + std::to_string(k + 1), maximum - minimum, "length"});
    }
    set_line(axis, centre, eigen(moments.directions[0]), centre);
    axis.quality = moments.variances[0] > 0 ? 1 - moments.variances[1] / moments.variances[0] : 0;
    axis.found = axis.quality > 0.1;
    if (!axis.found) axis.reason = "it is as wide as it is long: the first two principal variances are nearly equal";
    return axis;
}

Axis circle_axis(const std::vector<Point>& points) {
    Axis axis;
    if (points.size() < 3) {
        axis.reason = "a circle needs at least three points";
        return axis;
    }
    Vector3d mean = Vector3d::Zero();
    for (const auto& p : points) mean += eigen(p) - eigen(points[0]);
    mean = eigen(points[0]) + mean / double(points.size());
    Matrix3d covariance = Matrix3d::Zero();
    for (const auto& p : points) covariance += (eigen(p) - mean) * (eigen(p) - mean).transpose() / double(points.size());
    const SymmetricEigen3 solver(covariance);
    const Vector3d a = oriented(solver.eigenvectors().col(0)), u = solver.eigenvectors().col(2), w = a.cross(u);
    std::vector<Eigen::Vector2d> planar_points;
    for (const auto& p : points) planar_points.emplace_back(u.dot(eigen(p) - mean), w.dot(eigen(p) - mean));
    const ArcFit fit = fit_arc(planar_points);
    const Circle& circle = fit.circle;
    if (circle.radius < 0) {
        axis.reason = "its vertices are collinear";
        return axis;
    }
    double sum = 0;
    for (std::size_t i = 0; i < planar_points.size(); ++i) {
        const Eigen::Vector2d q = planar_points[i] - circle.centre;
        const double offset = a.dot(eigen(points[i]) - mean);
        sum += std::pow(q.norm() - circle.radius, 2) + offset * offset;
    }
    const double rms = std::sqrt(sum / double(planar_points.size()));
    const Vector3d centre = mean + circle.centre.x() * u + circle.centre.y() * w;
    set_line(axis, centre, a, centre);
    axis.quality = std::max(0.0, 1 - rms / circle.radius);
    axis.found = true;
    axis.lines = {{point_of(centre - circle.radius * a), point_of(centre + circle.radius * a)}};
    axis.figures = {{"diameter", 2 * circle.radius, "length"},
                    {"circle preserved", 100 * fit.angle / (2 * pi), "%"},
                    {"rms distance", rms, "length"},
                    {"diameter at least", 2 * fit.radius_low, "length"}};
    // No upper bound if a straight line fits too.
    if (std::isfinite(fit.radius_high)) axis.figures.push_back({"diameter at most", 2 * fit.radius_high, "length"});
    return axis;
}

Axis find_axis(const Mesh& mesh, const std::vector<Index>& faces, const AxisOptions& options) {
    check_options(options, "axis");
    if (options.method == AxisMethod::slices) return slice_axis(mesh, faces, options);
    if (options.method == AxisMethod::skeleton) return skeleton_axis(mesh, faces, options);
    if (options.method == AxisMethod::principal) return principal_axis(mesh, faces, options);
    return rotation_axis(mesh, faces, options);
}

std::string to_string(AxisMethod method) { return option_text(AxisOptions{.method = method}, "method"); }

std::string to_obj(const Axis& axis) {
    std::string text = "# axis\n";
    char buffer[128];
    std::size_t next = 1;
    for (const auto& line : axis.lines) {
        std::string element = "l";
        for (const auto& p : line) {
            std::snprintf(buffer, sizeof buffer, "v %.17g %.17g %.17g\n", p.x(), p.y(), p.z());
            text += buffer;
            element += " " + std::to_string(next++);
        }
        text += element + "\n";
    }
    return text;
}

void AxisOptions::declare_options(OptionList& list) {
    list("method", method, "method by which the axis is computed", Choices{"rotation", "slices", "skeleton", "principal"});
    list("tolerance", tolerance, "rotation: maximum distance at which a point counts as lying on the surface of revolution",
         Range{0, 1}, "share of its largest diameter");
    list("min-quality", min_quality, "rotation: minimum share of the area that lies on the surface of revolution", Range{0, 1});
    list("slices", slices, "slices: number of planes that slice the part", Range{4, 10000});
    list("trials", trials, "rotation: number of random sets of normals from which an axis is computed (RANSAC)",
         Range{0, 1000000});
    list("smoothing", smoothing, "rotation: number of rounds in which each normal is averaged with its neighbours",
         Range{0, 100});
    list("seed", seed, "rotation: random seed");
}

}  // namespace ostraka

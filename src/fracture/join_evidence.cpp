#include "ostraka/fracture/join_evidence.h"

#include "fracture/prepared_fracture.h"
#include "ostraka/algebra/dense.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/stats/summary.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

constexpr double could_touch = 3;  // in tolerances

/// Contact measured from one side: the samples of `from`, moved by `pose`, on the fracture of `on`.
struct Contact {
    std::vector<Vector3d> places, normals;
    double area = 0, could = 0, square = 0, facing = 0;
};

Contact contact(const PreparedFracture::Parts& on, const PreparedFracture::Parts& from, const Motion& pose, double tolerance,
                std::size_t max_samples) {
    Contact result;
    const SurfaceSamples& samples = from.side.fracture;
    const std::size_t count = std::min(max_samples, samples.places.size());
    const double each = samples.area / static_cast<double>(count);
    for (std::size_t s = 0; s < count; ++s) {
        const std::size_t i = (2 * s + 1) * samples.places.size() / (2 * count);
        const Vector3d p = pose(samples.places[i]);
        const PointTree::Near nearest = on.fracture.nearest(point_of(p), could_touch * tolerance);
        if (nearest.index == no_index) continue;
        result.could += each;
        const Vector3d& normal = on.side.fracture.normals[nearest.index];
        const double facing = -normal.dot(pose.rotation * samples.normals[i]);
        if (nearest.squared > tolerance * tolerance || facing < min_facing) continue;
        const double distance = normal.dot(p - on.side.fracture.places[nearest.index]);
        result.area += each;
        result.square += each * distance * distance;
        result.facing += each * facing;
        result.places.push_back(p);
        result.normals.push_back(normal);
    }
    return result;
}

/// Area of `from` that lies deeper inside `on` than the tolerance.
void penetrate(const PreparedFracture::Parts& on, const PreparedFracture::Parts& from, const Motion& pose, double tolerance,
               std::size_t max_samples, double& area, double& depth) {
    const auto add_samples = [&](const SurfaceSamples& samples) {
        const std::size_t count = std::min<std::size_t>({600, max_samples / 3, samples.places.size()});
        const double each = count > 0 ? samples.area / static_cast<double>(count) : 0;
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t k = (2 * i + 1) * samples.places.size() / (2 * count);
            const Vector3d p = pose(samples.places[k]);
            const Index cell = on.grid->near(p);
            // Outside the box, or clearly above the nearest sample.
            if (cell == no_index) continue;
            const Vector3d away = p - on.places[cell];
            if (on.normals[cell].dot(away) > 0.5 * away.norm() && away.norm() > 2 * tolerance) continue;
            const SurfaceHit hit = on.surface->closest(point_of(p));
            if (hit.face == no_index || hit.distance < tolerance) continue;
            if (eigen(on.surface->normal(hit.face)).dot(p - eigen(hit.point)) > -0.3 * hit.distance ||
                !on.surface->inside(point_of(p)))
                continue;
            area += each;
            depth = std::max(depth, hit.distance);
        }
    };
    add_samples(from.side.fracture);
    add_samples(from.side.intact);
}

}  // namespace

std::pair<double, double> deviations(const std::vector<Vector3d>& places) {
    if (places.size() < 10) return {0, 0};
    Vector3d middle = Vector3d::Zero();
    for (const Vector3d& p : places) middle += p / static_cast<double>(places.size());
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const Vector3d& p : places) spread += (p - middle) * (p - middle).transpose() / static_cast<double>(places.size());
    const SymmetricEigen3 axes(spread);
    const double plane = std::sqrt(std::max(0.0, axes.eigenvalues()[0])),
                 unit = std::sqrt(std::max(1e-300, axes.eigenvalues()[2]));
    using Row = Eigen::Matrix<double, 6, 1>;
    Eigen::Matrix<double, 6, 6> matrix = 1e-6 * Eigen::Matrix<double, 6, 6>::Identity();
    Row right = Row::Zero();
    double square = 0;
    for (const Vector3d& p : places) {
        const Vector3d d = axes.eigenvectors().transpose() * (p - middle) / unit;
        Row row;
        row << 1, d[1], d[2], d[1] * d[1], d[1] * d[2], d[2] * d[2];
        matrix += row * row.transpose() / static_cast<double>(places.size());
        right += d[0] * row / static_cast<double>(places.size());
        square += d[0] * d[0] / static_cast<double>(places.size());
    }
    const double rest = square - right.dot(solve_ldlt<6>(matrix, right));
    return {plane, unit * std::sqrt(std::max(0.0, rest))};
}

double surface_noise(const SurfaceSamples& intact) {
    const std::size_t n = intact.places.size();
    if (n < 10) return 0;
    const PointTree tree(points_of(intact.places));
    const double radius = 3 * std::sqrt(intact.area / static_cast<double>(n));
    constexpr std::size_t max_places = 200;
    std::vector<double> residuals;
    for (std::size_t k = 0; k < std::min(n, max_places); ++k) {
        const std::size_t i = (2 * k + 1) * n / (2 * std::min(n, max_places));
        std::vector<Index> neighbours;
        tree.within(point_of(intact.places[i]), radius, neighbours);
        std::vector<Vector3d> places;
        for (const Index j : neighbours)
            if (intact.normals[j].dot(intact.normals[i]) > 0.7) places.push_back(intact.places[j]);
        if (places.size() >= 12) residuals.push_back(deviations(places).second);
    }
    return residuals.empty() ? 0 : upper_median(std::move(residuals));
}

double common_axis_deviation(const PreparedFracture::Parts& a, const PreparedFracture::Parts& b, const Motion& pose) {
    Motion about_middles = pose;
    about_middles.translation = pose(b.middle) - a.middle;
    LineComplex joint_lines = b.lines.moved(about_middles);
    joint_lines.add(a.lines);
    const double both = joint_lines.off_axis(), alone = (a.off_axis * a.off_axis + b.off_axis * b.off_axis) / 2;
    return std::sqrt(std::max(0.0, both * both - alone));
}

JoinEvidence measure_join(const PreparedFracture& first, const PreparedFracture& second, const Motion& pose, double tolerance,
                          std::size_t samples) {
    const PreparedFracture::Parts &a = first.parts(), &b = second.parts();
    JoinEvidence evidence;
    const Motion back = pose.inverse();
    const Contact on_a = contact(a, b, pose, tolerance, samples), on_b = contact(b, a, back, tolerance, samples);
    const double area = 0.5 * (on_a.area + on_b.area), both = on_a.area + on_b.area,
                 smaller = std::min(a.side.fracture.area, b.side.fracture.area);
    evidence.area = area / (tolerance * tolerance);
    evidence.share = area / smaller;
    evidence.coverage = both / std::max(1e-300, on_a.could + on_b.could);
    if (both > 0) {
        evidence.residual = std::sqrt((on_a.square + on_b.square) / both) / tolerance;
        evidence.facing = (on_a.facing + on_b.facing) / both;
    }
    const auto [plane, quadric] = deviations(on_a.places);
    evidence.bending = plane / tolerance;
    evidence.relief = quadric / tolerance;

    std::vector<Vector3d> places = on_a.places, normals = on_a.normals;
    double could = 0, square = 0, turns = 0, steps = 0, side_count = 0;
    const double each = b.side.frames.empty() ? 0 : b.side.rim_length / static_cast<double>(b.side.frames.size());
    for (const RimFrame& frame : b.side.frames) {
        const Vector3d p = pose(frame.place);
        const PointTree::Near nearest = a.frames.nearest(point_of(p), could_touch * tolerance);
        if (nearest.index == no_index) continue;
        could += each;
        const RimFrame& other = a.side.frames[nearest.index];
        if (other.facet != frame.facet || other.fracture.dot(pose.rotation * frame.fracture) > -min_facing) continue;
        const Vector3d side = pose.rotation * frame.side, across = pose(frame.beside) - other.beside;
        const double cosine = other.side.dot(side), apart = across.norm();
        // Sides that face each other, or are perpendicular, do not continue each other.
        turns += cosine > 0 ? 1 - cosine * cosine : 1;
        steps += cosine > 0 && apart > 0 ? std::pow(0.5 * (side + other.side).dot(across) / apart, 2) : 1;
        ++side_count;
        if (cosine < continued) continue;
        const double step = other.side.dot(p - other.place);
        if (std::abs(step) > tolerance) continue;
        evidence.rim += each;
        square += each * step * step;
        places.push_back(p);
        normals.push_back(other.side);
    }
    if (side_count > 0) {
        evidence.side_turn = std::sqrt(turns / side_count);
        evidence.side_step = std::sqrt(steps / side_count);
        evidence.side_length = side_count * each / tolerance;
    }
    const double shorter = std::min(a.side.rim_length, b.side.rim_length);
    evidence.rim_coverage = could > 0 ? evidence.rim / could : 0;
    evidence.rim_step = evidence.rim > 0 ? std::sqrt(square / evidence.rim) / tolerance : 1;
    evidence.rim_share = evidence.rim / shorter;
    evidence.rim /= tolerance;

    if (places.size() >= 6) {
        Vector3d middle = Vector3d::Zero();
        for (const Vector3d& p : places) middle += p / static_cast<double>(places.size());
        double unit = 0;
        for (const Vector3d& p : places) unit += (p - middle).squaredNorm() / static_cast<double>(places.size());
        unit = std::sqrt(std::max(1e-300, unit));
        Eigen::MatrixXd system = Eigen::MatrixXd::Zero(6, 6);
        for (std::size_t i = 0; i < places.size(); ++i) {
            Eigen::VectorXd row(6);
            row << ((places[i] - middle) / unit).cross(normals[i]), normals[i];
            system += row * row.transpose();
        }
        evidence.stability = std::max(0.0, SymmetricEigenX(system).eigenvalues()[0]) / std::max(1e-300, system.trace() / 6);
    }
    double inside = 0, depth = 0;
    penetrate(a, b, pose, tolerance, samples, inside, depth);
    penetrate(b, a, back, tolerance, samples, inside, depth);
    evidence.penetration = inside / std::max(area, 0.01 * smaller);
    evidence.depth = depth / tolerance;
    evidence.width_log_ratio = std::abs(std::log(a.width / b.width));
    evidence.noise = std::hypot(a.noise, b.noise) / tolerance;
    evidence.edge = std::max(a.edge, b.edge) / tolerance;
    evidence.roughness = std::min(a.relief, b.relief) / tolerance;
    evidence.axis = common_axis_deviation(a, b, pose) / std::min(a.size, b.size);
    evidence.own_axis = std::hypot(a.off_axis, b.off_axis) / std::min(a.size, b.size);
    return evidence;
}

std::vector<ContactPoint> contact_points(const PreparedFracture& first, const PreparedFracture& second, const Motion& pose,
                                         double search_radius, std::size_t samples) {
    const PreparedFracture::Parts &a = first.parts(), &b = second.parts();
    std::vector<ContactPoint> result;
    const SurfaceSamples& from = b.side.fracture;
    const std::size_t count = std::min(samples, from.places.size());
    double fracture_weight = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t k = (2 * i + 1) * from.places.size() / (2 * count);
        const PointTree::Near nearest = a.fracture.nearest(point_of(pose(from.places[k])), search_radius);
        if (nearest.index == no_index) continue;
        const Vector3d& normal = a.side.fracture.normals[nearest.index];
        if (-normal.dot(pose.rotation * from.normals[k]) < min_facing) continue;
        const double ratio = nearest.squared / (search_radius * search_radius);
        result.push_back({a.side.fracture.places[nearest.index], normal, from.places[k], (1 - ratio) * (1 - ratio)});
        fracture_weight += result.back().weight;
    }
    const std::size_t fractures = result.size();
    double rim = 0;
    for (const RimFrame& frame : b.side.frames) {
        const PointTree::Near nearest = a.frames.nearest(point_of(pose(frame.place)), search_radius);
        if (nearest.index == no_index) continue;
        const RimFrame& other = a.side.frames[nearest.index];
        if (other.facet != frame.facet || other.side.dot(pose.rotation * frame.side) < continued ||
            other.fracture.dot(pose.rotation * frame.fracture) > -min_facing)
            continue;
        const double ratio = nearest.squared / (search_radius * search_radius), weight = (1 - ratio) * (1 - ratio);
        result.push_back({other.place, other.side, frame.place, weight});
        result.push_back({other.place, other.fracture, frame.place, weight});
        rim += 2 * weight;
    }
    // The rims get the same total weight as the fractures.
    if (rim > 0 && fracture_weight > 0)
        for (std::size_t k = fractures; k < result.size(); ++k) result[k].weight *= fracture_weight / rim;
    return result;
}

std::array<double, JoinEvidence::count> JoinEvidence::features() const {
    const auto logarithm = [](double x, double low, double high) { return std::log(std::clamp(x, low, high)); };
    return {logarithm(area, 1, 1e4) - 4,
            4 * share,
            4 * coverage,
            -3 * residual,
            logarithm(relief / std::max(residual, 0.02), 0.1, 30),
            logarithm(bending / std::max(residual, 0.02), 0.1, 100) - 1,
            logarithm(stability, 1e-4, 1) / 2 + 2,
            10 * (facing - 0.9),
            logarithm(rim, 0.5, 500) - 3,
            4 * rim_share,
            4 * rim_coverage,
            -3 * rim_step,
            -logarithm(0.01 + penetration, 0.01, 10) - 2,
            -logarithm(1 + depth, 1, 100),
            -3 * std::min(width_log_ratio, 1.5),
            -5 * side_turn,
            -5 * side_step,
            logarithm(side_length, 0.5, 500) - 3,
            logarithm(noise, 0.003, 3) + 3,
            logarithm(edge, 0.1, 20),
            logarithm(roughness, 0.1, 30),
            -logarithm(std::max(residual, 0.02) / std::hypot(0.1, noise, 0.1 * edge), 0.1, 10),
            -logarithm(0.003 + axis, 0.003, 1) - 4,
            -logarithm(0.003 + own_axis, 0.003, 1) - 3};
}

const std::array<std::string, JoinEvidence::count>& JoinEvidence::names() {
    static const std::array<std::string, count> names{"area in contact",
                                                      "share of the smaller fracture in contact",
                                                      "contact where contact is possible",
                                                      "close contact",
                                                      "matching relief",
                                                      "matching shape",
                                                      "firmly constrained pose",
                                                      "facing normals",
                                                      "length of common rim",
                                                      "share of the shorter rim",
                                                      "rim continued where possible",
                                                      "sides without a step",
                                                      "no penetration",
                                                      "no depth of penetration",
                                                      "fractures of equal width",
                                                      "sides of equal slope beside the rim",
                                                      "sides that continue beside the rim",
                                                      "length of sides that could continue",
                                                      "noise of the surfaces",
                                                      "coarseness of the meshes",
                                                      "relief of the fractures",
                                                      "contact as close as the noise allows",
                                                      "sides with a common axis",
                                                      "roundness of the sides"};
    return names;
}

}  // namespace ostraka

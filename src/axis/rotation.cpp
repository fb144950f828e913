// Axis of a surface of revolution from normals, refined on positions.
#include "axis/axis_methods.h"
#include "axis/revolved_profile.h"

#include "ostraka/algebra/dense.h"
#include "ostraka/core/angles.h"
#include "ostraka/core/progress.h"
#include "ostraka/geom/line_complex.h"
#include "ostraka/stats/summary.h"

#include <random>

namespace ostraka {

using namespace detail;

namespace detail {

AxisLine axis_along(const std::vector<RoundSample>& samples, const Vector3d& direction) {
    const auto [u, w] = across(direction);
    Eigen::Matrix2d A = Eigen::Matrix2d::Zero();
    Eigen::Vector2d b = Eigen::Vector2d::Zero();
    for (const RoundSample& s : samples) {
        const Vector3d side = s.n.cross(direction);
        const Eigen::Vector2d row(side.dot(u), side.dot(w));
        A += s.weight * row * row.transpose();
        b += s.weight * side.dot(s.p) * row;
    }
    const Eigen::Vector2d x = (A + 1e-9 * Eigen::Matrix2d::Identity()).inverse() * b;
    return {x[0] * u + x[1] * w, direction};
}

}  // namespace detail

namespace {

using Sample = RoundSample;
using Line = AxisLine;
using Profile = RevolvedProfile;
using Refinement = AxisRefinement;

Line line_of(const LineComplex& complex) {
    const LineComplex::Axis axis = complex.solve();
    return {axis.place, axis.direction};
}

double score(const std::vector<Sample>& samples, std::size_t step, const Line& axis) {
    double sum = 0;
    for (std::size_t i = 0; i < samples.size(); i += step)
        if (const double s = sine(samples[i], axis); std::abs(s) < 0.17) sum += samples[i].weight * (1 - s * s / (0.17 * 0.17));
    return sum;
}

/// Iteratively reweighted least squares with Cauchy weights.
Line reweighted(const std::vector<Sample>& samples, Line axis, int rounds) {
    for (int round = 0; round < rounds; ++round) {
        check_cancelled();
        std::vector<double> sines(samples.size());
        for (std::size_t i = 0; i < samples.size(); ++i) sines[i] = std::abs(sine(samples[i], axis));
        const double sigma = std::max(1.4826 * upper_median(sines), 0.01);
        LineComplex complex;
        for (std::size_t i = 0; i < samples.size(); ++i)
            complex.add(samples[i].p, samples[i].n, samples[i].weight / (1 + std::pow(sines[i] / sigma, 2)));
        axis = line_of(complex);
    }
    return axis;
}

Line first_guess(const std::vector<Sample>& samples, const AreaMoments& moments, const AxisOptions& options) {
    const std::size_t step = std::max<std::size_t>(1, samples.size() / 1000);
    Line best = reweighted(
        samples,
        [&] {
            LineComplex complex;
            for (const auto& s : samples) complex.add(s.p, s.n, s.weight);
            return line_of(complex);
        }(),
        10);
    double maximum = score(samples, step, best);
    const auto consider = [&](const Line& line) {
        const double value = score(samples, step, line);
        if (value > maximum) maximum = value, best = line;
    };
    for (const auto& d : moments.directions) consider({Vector3d::Zero(), eigen(d)});
    std::mt19937_64 random(options.seed);
    CancelCheck check;
    for (int trial = 0; trial < options.trials; ++trial) {
        check();
        LineComplex complex;
        for (int k = 0; k < 6; ++k) {
            const Sample& s = samples[random() % samples.size()];
            complex.add(s.p, s.n);
        }
        const Line line = line_of(complex);
        if (line.direction.allFinite() && line.point.allFinite()) consider(line);
    }
    return reweighted(samples, best, 15);
}

/// Area-weighted mean squared distance from the profile, clamped to `limit`; samples without a bin count with `limit`.
double profile_deviation(const std::vector<Sample>& samples, const Profile& profile, double limit) {
    double sum = 0;
    for (std::size_t i = 0; i < samples.size(); ++i)
        sum += samples[i].weight * std::pow(profile.bin_of[i] < 0 ? limit : std::min(limit, std::abs(profile.error[i])), 2);
    return sum;
}

Line refined(const std::vector<Sample>& samples, Line axis, int rounds) {
    for (int round = 0; round < rounds; ++round) {
        check_cancelled();
        const Profile profile(samples, axis);
        const Refinement system(samples, axis, profile);
        if (!(system.weight > 0)) break;
        const Eigen::Matrix4d damped = system.H + 1e-6 * system.H.trace() * Eigen::Matrix4d::Identity();
        const Eigen::Vector4d step = -solve_ldlt<4>(damped, system.g);
        if (!step.allFinite() || step.norm() > 0.5) break;
        axis.point += step[0] * system.u + step[1] * system.w;
        axis.direction = (axis.direction + step[2] * system.u + step[3] * system.w).normalized();
        axis.point -= axis.point.dot(axis.direction) * axis.direction;
        if (step.norm() < 1e-10) break;
    }
    return axis;
}

/// The best of the axes refined from several initialisations: the axis of the normals, and those of their principal directions
/// (the one of smallest variance suits a short arc of a cylinder). `rival`: another axis, at an angle of more than 15 degrees,
/// has less than 1.5 times its mean squared distance from the profile.
struct BestAxis {
    Line line;
    bool rival = false;
};
BestAxis best_axis(const std::vector<Sample>& samples, const Line& guess) {
    Matrix3d normal_moments = Matrix3d::Zero();
    for (const Sample& s : samples) normal_moments += s.weight * s.n * s.n.transpose();
    const SymmetricEigen3 solver(normal_moments);
    std::vector<Line> starts{guess};
    for (int k = 0; k < 3; ++k) starts.push_back(axis_along(samples, solver.eigenvectors().col(k)));
    std::vector<Line> lines;
    std::vector<Profile> profiles;
    double sigma = 1;
    for (const Line& start : starts) {
        lines.push_back(refined(samples, start, 30));
        profiles.emplace_back(samples, lines.back());
        sigma = std::min(sigma, profiles.back().sigma);
    }
    std::vector<double> deviations;
    for (const Profile& profile : profiles)
        deviations.push_back(profile_deviation(samples, profile, 4.685 * std::max(sigma, 1e-4)));
    const auto best_index = static_cast<std::size_t>(std::min_element(deviations.begin(), deviations.end()) - deviations.begin());
    BestAxis best{lines[best_index], false};
    const auto radius = [&](std::size_t k) { return upper_median(profiles[k].radius); };
    for (std::size_t k = 0; k < lines.size(); ++k)
        best.rival = best.rival || (std::abs(lines[k].direction.dot(best.line.direction)) < std::cos(pi / 12) &&
                                    deviations[k] < 1.5 * deviations[best_index] && radius(k) < 3 * radius(best_index));
    return best;
}

/// Median distance (as a standard deviation) of the samples on the profile from their best-fitting sphere: |p|^2 = 2 c . p + d.
double sphere_error(const std::vector<Sample>& samples, const Profile& profile) {
    Eigen::Matrix4d A = Eigen::Matrix4d::Zero();
    Eigen::Vector4d b = Eigen::Vector4d::Zero();
    const auto for_each_on_profile = [&](const auto& visit) {
        for (std::size_t i = 0; i < samples.size(); ++i)
            if (profile.bin_of[i] >= 0 && profile.robust[i] > 0) visit(samples[i]);
    };
    for_each_on_profile([&](const Sample& s) {
        const Eigen::Vector4d row(2 * s.p.x(), 2 * s.p.y(), 2 * s.p.z(), 1);
        A += s.weight * row * row.transpose();
        b += s.weight * s.p.squaredNorm() * row;
    });
    const Eigen::Vector4d x = solve_ldlt<4>(A, b);
    const double square = x[3] + x.head<3>().squaredNorm();
    if (!x.allFinite() || !(square > 0)) return std::numeric_limits<double>::infinity();
    std::vector<double> errors;
    for_each_on_profile([&](const Sample& s) { errors.push_back(std::abs((s.p - x.head<3>()).norm() - std::sqrt(square))); });
    return 1.4826 * upper_median(std::move(errors));
}

}  // namespace

namespace detail {

RotationSearch search_rotation(const Mesh& mesh, const std::vector<Index>& faces, const AxisOptions& options) {
    const AreaMoments moments = part_moments(mesh, faces, options);
    const double scale = part_diagonal(mesh, faces);
    const Vector3d centroid = eigen(moments.centroid);
    RotationSearch search;
    search.centroid = centroid;
    search.scale = scale;
    search.samples = take_samples(mesh, faces, options.smoothing, centroid, scale);
    const std::vector<Sample>& samples = search.samples;
    Axis& axis = search.axis;
    if (samples.size() < 12) {
        axis.reason = "it has too few faces to determine an axis";
        return search;
    }
    // Every line across a flat part is an axis.
    if (moments.variances[2] < 1e-4 * moments.variances[1]) {
        axis.reason = "it is flat: every line perpendicular to it is an axis";
        return search;
    }
    const auto [line, rival] = best_axis(samples, first_guess(samples, moments, options));
    search.line = line;
    const Profile profile(samples, line);
    const Refinement system(samples, line, profile);
    double round = 0, facing = 0, squares = 0, largest = 0;
    std::vector<double> angles;
    const auto [u, w] = across(line.direction);
    for (const auto& bin : profile.bins)
        if (bin.weight > 0.002 && bin.members.size() >= 8) largest = std::max(largest, bin.radius);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const bool on_profile = profile.bin_of[i] >= 0;
        if (!on_profile && std::abs(samples[i].n.dot(line.direction)) > 0.95) continue;
        facing += samples[i].weight;
        if (!on_profile) continue;
        if (std::abs(profile.error[i]) > options.tolerance * 2 * largest) continue;
        round += samples[i].weight;
        squares += samples[i].weight * profile.error[i] * profile.error[i];
        const Vector3d d = samples[i].p - line.point;
        angles.push_back(std::atan2(w.dot(d), u.dot(d)));
    }
    if (facing < 0.02 || !(system.weight > 0)) {
        axis.reason = "no part of it faces away from an axis";
        return search;
    }
    const double information = system.tilt_information();
    const double error = profile.sigma / std::sqrt(std::max(1e-300, information * std::max(1.0, system.count)));
    // The shorter the arc, the more the radius is correlated with a translation of the axis towards it.
    Vector3d mean_direction = Vector3d::Zero();
    for (const double angle : angles) mean_direction += Vector3d(std::cos(angle), std::sin(angle), 0) / double(angles.size());
    const double diameter_error =
        2 * profile.sigma * std::sqrt((system.radius_uncertainty(mean_direction.head<2>()) + 1) / std::max(1.0, system.count));
    axis.quality = facing > 0 ? round / facing : 0;
    search.determined = axis.quality >= options.min_quality;
    axis.figures = {{"largest diameter", 2 * largest * scale, "length"},
                    {"circle preserved", covered_percent(angles), "%"},
                    {"rms distance", round > 0 ? std::sqrt(squares / round) * scale : 0, "length"},
                    {"direction error", std::min(90.0, error * 180 / pi), "degree"},
                    {"diameter error", std::min(1e6, diameter_error) * scale, "length"}};
    if (sphere_error(samples, profile) < 2 * profile.sigma ||
        information < 2e-4 * system.shift_information() * system.radius * system.radius) {
        axis.reason = "it resembles a part of a sphere: many axes fit";
        search.sphere = true;
        return search;
    }
    if (rival) {
        axis.reason = "several axes fit: too little of its circumference is preserved to distinguish them";
        return search;
    }
    if (axis.quality < options.min_quality) {
        axis.reason = "it is not rotationally symmetric about any line";
        return search;
    }
    if (error > 0.09) {
        axis.reason = "the direction is not determined to within five degrees";
        return search;
    }
    if (2 * diameter_error > largest) {
        axis.reason = "too little of its circumference is preserved: the diameter is not determined to within a half";
        return search;
    }
    axis.found = true;
    set_line(axis, centroid + scale * line.point, line.direction, centroid);
    double minimum = 1e300, maximum = -1e300;
    const Vector3d a = eigen(axis.direction), origin = eigen(axis.point);
    for (const Index f : faces)
        for (const Vertex v : corners(mesh, Face(f))) {
            const double h = a.dot(eigen(mesh.point(v)) - origin);
            minimum = std::min(minimum, h), maximum = std::max(maximum, h);
        }
    axis.lines = {{point_of(origin + minimum * a), point_of(origin + maximum * a)}};
    return search;
}

}  // namespace detail

Axis rotation_axis(const Mesh& mesh, const std::vector<Index>& faces, const AxisOptions& options) {
    return search_rotation(mesh, faces, options).axis;
}

}  // namespace ostraka

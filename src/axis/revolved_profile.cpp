// Profiles of parts about a line.
#include "axis/revolved_profile.h"

#include "ostraka/algebra/dense.h"
#include "ostraka/core/progress.h"
#include "ostraka/stats/summary.h"

#include <algorithm>
#include <cmath>

namespace ostraka::detail {

std::vector<RoundSample> take_samples(const Mesh& mesh, const std::vector<Index>& faces, int rounds, const Vector3d& centre,
                                      double scale) {
    std::vector<Index> vertices;
    for (const Index f : faces)
        for (const Vertex v : corners(mesh, Face(f))) vertices.push_back(v.idx());
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    const auto index_of = [&](Vertex v) {
        return static_cast<std::size_t>(std::lower_bound(vertices.begin(), vertices.end(), v.idx()) - vertices.begin());
    };
    std::vector<std::array<std::size_t, 3>> triangles;
    std::vector<Vector3d> normals(vertices.size(), Vector3d::Zero());
    double total = 0;
    for (const Index f : faces) {
        const auto c = corners(mesh, Face(f));
        triangles.push_back({index_of(c[0]), index_of(c[1]), index_of(c[2])});
        const Vector3d n = eigen(area_vector(mesh, Face(f)));
        for (const std::size_t v : triangles.back()) normals[v] += n;
        total += n.norm();
    }
    for (int round = 0; round <= rounds; ++round) {
        check_cancelled();
        for (auto& n : normals)
            if (n.norm() > 0) n.normalize();
        if (round == rounds) break;
        std::vector<Vector3d> sums = normals;
        for (const auto& [a, b, c] : triangles) {
            const Vector3d sum = (normals[a] + normals[b] + normals[c]) / 3;
            sums[a] += sum, sums[b] += sum, sums[c] += sum;
        }
        normals = std::move(sums);
    }
    const std::size_t maximum = 8000;
    std::vector<RoundSample> samples;
    double area_so_far = 0;
    std::size_t sample_count = 0;
    for (std::size_t i = 0; i < faces.size(); ++i) {
        const double area = face_area(mesh, Face(faces[i]));
        if (!(area > 0)) continue;
        area_so_far += area;
        double weight = area / total;
        if (faces.size() > maximum) {
            const auto due = static_cast<std::size_t>(area_so_far / total * double(maximum));
            if (due <= sample_count) continue;
            weight = double(due - sample_count) / double(maximum);
            sample_count = due;
        }
        Vector3d p = Vector3d::Zero(), n = Vector3d::Zero();
        for (const Vertex v : corners(mesh, Face(faces[i]))) p += (eigen(mesh.point(v)) - centre) / (3 * scale);
        for (const std::size_t v : triangles[i]) n += normals[v];
        if (n.norm() > 0) samples.push_back({p, n.normalized(), weight});
    }
    return samples;
}

double sine(const RoundSample& s, const AxisLine& axis) {
    const Vector3d v = axis.direction.cross(s.p - axis.point);
    const double speed = v.norm();
    return speed > 0.01 ? s.n.dot(v) / speed : 0;
}

RevolvedProfile::RevolvedProfile(const std::vector<RoundSample>& samples, const AxisLine& axis)
    : bin_of(samples.size(), -1),
      height(samples.size()),
      radius(samples.size()),
      error(samples.size(), 0),
      robust(samples.size(), 1) {
    const int count = 20;
    double minimum = 1e300, maximum = -1e300;
    std::vector<double> facing(samples.size(), 0);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const Vector3d d = samples[i].p - axis.point;
        height[i] = d.dot(axis.direction);
        const Vector3d offset = d - height[i] * axis.direction;
        radius[i] = offset.norm();
        if (radius[i] > 0.01) facing[i] = samples[i].n.dot(offset) / radius[i];
        if (std::abs(facing[i]) < 0.3) continue;
        minimum = std::min(minimum, height[i]), maximum = std::max(maximum, height[i]);
    }
    if (minimum > maximum) return;
    bins.resize(2 * static_cast<std::size_t>(count));
    for (std::size_t i = 0; i < samples.size(); ++i) {
        if (std::abs(facing[i]) < 0.3) continue;
        const int bin_index =
            maximum > minimum ? std::min(count - 1, static_cast<int>((height[i] - minimum) / (maximum - minimum) * count)) : 0;
        bin_of[i] = 2 * bin_index + (facing[i] > 0 ? 1 : 0);
        bins[static_cast<std::size_t>(bin_of[i])].members.push_back(i);
    }
    for (int round = 0; round < 6; ++round) fit(samples, round == 0);
}

void RevolvedProfile::fit(const std::vector<RoundSample>& samples, bool first) {
    std::vector<double> errors;
    for (auto& bin : bins) {
        if (first && !bin.members.empty()) {
            // Starts at the median, so that a handle does not shift the circle.
            std::vector<double> radii;
            for (const std::size_t i : bin.members) radii.push_back(radius[i]);
            bin.radius = upper_median(std::move(radii));
        } else {
            bin.weight = bin.height = bin.radius = bin.hh = bin.hr = 0;
            for (const std::size_t i : bin.members) {
                const double w = samples[i].weight * robust[i];
                bin.weight += w, bin.height += w * height[i], bin.radius += w * radius[i];
            }
            if (!(bin.weight > 0)) continue;
            bin.height /= bin.weight, bin.radius /= bin.weight;
            for (const std::size_t i : bin.members) {
                const double w = samples[i].weight * robust[i], h = height[i] - bin.height;
                bin.hh += w * h * h, bin.hr += w * h * (radius[i] - bin.radius);
            }
            bin.slope = bin.hh > 1e-12 * bin.weight ? std::clamp(bin.hr / bin.hh, -4.0, 4.0) : 0;
        }
        for (const std::size_t i : bin.members) {
            error[i] = (radius[i] - bin.radius - bin.slope * (height[i] - bin.height)) / std::hypot(1, bin.slope);
            errors.push_back(std::abs(error[i]));
        }
    }
    if (errors.empty()) return;
    sigma = std::max(1.4826 * upper_median(std::move(errors)), 1e-6);
    for (std::size_t i = 0; i < error.size(); ++i) {
        const double t = error[i] / (4.685 * sigma);  // Tukey's biweight
        robust[i] = std::abs(t) < 1 ? std::pow(1 - t * t, 2) : 0;
    }
}

AxisRefinement::AxisRefinement(const std::vector<RoundSample>& samples, const AxisLine& axis, const RevolvedProfile& profile)
    : AxisRefinement(samples, axis, profile, across(axis.direction).first, across(axis.direction).second) {}

AxisRefinement::AxisRefinement(const std::vector<RoundSample>& samples, const AxisLine& axis, const RevolvedProfile& profile,
                               const Vector3d& along_u, const Vector3d& along_w)
    : u(along_u), w(along_w), rows(samples.size(), Eigen::Vector4d::Zero()) {
    double sum = 0, sum_squares = 0;
    for (const auto& bin : profile.bins) {
        if (bin.members.size() < 8 || !(bin.weight > 0)) continue;
        const auto row = [&](std::size_t i) {
            const Vector3d d = samples[i].p - axis.point;
            const Vector3d e = (d - d.dot(axis.direction) * axis.direction).normalized();
            const double arm = profile.height[i] + bin.slope * profile.radius[i];
            return Eigen::Vector4d(Eigen::Vector4d(u.dot(e), w.dot(e), arm * u.dot(e), arm * w.dot(e)) /
                                   -std::hypot(1, bin.slope));
        };
        Eigen::Vector4d mean = Eigen::Vector4d::Zero(), slope = Eigen::Vector4d::Zero();
        for (const std::size_t i : bin.members) mean += samples[i].weight * profile.robust[i] / bin.weight * row(i);
        for (const std::size_t i : bin.members)
            slope += samples[i].weight * profile.robust[i] * (profile.height[i] - bin.height) * row(i);
        if (bin.hh > 1e-12 * bin.weight) slope /= bin.hh;
        else slope.setZero();
        for (const std::size_t i : bin.members) {
            const double sample_weight = samples[i].weight * profile.robust[i];
            const Eigen::Vector4d r = row(i) - mean - (profile.height[i] - bin.height) * slope;
            rows[i] = r;
            H += sample_weight * r * r.transpose();
            g += sample_weight * profile.error[i] * r;
            squares += sample_weight * profile.error[i] * profile.error[i];
            radius += sample_weight * profile.radius[i];
            sum += sample_weight, sum_squares += sample_weight * sample_weight;
        }
    }
    weight = sum;
    if (sum_squares > 0) count = sum * sum / sum_squares;
    if (sum > 0) radius /= sum;
}

double AxisRefinement::radius_uncertainty(const Eigen::Vector2d& along) const {
    const Eigen::Vector4d t(along.x(), along.y(), 0, 0);
    const Eigen::Matrix4d information = H / weight + 1e-15 * H.trace() / weight * Eigen::Matrix4d::Identity();
    return std::max(0.0, t.dot(solve_ldlt<4>(information, t)));
}
double AxisRefinement::shift_information() const {
    return std::max(0.0, SymmetricEigen2(Eigen::Matrix2d(H.topLeftCorner<2, 2>())).eigenvalues()[0]) / weight;
}
double AxisRefinement::tilt_information() const {
    const Eigen::Matrix2d shifts = H.topLeftCorner<2, 2>() + 1e-12 * (H.trace() + 1e-30) * Eigen::Matrix2d::Identity();
    const Eigen::Matrix2d schur_complement =
        H.bottomRightCorner<2, 2>() - H.bottomLeftCorner<2, 2>() * shifts.inverse() * H.topRightCorner<2, 2>();
    return std::max(0.0, SymmetricEigen2(schur_complement).eigenvalues()[0]) / weight;
}

}  // namespace ostraka::detail

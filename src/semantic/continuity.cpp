#include "semantic/continuity.h"

#include "ostraka/core/angles.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/semantic/edit.h"

#include <algorithm>
#include <cmath>

namespace ostraka::semantic {

namespace {

/// Points at equal intervals along a polyline.
std::vector<Vector3d> resampled(const std::vector<Point>& line, int steps) {
    std::vector<double> at{0};
    for (std::size_t i = 1; i < line.size(); ++i) at.push_back(at.back() + (eigen(line[i]) - eigen(line[i - 1])).norm());
    std::vector<Vector3d> points;
    std::size_t i = 1;
    for (int k = 0; k <= steps; ++k) {
        const double s = at.back() * k / steps;
        while (i + 1 < line.size() && at[i] < s) ++i;
        const double length = at[i] - at[i - 1], share = length > 0 ? std::clamp((s - at[i - 1]) / length, 0.0, 1.0) : 0;
        points.push_back((1 - share) * eigen(line[i - 1]) + share * eigen(line[i]));
    }
    return points;
}

/// Number of slices of about three edge lengths each. With fewer vertices per slice the mean of a ring would be off the axis,
/// and a constraint on it would shrink the part.
int slices_of(const Mesh& mesh, const Annotation& part, const std::vector<Point>& skeleton) {
    double length = 0, sum = 0;
    for (std::size_t i = 1; i < skeleton.size(); ++i) length += (eigen(skeleton[i]) - eigen(skeleton[i - 1])).norm();
    for (const Index f : part.faces)
        for (const Halfedge h : CGAL::halfedges_around_face(mesh.halfedge(Face(f)), mesh))
            sum += (eigen(mesh.point(mesh.target(h))) - eigen(mesh.point(mesh.source(h)))).norm();
    const double edge = sum / (3 * static_cast<double>(part.faces.size()));
    return edge > 0 ? static_cast<int>(std::clamp(length / (3 * edge), 4.0, 20.0)) : 20;
}

}  // namespace

AxisSegment continuing_segment(const Mesh& mesh, const Annotation& part, const Annotation& reference, const Vector& axis,
                               double angle) {
    AxisSegment result;
    Axis skeleton = skeleton_axis(mesh, part.faces);
    // A part of few faces may shrink to a point; its slices still give an axis.
    if (!skeleton.found || skeleton.lines.empty() || skeleton.lines[0].size() < 2)
        if (Axis slices = slice_axis(mesh, part.faces); slices.found) skeleton = std::move(slices);
    if (!skeleton.found || skeleton.lines.empty() || skeleton.lines[0].size() < 2) {
        result.reason = "has no skeleton: " + skeleton.reason;
        return result;
    }
    const int steps = slices_of(mesh, part, skeleton.lines[0]);
    std::vector<Vector3d> line = resampled(skeleton.lines[0], steps);
    double to_front = std::numeric_limits<double>::infinity(), to_back = to_front;
    for (const Index v : vertices_of(mesh, reference)) {
        const Vector3d p = eigen(mesh.point(Vertex(v)));
        to_front = std::min(to_front, (p - line.front()).norm());
        to_back = std::min(to_back, (p - line.back()).norm());
    }
    if (to_back < to_front) std::reverse(line.begin(), line.end());
    const Vector3d direction = eigen(axis).normalized();
    const double limit = std::cos(angle * pi / 180);
    int last = 0;
    for (; last < steps; ++last) {
        const Vector3d step = line[static_cast<std::size_t>(last) + 1] - line[static_cast<std::size_t>(last)];
        if (!(step.norm() > 0) || std::abs(step.normalized().dot(direction)) < limit) break;
    }
    if (last < 2) {
        result.is_empty = true;
        result.reason = "does not begin in the direction of the reference: its skeleton leaves it by more than " +
                        std::to_string(angle) + " degrees at once";
        return result;
    }
    // Each vertex is assigned to the two ends of the nearest skeleton step.
    for (const Index v : vertices_of(mesh, part)) {
        const Vector3d p = eigen(mesh.point(Vertex(v)));
        double best = std::numeric_limits<double>::infinity(), along = 0;
        int at = 0;
        for (int k = 0; k < steps; ++k) {
            const Vector3d a = line[static_cast<std::size_t>(k)], d = line[static_cast<std::size_t>(k) + 1] - a;
            const double share = d.squaredNorm() > 0 ? std::clamp((p - a).dot(d) / d.squaredNorm(), 0.0, 1.0) : 0;
            const double off = (p - a - share * d).squaredNorm();
            if (off < best) best = off, at = k, along = share;
        }
        if (at >= last) continue;
        result.vertices.push_back(static_cast<int>(v));
        result.stations.push_back(at);
        result.shares.push_back(along);
    }
    // Stations without vertices are removed, so that they are numbered consecutively.
    std::vector<double> weight(static_cast<std::size_t>(last) + 1, 0);
    for (std::size_t i = 0; i < result.stations.size(); ++i) {
        const auto s = static_cast<std::size_t>(result.stations[i]);
        weight[s] += 1 - result.shares[i];
        weight[s + 1] += result.shares[i];
    }
    std::vector<int> number(weight.size(), -1);
    for (std::size_t s = 0; s < weight.size(); ++s)
        if (weight[s] > 0.1) number[s] = result.count++;
    for (std::size_t i = 0; i < result.stations.size(); ++i) {
        const auto s = static_cast<std::size_t>(result.stations[i]);
        // Next to a removed station a vertex counts for the remaining one only.
        if (number[s] < 0) result.stations[i] = number[s + 1], result.shares[i] = 0;
        else result.stations[i] = number[s], result.shares[i] = number[s + 1] < 0 ? 0 : result.shares[i];
    }
    if (result.count < 2) result.reason = "has too few vertices beside its skeleton";
    return result;
}

std::vector<Vector3d> stations_of(const AxisSegment& segment, const Eigen::Matrix3Xd& points) {
    std::vector<Vector3d> sums(static_cast<std::size_t>(segment.count), Vector3d::Zero());
    std::vector<double> weights(sums.size(), 0);
    const auto add = [&](int station, double weight, const Vector3d& p) {
        if (weight == 0) return;
        sums[static_cast<std::size_t>(station)] += weight * p;
        weights[static_cast<std::size_t>(station)] += weight;
    };
    for (std::size_t i = 0; i < segment.vertices.size(); ++i) {
        const Vector3d p = points.col(segment.vertices[i]);
        add(segment.stations[i], 1 - segment.shares[i], p);
        add(segment.stations[i] + 1, segment.shares[i], p);
    }
    for (std::size_t s = 0; s < sums.size(); ++s) sums[s] /= weights[s];
    return sums;
}

}  // namespace ostraka::semantic

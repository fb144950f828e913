#include "fracture/rotations.h"

#include "ostraka/core/angles.h"
#include "ostraka/execution/parallel.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

std::size_t step_of(double rotation, std::size_t steps) {
    const auto n = static_cast<long>(steps);
    const long k = std::lround(rotation / (2 * pi) * static_cast<double>(n));
    return static_cast<std::size_t>(((k % n) + n) % n);
}

/// Area of the second sherd's fracture that is close to the first's and faces it, per step.
std::vector<double> contacts(const UprightSherd& a, const UprightSherd& b, int steps, double search_radius) {
    std::vector<double> area(static_cast<std::size_t>(steps), 0);
    const SampleGrid grid(a.side.fracture.places, search_radius);
    const std::size_t size = b.side.fracture.places.size(), count = std::min<std::size_t>(size, 500);
    const double each = b.side.fracture.area / static_cast<double>(count);
    parallel_for(area.size(), 8, [&](std::size_t t) {
        const Motion motion = rotated_by(2 * pi * static_cast<double>(t) / steps);
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t k = (2 * i + 1) * size / (2 * count);
            const Vector3d p = motion(b.side.fracture.places[k]);
            const Index near = grid.near(p);
            if (near == no_index) continue;
            const double ratio = (p - a.side.fracture.places[near]).squaredNorm() / (search_radius * search_radius),
                         facing = -a.side.fracture.normals[near].dot(motion.rotation * b.side.fracture.normals[k]);
            if (ratio < 1 && facing > 0.3) area[t] += each * (1 - ratio) * facing;
        }
    });
    return area;
}

}  // namespace

double wrapped(double angle) { return std::remainder(angle, 2 * pi); }

Motion rotated_by(double angle) {
    Motion motion;
    motion.rotation = Eigen::AngleAxisd(angle, Vector3d::UnitZ()).toRotationMatrix();
    return motion;
}

double rotation_about_axis(const Motion& motion) {
    return std::atan2(motion.rotation(1, 0) - motion.rotation(0, 1), motion.rotation(0, 0) + motion.rotation(1, 1));
}

double RotationPair::shared_at(double rotation) const { return shared.empty() ? 0 : shared[step_of(rotation, shared.size())]; }

double RotationPair::met(double rotation) const {
    double best = 0;
    for (const MeetingRotation& candidate : meetings) {
        const double deviation = wrapped(rotation - candidate.rotation) / tolerance;
        if (deviation * deviation < 1) best = std::max(best, candidate.value * (1 - deviation * deviation));
    }
    return best;
}

const MeetingRotation* RotationPair::meeting(double rotation) const {
    const MeetingRotation* best = nullptr;
    double maximum = 0;
    for (const MeetingRotation& candidate : meetings) {
        const double deviation = wrapped(rotation - candidate.rotation) / tolerance,
                     value = candidate.value * (1 - deviation * deviation);
        if (value > maximum) best = &candidate, maximum = value;
    }
    return best;
}

RotationPair meet(const UprightSherd& a, const UprightSherd& b, int steps, double wall, const RotationMatchOptions& options) {
    RotationPair pair;
    const auto n = static_cast<std::size_t>(steps);
    pair.shared.assign(n, 0);
    const auto ab = a.map->shared(*b.map), ba = b.map->shared(*a.map);
    for (std::size_t t = 0; t < n; ++t) pair.shared[t] = std::max(ab[t], ba[(n - t) % n]);
    // A joint is located up to the width of the wall.
    pair.tolerance = std::min(1.0, wall / std::max(std::min(a.radius, b.radius), wall));
    if (a.side.frames.empty() || b.side.frames.empty()) return pair;
    const std::vector<double> close = contacts(a, b, steps, wall);
    std::vector<double> score(n);
    for (std::size_t t = 0; t < n; ++t) score[t] = close[t] - pair.shared[t];
    std::vector<std::size_t> tops;
    const auto window =
        std::max<std::size_t>(1, static_cast<std::size_t>(0.5 * pair.tolerance / (2 * pi) * static_cast<double>(n)));
    for (std::size_t t = 0; t < n; ++t) {
        bool top = score[t] > 0;
        for (std::size_t k = 1; top && k <= window; ++k)
            top = score[t] > score[(t + n - k) % n] && score[t] >= score[(t + k) % n];
        if (top) tops.push_back(t);
    }
    std::stable_sort(tops.begin(), tops.end(), [&](std::size_t x, std::size_t y) { return score[x] > score[y]; });
    if (tops.size() > static_cast<std::size_t>(options.candidates)) tops.resize(static_cast<std::size_t>(options.candidates));
    if (tops.empty()) return pair;

    const FractureTrees trees(a.mesh, a.side);
    const FractureAligner aligner(trees.target(), b.side, wall, 0.5 * wall, 1);
    const double area = std::min(a.side.fracture.area, b.side.fracture.area);
    std::vector<MeetingRotation> meetings(tops.size());
    parallel_for(tops.size(), 1, [&](std::size_t i) {
        const Motion start = rotated_by(2 * pi * static_cast<double>(tops[i]) / steps);
        const auto samples = static_cast<std::size_t>(options.samples);
        MeetingRotation& meeting = meetings[i];
        meeting.fit = aligner.judge(aligner.align(start, std::min<std::size_t>(samples, 600), 16, options.hold), samples, 0.6);
        meeting.rotation = rotation_about_axis(meeting.fit.pose);
        meeting.value = meeting.fit.score * area;
        // Poses off the template are not positions on this vessel.
        const Motion residual_motion = meeting.fit.pose.after(rotated_by(-meeting.rotation));
        double squares = 0;
        for (const Vector3d& p : b.side.intact.places) squares += (residual_motion(p) - p).squaredNorm();
        if (!(squares < wall * wall * static_cast<double>(b.side.intact.places.size()))) meeting.value = 0;
    });
    std::stable_sort(meetings.begin(), meetings.end(),
                     [](const MeetingRotation& x, const MeetingRotation& y) { return x.value > y.value; });
    for (MeetingRotation& meeting : meetings) {
        if (!(meeting.value > 0)) break;
        if (std::none_of(pair.meetings.begin(), pair.meetings.end(), [&](const MeetingRotation& accepted) {
                return std::abs(wrapped(accepted.rotation - meeting.rotation)) < 0.5 * pair.tolerance;
            }))
            pair.meetings.push_back(std::move(meeting));
    }
    return pair;
}

}  // namespace ostraka

#include "ostraka/synthetic/synthetic_object.h"

#include <cmath>

namespace ostraka {

namespace {

/// Smooth minimum, cubic: equals min(a, b) where they differ by more than `width` (with a twice differentiable transition).
Sample smooth_union(const Sample& a, const Sample& b, double width) {
    const bool a_first = a.value < b.value;
    const Sample& low = a_first ? a : b;
    const double overlap = width > 0 ? std::max(1 - std::abs(a.value - b.value) / width, 0.0) : 0;
    if (overlap == 0) return low;
    const Sample& high = a_first ? b : a;
    const double share = 0.5 * overlap * overlap;  // weight of the larger one
    return {low.value - overlap * overlap * overlap * width / 6, (1 - share) * low.gradient + share * high.gradient};
}

Sample negative(const Sample& a) { return {-a.value, -a.gradient}; }

/// Frame of a relief: coordinates in its plane and height above it.
struct ReliefFrame {
    Vector3d u, v, w;
    explicit ReliefFrame(const Vector3d& axis) : w(axis.normalized()) {
        const Vector3d up = std::abs(w.z()) < 0.9 ? Vector3d::UnitZ() : Vector3d::UnitX();
        u = up.cross(w).normalized();
        v = w.cross(u);
    }
};

/// Distance from the relief's axis, relative to the petal curve's radius in that direction: below 1 inside.
double petal_share(const Relief& relief, double x, double y) {
    const double petal = relief.radius * (1 + relief.petal_depth * std::cos(relief.petals * std::atan2(y, x)));
    return std::hypot(x, y) / petal;
}

/// Profile of the relief: 1 at the centre, decreasing to 0 at the petal curve with zero slope.
double raised(const Relief& relief, double x, double y) {
    const double share = petal_share(relief, x, y);
    if (share >= 1) return 0;
    const double inner = 1 - share * share * share * share;
    return inner * inner;
}

bool near_relief(const Relief& relief, const Vector3d& offset) {
    const double radius = relief.radius * (1 + relief.petal_depth);
    return offset.squaredNorm() < 2 * radius * radius;
}

}  // namespace

void SyntheticObject::finish() {
    boxes_.clear();
    margin_ = 0;
    for (const Member& member : members) {
        boxes_.push_back(member.solid->box());
        margin_ = std::max(margin_, member.blend);
    }
    box_ = Eigen::AlignedBox3d();
    // A smooth union bulges by at most a sixth of its width where two solids meet, slightly more where several do.
    double swell = slack();
    for (std::size_t i = 0; i < members.size(); ++i) {
        if (!members[i].carves) box_.extend(boxes_[i]);
        swell += members[i].blend / 6;
    }
    box_ = {box_.min() - Vector3d::Constant(swell), box_.max() + Vector3d::Constant(swell)};
    margin_ += 4 * slack() + 1e-3 * box_.diagonal().norm();
}

Sample SyntheticObject::member_sample(std::size_t member, const Vector3d& p) const {
    // Far from a solid a lower bound of its value is sufficient: solids beyond every blend width have no effect.
    const auto& solid = *members[member].solid;
    const double distance = boxes_[member].exteriorDistance(p) * solid.flatness();
    if (distance > margin_) {
        const Vector3d nearest = p.cwiseMax(boxes_[member].min()).cwiseMin(boxes_[member].max());
        return {distance, (p - nearest).normalized()};
    }
    return solid.sample(p);
}

double SyntheticObject::slack() const {
    double maximum = 0;
    for (const Relief& relief : reliefs) maximum = std::max(maximum, std::abs(relief.height));
    return maximum;
}

Sample SyntheticObject::sample(const Vector3d& p) const {
    Sample result = member_sample(0, p);
    for (std::size_t i = 1; i < members.size(); ++i) {
        const Sample next = member_sample(i, p);
        result = members[i].carves ? negative(smooth_union(negative(result), next, members[i].blend))
                                   : smooth_union(result, next, members[i].blend);
    }
    for (const Relief& relief : reliefs) {
        const Vector3d offset = p - relief.centre;
        if (!near_relief(relief, offset)) continue;
        const ReliefFrame frame(relief.axis);
        const double x = frame.u.dot(offset), y = frame.v.dot(offset);
        if (petal_share(relief, x, y) >= 1) continue;
        const double step = 1e-5 * relief.radius;
        const double dx = (raised(relief, x + step, y) - raised(relief, x - step, y)) / (2 * step);
        const double dy = (raised(relief, x, y + step) - raised(relief, x, y - step)) / (2 * step);
        result.value -= relief.height * raised(relief, x, y);
        result.gradient -= relief.height * (dx * frame.u + dy * frame.v);
    }
    return result;
}

Vector SyntheticObject::gradient(const Point& p) const {
    const Vector3d g = sample({p.x(), p.y(), p.z()}).gradient;
    return {g.x(), g.y(), g.z()};
}

int SyntheticObject::part(const Vector3d& p) const {
    std::size_t nearest = 0;
    double minimum = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < members.size(); ++i) {
        if (members[i].carves && members[i].stretches.empty()) continue;
        const double value = member_sample(i, p).value;
        // A wall left by a subtraction lies inside the previous solid.
        if (members[i].carves ? -value > minimum : value < minimum) minimum = members[i].carves ? -value : value, nearest = i;
    }
    const Member& member = members[nearest];
    int label = member.stretches.back().part;
    if (member.stretches.size() > 1) {
        const double t = member.solid->parameter(p);
        for (std::size_t i = member.stretches.size(); i-- > 0;) {
            if (t < member.stretches[i].until) label = member.stretches[i].part;
        }
    }
    for (const Relief& relief : reliefs) {
        const Vector3d offset = p - relief.centre;
        if (!near_relief(relief, offset)) continue;
        const ReliefFrame frame(relief.axis);
        if (petal_share(relief, frame.u.dot(offset), frame.v.dot(offset)) < 1) label = relief.part;
    }
    for (const Cut& cut : cuts) {
        if (label == cut.from && cut.side(p) < 0) label = cut.to;
    }
    return label;
}

Vector3d SyntheticObject::project(const Vector3d& p) const {
    Vector3d q = p;
    const double enough = 1e-13 * box_.diagonal().norm();
    for (int i = 0; i < 12; ++i) {
        const Sample s = sample(q);
        if (std::abs(s.value) <= enough) break;
        q -= s.value / std::max(s.gradient.squaredNorm(), 1e-4) * s.gradient;
    }
    return q;
}

Point SyntheticObject::project(const Point& p) const {
    const Vector3d q = project(Vector3d(p.x(), p.y(), p.z()));
    return {q.x(), q.y(), q.z()};
}

}  // namespace ostraka

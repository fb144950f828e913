#include "semantic/sizes.h"

#include <algorithm>
#include <cmath>

namespace ostraka::semantic {

namespace {

/// True if at least nine tenths of the second's vertices belong to the first.
bool holds(const Sized& whole, const Sized& part) {
    std::size_t common = 0;
    for (const Index v : part.vertices) common += std::binary_search(whole.vertices.begin(), whole.vertices.end(), v) ? 1 : 0;
    return 10 * common >= 9 * part.vertices.size();
}

}  // namespace

Sizes::Sizes(std::vector<const Sized*> parts, const Shape& shape, const State& edited) : parts_(std::move(parts)) {
    const std::size_t n = parts_.size();
    owner_.assign(shape.mesh.number_of_vertices(), -1);
    std::vector<std::size_t> smallest(n);
    for (std::size_t i = 0; i < n; ++i) smallest[i] = i;
    std::stable_sort(smallest.begin(), smallest.end(),
                     [&](std::size_t a, std::size_t b) { return parts_[a]->vertices.size() < parts_[b]->vertices.size(); });
    for (const std::size_t i : smallest)
        for (const Index v : parts_[i]->vertices)
            if (owner_[v] < 0) owner_[v] = static_cast<int>(i);
    in_.resize(n);
    slopes_ = Eigen::MatrixXd::Identity(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(n));
    for (std::size_t i = 0; i < n; ++i) {
        for (const std::size_t j : smallest) {
            if (i == j || !holds(*parts_[j], *parts_[i])) continue;
            in_[i].push_back(j);
            slopes_(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
                parts_[i]->axis.dot(parts_[j]->along * parts_[i]->axis);
        }
        std::size_t asked = 0;
        for (const Index v : parts_[i]->vertices) asked += edited.asked.empty() || edited.asked[v] ? 1 : 0;
        // A part that was only moved by its neighbours keeps its shape at rest.
        start_.push_back(2 * asked >= parts_[i]->vertices.size() ? edited.points : shape.rest);
        led_.push_back(parts_[i]->led ? parts_[i]->led(edited) : std::nullopt);
        const auto [low, high] = led_[i] ? *led_[i] : parts_[i]->range(edited);
        const double value = parts_[i]->value(edited);
        side_.push_back(value < low ? -1 : value > high ? 1 : 0);
    }
    factors_ = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(n));
    renew_maps();
}

void Sizes::renew_maps() {
    const auto stretch = [&](std::size_t i) -> Eigen::Matrix3d {
        return Eigen::Matrix3d::Identity() + std::expm1(factors_[static_cast<Eigen::Index>(i)]) * parts_[i]->along;
    };
    maps_.clear();
    for (std::size_t i = 0; i < parts_.size(); ++i) {
        Eigen::Matrix3d map = stretch(i);
        for (const std::size_t j : in_[i]) map = map * stretch(j);
        maps_.push_back(map);
    }
}

Eigen::VectorXd Sizes::errors(const State& now) const {
    Eigen::VectorXd list(static_cast<Eigen::Index>(parts_.size()));
    for (std::size_t i = 0; i < parts_.size(); ++i) {
        const double value = parts_[i]->value(now);
        const auto [low, high] = led_[i] ? *led_[i] : parts_[i]->range(now);
        constexpr double far = 5;  // error of a measure that has vanished
        const double goal = side_[i] < 0 ? low : side_[i] > 0 ? high : std::clamp(value, low, high);
        list[static_cast<Eigen::Index>(i)] = value > 0 ? std::clamp(std::log(value / goal), -far, far) : -far;
    }
    return list;
}

double Sizes::off(const State& now) const { return parts_.empty() ? 0 : errors(now).cwiseAbs().maxCoeff(); }

void Sizes::follow(const State& now) {
    const Eigen::VectorXd next = errors(now);
    constexpr double least = 1e-8, longest = 0.5, farthest = 2;
    if (errors_.size() > 0 && step_.norm() > least)
        slopes_ += (next - errors_ - slopes_ * step_) * step_.transpose() / step_.squaredNorm();
    errors_ = next;
    // For contradictory measures the slopes are singular, and no step satisfies both.
    Eigen::JacobiSVD<Eigen::MatrixXd> svd(slopes_, Eigen::ComputeThinU | Eigen::ComputeThinV);
    svd.setThreshold(0.02);
    const Eigen::VectorXd before = factors_;
    Eigen::VectorXd step = svd.solve(-errors_);
    if (const double size = step.cwiseAbs().maxCoeff(); size > longest) step *= longest / size;
    factors_ = (factors_ + step).cwiseMax(-farthest).cwiseMin(farthest);
    step_ = factors_ - before;
    renew_maps();
}

bool Sizes::allow_whole_ranges() {
    if (std::all_of(side_.begin(), side_.end(), [](int side) { return side == 0; })) return false;
    std::fill(side_.begin(), side_.end(), 0);
    errors_.resize(0);  // not the errors from which slopes would be estimated
    return true;
}

std::vector<Sizes::Copy> Sizes::copies() const {
    std::vector<Copy> list;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
        Copy copy;
        copy.contains_parts = false;
        for (const Index v : parts_[i]->vertices) {
            if (owner_[v] == static_cast<int>(i)) copy.ids.push_back(static_cast<int>(v));
            else copy.contains_parts = true;
        }
        if (copy.ids.size() < 3) continue;  // all vertices belong to parts inside, which are stretched with it
        copy.shape.resize(3, static_cast<Eigen::Index>(copy.ids.size()));
        for (std::size_t k = 0; k < copy.ids.size(); ++k)
            copy.shape.col(static_cast<Eigen::Index>(k)) = maps_[i] * start_[i].col(copy.ids[k]);
        list.push_back(std::move(copy));
    }
    return list;
}

const Eigen::Matrix3d& Sizes::around(Index vertex) const {
    static const Eigen::Matrix3d identity = Eigen::Matrix3d::Identity();
    return owner_.empty() || owner_[vertex] < 0 ? identity : maps_[static_cast<std::size_t>(owner_[vertex])];
}

std::vector<Index> Sizes::anchors() const {
    std::vector<Index> list;
    for (std::size_t i = 0; i < parts_.size(); ++i)
        if (in_[i].empty()) list.insert(list.end(), parts_[i]->anchors.begin(), parts_[i]->anchors.end());
    return list;
}

bool contradict(const Sized& part, const Sized& whole, const State& state) {
    return part.extent && whole.extent && std::abs(part.axis.dot(whole.axis)) > 1 - 1e-9 &&
           part.range(state).first > whole.range(state).second &&
           std::includes(whole.vertices.begin(), whole.vertices.end(), part.vertices.begin(), part.vertices.end());
}

}  // namespace ostraka::semantic

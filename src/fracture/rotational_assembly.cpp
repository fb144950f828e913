#include "fracture/rotations.h"
#include "ostraka/core/angles.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

namespace ostraka {

namespace {

struct State {
    std::vector<double> rotations;
    std::vector<bool> placed;
    double value = 0;
};

/// Equal for states in which the same sherds have the same rotations, to about a degree.
std::vector<long> signature(const State& state) {
    std::vector<long> key;
    for (std::size_t k = 0; k < state.rotations.size(); ++k)
        key.push_back(state.placed[k] ? std::lround(std::fmod(state.rotations[k] + 4 * pi, 2 * pi) * 60) % 377 : -1);
    return key;
}

/// The state with one more sherd at a rotation; empty if it gains nothing.
std::optional<State> with_sherd(const State& state, const RotationPairs& pairs, std::size_t sherd, double rotation) {
    double gain = 0;
    for (std::size_t q = 0; q < pairs.count(); ++q)
        if (state.placed[q]) gain += pairs.value(q, sherd, state.rotations[q], rotation);
    if (!(gain > 0)) return {};
    State grown = state;
    grown.rotations[sherd] = wrapped(rotation);
    grown.placed[sherd] = true;
    grown.value += gain;
    return grown;
}

}  // namespace

RotationAssembly assemble_rotations(const RotationPairs& pairs, const std::vector<bool>& fixed, std::size_t root, int beam) {
    const std::size_t n = pairs.count();
    State first{std::vector<double>(n, 0), fixed, 0};
    if (std::find(fixed.begin(), fixed.end(), true) == fixed.end()) first.placed[root] = true;
    State best = first;
    std::vector<State> states{first};
    while (!states.empty()) {
        std::vector<State> next;
        std::set<std::vector<long>> visited;
        for (const State& state : states)
            for (std::size_t u = 0; u < n; ++u)
                for (std::size_t p = 0; p < n && !state.placed[u]; ++p) {
                    if (!state.placed[p]) continue;
                    for (const MeetingRotation& meeting : pairs.at(p, u).meetings) {
                        auto grown =
                            with_sherd(state, pairs, u, state.rotations[p] + (p < u ? meeting.rotation : -meeting.rotation));
                        if (grown && visited.insert(signature(*grown)).second) next.push_back(std::move(*grown));
                    }
                }
        std::stable_sort(next.begin(), next.end(), [](const State& x, const State& y) { return x.value > y.value; });
        if (next.size() > static_cast<std::size_t>(beam)) next.resize(static_cast<std::size_t>(beam));
        if (!next.empty() && next.front().value > best.value) best = next.front();
        states = std::move(next);
    }
    RotationAssembly result{best.rotations, best.placed, best.value};
    std::vector<bool> counts = best.placed;
    for (std::size_t u = 0; u < n; ++u) {
        if (counts[u]) continue;
        double shared = 0;
        result.rotations[u] = least_shared_rotation(pairs, result.rotations, counts, u, shared);
        counts[u] = true;
    }
    return result;
}

RotationLead rotation_lead(const RotationPairs& pairs, const std::vector<double>& rotations, const std::vector<bool>& counts,
                           const std::vector<bool>& side, int steps) {
    RotationLead lead;
    double tolerance = 0;
    std::vector<std::pair<std::size_t, std::size_t>> across;
    for (std::size_t i = 0; i < rotations.size(); ++i)
        for (std::size_t j = 0; j < rotations.size(); ++j)
            if (counts[i] && counts[j] && !side[i] && side[j]) {
                across.emplace_back(i, j);
                tolerance = std::max(tolerance, pairs.at(i, j).tolerance);
            }
    for (const auto& [i, j] : across) lead.current += pairs.value(i, j, rotations[i], rotations[j]);
    // Overlap does not count at other rotations: lack of room there is no evidence about the fractures.
    for (int k = 0; k < steps; ++k) {
        const double rotation = wrapped(2 * pi * k / steps);
        if (std::abs(rotation) < 2 * tolerance) continue;
        double sum = 0;
        for (const auto& [i, j] : across)
            sum += pairs.at(i, j).met(RotationPairs::between(i, j, rotations[i], rotations[j] + rotation));
        lead.best_other = std::max(lead.best_other, sum);
    }
    return lead;
}

double least_shared_rotation(const RotationPairs& pairs, const std::vector<double>& rotations, const std::vector<bool>& counts,
                             std::size_t sherd, double& shared) {
    std::size_t steps = 1;
    for (std::size_t q = 0; q < rotations.size(); ++q)
        if (q != sherd) steps = std::max(steps, pairs.at(q, sherd).shared.size());
    // The middle of the widest interval of rotations with the least shared area.
    std::vector<double> area(steps, 0);
    for (std::size_t k = 0; k < steps; ++k) {
        const double rotation = 2 * pi * static_cast<double>(k) / static_cast<double>(steps);
        for (std::size_t q = 0; q < rotations.size(); ++q)
            if (q != sherd && counts[q])
                area[k] += pairs.at(q, sherd).shared_at(RotationPairs::between(q, sherd, rotations[q], rotation));
    }
    const double minimum = *std::min_element(area.begin(), area.end());
    shared = minimum;
    std::size_t begin = 0, longest = 0;
    for (std::size_t k = 0; k < steps; ++k) {
        std::size_t length = 0;
        while (length < steps && area[(k + length) % steps] <= minimum * (1 + 1e-9)) ++length;
        if (length > longest) begin = k, longest = length;
    }
    const std::size_t middle = begin + longest / 2;
    return wrapped(2 * pi * static_cast<double>(middle) / static_cast<double>(steps));
}

}  // namespace ostraka

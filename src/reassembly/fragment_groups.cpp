#include "fragment_groups.h"

#include "ostraka/core/error.h"
#include "ostraka/core/parallel.h"
#include "ostraka/core/progress.h"
#include "ostraka/geom/plane_motion.h"
#include "refine_group.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <queue>

namespace ostraka {

using Eigen::Vector3d;

namespace {

/// Prior log odds of a candidate: each pair has several, and most pairs do not meet.
constexpr double prior = -2;
/// A join whose log odds are lower than needed by more than this is not examined.
constexpr double hopeless_edge = 4;

}  // namespace

FragmentGroups::FragmentGroups(const LooseFragments& loose, const PairGraph& graph, const ReassemblyOptions& options)
    : loose_(loose),
      graph_(graph),
      needed_(logit(std::clamp(options.min_join, 1e-6, 1 - 1e-6))),
      order_(graph.edges().size()),
      poses_(loose.count()),
      version_(loose.count(), 0),
      refined_(loose.count(), 0),
      seen_(graph.edges().size()) {
    for (std::size_t k = 0; k < loose.count(); ++k)
        if (loose.has(k)) members_[k] = {k};
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::stable_sort(order_.begin(), order_.end(),
                     [&](std::size_t x, std::size_t y) { return graph.edges()[x].boosted > graph.edges()[y].boosted; });
}

void FragmentGroups::merge(bool all) {
    if (all) join_the_surest();
    else join_as_promised();
}

std::vector<UndoneJoin> FragmentGroups::undone() const {
    std::vector<UndoneJoin> list;
    for (const std::size_t e : order_) {
        const PairEdge& edge = graph_.edges()[e];
        if (edge.own < needed_) continue;
        const double likely = probability(edge.own);
        if (members_.at(edge.a) == members_.at(edge.b)) {
            const Motion here = poses_[edge.a].inverse().after(poses_[edge.b]);
            if (!loose_.agree(here, edge.pose, edge.b, loose_.loop_length(edge.a, edge.b, edge.b)))
                list.push_back({edge.a, edge.b, likely, "surer joins put the two elsewhere"});
        } else if (seen_[e] && !seen_[e]->verdict.against.empty()) {
            list.push_back({edge.a, edge.b, likely, seen_[e]->verdict.against});
        } else {
            list.push_back({edge.a, edge.b, likely, "what else would touch does not fit"});
        }
    }
    return list;
}

std::vector<std::vector<std::size_t>> FragmentGroups::groups() const {
    std::set<std::vector<std::size_t>> distinct;
    for (const auto& [k, group] : members_)
        if (group.size() > 1) distinct.insert(group);
    std::vector<std::vector<std::size_t>> list(distinct.begin(), distinct.end());
    const auto area = [&](const std::vector<std::size_t>& group) {
        double sum = 0;
        for (const std::size_t k : group) sum += loose_[k].size() * loose_[k].size();
        return sum;
    };
    std::stable_sort(list.begin(), list.end(), [&](const auto& x, const auto& y) { return area(x) > area(y); });
    return list;
}

/// Pairs of fragments of two groups that may touch if `join` is applied to the second group.
FragmentPairs FragmentGroups::close_pairs(std::size_t a, std::size_t b, const Motion& join) const {
    FragmentPairs close;
    for (const std::size_t i : members_.at(a))
        for (const std::size_t j : members_.at(b))
            if (loose_.near(i, poses_[i], j, join.after(poses_[j]))) close.emplace_back(i, j);
    return close;
}

/// Registers the second group, as one rigid body, with the first by all contacts: the error of a single join grows with the
/// distance from it.
Motion FragmentGroups::settled(std::size_t a, std::size_t b, Motion join) const {
    if (members_.at(a).size() + members_.at(b).size() < 3) return join;
    constexpr int steps = 12;
    constexpr double widest = 4;  // in tolerances
    constexpr std::size_t samples = 300;
    for (int step = 0; step < steps; ++step) {
        const double wide = std::pow(widest, 1 - std::min(1.0, 1.5 * step / (steps - 1)));
        const FragmentPairs close = close_pairs(a, b, join);
        std::vector<std::vector<ContactPoint>> contacts(2 * close.size());
        parallel_for(
            close.size(),
            [&](std::size_t k) {
                const auto [i, j] = close[k];
                const Motion pose = poses_[i].inverse().after(join).after(poses_[j]);
                contacts[2 * k] = contact_points(loose_[i], loose_[j], pose, wide * loose_.tolerance(i, j), samples);
                contacts[2 * k + 1] =
                    contact_points(loose_[j], loose_[i], pose.inverse(), wide * loose_.tolerance(i, j), samples);
            },
            1);
        std::vector<PlanePoint> planes;
        for (std::size_t k = 0; k < close.size(); ++k) {
            const auto [i, j] = close[k];
            const Motion moved_b = join.after(poses_[j]);
            // A sample represents the same area on either fragment.
            for (const bool back : {false, true}) {
                const Motion &on = back ? moved_b : poses_[i], &from = back ? poses_[i] : moved_b;
                const double each = loose_[back ? i : j].fracture_area();
                for (const ContactPoint& one : contacts[2 * k + (back ? 1 : 0)]) {
                    Vector3d point = from(one.on_b), normal = on.rotation * one.normal;
                    const double off = normal.dot(on(one.on_a) - point);
                    // For samples of the first, the plane of the second is moved to the point of the first.
                    if (back) point += off * normal, normal = -normal;
                    planes.push_back({point, normal, off, each * one.weight});
                }
            }
        }
        if (planes.size() < 12 || !step_onto_planes(planes, join)) break;
    }
    return join;
}

/// The evidence if the groups of an edge's fragments are joined along it.
FragmentGroups::Verdict FragmentGroups::examine(const PairEdge& edge) const {
    Verdict verdict;
    const Motion told = poses_[edge.a].after(edge.pose).after(poses_[edge.b].inverse());
    const Motion join = settled(edge.a, edge.b, told);
    verdict.join = join;
    const Motion here = poses_[edge.a].inverse().after(join).after(poses_[edge.b]);
    if (!loose_.agree(here, edge.pose, edge.b, loose_.loop_length(edge.a, edge.b, edge.b))) {
        verdict.against = "what else would touch draws them apart";
        verdict.log_odds = -1e9;
        return verdict;
    }
    double others = 0;
    const FragmentPairs close = close_pairs(edge.a, edge.b, join);
    std::vector<JoinEvidence> seen(close.size());
    parallel_for(
        close.size(),
        [&](std::size_t k) {
            const auto [i, j] = close[k];
            seen[k] =
                measure_join(loose_[i], loose_[j], poses_[i].inverse().after(join).after(poses_[j]), loose_.tolerance(i, j));
        },
        1);
    for (std::size_t k = 0; k < close.size(); ++k) {
        const auto [i, j] = close[k];
        const double t = loose_.tolerance(i, j), smaller = std::min(loose_[i].fracture_area(), loose_[j].fracture_area()),
                     inside = seen[k].penetration * std::max(seen[k].area * t * t, 0.01 * smaller);
        constexpr double touches = 0.03;
        // Coarse or noisy fractures overlap in places where they touch.
        const double too_much = seen[k].share > touches ? 0.4 : 0.2;
        if (inside > too_much * smaller) {
            verdict.against = loose_[j].name() + " would lie inside " + loose_[i].name();
            verdict.log_odds = -1e9;
            return verdict;
        }
        const bool itself = i == edge.a && j == edge.b;
        if (!itself && seen[k].share > touches) others += std::clamp(join_log_odds(seen[k]) - prior, -3.0, 5.0);
        if (!itself && seen[k].share <= touches && inside > 0.02 * smaller) others -= 1;
    }
    verdict.log_odds = std::max(edge.boosted + std::min(0.0, others), edge.own + others);
    return verdict;
}

/// Whether the verdict on an edge is up to date.
bool FragmentGroups::up_to_date(std::size_t e) const {
    return seen_[e] && seen_[e]->a == version_[graph_.edges()[e].a] && seen_[e]->b == version_[graph_.edges()[e].b];
}

void FragmentGroups::look_at(std::size_t e) {
    seen_[e] = Seen{version_[graph_.edges()[e].a], version_[graph_.edges()[e].b], examine(graph_.edges()[e])};
}

/// Joins the best edge, re-evaluating all edges after each join.
void FragmentGroups::join_the_surest() {
    while (true) {
        check_cancelled();
        std::size_t best = graph_.edges().size();
        double maximum = needed_;
        for (const std::size_t e : order_) {
            const PairEdge& edge = graph_.edges()[e];
            if (edge.boosted < needed_ - hopeless_edge) break;
            if (members_.at(edge.a) == members_.at(edge.b)) continue;
            if (!up_to_date(e)) look_at(e);
            if (seen_[e]->verdict.log_odds > maximum) maximum = seen_[e]->verdict.log_odds, best = e;
            // Edges further down cannot overtake it: the gain from other contacts is bounded in practice by their own
            // certainty.
            if (best < graph_.edges().size() && edge.boosted < maximum - 12) break;
        }
        if (best == graph_.edges().size()) break;
        join(graph_.edges()[best], seen_[best]->verdict.join);
    }
}

/// For many fragments (lazy evaluation): the log odds from the last examination of an edge stand until they are the highest of
/// all; only then is the edge examined again. An edge with evidence against it is not examined again; one that falls short,
/// twice more.
void FragmentGroups::join_as_promised() {
    using Promise = std::pair<double, std::size_t>;  // log odds, edge
    const auto later = [](const Promise& x, const Promise& y) {
        return std::pair(x.first, y.second) < std::pair(y.first, x.second);
    };
    std::priority_queue<Promise, std::vector<Promise>, decltype(later)> promises(later);
    std::vector<std::size_t> short_of;
    std::vector<int> fallen(graph_.edges().size(), 0);
    for (const std::size_t e : order_)
        if (graph_.edges()[e].boosted >= needed_ - hopeless_edge) promises.emplace(graph_.edges()[e].boosted, e);
    Progress progress("join groups", members_.size());
    while (!promises.empty()) {
        check_cancelled();
        const std::size_t e = promises.top().second;
        promises.pop();
        const PairEdge& edge = graph_.edges()[e];
        if (members_.at(edge.a) == members_.at(edge.b)) continue;
        if (up_to_date(e)) {
            join(edge, seen_[e]->verdict.join);
            progress.advance();
            // The group has grown and touches more fragments.
            std::erase_if(short_of, [&](std::size_t other) {
                if (up_to_date(other)) return false;
                promises.emplace(std::min(graph_.edges()[other].boosted, needed_), other);
                return true;
            });
            continue;
        }
        look_at(e);
        const Verdict& verdict = seen_[e]->verdict;
        if (!verdict.against.empty()) continue;
        constexpr int chances = 3;
        if (verdict.log_odds > needed_) promises.emplace(verdict.log_odds, e);
        else if (++fallen[e] < chances) short_of.push_back(e);
    }
}

void FragmentGroups::join(const PairEdge& edge, const Motion& move) {
    std::vector<std::size_t> all = members_.at(edge.a);
    for (const std::size_t j : members_.at(edge.b)) {
        poses_[j] = move.after(poses_[j]);
        all.push_back(j);
    }
    ++versions_;
    for (const std::size_t k : all) {
        members_[k] = all;
        version_[k] = versions_;
    }
    constexpr std::size_t small = 25;
    constexpr double grown = 1.2;
    std::size_t refined = 0;
    for (const std::size_t k : all) refined = std::max(refined, refined_[k]);
    // Large groups are not refined after each join: the time would be quadratic in their size.
    if (all.size() > small && static_cast<double>(all.size()) < grown * static_cast<double>(refined)) return;
    refine(all, 3);
    for (const std::size_t k : all) refined_[k] = all.size();
}

std::vector<std::pair<std::pair<std::size_t, std::size_t>, JoinEvidence>> FragmentGroups::meetings(
    const std::vector<std::size_t>& group) const {
    std::vector<std::pair<std::pair<std::size_t, std::size_t>, JoinEvidence>> list;
    for (std::size_t x = 0; x < group.size(); ++x)
        for (std::size_t y = x + 1; y < group.size(); ++y) {
            const std::size_t i = std::min(group[x], group[y]), j = std::max(group[x], group[y]);
            if (loose_.near(i, poses_[i], j, poses_[j])) list.push_back({{i, j}, {}});
        }
    parallel_for(
        list.size(),
        [&](std::size_t k) {
            const auto [i, j] = list[k].first;
            list[k].second = measure_join(loose_[i], loose_[j], poses_[i].inverse().after(poses_[j]), loose_.tolerance(i, j));
        },
        1);
    std::erase_if(list, [](const auto& one) { return one.second.share < 0.02; });
    return list;
}

void FragmentGroups::refine(const std::vector<std::size_t>& group, int rounds) {
    std::vector<const PreparedBreak*> fragments;
    std::vector<Motion> poses;
    std::map<std::size_t, std::size_t> place;
    for (const std::size_t k : group) {
        place[k] = fragments.size();
        fragments.push_back(&loose_[k]);
        poses.push_back(poses_[k]);
    }
    std::vector<MeetingPair> pairs;
    for (const auto& [pair, evidence] : meetings(group))
        pairs.push_back({place[pair.first], place[pair.second], loose_.tolerance(pair.first, pair.second)});
    refine_group(fragments, pairs, poses, rounds);
    for (std::size_t k = 0; k < group.size(); ++k) poses_[group[k]] = poses[k];
}

}  // namespace ostraka

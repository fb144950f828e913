#include "reassembly/fragment_groups.h"

#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/geom/plane_motion.h"
#include "reassembly/refine_group.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <queue>

namespace ostraka {

namespace {

/// Prior log odds of a candidate: each pair has several, and most pairs do not meet.
constexpr double prior = -2;
/// A join whose log odds are lower than needed by more than this is not examined.
constexpr double hopeless_edge = 4;

}  // namespace

FragmentGroups::FragmentGroups(const PreparedFragments& fragments, const PairGraph& graph, const ReassemblyOptions& options)
    : fragments_(fragments),
      graph_(graph),
      min_log_odds_(logit(std::clamp(options.min_join, 1e-6, 1 - 1e-6))),
      order_(graph.edges().size()),
      poses_(fragments.count()),
      version_(fragments.count(), 0),
      refined_(fragments.count(), 0),
      examinations_(graph.edges().size()) {
    for (std::size_t k = 0; k < fragments.count(); ++k)
        if (fragments.has(k)) members_[k] = {k};
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::stable_sort(order_.begin(), order_.end(),
                     [&](std::size_t x, std::size_t y) { return graph.edges()[x].boosted > graph.edges()[y].boosted; });
}

void FragmentGroups::merge(bool all_pairs) {
    if (all_pairs) join_eagerly();
    else join_lazily();
}

std::vector<RejectedJoin> FragmentGroups::undone() const {
    std::vector<RejectedJoin> rejected;
    for (const std::size_t e : order_) {
        const PairEdge& edge = graph_.edges()[e];
        if (edge.pair_log_odds < min_log_odds_) continue;
        const double likely = probability(edge.pair_log_odds);
        if (members_.at(edge.a) == members_.at(edge.b)) {
            const Motion pose = poses_[edge.a].inverse().after(poses_[edge.b]);
            if (!fragments_.agree(pose, edge.pose, edge.b, fragments_.loop_length(edge.a, edge.b, edge.b)))
                rejected.push_back({edge.a, edge.b, likely, "more certain joins place the two elsewhere"});
        } else if (examinations_[e] && !examinations_[e]->verdict.against.empty()) {
            rejected.push_back({edge.a, edge.b, likely, examinations_[e]->verdict.against});
        } else {
            rejected.push_back({edge.a, edge.b, likely, "other contacts of this join do not fit"});
        }
    }
    return rejected;
}

std::vector<std::vector<std::size_t>> FragmentGroups::groups() const {
    std::set<std::vector<std::size_t>> distinct;
    for (const auto& [k, group] : members_)
        if (group.size() > 1) distinct.insert(group);
    std::vector<std::vector<std::size_t>> sorted(distinct.begin(), distinct.end());
    const auto area = [&](const std::vector<std::size_t>& group) {
        double sum = 0;
        for (const std::size_t k : group) sum += fragments_[k].size() * fragments_[k].size();
        return sum;
    };
    std::stable_sort(sorted.begin(), sorted.end(), [&](const auto& x, const auto& y) { return area(x) > area(y); });
    return sorted;
}

/// Pairs of fragments of two groups that may touch if `join` is applied to the second group.
FragmentPairs FragmentGroups::close_pairs(std::size_t a, std::size_t b, const Motion& join) const {
    FragmentPairs close;
    for (const std::size_t i : members_.at(a))
        for (const std::size_t j : members_.at(b))
            if (fragments_.near(i, poses_[i], j, join.after(poses_[j]))) close.emplace_back(i, j);
    return close;
}

/// Registers the second group, as one rigid body, with the first by all contacts: the error of a single join grows with the
/// distance from it.
Motion FragmentGroups::registered(std::size_t a, std::size_t b, Motion join) const {
    if (members_.at(a).size() + members_.at(b).size() < 3) return join;
    constexpr int steps = 12;
    constexpr double widest = 4;  // in tolerances
    constexpr std::size_t samples = 300;
    for (int step = 0; step < steps; ++step) {
        const double radius_factor = std::pow(widest, 1 - std::min(1.0, 1.5 * step / (steps - 1)));
        const FragmentPairs close = close_pairs(a, b, join);
        std::vector<std::vector<ContactPoint>> contacts(2 * close.size());
        parallel_for(close.size(), 1, [&](std::size_t k) {
            const auto [i, j] = close[k];
            const Motion pose = poses_[i].inverse().after(join).after(poses_[j]);
            contacts[2 * k] =
                contact_points(fragments_[i], fragments_[j], pose, radius_factor * fragments_.tolerance(i, j), samples);
            contacts[2 * k + 1] =
                contact_points(fragments_[j], fragments_[i], pose.inverse(), radius_factor * fragments_.tolerance(i, j), samples);
        });
        std::vector<PlanePoint> planes;
        for (std::size_t k = 0; k < close.size(); ++k) {
            const auto [i, j] = close[k];
            const Motion moved_b = join.after(poses_[j]);
            // A sample represents the same area on either fragment.
            for (const bool back : {false, true}) {
                const Motion &on = back ? moved_b : poses_[i], &from = back ? poses_[i] : moved_b;
                const double each = fragments_[back ? i : j].fracture_area();
                for (const ContactPoint& contact : contacts[2 * k + (back ? 1 : 0)]) {
                    Vector3d point = from(contact.on_b), normal = on.rotation * contact.normal;
                    const double distance = normal.dot(on(contact.on_a) - point);
                    // For samples of the first, the plane of the second is moved to the point of the first.
                    if (back) point += distance * normal, normal = -normal;
                    planes.push_back({point, normal, distance, each * contact.weight});
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
    const Motion initial = poses_[edge.a].after(edge.pose).after(poses_[edge.b].inverse());
    const Motion join = registered(edge.a, edge.b, initial);
    verdict.join = join;
    const Motion pose = poses_[edge.a].inverse().after(join).after(poses_[edge.b]);
    if (!fragments_.agree(pose, edge.pose, edge.b, fragments_.loop_length(edge.a, edge.b, edge.b))) {
        verdict.against = "other contacts of this join pull the two apart";
        verdict.log_odds = -1e9;
        return verdict;
    }
    double other_log_odds = 0;
    const FragmentPairs close = close_pairs(edge.a, edge.b, join);
    std::vector<JoinEvidence> evidence(close.size());
    parallel_for(close.size(), 1, [&](std::size_t k) {
        const auto [i, j] = close[k];
        evidence[k] = measure_join(fragments_[i], fragments_[j], poses_[i].inverse().after(join).after(poses_[j]),
                                   fragments_.tolerance(i, j));
    });
    for (std::size_t k = 0; k < close.size(); ++k) {
        const auto [i, j] = close[k];
        const double t = fragments_.tolerance(i, j),
                     smaller = std::min(fragments_[i].fracture_area(), fragments_[j].fracture_area()),
                     inside = evidence[k].penetration * std::max(evidence[k].area * t * t, 0.01 * smaller);
        constexpr double touches = 0.03;
        // Coarse or noisy fractures overlap in places where they touch.
        const double max_overlap = evidence[k].share > touches ? 0.4 : 0.2;
        if (inside > max_overlap * smaller) {
            verdict.against = fmt::format("{} would lie inside {}", fragments_[j].name(), fragments_[i].name());
            verdict.log_odds = -1e9;
            return verdict;
        }
        const bool is_this_edge = i == edge.a && j == edge.b;
        if (!is_this_edge && evidence[k].share > touches)
            other_log_odds += std::clamp(join_log_odds(evidence[k]) - prior, -3.0, 5.0);
        if (!is_this_edge && evidence[k].share <= touches && inside > 0.02 * smaller) other_log_odds -= 1;
    }
    verdict.log_odds = std::max(edge.boosted + std::min(0.0, other_log_odds), edge.pair_log_odds + other_log_odds);
    return verdict;
}

/// Whether the verdict on an edge is up to date.
bool FragmentGroups::up_to_date(std::size_t e) const {
    return examinations_[e] && examinations_[e]->a == version_[graph_.edges()[e].a] &&
           examinations_[e]->b == version_[graph_.edges()[e].b];
}

void FragmentGroups::update(std::size_t e) {
    examinations_[e] = Examination{version_[graph_.edges()[e].a], version_[graph_.edges()[e].b], examine(graph_.edges()[e])};
}

/// Joins the best edge, re-evaluating all edges after each join.
void FragmentGroups::join_eagerly() {
    while (true) {
        check_cancelled();
        std::size_t best = graph_.edges().size();
        double maximum = min_log_odds_;
        for (const std::size_t e : order_) {
            const PairEdge& edge = graph_.edges()[e];
            if (edge.boosted < min_log_odds_ - hopeless_edge) break;
            if (members_.at(edge.a) == members_.at(edge.b)) continue;
            if (!up_to_date(e)) update(e);
            if (examinations_[e]->verdict.log_odds > maximum) maximum = examinations_[e]->verdict.log_odds, best = e;
            // Edges further down cannot overtake it: the gain from other contacts is bounded in practice by their own
            // certainty.
            if (best < graph_.edges().size() && edge.boosted < maximum - 12) break;
        }
        if (best == graph_.edges().size()) break;
        join(graph_.edges()[best], examinations_[best]->verdict.join);
    }
}

/// For many fragments (lazy evaluation): the log odds from the last examination of an edge stand until they are the highest of
/// all; only then is the edge examined again. An edge with evidence against it is not examined again; one that falls short,
/// twice more.
void FragmentGroups::join_lazily() {
    using Candidate = std::pair<double, std::size_t>;  // log odds, edge
    const auto later = [](const Candidate& x, const Candidate& y) {
        return std::pair(x.first, y.second) < std::pair(y.first, x.second);
    };
    std::priority_queue<Candidate, std::vector<Candidate>, decltype(later)> queue(later);
    std::vector<std::size_t> waiting;
    std::vector<int> failures(graph_.edges().size(), 0);
    for (const std::size_t e : order_)
        if (graph_.edges()[e].boosted >= min_log_odds_ - hopeless_edge) queue.emplace(graph_.edges()[e].boosted, e);
    Progress progress("join groups", members_.size());
    while (!queue.empty()) {
        check_cancelled();
        const std::size_t e = queue.top().second;
        queue.pop();
        const PairEdge& edge = graph_.edges()[e];
        if (members_.at(edge.a) == members_.at(edge.b)) continue;
        if (up_to_date(e)) {
            join(edge, examinations_[e]->verdict.join);
            progress.advance();
            // The group has grown and touches more fragments.
            std::erase_if(waiting, [&](std::size_t other) {
                if (up_to_date(other)) return false;
                queue.emplace(std::min(graph_.edges()[other].boosted, min_log_odds_), other);
                return true;
            });
            continue;
        }
        update(e);
        const Verdict& verdict = examinations_[e]->verdict;
        if (!verdict.against.empty()) continue;
        constexpr int max_attempts = 3;
        if (verdict.log_odds > min_log_odds_) queue.emplace(verdict.log_odds, e);
        else if (++failures[e] < max_attempts) waiting.push_back(e);
    }
}

void FragmentGroups::join(const PairEdge& edge, const Motion& move) {
    std::vector<std::size_t> members = members_.at(edge.a);
    for (const std::size_t j : members_.at(edge.b)) {
        poses_[j] = move.after(poses_[j]);
        members.push_back(j);
    }
    ++versions_;
    for (const std::size_t k : members) {
        members_[k] = members;
        version_[k] = versions_;
    }
    constexpr std::size_t small = 25;
    constexpr double min_growth = 1.2;
    std::size_t refined_size = 0;
    for (const std::size_t k : members) refined_size = std::max(refined_size, refined_[k]);
    // Large groups are not refined after each join: the time would be quadratic in their size.
    if (members.size() > small && static_cast<double>(members.size()) < min_growth * static_cast<double>(refined_size)) return;
    refine(members, 3);
    for (const std::size_t k : members) refined_[k] = members.size();
}

std::vector<std::pair<std::pair<std::size_t, std::size_t>, JoinEvidence>> FragmentGroups::meetings(
    const std::vector<std::size_t>& group) const {
    std::vector<std::pair<std::pair<std::size_t, std::size_t>, JoinEvidence>> contacts;
    for (std::size_t x = 0; x < group.size(); ++x)
        for (std::size_t y = x + 1; y < group.size(); ++y) {
            const std::size_t i = std::min(group[x], group[y]), j = std::max(group[x], group[y]);
            if (fragments_.near(i, poses_[i], j, poses_[j])) contacts.push_back({{i, j}, {}});
        }
    parallel_for(contacts.size(), 1, [&](std::size_t k) {
        const auto [i, j] = contacts[k].first;
        contacts[k].second =
            measure_join(fragments_[i], fragments_[j], poses_[i].inverse().after(poses_[j]), fragments_.tolerance(i, j));
    });
    std::erase_if(contacts, [](const auto& contact) { return contact.second.share < 0.02; });
    return contacts;
}

void FragmentGroups::refine(const std::vector<std::size_t>& group, int rounds) {
    std::vector<const PreparedFracture*> fragments;
    std::vector<Motion> poses;
    std::map<std::size_t, std::size_t> index;
    for (const std::size_t k : group) {
        index[k] = fragments.size();
        fragments.push_back(&fragments_[k]);
        poses.push_back(poses_[k]);
    }
    std::vector<MeetingPair> pairs;
    for (const auto& [pair, evidence] : meetings(group))
        pairs.push_back({index[pair.first], index[pair.second], fragments_.tolerance(pair.first, pair.second)});
    refine_group(fragments, pairs, poses, rounds);
    for (std::size_t k = 0; k < group.size(); ++k) poses_[group[k]] = poses[k];
}

}  // namespace ostraka

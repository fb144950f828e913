#include "ostraka/reassembly/reassembly.h"

#include "ostraka/core/error.h"
#include "ostraka/core/parallel.h"
#include "ostraka/core/progress.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/plane_motion.h"
#include "pair_choice.h"
#include "refine_group.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <numeric>
#include <queue>
#include <set>

namespace ostraka {

using Eigen::Vector3d;

namespace {

double logit(double p) { return std::log(p / (1 - p)); }
double probability(double log_odds) { return 1 / (1 + std::exp(-log_odds)); }

/// How much likelier it is that a right pose closes a loop with two right ones than that a wrong one does: the inverse of the
/// share of poses within the tolerances of `agree`, by far on the safe side (poses are not spread evenly over all motions).
constexpr double loop_gain = 1000;
/// Log odds of a candidate before anything is seen of it: there are several to a pair, and most pairs do not meet.
constexpr double prior = -2;

/// A candidate of a pair.
struct Edge {
    std::size_t a, b;  ///< a < b
    Motion pose;       ///< b onto a
    double own;        ///< log odds by the two alone
    double boosted;    ///< with loops
    std::size_t pair;  ///< number of its pair
};

class Assembler {
public:
    Assembler(const std::vector<Fragment>& given, const ReassemblyOptions& options, const PairMemory& memory)
        : options_(options), memory_(memory), count_(given.size()), effort_(effort_among(count_, options)) {
        result_.poses.resize(count_);
        result_.group.assign(count_, -1);
        result_.alone.resize(count_);
        prepared_.resize(count_);
        prepare(given);
    }

    Reassembly run() {
        try_pairs();
        make_edges();
        close_loops();
        merge();
        report();
        return std::move(result_);
    }

private:
    void prepare(const std::vector<Fragment>& given) {
        Progress progress("prepare fragments", count_);
        middle_.resize(count_, Vector3d::Zero());
        radius_.resize(count_, 0);
        parallel_for(
            count_,
            [&](std::size_t k) {
                prepare(given[k], k);
                progress.advance();
            },
            1);
    }

    void prepare(const Fragment& given, std::size_t k) {
        const Mesh& mesh = given.mesh;
        if (mesh.number_of_faces() < static_cast<std::size_t>(options_.min_faces)) {
            result_.alone[k] = "it has " + std::to_string(mesh.number_of_faces()) + " faces, too few to show how it broke";
            return;
        }
        try {
            prepared_[k] = std::make_unique<PreparedBreak>(given, effort_.prepared);
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::input) throw;
            result_.alone[k] = "it " + error.problem();
            return;
        }
        result_.alone[k] = what_hides_the_break(*prepared_[k]);
        if (!result_.alone[k].empty()) {
            prepared_[k].reset();
            return;
        }
        for (const Vertex v : mesh.vertices())
            middle_[k] += eigen(mesh.point(v)) / static_cast<double>(mesh.number_of_vertices());
        for (const Vertex v : mesh.vertices()) radius_[k] = std::max(radius_[k], (eigen(mesh.point(v)) - middle_[k]).norm());
    }

    /// Why a break cannot tell what it belongs to, before it is laid against any other; empty: it may.
    [[nodiscard]] std::string what_hides_the_break(const PreparedBreak& one) const {
        constexpr std::size_t little = 30;  // coarse sherds of a thousand faces have breaks of about a hundred
        if (one.fracture_faces() < little)
            return "its break has " + std::to_string(one.fracture_faces()) + " faces, too few to show how it broke";
        constexpr double smooth = 0.7;  // tolerances
        if (!effort_.all && one.relief() < smooth * options_.pairs.last_search_radius * join_scale(one, one))
            return "its break is so smooth that it fits too many of so many fragments";
        return "";
    }

    [[nodiscard]] double tolerance(std::size_t a, std::size_t b) const {
        return options_.pairs.last_search_radius * join_scale(*prepared_[a], *prepared_[b]);
    }

    void try_pairs() {
        const FragmentPairs list = promising_pairs(prepared_, effort_);
        const auto takes_part = static_cast<std::size_t>(
            std::count_if(prepared_.begin(), prepared_.end(), [](const auto& one) { return one != nullptr; }));
        result_.pairs_tried = list.size();
        result_.pairs_left = takes_part * (takes_part - 1) / 2 - list.size();
        pairs_ = tried("lay breaks against each other", list, effort_.first);
        if (effort_.all) return;
        // Once more and thoroughly where the first look leaves it open.
        constexpr double hopeless = 0.003, beyond_doubt = 0.98;
        std::vector<std::size_t> open;
        for (std::size_t p = 0; p < pairs_.size(); ++p)
            if (pairs_[p].confidence > hopeless && pairs_[p].confidence < beyond_doubt) open.push_back(p);
        std::stable_sort(open.begin(), open.end(),
                         [&](std::size_t x, std::size_t y) { return pairs_[x].confidence > pairs_[y].confidence; });
        if (open.size() > effort_.most_thorough) open.resize(effort_.most_thorough);
        FragmentPairs again;
        for (const std::size_t p : open) again.push_back(list[p]);
        std::vector<PairOfMany> better = tried("lay the likely ones more thoroughly", again, effort_.thorough);
        for (std::size_t k = 0; k < open.size(); ++k) pairs_[open[k]] = std::move(better[k]);
    }

    [[nodiscard]] std::vector<PairOfMany> tried(const std::string& phase, const FragmentPairs& list, const PairOptions& how) {
        std::vector<PairOfMany> result(list.size());
        std::mutex one_at_a_time;
        Progress progress(phase, list.size());
        parallel_for(
            list.size(),
            [&](std::size_t p) {
                check_cancelled();
                const auto [i, j] = list[p];
                std::optional<PairOfMany> pair;
                if (memory_.recall) {
                    const std::lock_guard lock(one_at_a_time);
                    pair = memory_.recall(i, j, how);
                }
                if (!pair) {
                    BreakPair found = pair_breaks(*prepared_[i], *prepared_[j], how);
                    pair = PairOfMany{i, j, std::move(found.candidates), found.confidence};
                    const std::lock_guard lock(one_at_a_time);
                    if (memory_.keep) memory_.keep(*pair, how);
                }
                result[p] = std::move(*pair);
                progress.advance();
            },
            1);
        return result;
    }

    /// A pair's probability among so many.
    [[nodiscard]] double probable(double alone) const {
        return probability(logit(std::clamp(alone, 1e-9, 1 - 1e-9)) + log_odds_of_a_join_among(count_));
    }

    void make_edges() {
        constexpr double least = 0.002;
        for (std::size_t p = 0; p < pairs_.size(); ++p) {
            const PairOfMany& pair = pairs_[p];
            for (std::size_t c = 0; c < pair.candidates.size(); ++c) {
                const double here = pair.candidates[c].log_odds, best = pair.candidates.front().log_odds,
                             lead = c > 0                        ? here - best
                                    : pair.candidates.size() > 1 ? here - pair.candidates[1].log_odds
                                                                 : 1e9;
                const double likely = probable(join_probability(here, lead));
                if (likely < least) continue;
                of_pair_[{pair.first, pair.second}].push_back(edges_.size());
                edges_.push_back({pair.first, pair.second, pair.candidates[c].pose, logit(likely), logit(likely), p});
            }
        }
    }

    /// Candidates of a pair, the lower number first; none of one that was not tried.
    [[nodiscard]] const std::vector<std::size_t>& edges_of(std::size_t i, std::size_t j) const {
        static const std::vector<std::size_t> none;
        const auto found = of_pair_.find({i, j});
        return found == of_pair_.end() ? none : found->second;
    }

    /// Two poses of fragment `k` into the frame of another are the same for what a loop asks.
    [[nodiscard]] bool agree(const Motion& x, const Motion& y, std::size_t k, double length) const {
        constexpr double angle = 0.2;  // radians
        return (x(middle_[k]) - y(middle_[k])).norm() < length &&
               Eigen::AngleAxisd(x.rotation.transpose() * y.rotation).angle() < angle;
    }
    [[nodiscard]] double loop_length(std::size_t i, std::size_t j, std::size_t k) const {
        return 0.1 * std::min({prepared_[i]->size(), prepared_[j]->size(), prepared_[k]->size()});
    }

    /// Edges that close loops of three get surer by how sure the other two are.
    void close_loops() {
        constexpr int rounds = 2;
        for (int round = 0; round < rounds; ++round) {
            std::vector<double> support(edges_.size(), 0);
            for (const auto& [first, those] : of_pair_) {
                const auto [i, j] = first;
                for (auto next = of_pair_.lower_bound({j, 0}); next != of_pair_.end() && next->first.first == j; ++next) {
                    const std::size_t k = next->first.second;
                    for (const std::size_t ik : edges_of(i, k))
                        for (const std::size_t ij : those)
                            for (const std::size_t jk : next->second) {
                                if (!agree(edges_[ij].pose.after(edges_[jk].pose), edges_[ik].pose, k, loop_length(i, j, k)))
                                    continue;
                                const double p = probability(edges_[ij].boosted), q = probability(edges_[jk].boosted),
                                             r = probability(edges_[ik].boosted);
                                support[ij] += q * r, support[jk] += p * r, support[ik] += p * q;
                            }
                }
            }
            for (std::size_t e = 0; e < edges_.size(); ++e)
                edges_[e].boosted = edges_[e].own + std::log(1 + loop_gain * support[e]);
        }
    }

    struct Verdict {
        Motion join;  ///< of the second group onto the first
        double log_odds = 0;
        std::string against;  ///< empty: nothing
    };

    /// Pairs of fragments of two groups that may touch where `join` lays the second group.
    [[nodiscard]] FragmentPairs close_pairs(std::size_t a, std::size_t b, const Motion& join) const {
        FragmentPairs close;
        for (const std::size_t i : members_.at(a))
            for (const std::size_t j : members_.at(b))
                if ((result_.poses[i](middle_[i]) - join.after(result_.poses[j])(middle_[j])).norm() < radius_[i] + radius_[j])
                    close.emplace_back(i, j);
        return close;
    }

    /// The second group as one body onto the first, by all that then comes into contact: what one join leaves of an error
    /// grows with the distance from it.
    [[nodiscard]] Motion settled(std::size_t a, std::size_t b, Motion join) const {
        if (members_.at(a).size() + members_.at(b).size() < 3) return join;
        constexpr int steps = 12;
        constexpr double widest = 4;  // tolerances
        constexpr std::size_t samples = 300;
        for (int step = 0; step < steps; ++step) {
            const double wide = std::pow(widest, 1 - std::min(1.0, 1.5 * step / (steps - 1)));
            const FragmentPairs close = close_pairs(a, b, join);
            std::vector<std::vector<ContactPoint>> contacts(2 * close.size());
            parallel_for(
                close.size(),
                [&](std::size_t k) {
                    const auto [i, j] = close[k];
                    const Motion pose = result_.poses[i].inverse().after(join).after(result_.poses[j]);
                    contacts[2 * k] = contact_points(*prepared_[i], *prepared_[j], pose, wide * tolerance(i, j), samples);
                    contacts[2 * k + 1] =
                        contact_points(*prepared_[j], *prepared_[i], pose.inverse(), wide * tolerance(i, j), samples);
                },
                1);
            struct Plane {
                Vector3d point, normal;
                double off, weight;
            };
            std::vector<Plane> planes;
            Vector3d centre = Vector3d::Zero();
            double total = 0;
            for (std::size_t k = 0; k < close.size(); ++k) {
                const auto [i, j] = close[k];
                const Motion moved_b = join.after(result_.poses[j]);
                // A sample stands for the same area whichever fragment it is of.
                for (const bool back : {false, true}) {
                    const Motion &on = back ? moved_b : result_.poses[i], &from = back ? result_.poses[i] : moved_b;
                    const double each = prepared_[back ? i : j]->fracture_area();
                    for (const ContactPoint& one : contacts[2 * k + (back ? 1 : 0)]) {
                        Vector3d point = from(one.on_b), normal = on.rotation * one.normal;
                        const double off = normal.dot(on(one.on_a) - point);
                        // Seen from the second, its plane moves onto the first's place.
                        if (back) point += off * normal, normal = -normal;
                        planes.push_back({point, normal, off, each * one.weight});
                        centre += planes.back().weight * point;
                        total += planes.back().weight;
                    }
                }
            }
            if (planes.size() < 12) break;
            centre /= total;
            double unit = 0;
            for (const Plane& plane : planes) unit += plane.weight / total * (plane.point - centre).squaredNorm();
            if (!(unit > 0)) break;
            PlaneMotion system(centre, std::sqrt(unit));
            for (const Plane& plane : planes) system.add(plane.point, plane.normal, plane.off, plane.weight);
            join = system.motion(system.solve(1e-3 / 6)).after(join);
            join.rotation = Eigen::Quaterniond(join.rotation).normalized().toRotationMatrix();
        }
        return join;
    }

    /// What is seen when the groups of an edge's fragments are joined by it.
    [[nodiscard]] Verdict examine(const Edge& edge) const {
        Verdict verdict;
        const Motion told = result_.poses[edge.a].after(edge.pose).after(result_.poses[edge.b].inverse());
        const Motion join = settled(edge.a, edge.b, told);
        verdict.join = join;
        const Motion here = result_.poses[edge.a].inverse().after(join).after(result_.poses[edge.b]);
        if (!agree(here, edge.pose, edge.b, loop_length(edge.a, edge.b, edge.b))) {
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
                seen[k] = measure_join(*prepared_[i], *prepared_[j],
                                       result_.poses[i].inverse().after(join).after(result_.poses[j]), tolerance(i, j));
            },
            1);
        for (std::size_t k = 0; k < close.size(); ++k) {
            const auto [i, j] = close[k];
            const double t = tolerance(i, j), smaller = std::min(prepared_[i]->fracture_area(), prepared_[j]->fracture_area()),
                         inside = seen[k].penetration * std::max(seen[k].area * t * t, 0.01 * smaller);
            constexpr double touches = 0.03;
            // Where breaks touch, coarse or noisy ones overlap in places.
            const double too_much = seen[k].share > touches ? 0.4 : 0.2;
            if (inside > too_much * smaller) {
                verdict.against = prepared_[j]->name() + " would lie inside " + prepared_[i]->name();
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

    void merge() {
        for (std::size_t k = 0; k < count_; ++k) {
            if (prepared_[k]) members_[k] = {k};
            version_.push_back(0);
            refined_.push_back(0);
        }
        seen_.resize(edges_.size());
        needed_ = logit(std::clamp(options_.min_join, 1e-6, 1 - 1e-6));
        std::vector<std::size_t> order(edges_.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::stable_sort(order.begin(), order.end(),
                         [&](std::size_t x, std::size_t y) { return edges_[x].boosted > edges_[y].boosted; });
        if (effort_.all) join_the_surest(order);
        else join_as_promised(order);
        for (const std::size_t e : order) {
            const Edge& edge = edges_[e];
            if (edge.own < needed_) continue;
            const double likely = probability(edge.own);
            if (members_.at(edge.a) == members_.at(edge.b)) {
                const Motion here = result_.poses[edge.a].inverse().after(result_.poses[edge.b]);
                if (!agree(here, edge.pose, edge.b, loop_length(edge.a, edge.b, edge.b)))
                    result_.undone.push_back({edge.a, edge.b, likely, "surer joins put the two elsewhere"});
            } else if (seen_[e] && !seen_[e]->verdict.against.empty()) {
                result_.undone.push_back({edge.a, edge.b, likely, seen_[e]->verdict.against});
            } else {
                result_.undone.push_back({edge.a, edge.b, likely, "what else would touch does not fit"});
            }
        }
    }

    /// What was seen of an edge still holds.
    [[nodiscard]] bool up_to_date(std::size_t e) const {
        return seen_[e] && seen_[e]->a == version_[edges_[e].a] && seen_[e]->b == version_[edges_[e].b];
    }
    void look_at(std::size_t e) { seen_[e] = Seen{version_[edges_[e].a], version_[edges_[e].b], examine(edges_[e])}; }

    static constexpr double hopeless_edge = 4;  // below what is needed

    /// Each time the best of all as they then are.
    void join_the_surest(const std::vector<std::size_t>& order) {
        while (true) {
            check_cancelled();
            std::size_t best = edges_.size();
            double maximum = needed_;
            for (const std::size_t e : order) {
                const Edge& edge = edges_[e];
                if (edge.boosted < needed_ - hopeless_edge) break;
                if (members_.at(edge.a) == members_.at(edge.b)) continue;
                if (!up_to_date(e)) look_at(e);
                if (seen_[e]->verdict.log_odds > maximum) maximum = seen_[e]->verdict.log_odds, best = e;
                // None further down can overtake it: what others add is bounded in practice by how sure they are.
                if (best < edges_.size() && edge.boosted < maximum - 12) break;
            }
            if (best == edges_.size()) break;
            join(edges_[best], seen_[best]->verdict.join);
        }
    }

    /// Of many: what an edge promised when it was last looked at stands until it is the best of all promises; only then it is
    /// looked at again. One that something speaks against is not looked at again, one that falls short twice more.
    void join_as_promised(const std::vector<std::size_t>& order) {
        using Promise = std::pair<double, std::size_t>;  // log odds, edge
        const auto later = [](const Promise& x, const Promise& y) {
            return std::pair(x.first, y.second) < std::pair(y.first, x.second);
        };
        std::priority_queue<Promise, std::vector<Promise>, decltype(later)> promises(later);
        std::vector<std::size_t> short_of;
        std::vector<int> fallen(edges_.size(), 0);
        for (const std::size_t e : order)
            if (edges_[e].boosted >= needed_ - hopeless_edge) promises.emplace(edges_[e].boosted, e);
        Progress progress("join groups", members_.size());
        while (!promises.empty()) {
            check_cancelled();
            const std::size_t e = promises.top().second;
            promises.pop();
            const Edge& edge = edges_[e];
            if (members_.at(edge.a) == members_.at(edge.b)) continue;
            if (up_to_date(e)) {
                join(edge, seen_[e]->verdict.join);
                progress.advance();
                // More touches now.
                std::erase_if(short_of, [&](std::size_t other) {
                    if (up_to_date(other)) return false;
                    promises.emplace(std::min(edges_[other].boosted, needed_), other);
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

    void join(const Edge& edge, const Motion& move) {
        std::vector<std::size_t> all = members_.at(edge.a);
        for (const std::size_t j : members_.at(edge.b)) {
            result_.poses[j] = move.after(result_.poses[j]);
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
        // Of large groups not at each join: the time would go with the square of their size.
        if (all.size() > small && static_cast<double>(all.size()) < grown * static_cast<double>(refined)) return;
        refine(all, 3);
        for (const std::size_t k : all) refined_[k] = all.size();
    }

    /// Pairs of a group that touch where they are.
    [[nodiscard]] std::vector<std::pair<std::pair<std::size_t, std::size_t>, JoinEvidence>> meetings(
        const std::vector<std::size_t>& group) const {
        std::vector<std::pair<std::pair<std::size_t, std::size_t>, JoinEvidence>> list;
        for (std::size_t x = 0; x < group.size(); ++x)
            for (std::size_t y = x + 1; y < group.size(); ++y) {
                const std::size_t i = std::min(group[x], group[y]), j = std::max(group[x], group[y]);
                if ((result_.poses[i](middle_[i]) - result_.poses[j](middle_[j])).norm() < radius_[i] + radius_[j])
                    list.push_back({{i, j}, {}});
            }
        parallel_for(
            list.size(),
            [&](std::size_t k) {
                const auto [i, j] = list[k].first;
                list[k].second = measure_join(*prepared_[i], *prepared_[j], result_.poses[i].inverse().after(result_.poses[j]),
                                              tolerance(i, j));
            },
            1);
        std::erase_if(list, [](const auto& one) { return one.second.share < 0.02; });
        return list;
    }

    void refine(const std::vector<std::size_t>& group, int rounds) {
        std::vector<const PreparedBreak*> fragments;
        std::vector<Motion> poses;
        std::map<std::size_t, std::size_t> place;
        for (const std::size_t k : group) {
            place[k] = fragments.size();
            fragments.push_back(prepared_[k].get());
            poses.push_back(result_.poses[k]);
        }
        std::vector<MeetingPair> pairs;
        for (const auto& [pair, evidence] : meetings(group))
            pairs.push_back({place[pair.first], place[pair.second], tolerance(pair.first, pair.second)});
        refine_group(fragments, pairs, poses, rounds);
        for (std::size_t k = 0; k < group.size(); ++k) result_.poses[group[k]] = poses[k];
    }

    void report() {
        std::set<std::vector<std::size_t>> groups;
        for (const auto& [k, group] : members_)
            if (group.size() > 1) groups.insert(group);
        std::vector<std::vector<std::size_t>> list(groups.begin(), groups.end());
        const auto area = [&](const std::vector<std::size_t>& group) {
            double sum = 0;
            for (const std::size_t k : group) sum += prepared_[k]->size() * prepared_[k]->size();
            return sum;
        };
        std::stable_sort(list.begin(), list.end(), [&](const auto& x, const auto& y) { return area(x) > area(y); });
        for (std::size_t g = 0; g < list.size(); ++g) {
            refine(list[g], 6);
            const std::size_t root = *std::max_element(list[g].begin(), list[g].end(), [&](std::size_t x, std::size_t y) {
                return std::pair(prepared_[x]->size(), y) < std::pair(prepared_[y]->size(), x);
            });
            const Motion home = result_.poses[root].inverse();
            for (const std::size_t k : list[g]) {
                result_.poses[k] = home.after(result_.poses[k]);
                result_.group[k] = static_cast<int>(g);
            }
            result_.poses[root] = Motion();
            joins_of(list[g]);
        }
        for (std::size_t k = 0; k < count_; ++k) {
            if (result_.group[k] >= 0 || !result_.alone[k].empty()) continue;
            result_.poses[k] = Motion();
            result_.alone[k] = why_alone(k);
        }
    }

    void joins_of(const std::vector<std::size_t>& group) {
        struct Meeting {
            std::size_t i, j;
            JoinEvidence evidence;
            double own;
        };
        std::vector<Meeting> list;
        std::map<std::pair<std::size_t, std::size_t>, double> own;
        for (const auto& [pair, evidence] : meetings(group)) {
            const auto [i, j] = pair;
            const Motion here = result_.poses[i].inverse().after(result_.poses[j]);
            double likely = probable(join_probability(join_log_odds(evidence), -1));
            for (const std::size_t e : edges_of(i, j))
                if (agree(here, edges_[e].pose, j, loop_length(i, j, j))) likely = std::max(likely, probability(edges_[e].own));
            list.push_back({i, j, evidence, logit(std::clamp(likely, 1e-9, 1 - 1e-9))});
            own[{i, j}] = likely;
        }
        const auto between = [&](std::size_t x, std::size_t y) {
            const auto found = own.find({std::min(x, y), std::max(x, y)});
            return found == own.end() ? 0 : found->second;
        };
        std::vector<FragmentJoin> joins;
        for (const Meeting& one : list) {
            FragmentJoin join;
            join.first = one.i;
            join.second = one.j;
            join.pose = result_.poses[one.i].inverse().after(result_.poses[one.j]);
            join.pair = probability(one.own);
            join.evidence = one.evidence;
            double support = 0;
            for (const std::size_t k : group) {
                if (k == one.i || k == one.j) continue;
                const double both = between(one.i, k) * between(one.j, k);
                if (both > 0.01) ++join.loops;
                support += both;
            }
            join.confidence = probability(one.own + std::log(1 + loop_gain * support));
            join.reason = join.loops > 0 ? "confirmed by " + std::to_string(join.loops) + (join.loops > 1 ? " loops" : " loop")
                                         : "by the two alone";
            joins.push_back(std::move(join));
        }
        std::stable_sort(joins.begin(), joins.end(),
                         [](const FragmentJoin& x, const FragmentJoin& y) { return x.confidence > y.confidence; });
        std::map<std::size_t, std::size_t> set;
        for (const std::size_t k : group) set[k] = k;
        const auto find = [&](std::size_t k) {
            while (set[k] != k) k = set[k];
            return k;
        };
        for (FragmentJoin& join : joins) {
            const std::size_t a = find(join.first), b = find(join.second);
            if (a == b) continue;
            set[std::max(a, b)] = std::min(a, b);
            join.carries = true;
        }
        for (FragmentJoin& join : joins) result_.joins.push_back(std::move(join));
    }

    [[nodiscard]] std::string why_alone(std::size_t k) const {
        const PairCandidate* best = nullptr;
        double maximum = -1;
        std::size_t other = k;
        for (const PairOfMany& pair : pairs_) {
            if ((pair.first != k && pair.second != k) || pair.candidates.empty() || pair.confidence <= maximum) continue;
            maximum = pair.confidence;
            best = &pair.candidates.front();
            other = pair.first == k ? pair.second : pair.first;
        }
        if (best == nullptr)
            return std::count_if(prepared_.begin(), prepared_.end(), [](const auto& one) { return one != nullptr; }) > 1
                       ? "its break comes into contact with no other"
                       : "there is no other fragment with a break to lay it against";
        const auto percent = [](double p) { return std::to_string(static_cast<int>(std::floor(100 * p))) + " %"; };
        const double among = probable(maximum);
        std::string text = "it fits best on " + prepared_[other]->name() + ", with a probability of " + percent(maximum);
        if (percent(among) != percent(maximum))
            text += " by the two alone and of " + percent(among) + " among so many fragments, of which some fit by chance";
        if (among < options_.min_join)
            return text + "; fragments are joined from " + percent(options_.min_join) +
                   " on: " + weakest_evidence(best->evidence);
        for (const UndoneJoin& one : result_.undone)
            if (one.first == std::min(k, other) && one.second == std::max(k, other))
                return text + "; not joined, since " + one.reason;
        return text + "; not joined, since what else would touch does not fit";
    }

    struct Seen {
        std::size_t a, b;  ///< versions of the groups
        Verdict verdict;
    };

    const ReassemblyOptions& options_;
    const PairMemory& memory_;
    std::size_t count_;
    PairEffort effort_;
    std::vector<std::unique_ptr<PreparedBreak>> prepared_;
    std::vector<Vector3d> middle_;
    std::vector<double> radius_;
    std::vector<PairOfMany> pairs_;
    std::vector<Edge> edges_;
    std::map<std::pair<std::size_t, std::size_t>, std::vector<std::size_t>> of_pair_;  ///< edges, the lower number first
    std::map<std::size_t, std::vector<std::size_t>> members_;                          ///< of each fragment: its group
    std::vector<std::size_t> version_;                                                 ///< of each fragment's group
    std::vector<std::size_t> refined_;  ///< of each fragment: how large its group was when it was last refined
    std::size_t versions_ = 0;
    std::vector<std::optional<Seen>> seen_;  ///< of each edge
    double needed_ = 0;                      ///< log odds
    Reassembly result_;
};

}  // namespace

int Reassembly::groups() const { return group.empty() ? 0 : 1 + *std::max_element(group.begin(), group.end()); }

Reassembly reassemble(const std::vector<Fragment>& fragments, const ReassemblyOptions& options, const PairMemory& memory) {
    check_options(options, "assemble");
    check_options(options.pairs, "pair");
    if (fragments.empty()) fail_usage("there are no fragments to assemble", "name two or more");
    return Assembler(fragments, options, memory).run();
}

void ReassemblyOptions::describe(OptionList& visit) {
    visit("least-join", min_join, "probability from which fragments are joined", Range{0.01, 0.999});
    visit("partners", partners, "of each fragment, those whose breaks quickly fit best are tried in full", Range{1, 100000});
    visit("least-faces", min_faces, "a fragment of fewer faces stays alone", Range{4, 1e9});
    pairs.describe(visit);
}

}  // namespace ostraka

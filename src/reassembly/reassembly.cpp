#include "ostraka/reassembly/reassembly.h"

#include "fragment_groups.h"
#include "ostraka/core/error.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace ostraka {

namespace {

class Assembler {
public:
    Assembler(const std::vector<Fragment>& given, const ReassemblyOptions& options, const PairMemory& memory)
        : options_(options),
          effort_(effort_among(given.size(), options)),
          result_(nothing_joined(given.size())),
          loose_(given, options, effort_, result_.alone),
          graph_(loose_, effort_, memory, result_),
          groups_(loose_, graph_, options) {}

    Reassembly run() {
        groups_.merge(effort_.all);
        result_.undone = groups_.undone();
        place_groups();
        for (std::size_t k = 0; k < result_.alone.size(); ++k)
            if (result_.group[k] < 0 && result_.alone[k].empty()) result_.alone[k] = why_alone(k);
        return std::move(result_);
    }

private:
    static Reassembly nothing_joined(std::size_t count) {
        Reassembly result;
        result.poses.resize(count);
        result.group.assign(count, -1);
        result.alone.resize(count);
        return result;
    }

    void place_groups() {
        const auto list = groups_.groups();
        for (std::size_t g = 0; g < list.size(); ++g) {
            groups_.refine(list[g], 6);
            const std::size_t root = *std::max_element(list[g].begin(), list[g].end(), [&](std::size_t x, std::size_t y) {
                return std::pair(loose_[x].size(), y) < std::pair(loose_[y].size(), x);
            });
            const Motion home = groups_.pose(root).inverse();
            for (const std::size_t k : list[g]) {
                result_.poses[k] = home.after(groups_.pose(k));
                result_.group[k] = static_cast<int>(g);
            }
            result_.poses[root] = Motion();
            joins_of(list[g]);
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
        for (const auto& [pair, evidence] : groups_.meetings(group)) {
            const auto [i, j] = pair;
            const Motion here = result_.poses[i].inverse().after(result_.poses[j]);
            double likely = graph_.probable(join_probability(join_log_odds(evidence), -1));
            for (const std::size_t e : graph_.edges_of(i, j))
                if (loose_.agree(here, graph_.edges()[e].pose, j, loose_.loop_length(i, j, j)))
                    likely = std::max(likely, probability(graph_.edges()[e].own));
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
        for (const PairOfMany& pair : graph_.pairs()) {
            if ((pair.first != k && pair.second != k) || pair.candidates.empty() || pair.confidence <= maximum) continue;
            maximum = pair.confidence;
            best = &pair.candidates.front();
            other = pair.first == k ? pair.second : pair.first;
        }
        if (best == nullptr)
            return loose_.taking_part() > 1 ? "its break comes into contact with no other"
                                            : "there is no other fragment with a break to lay it against";
        const auto percent = [](double p) { return std::to_string(static_cast<int>(std::floor(100 * p))) + " %"; };
        const double among = graph_.probable(maximum);
        std::string text = "it fits best on " + loose_[other].name() + ", with a probability of " + percent(maximum);
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

    const ReassemblyOptions& options_;
    PairEffort effort_;
    Reassembly result_;
    LooseFragments loose_;
    PairGraph graph_;
    FragmentGroups groups_;
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
    visit("min-join", min_join, "minimum probability of a join", Range{0.01, 0.999});
    visit("partners", partners, "number of partners per fragment, the best of a coarse comparison, that are registered fully",
          Range{1, 100000});
    visit("min-faces", min_faces, "minimum number of faces of a fragment that is joined", Range{4, 1e9});
    pairs.describe(visit);
}

}  // namespace ostraka

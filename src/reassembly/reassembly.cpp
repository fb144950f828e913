#include "ostraka/reassembly/reassembly.h"

#include "ostraka/core/error.h"
#include "reassembly/fragment_groups.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace ostraka {

namespace {

class Assembler {
public:
    Assembler(const std::vector<Fragment>& fragments, const ReassemblyOptions& options, const PairMemory& memory)
        : options_(options),
          effort_(pair_effort(fragments.size(), options)),
          result_(nothing_joined(fragments.size())),
          fragments_(fragments, options, effort_, result_.reasons_not_joined),
          graph_(fragments_, effort_, memory, result_),
          groups_(fragments_, graph_, options) {}

    Reassembly run() {
        groups_.merge(effort_.all_pairs);
        result_.rejected = groups_.undone();
        place_groups();
        for (std::size_t k = 0; k < result_.reasons_not_joined.size(); ++k)
            if (result_.group[k] < 0 && result_.reasons_not_joined[k].empty()) result_.reasons_not_joined[k] = reason_alone(k);
        return std::move(result_);
    }

private:
    static Reassembly nothing_joined(std::size_t count) {
        Reassembly result;
        result.poses.resize(count);
        result.group.assign(count, -1);
        result.reasons_not_joined.resize(count);
        return result;
    }

    void place_groups() {
        const auto groups = groups_.groups();
        for (std::size_t g = 0; g < groups.size(); ++g) {
            groups_.refine(groups[g], 6);
            const std::size_t root = *std::max_element(groups[g].begin(), groups[g].end(), [&](std::size_t x, std::size_t y) {
                return std::pair(fragments_[x].size(), y) < std::pair(fragments_[y].size(), x);
            });
            const Motion to_root = groups_.pose(root).inverse();
            for (const std::size_t k : groups[g]) {
                result_.poses[k] = to_root.after(groups_.pose(k));
                result_.group[k] = static_cast<int>(g);
            }
            result_.poses[root] = Motion();
            add_joins(groups[g]);
        }
    }

    void add_joins(const std::vector<std::size_t>& group) {
        struct Meeting {
            std::size_t i, j;
            JoinEvidence evidence;
            double log_odds;
        };
        std::vector<Meeting> contacts;
        std::map<std::pair<std::size_t, std::size_t>, double> pair_probability;
        for (const auto& [pair, evidence] : groups_.meetings(group)) {
            const auto [i, j] = pair;
            const Motion pose = result_.poses[i].inverse().after(result_.poses[j]);
            double likely = graph_.probable(join_probability(join_log_odds(evidence), -1));
            for (const std::size_t e : graph_.edges_of(i, j))
                if (fragments_.agree(pose, graph_.edges()[e].pose, j, fragments_.loop_length(i, j, j)))
                    likely = std::max(likely, probability(graph_.edges()[e].pair_log_odds));
            contacts.push_back({i, j, evidence, logit(std::clamp(likely, 1e-9, 1 - 1e-9))});
            pair_probability[{i, j}] = likely;
        }
        const auto between = [&](std::size_t x, std::size_t y) {
            const auto entry = pair_probability.find({std::min(x, y), std::max(x, y)});
            return entry == pair_probability.end() ? 0 : entry->second;
        };
        std::vector<FragmentJoin> joins;
        for (const Meeting& contact : contacts) {
            FragmentJoin join;
            join.first = contact.i;
            join.second = contact.j;
            join.pose = result_.poses[contact.i].inverse().after(result_.poses[contact.j]);
            join.pair_probability = probability(contact.log_odds);
            join.evidence = contact.evidence;
            double support = 0;
            for (const std::size_t k : group) {
                if (k == contact.i || k == contact.j) continue;
                const double both = between(contact.i, k) * between(contact.j, k);
                if (both > 0.01) ++join.loops;
                support += both;
            }
            join.confidence = probability(contact.log_odds + std::log(1 + loop_gain * support));
            join.reason = join.loops > 0 ? fmt::format("confirmed by {} loop{}", join.loops, join.loops > 1 ? "s" : "")
                                         : "by the two fragments alone";
            joins.push_back(std::move(join));
        }
        std::stable_sort(joins.begin(), joins.end(),
                         [](const FragmentJoin& x, const FragmentJoin& y) { return x.confidence > y.confidence; });
        std::map<std::size_t, std::size_t> parents;
        for (const std::size_t k : group) parents[k] = k;
        const auto find = [&](std::size_t k) {
            while (parents[k] != k) k = parents[k];
            return k;
        };
        for (FragmentJoin& join : joins) {
            const std::size_t a = find(join.first), b = find(join.second);
            if (a == b) continue;
            parents[std::max(a, b)] = std::min(a, b);
            join.carries = true;
        }
        for (FragmentJoin& join : joins) result_.joins.push_back(std::move(join));
    }

    [[nodiscard]] std::string reason_alone(std::size_t k) const {
        const PairCandidate* best = nullptr;
        double maximum = -1;
        std::size_t other = k;
        for (const PairResult& pair : graph_.pairs()) {
            if ((pair.first != k && pair.second != k) || pair.candidates.empty() || pair.confidence <= maximum) continue;
            maximum = pair.confidence;
            best = &pair.candidates.front();
            other = pair.first == k ? pair.second : pair.first;
        }
        if (best == nullptr)
            return fragments_.matched_count() > 1 ? "its fracture surface comes into contact with no other fragment"
                                                  : "there is no other fragment with a fracture surface to match";
        const auto percent = [](double p) { return std::to_string(static_cast<int>(std::floor(100 * p))) + " %"; };
        const double corrected = graph_.probable(maximum);
        std::string text =
            fmt::format("it fits best on {}, with a probability of {}", fragments_[other].name(), percent(maximum));
        if (percent(corrected) != percent(maximum))
            text +=
                fmt::format(" by the two alone and of {} among all fragments, some of which fit by chance", percent(corrected));
        if (corrected < options_.min_join)
            return fmt::format("{}; a join needs at least {}: {}", text, percent(options_.min_join),
                               weakest_evidence(best->evidence));
        for (const RejectedJoin& rejected : result_.rejected)
            if (rejected.first == std::min(k, other) && rejected.second == std::max(k, other))
                return fmt::format("{}; not joined, since {}", text, rejected.reason);
        return text + "; not joined, since other contacts of the join do not fit";
    }

    const ReassemblyOptions& options_;
    PairEffort effort_;
    Reassembly result_;
    PreparedFragments fragments_;
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

void ReassemblyOptions::declare_options(OptionList& list) {
    list("min-join", min_join, "minimum probability of a join", Range{0.01, 0.999});
    list("partners", partners, "number of fragments with which each fragment is fully registered, best first", Range{1, 100000});
    list("min-faces", min_faces, "minimum number of faces of a fragment; smaller fragments are not joined", Range{4, 1e9});
    pairs.declare_options(list);
}

}  // namespace ostraka

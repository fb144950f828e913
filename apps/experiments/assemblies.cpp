// Reassembles boxes that mix the fragments of one object with unrelated fragments: placed fragments, wrong joins.
#include "boxes.h"

#include "ostraka/reassembly/reassembly.h"

#include <algorithm>
#include <cmath>

namespace ostraka::experiments {

namespace {

struct AssemblyOptions : BoxOptions {
    AssemblyOptions() { output = "experiments-output/assemblies", pieces = 10; }
    int strangers = 10;
    bool found = false;
    void list_options(OptionList& list) {
        BoxOptions::list_options(list);
        list("strangers", strangers, "number of unrelated fragments per box, one from each of the other boxes", Range{0, 100});
        list("found", found, "facets that the library finds, instead of known ones");
    }
};

/// Results of one box, or of several.
struct Outcome {
    std::size_t own = 0, placed = 0, strangers = 0, strangers_joined = 0;
    std::size_t joins = 0, wrong = 0, sure = 0, sure_right = 0, even = 0, even_right = 0, pairs = 0;
    double degrees = 0, off = 0;  ///< root mean square over the object's fragments in its main group; off: share of the diagonal
    Seconds seconds;

    Outcome& operator+=(const Outcome& o) {
        own += o.own, placed += o.placed, strangers += o.strangers, strangers_joined += o.strangers_joined;
        joins += o.joins, wrong += o.wrong, sure += o.sure, sure_right += o.sure_right, even += o.even;
        even_right += o.even_right, pairs += o.pairs, seconds += o.seconds;
        return *this;
    }
};

/// A fragment of the mixture: whether it belongs to the box's object, and the motion applied to it.
struct Given {
    bool own = false;
    Motion motion;
};

/// Deviation of a fragment from its true position: `way` is its motion error in the object's frame.
std::pair<double, double> deviation(const Mesh& mesh, const Given& given, const Motion& way) {
    return {degrees_of(way), off_of(mesh, given.motion.after(way).after(given.motion.inverse()))};
}

Outcome judge(const std::vector<Fragment>& fragments, const std::vector<Given>& given, const Reassembly& result, double diagonal,
              const std::string& name, Rows& joins) {
    constexpr double near_degrees = 2, near_share = 0.01;
    Outcome outcome;
    std::vector<Motion> home(given.size());  // from the true position in the object to the group's frame
    for (std::size_t k = 0; k < given.size(); ++k) home[k] = result.poses[k].after(given[k].motion);
    // The reference fragment for which most fragments are correct.
    for (std::size_t r = 0; r < given.size(); ++r) {
        if (!given[r].own || result.group[r] < 0) continue;
        std::size_t right = 0, members = 0;
        double angles = 0, ways = 0;
        for (std::size_t k = 0; k < given.size(); ++k) {
            if (!given[k].own || result.group[k] != result.group[r]) continue;
            const auto [angle, off] = deviation(fragments[k].mesh, given[k], home[r].inverse().after(home[k]));
            ++members;
            angles += angle * angle, ways += off * off / diagonal / diagonal;
            right += angle <= near_degrees && off <= near_share * diagonal ? 1 : 0;
        }
        if (right <= outcome.placed) continue;
        outcome.placed = right;
        outcome.degrees = std::sqrt(angles / static_cast<double>(members));
        outcome.off = std::sqrt(ways / static_cast<double>(members));
    }
    for (std::size_t k = 0; k < given.size(); ++k) {
        (given[k].own ? outcome.own : outcome.strangers) += 1;
        outcome.strangers_joined += !given[k].own && result.group[k] >= 0 ? 1 : 0;
    }
    for (const FragmentJoin& join : result.joins) {
        const std::size_t i = join.first, j = join.second;
        bool right = given[i].own && given[j].own;
        if (right) {
            const auto [angle, off] = deviation(fragments[j].mesh, given[j], home[i].inverse().after(home[j]));
            right = angle < 6 && off < 0.06 * box_diagonal(fragments[j].mesh);
        }
        ++outcome.joins;
        outcome.wrong += right ? 0 : 1;
        if (join.confidence >= 0.9) ++outcome.sure, outcome.sure_right += right ? 1 : 0;
        if (join.confidence >= 0.5) ++outcome.even, outcome.even_right += right ? 1 : 0;
        joins(name, fragments[i].name, fragments[j].name, right, join.confidence, join.pair, join.loops, join.carries,
              join.evidence.share);
    }
    outcome.pairs = result.pairs_tried;
    return outcome;
}

void add_row(Table& table, const std::string& name, const Outcome& one) {
    table.row("{} | {} of {} | {} of {} | {}, {} | {} of {} | {} of {} | {:.2f} | {:.2f} | {} | {:.1f} | {:.1f}", name,
              one.placed, one.own, one.strangers_joined, one.strangers, one.joins, one.wrong, one.sure_right, one.sure,
              one.even_right, one.even, one.degrees, 100 * one.off, one.pairs, one.seconds.wall, one.seconds.processor);
}

/// Reassembles boxes that contain the fragments of one object and unrelated fragments, one from each other box.
void assemblies(const AssemblyOptions& options) {
    std::vector<Box> boxes;
    for_each_box(
        options, [&](std::uint64_t) { return options.found ? FacetChoice::found : FacetChoice::known; },
        [&](Box&& box, std::uint64_t) { boxes.push_back(std::move(box)); });
    Table table(
        "box | placed, of | strangers joined, of | joins, wrong | right of those at 0.9 | at 0.5 | degrees off | % of the "
        "diagonal "
        "off | pairs | s wall | s processor");
    Rows joins("box,first,second,right,confidence,pair,loops,carries,share");
    Outcome all;
    for (std::size_t b = 0; b < boxes.size(); ++b) {
        Random random(options.seed + b, 11);
        std::vector<Fragment> fragments;
        std::vector<Given> given;
        const auto add = [&](const Box& from, std::size_t k) {
            Fragment fragment = from.fragments[k];
            fragment.name = from.name + "-" + fragment.name;
            given.push_back({&from == &boxes[b], random_motion(random, 2 * boxes[b].diagonal)});
            fragment.mesh = moved(fragment.mesh, given.back().motion);
            fragments.push_back(std::move(fragment));
        };
        for (std::size_t k = 0; k < boxes[b].fragments.size(); ++k) add(boxes[b], k);
        for (std::size_t s = 1; s <= std::min<std::size_t>(static_cast<std::size_t>(options.strangers), boxes.size() - 1); ++s) {
            const Box& other = boxes[(b + s) % boxes.size()];
            add(other, (b + s) % other.fragments.size());
        }
        const Stopwatch watch;
        const Reassembly result = reassemble(fragments, {});
        const Seconds seconds = watch.seconds();
        Outcome one = judge(fragments, given, result, boxes[b].diagonal, boxes[b].name, joins);
        one.seconds = seconds;
        add_row(table, boxes[b].name + boxes[b].level, one);
        all += one;
        all.degrees += one.degrees / static_cast<double>(boxes.size());
        all.off += one.off / static_cast<double>(boxes.size());
    }
    add_row(table, "all", all);
    joins.write(Path(options.output) / "assemblies.csv");
}

const Registration registered("assemblies", "fragments of one object among strangers put together", assemblies);

}  // namespace

}  // namespace ostraka::experiments

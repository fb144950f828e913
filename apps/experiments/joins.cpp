// Pairs of fragments of broken objects: accuracy of the pose found, and calibration of its confidence. Boxes that mix the
// fragments of one object with unrelated ones, reassembled.
#include "boxes.h"

#include "ostraka/core/error.h"
#include "ostraka/files/csv.h"
#include "ostraka/files/json_build.h"
#include "ostraka/fracture/pair_registration.h"
#include "ostraka/reassembly/reassembly.h"
#include "ostraka/stats/boosted_trees.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace ostraka::experiments {

namespace {

using Features = Eigen::Array<double, JoinEvidence::count, 1>;

struct JoinOptions : BoxOptions {
    JoinOptions() { output = "experiments-output/joins"; }
    std::vector<std::string> rows;
    std::string model, recipe, facets = "known";
    bool adjacent_only = false;
    void declare_options(OptionList& list) {
        BoxOptions::declare_options(list);
        list("rows", rows, "joins.csv of earlier runs, as additional training data");
        list("model", model, "model file to train and write (data/joins.model.json)");
        list("recipe", recipe, "description of the training, stored in the model");
        list("facets", facets, "known facets, those that the library finds, or found ones in every second box",
             Choices{"known", "found", "both"});
        list("adjacent-only", adjacent_only, "only pairs that touch");
    }
};

struct Candidate {
    bool right = false;
    double log_odds = 0;
    Features features;
};

/// Result of a pair.
struct Row {
    std::string box, other;  ///< boxes of the first and of the second fragment
    std::size_t first = 0, second = 0;
    double contact = 0;  ///< truth: share of the smaller fracture surface; 0 for unrelated fragments
    bool stranger = false;
    double confidence = 0, seconds = 0;
    std::vector<Candidate> candidates;
};

/// Whether a pose that is off by a motion joins a fragment to its neighbour.
bool is_right(const Mesh& mesh, const Motion& off) {
    return degrees_of(off) < 6 && off_of(mesh, off) < 0.06 * box_diagonal(mesh);
}

Row try_pair(const Box& from, std::size_t i, const Box& with, std::size_t j, const PreparedFracture& a,
             const PreparedFracture& moved_b, const Motion& motion) {
    const bool stranger = &from != &with;
    const Stopwatch watch;
    const PairRegistration pair = register_fractures(a, moved_b);
    const double seconds = watch.seconds().processor, contact = stranger ? 0 : from.contact[std::min(i, j)][std::max(i, j)];
    Row row{from.name, with.name, i, j, contact, stranger, pair.confidence, seconds, {}};
    for (const PairCandidate& candidate : pair.candidates) {
        const bool right = !stranger && is_right(with.fragments[j].mesh, candidate.pose.after(motion));
        row.candidates.push_back({right, candidate.log_odds, Features::Map(candidate.evidence.features().data())});
    }
    return row;
}

/// Scanned and published objects are few but most relevant.
double weight_of(const Row& row) { return row.box.find(':') == std::string::npos ? 2 : 1; }

struct Trained {
    BoostedTrees trees;
    Eigen::Vector3d pair;
    Features usual = Features::Zero(), spread = Features::Zero();  ///< per feature over true joins: mean, standard deviation
    double joined = 0;                                             ///< share of the pairs whose first candidate is correct
};

std::vector<float> row_of(const Features& features) { return {features.begin(), features.end()}; }

BoostedTrees learnt_from(const std::vector<Row>& rows, auto&& chosen) {
    FeatureTable table;
    std::vector<bool> truth;
    std::vector<double> weights;
    for (const Row& row : rows)
        for (const Candidate& candidate : row.candidates) {
            if (!chosen(row)) break;
            table.add(row_of(candidate.features));
            truth.push_back(candidate.right);
            weights.push_back(weight_of(row));
        }
    return boost(table, truth, weights, {.trees = 200, .depth = 3, .rate = 0.04, .leaf_weight = 15, .ridge = 1});
}

/// Negative log odds and truth of the candidates, the most probable first.
using Scores = std::vector<std::pair<double, bool>>;
Scores scores_of(const Row& row, const BoostedTrees& trees) {
    Scores scored;
    for (const Candidate& candidate : row.candidates)
        scored.emplace_back(-trees.log_odds(row_of(candidate.features)), candidate.right);
    std::stable_sort(scored.begin(), scored.end(), [](const auto& x, const auto& y) { return x.first < y.first; });
    return scored;
}

/// What the confidence of a pair depends on: 1, log odds of the first candidate, and its lead.
Eigen::Vector3d input_of(const Scores& scored) {
    return {1, -scored[0].first, scored.size() > 1 ? std::min(2.0, scored[1].first - scored[0].first) : 2.0};
}

/// Trees are trained on all rows; calibration uses trees trained without a pair's object (five folds).
Trained train(const std::vector<Row>& rows) {
    Trained model;
    std::map<std::string, std::size_t> fold;
    for (const Row& row : rows) fold.emplace(row.box, fold.size() % 5);
    std::array<BoostedTrees, 5> others;
    for (std::size_t f = 0; f < others.size(); ++f)
        others[f] = learnt_from(rows, [&](const Row& row) {
            const auto other = fold.find(row.other);
            return fold.at(row.box) != f && (other == fold.end() || other->second != f);
        });
    model.trees = learnt_from(rows, [](const Row&) { return true; });
    double joins = 0;
    std::vector<Eigen::Vector3d> inputs;
    std::vector<bool> truth;
    std::vector<double> weights;
    for (const Row& row : rows) {
        for (const Candidate& candidate : row.candidates)
            if (candidate.right) ++joins, model.usual += candidate.features, model.spread += candidate.features.square();
        const auto scored = scores_of(row, others[fold.at(row.box)]);
        if (scored.empty()) continue;
        inputs.push_back(input_of(scored));
        truth.push_back(scored[0].second);
        weights.push_back(weight_of(row));
        model.joined += scored[0].second ? 1 : 0;
    }
    model.usual /= std::max(1.0, joins);
    model.spread = (model.spread / std::max(1.0, joins) - model.usual.square()).max(1e-6).sqrt();
    model.joined /= static_cast<double>(rows.size());
    model.pair = logistic(inputs, truth, weights, 0.01);
    return model;
}

/// Evaluates a row by a model trained without its object.
Row judged(Row row, const Trained& model) {
    const auto scored = scores_of(row, model.trees);
    row.confidence = scored.empty() ? 0 : 1 / (1 + std::exp(-model.pair.dot(input_of(scored))));
    for (std::size_t c = 0; c < scored.size(); ++c) row.candidates[c].right = scored[c].second;
    return row;
}

void write_model(const Path& file, const Trained& model, const std::string& recipe) {
    Json document;
    document.SetObject();
    auto& allocator = document.GetAllocator();
    const std::vector<double> usual(model.usual.begin(), model.usual.end()), spread(model.spread.begin(), model.spread.end()),
        pair(model.pair.begin(), model.pair.end());
    add_members(document, allocator, "recipe", recipe, "joined", model.joined, "pair", pair, "usual", usual, "spread", spread,
                "trees", model.trees.to_json(allocator));
    write_json(file, document);
}

/// Reads the rows written by an earlier run. Throws Error (input) if the file is not such a table.
std::vector<Row> read_rows(const std::string& file) {
    std::vector<Row> rows;
    constexpr std::size_t before = 10;  // number of leading columns
    for (const CsvRow& line : csv_rows(read_file(file), ',', file)) {
        if (line.line == 1) continue;
        if (line.cells.size() != before + JoinEvidence::count)
            fail_input(file, "has rows with another number of features than today's", "make it anew");
        const auto number = [&](std::size_t k) { return std::stod(line.cells[k]); };
        if (number(6) == 0)
            rows.push_back({line.cells[0],
                            line.cells[3],
                            static_cast<std::size_t>(number(1)),
                            static_cast<std::size_t>(number(2)),
                            number(4),
                            number(5) != 0,
                            number(9),
                            0,
                            {}});
        Candidate& candidate = rows.back().candidates.emplace_back();
        candidate.right = number(7) != 0;
        candidate.log_odds = number(8);
        for (std::size_t k = 0; k < JoinEvidence::count; ++k)
            candidate.features[static_cast<Eigen::Index>(k)] = number(before + k);
    }
    return rows;
}

void report(const std::vector<Row>& rows, const std::string& name, Table& table) {
    Hits sure, even, joins, strangers_sure, strangers_even;
    std::size_t reached = 0;
    double seconds = 0;
    Calibration calibration;
    for (const Row& row : rows) {
        const bool right = !row.candidates.empty() && row.candidates.front().right;
        seconds += row.seconds;
        if (row.confidence >= 0.9) sure.add(right);
        if (row.confidence >= 0.5) even.add(right);
        if (row.stranger) strangers_sure.add(row.confidence > 0.9), strangers_even.add(row.confidence >= 0.5);
        if (row.contact > 0.1) {
            joins.add(right && row.confidence >= 0.5);
            reached += std::any_of(row.candidates.begin(), row.candidates.end(), [](const Candidate& c) { return c.right; });
        }
        calibration.add(row.confidence, right);
    }
    table.row("{} | {} | {} ({:.1f} %) | {} ({:.1f} %) | {}, {} | {} ({:.0f} %), among candidates {} | {:.3f} | {:.2f}", name,
              rows.size(), sure.text(), sure.percent(), even.text(), even.percent(), strangers_sure.hits, strangers_even.text(),
              joins.text(), joins.percent(), reached, calibration.error(),
              seconds / static_cast<double>(std::max<std::size_t>(1, rows.size())));
}

/// Evaluates each scanned or published object by a model trained without it, and synthetic objects by five-fold
/// cross-validation.
void report_left_out(const std::vector<Row>& rows, Table& table) {
    std::map<std::string, std::size_t> fold;
    std::size_t made = 0, folds = 5;
    for (const Row& row : rows)
        if (!fold.contains(row.box)) fold[row.box] = weight_of(row) > 1 ? folds++ : made++ % 5;
    std::vector<Row> all_made, all_real;
    std::map<std::string, std::vector<Row>> boxes;
    for (std::size_t f = 0; f < folds; ++f) {
        std::vector<Row> others;
        const auto of_fold = [&](const std::string& name) { return fold.contains(name) && fold.at(name) == f; };
        for (const Row& row : rows)
            if (!of_fold(row.box) && !of_fold(row.other)) others.push_back(row);
        const Trained model = train(others);
        for (const Row& row : rows)
            if (of_fold(row.box)) {
                boxes[row.box].push_back(judged(row, model));
                (f < 5 ? all_made : all_real).push_back(boxes[row.box].back());
            }
    }
    for (const auto& [name, pairs] : boxes) report(pairs, name, table);
    report(all_made, "made, left out", table);
    report(all_real, "scanned and published, left out", table);
}

/// The fragments of a box that can be compared, as they are and moved at random.
struct PreparedBox {
    Box box;
    std::vector<PreparedFracture> given, moved;
    std::vector<Motion> motions;
    std::vector<std::size_t> index;  ///< in the box
};

PreparedBox prepare(Box&& box, std::uint64_t seed) {
    PreparedBox prepared;
    prepared.box = std::move(box);
    Random random(seed, 9);
    for (std::size_t k = 0; k < prepared.box.fragments.size(); ++k) {
        const Fragment& fragment = prepared.box.fragments[k];
        Fragment away = fragment;
        const Motion motion = move_at_random(away, random, 2 * prepared.box.diagonal);
        try {
            PreparedFracture here(fragment), there(away);
            prepared.given.push_back(std::move(here));
            prepared.moved.push_back(std::move(there));
        } catch (const Error& error) {
            fmt::print(stderr, "{} {} has no part in it: {}\n", prepared.box.name, fragment.name, error.what());
            continue;
        }
        prepared.motions.push_back(motion);
        prepared.index.push_back(k);
    }
    return prepared;
}

/// The pairs of a box, and pairs with fragments of the previous box, which are unrelated.
std::vector<Row> try_pairs(const PreparedBox& now, const PreparedBox& before, bool adjacent_only) {
    std::vector<Row> rows;
    const auto pair = [&](const PreparedBox& with, std::size_t i, std::size_t first, std::size_t j) {
        rows.push_back(try_pair(with.box, first, now.box, now.index[j], with.given[i], now.moved[j], now.motions[j]));
    };
    for (std::size_t i = 0; i < now.index.size(); ++i)
        for (std::size_t j = i + 1; j < now.index.size(); ++j)
            if (!adjacent_only || now.box.contact[now.index[i]][now.index[j]] > 0.1) pair(now, i, now.index[i], j);
    constexpr std::size_t strangers = 5;
    for (std::size_t i = 0; i < std::min(strangers, before.given.size()); ++i)
        for (std::size_t j = 0; j < std::min(strangers, now.index.size()); ++j) pair(before, i, i, j);
    return rows;
}

/// Registers pairs of fragments of broken objects: accuracy of poses and calibration of the confidence.
void joins(const JoinOptions& options) {
    Table table(
        "box | pairs | right of those at 0.9 | right of those at 0.5 | strangers above 0.9, at 0.5, of | true joins found | "
        "calibration error | s of processor a pair");
    std::string columns = "box,first,second,other,contact,stranger,candidate,right,log_odds,confidence";
    for (const std::string& name : JoinEvidence::names()) columns += ',' + name;
    Rows csv(columns);
    std::vector<Row> all;
    PreparedBox before;
    const auto facets = [&](std::uint64_t seed) {
        return options.facets == "found" || (options.facets == "both" && seed % 2 == 0) ? FacetChoice::found : FacetChoice::known;
    };
    for_each_box(options, facets, [&](Box&& box, std::uint64_t seed) {
        PreparedBox now = prepare(std::move(box), seed);
        const std::vector<Row> rows = try_pairs(now, before, options.adjacent_only);
        report(rows, now.box.name + now.box.level, table);
        for (const Row& row : rows)
            for (std::size_t c = 0; c < row.candidates.size(); ++c) {
                const auto& [right, log_odds, features] = row.candidates[c];
                std::vector<std::string> cells{row.box, Rows::cell(row.first), Rows::cell(row.second), row.other};
                for (const double x : {row.contact, double(row.stranger), double(c), double(right), log_odds, row.confidence})
                    cells.push_back(Rows::cell(x));
                for (const double x : features) cells.push_back(Rows::cell(x));
                csv.add(cells);
            }
        all.insert(all.end(), rows.begin(), rows.end());
        before = std::move(now);
    });
    if (!options.boxes.empty()) {
        report(all, "all", table);
        csv.write(Path(options.output) / "joins.csv");
    }
    for (const std::string& file : options.rows)
        for (Row& row : read_rows(file)) all.push_back(std::move(row));
    if (options.model.empty()) return;
    if (!options.rows.empty()) report_left_out(all, table);
    write_model(options.model, train(all), options.recipe);
}

const Registration registered_joins("joins", "pairs of fragments of broken objects: right poses and calibration", joins);

struct AssemblyOptions : BoxOptions {
    AssemblyOptions() { output = "experiments-output/assemblies", pieces = 10; }
    int strangers = 10;
    bool found = false;
    void declare_options(OptionList& list) {
        BoxOptions::declare_options(list);
        list("strangers", strangers, "number of unrelated fragments per box, one from each of the other boxes", Range{0, 100});
        list("found", found, "facets that the library finds, instead of known ones");
    }
};

/// Results of one box, or of several.
struct Outcome {
    Hits placed, strangers, joins, sure, even;  ///< fragments of the object, unrelated ones joined, right joins
    std::size_t pairs = 0;
    double degrees = 0, off = 0;  ///< root mean square over the object's fragments in its main group; off: share of the diagonal
    Seconds seconds;

    Outcome& operator+=(const Outcome& o) {
        placed += o.placed, strangers += o.strangers, joins += o.joins, sure += o.sure, even += o.even;
        pairs += o.pairs, seconds += o.seconds;
        return *this;
    }
};

/// A fragment of the mixture: whether it belongs to the box's object, and the motion applied to it.
struct Given {
    bool belongs = false;
    Motion motion;
};

Outcome judge(const std::vector<Fragment>& fragments, const std::vector<Given>& given, const Reassembly& result, double diagonal,
              const std::string& name, Rows& joins) {
    constexpr double near_degrees = 2, near_share = 0.01;
    Outcome outcome;
    std::vector<Motion> home(given.size());  // from the true position in the object to the group's frame
    for (std::size_t k = 0; k < given.size(); ++k) home[k] = result.poses[k].after(given[k].motion);
    // Motion error of a fragment against another one, in the fragment's frame.
    const auto off_from = [&](std::size_t k, std::size_t reference) {
        return given[k].motion.after(home[reference].inverse().after(home[k])).after(given[k].motion.inverse());
    };
    // The reference fragment for which most fragments are correct.
    for (std::size_t r = 0; r < given.size(); ++r) {
        if (!given[r].belongs || result.group[r] < 0) continue;
        std::size_t right = 0, members = 0;
        double angles = 0, ways = 0;
        for (std::size_t k = 0; k < given.size(); ++k) {
            if (!given[k].belongs || result.group[k] != result.group[r]) continue;
            const Motion motion = off_from(k, r);
            const double angle = degrees_of(motion), off = off_of(fragments[k].mesh, motion);
            ++members;
            angles += angle * angle, ways += off * off / diagonal / diagonal;
            right += angle <= near_degrees && off <= near_share * diagonal ? 1 : 0;
        }
        if (right <= outcome.placed.hits) continue;
        outcome.placed.hits = right;
        outcome.degrees = std::sqrt(angles / static_cast<double>(members));
        outcome.off = std::sqrt(ways / static_cast<double>(members));
    }
    for (std::size_t k = 0; k < given.size(); ++k)
        if (given[k].belongs) ++outcome.placed.all;
        else outcome.strangers.add(result.group[k] >= 0);
    for (const FragmentJoin& join : result.joins) {
        const std::size_t i = join.first, j = join.second;
        const bool right = given[i].belongs && given[j].belongs && is_right(fragments[j].mesh, off_from(j, i));
        outcome.joins.add(right);
        if (join.confidence >= 0.9) outcome.sure.add(right);
        if (join.confidence >= 0.5) outcome.even.add(right);
        joins(name, fragments[i].name, fragments[j].name, right, join.confidence, join.pair_probability, join.loops, join.carries,
              join.evidence.share);
    }
    outcome.pairs = result.pairs_tried;
    return outcome;
}

void add_row(Table& table, const std::string& name, const Outcome& box) {
    table.row("{} | {} | {} | {}, {} | {} | {} | {:.2f} | {:.2f} | {} | {:.1f} | {:.1f}", name, box.placed.text(),
              box.strangers.text(), box.joins.all, box.joins.all - box.joins.hits, box.sure.text(), box.even.text(), box.degrees,
              100 * box.off, box.pairs, box.seconds.wall, box.seconds.processor);
}

/// Reassembles boxes that contain the fragments of one object and unrelated fragments, one from each other box.
void assemblies(const AssemblyOptions& options) {
    std::vector<Box> boxes;
    for_each_box(
        options, [&](std::uint64_t) { return options.found ? FacetChoice::found : FacetChoice::known; },
        [&](Box&& box, std::uint64_t) { boxes.push_back(std::move(box)); });
    Table table(
        "box | placed, of | strangers joined, of | joins, wrong | right of those at 0.9 | at 0.5 | degrees off | % of the "
        "diagonal off | pairs | s wall | s processor");
    Rows joins("box,first,second,right,confidence,pair,loops,carries,share");
    Outcome all;
    for (std::size_t b = 0; b < boxes.size(); ++b) {
        Random random(options.seed + b, 11);
        std::vector<Fragment> fragments;
        std::vector<Given> given;
        const auto add = [&](const Box& from, std::size_t k) {
            Fragment fragment = from.fragments[k];
            fragment.name = from.name + "-" + fragment.name;
            given.push_back({&from == &boxes[b], move_at_random(fragment, random, 2 * boxes[b].diagonal)});
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
        Outcome outcome = judge(fragments, given, result, boxes[b].diagonal, boxes[b].name, joins);
        outcome.seconds = seconds;
        add_row(table, boxes[b].name + boxes[b].level, outcome);
        all += outcome;
        all.degrees += outcome.degrees / static_cast<double>(boxes.size());
        all.off += outcome.off / static_cast<double>(boxes.size());
    }
    add_row(table, "all", all);
    joins.write(Path(options.output) / "assemblies.csv");
}

const Registration registered_assemblies("assemblies", "fragments of one object among strangers put together", assemblies);

}  // namespace

}  // namespace ostraka::experiments

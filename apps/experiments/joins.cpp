// Pairs of fragments of broken objects: accuracy of the pose found, and calibration of its confidence.
#include "boxes.h"

#include "ostraka/algebra/dense.h"
#include "ostraka/core/error.h"
#include "ostraka/files/csv.h"
#include "ostraka/files/json_build.h"
#include "ostraka/fracture/pair_registration.h"
#include "ostraka/stats/boosted_trees.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>

namespace ostraka::experiments {

namespace {

using Features = std::array<double, JoinEvidence::count>;

struct JoinOptions : BoxOptions {
    JoinOptions() { output = "experiments-output/joins"; }
    std::vector<std::string> rows;
    std::string model, recipe, facets = "known";
    bool adjacent_only = false;
    void list_options(OptionList& list) {
        BoxOptions::list_options(list);
        list("rows", rows, "joins.csv of earlier runs, as additional training data");
        list("model", model, "model file to train and write (data/joins.model.json)");
        list("recipe", recipe, "description of the training, stored in the model");
        list("facets", facets, "known facets, those that the library finds, or found ones in every second box",
             Choices{"known", "found", "both"});
        list("adjacent-only", adjacent_only, "only pairs that touch");
    }
};

/// Result of a pair.
struct Row {
    std::string box, other;  ///< boxes of the first and of the second fragment
    std::size_t first = 0, second = 0;
    double contact = 0;  ///< truth: share of the smaller fracture surface; 0 for unrelated fragments
    bool stranger = false;
    std::vector<bool> right;  ///< per candidate
    std::vector<Features> features;
    std::vector<double> log_odds;
    double confidence = 0;
    double seconds = 0;
};

Row try_pair(const Box& of, std::size_t i, const Box& with, std::size_t j, const PreparedFracture& a,
             const PreparedFracture& moved_b, const Motion& motion) {
    Row row;
    row.box = of.name;
    row.other = with.name;
    row.first = i, row.second = j;
    row.stranger = &of != &with;
    if (!row.stranger) row.contact = of.contact[std::min(i, j)][std::max(i, j)];
    const Stopwatch watch;
    const PairRegistration pair = register_fractures(a, moved_b);
    row.seconds = watch.seconds().processor;
    const Mesh& mesh = with.fragments[j].mesh;
    for (const PairCandidate& one : pair.candidates) {
        const Motion off = one.pose.after(motion);
        row.right.push_back(!row.stranger && degrees_of(off) < 6 && off_of(mesh, off) < 0.06 * box_diagonal(mesh));
        row.features.push_back(one.evidence.features());
        row.log_odds.push_back(one.log_odds);
    }
    row.confidence = pair.confidence;
    return row;
}

/// Scanned and published objects are few but most relevant.
double weight_of(const Row& row) { return row.box.find(':') == std::string::npos ? 2 : 1; }

/// Logistic regression weights with ridge penalty (iteratively reweighted least squares). Each row begins with a 1.
Eigen::Vector3d logistic(const std::vector<Eigen::Vector3d>& rows, const std::vector<bool>& truth,
                         const std::vector<double>& counted, double ridge) {
    Eigen::Vector3d weights = Eigen::Vector3d::Zero();
    for (int step = 0; step < 60; ++step) {
        Eigen::Matrix3d hessian = ridge * Eigen::Matrix3d::Identity();
        hessian(0, 0) = 1e-9;
        Eigen::Vector3d gradient = -ridge * weights;
        gradient[0] = 0;
        for (std::size_t k = 0; k < rows.size(); ++k) {
            const double p = 1 / (1 + std::exp(-weights.dot(rows[k])));
            hessian += counted[k] * std::max(1e-9, p * (1 - p)) * rows[k] * rows[k].transpose();
            gradient += counted[k] * ((truth[k] ? 1 : 0) - p) * rows[k];
        }
        const Eigen::Vector3d move = solve_ldlt<3>(hessian, gradient);
        weights += move / std::max(1.0, move.norm());
        if (move.norm() < 1e-9) break;
    }
    return weights;
}

struct Trained {
    BoostedTrees trees;
    Eigen::Vector3d pair;
    Features usual{}, spread{};  ///< per feature over true joins: mean, standard deviation
    double joined = 0;           ///< share of the pairs whose first candidate is correct
};

std::vector<float> row_of(const Features& features) { return {features.begin(), features.end()}; }

BoostedTrees learnt_from(const std::vector<Row>& rows, auto&& chosen) {
    FeatureTable table;
    std::vector<bool> truth;
    std::vector<double> weights;
    for (const Row& row : rows)
        if (chosen(row))
            for (std::size_t c = 0; c < row.features.size(); ++c) {
                table.add(row_of(row.features[c]));
                truth.push_back(row.right[c]);
                weights.push_back(weight_of(row));
            }
    BoostOptions how;
    how.trees = 200;
    how.depth = 3;
    how.rate = 0.04;
    how.leaf_weight = 15;
    how.ridge = 1;
    return boost(table, truth, weights, how);
}

/// Negative log odds and truth of the candidates, the most probable first.
using Scores = std::vector<std::pair<double, bool>>;
Scores scores_of(const Row& row, const BoostedTrees& trees) {
    Scores scored;
    for (std::size_t c = 0; c < row.features.size(); ++c)
        scored.emplace_back(-trees.log_odds(row_of(row.features[c])), row.right[c]);
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
        for (std::size_t c = 0; c < row.features.size(); ++c) {
            if (!row.right[c]) continue;
            ++joins;
            for (std::size_t k = 0; k < model.usual.size(); ++k) {
                model.usual[k] += row.features[c][k];
                model.spread[k] += row.features[c][k] * row.features[c][k];
            }
        }
        const auto scored = scores_of(row, others[fold.at(row.box)]);
        if (scored.empty()) continue;
        inputs.push_back(input_of(scored));
        truth.push_back(scored[0].second);
        weights.push_back(weight_of(row));
        model.joined += scored[0].second ? 1 : 0;
    }
    for (std::size_t k = 0; k < model.usual.size(); ++k) {
        model.usual[k] /= std::max(1.0, joins);
        model.spread[k] = std::sqrt(std::max(1e-6, model.spread[k] / std::max(1.0, joins) - model.usual[k] * model.usual[k]));
    }
    model.joined /= static_cast<double>(rows.size());
    model.pair = logistic(inputs, truth, weights, 0.01);
    return model;
}

/// Evaluates a row by a model trained without its object.
Row judged(Row row, const Trained& model) {
    const auto scored = scores_of(row, model.trees);
    row.confidence = scored.empty() ? 0 : 1 / (1 + std::exp(-model.pair.dot(input_of(scored))));
    for (std::size_t c = 0; c < scored.size(); ++c) row.right[c] = scored[c].second;
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
        if (number(6) == 0) {
            Row& row = rows.emplace_back();
            row.box = line.cells[0];
            row.first = static_cast<std::size_t>(number(1)), row.second = static_cast<std::size_t>(number(2));
            row.other = line.cells[3];
            row.contact = number(4);
            row.stranger = number(5) != 0;
            row.confidence = number(9);
        }
        rows.back().right.push_back(number(7) != 0);
        rows.back().log_odds.push_back(number(8));
        for (std::size_t k = 0; k < JoinEvidence::count; ++k) {
            if (k == 0) rows.back().features.emplace_back();
            rows.back().features.back()[k] = number(before + k);
        }
    }
    return rows;
}

void report(const std::vector<Row>& rows, const std::string& name, Table& table) {
    std::size_t sure = 0, sure_right = 0, even = 0, even_right = 0, joins = 0, found = 0, reached = 0, strangers = 0,
                strangers_sure = 0, strangers_even = 0;
    double error = 0, seconds = 0;
    std::array<std::array<double, 3>, 10> bins{};
    for (const Row& row : rows) {
        const bool right = !row.right.empty() && row.right.front();
        seconds += row.seconds;
        if (row.confidence >= 0.9) ++sure, sure_right += right;
        if (row.confidence >= 0.5) ++even, even_right += right;
        if (row.stranger) ++strangers, strangers_sure += row.confidence > 0.9, strangers_even += row.confidence >= 0.5;
        if (row.contact > 0.1) {
            ++joins;
            found += right && row.confidence >= 0.5;
            reached += std::find(row.right.begin(), row.right.end(), true) != row.right.end();
        }
        auto& bin = bins[static_cast<std::size_t>(std::min(9.0, 10 * row.confidence))];
        ++bin[0], bin[1] += row.confidence, bin[2] += right;
    }
    for (const auto& bin : bins) error += std::abs(bin[1] - bin[2]);
    const auto count = static_cast<double>(std::max<std::size_t>(1, rows.size()));
    table.row(
        "{} | {} | {} of {} ({:.1f} %) | {} of {} ({:.1f} %) | {}, {} of {} | {} of {} ({:.0f} %), among candidates {} | {:.3f} "
        "| "
        "{:.2f}",
        name, rows.size(), sure_right, sure, percentage(sure_right, sure), even_right, even, percentage(even_right, even),
        strangers_sure, strangers_even, strangers, found, joins, percentage(found, joins), reached, error / count,
        seconds / count);
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
        const auto of_fold = [&](const std::string& name) {
            const auto found = fold.find(name);
            return found != fold.end() && found->second == f;
        };
        for (const Row& row : rows)
            if (!of_fold(row.box) && !of_fold(row.other)) others.push_back(row);
        const Trained model = train(others);
        for (const Row& row : rows)
            if (of_fold(row.box)) {
                boxes[row.box].push_back(judged(row, model));
                (f < 5 ? all_made : all_real).push_back(boxes[row.box].back());
            }
    }
    for (const auto& [name, those] : boxes) report(those, name, table);
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
        const Motion motion = random_motion(random, 2 * prepared.box.diagonal);
        Fragment away = fragment;
        away.mesh = moved(away.mesh, motion);
        try {
            PreparedFracture here(fragment), there(away);
            prepared.given.push_back(std::move(here));
            prepared.moved.push_back(std::move(there));
        } catch (const Error& error) {
            std::cerr << prepared.box.name << ' ' << fragment.name << " has no part in it: " << error.what() << '\n';
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
            for (std::size_t c = 0; c < row.right.size(); ++c) {
                std::vector<std::string> cells{row.box, Rows::cell(row.first), Rows::cell(row.second), row.other};
                for (const double x :
                     {row.contact, double(row.stranger), double(c), double(row.right[c]), row.log_odds[c], row.confidence})
                    cells.push_back(Rows::cell(x));
                for (const double x : row.features[c]) cells.push_back(Rows::cell(x));
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

const Registration registered("joins", "pairs of fragments of broken objects: right poses and calibration", joins);

}  // namespace

}  // namespace ostraka::experiments

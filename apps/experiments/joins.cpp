// Pairs of fragments of broken objects: accuracy of the pose found, and calibration of its confidence.
#include "boxes.h"
#include "breaks.h"
#include "experiments.h"
#include "report.h"

#include "ostraka/core/dense.h"
#include "ostraka/core/error.h"
#include "ostraka/core/json_build.h"
#include "ostraka/fracture/break_pair.h"
#include "ostraka/stats/boosted_trees.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>

namespace ostraka::experiments {

namespace {

/// Result of a pair.
struct Row {
    std::string box, other;  ///< boxes of the first and of the second fragment
    std::size_t first = 0, second = 0;
    double contact = 0;  ///< truth: share of the smaller fracture surface; 0 for unrelated fragments
    bool stranger = false;
    std::vector<bool> right;  ///< per candidate
    std::vector<std::array<double, JoinEvidence::count>> features;
    std::vector<double> log_odds;
    double confidence = 0;
    double seconds = 0;
};

Row try_pair(const Box& of, std::size_t i, const Box& with, std::size_t j, const PreparedBreak& a, const PreparedBreak& moved_b,
             const Motion& motion) {
    Row row;
    row.box = of.name;
    row.other = with.name;
    row.first = i, row.second = j;
    row.stranger = &of != &with;
    if (!row.stranger) row.contact = of.contact[std::min(i, j)][std::max(i, j)];
    const Stopwatch watch;
    const BreakPair pair = pair_breaks(a, moved_b);
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

using Features = std::array<double, JoinEvidence::count>;

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
        std::vector<std::pair<double, bool>> scored;
        for (std::size_t c = 0; c < row.features.size(); ++c) {
            scored.emplace_back(-others[fold.at(row.box)].log_odds(row_of(row.features[c])), row.right[c]);
            if (!row.right[c]) continue;
            ++joins;
            for (std::size_t k = 0; k < model.usual.size(); ++k) {
                model.usual[k] += row.features[c][k];
                model.spread[k] += row.features[c][k] * row.features[c][k];
            }
        }
        if (scored.empty()) continue;
        std::stable_sort(scored.begin(), scored.end(), [](const auto& x, const auto& y) { return x.first < y.first; });
        const double lead = scored.size() > 1 ? scored[1].first - scored[0].first : 2;
        inputs.emplace_back(1, -scored[0].first, std::min(lead, 2.0));
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
    std::vector<std::pair<double, bool>> scored;
    for (std::size_t c = 0; c < row.features.size(); ++c)
        scored.emplace_back(-model.trees.log_odds(row_of(row.features[c])), row.right[c]);
    std::stable_sort(scored.begin(), scored.end(), [](const auto& x, const auto& y) { return x.first < y.first; });
    const double lead = scored.size() > 1 ? std::min(2.0, scored[1].first - scored[0].first) : 2;
    row.confidence = scored.empty() ? 0 : 1 / (1 + std::exp(-model.pair.dot(Eigen::Vector3d(1, -scored[0].first, lead))));
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
    std::ifstream in(file);
    std::string line;
    std::vector<Row> rows;
    if (!std::getline(in, line)) fail_input(file, "cannot be read", "write it by 'ostraka_experiments joins'");
    constexpr std::size_t before = 10;  // number of leading columns
    while (std::getline(in, line)) {
        std::vector<std::string> words;
        std::istringstream text(line);
        for (std::string word; std::getline(text, word, ',');) words.push_back(word);
        if (words.size() != before + JoinEvidence::count)
            fail_input(file, "has rows of another length than features are told of today", "make it anew");
        const auto number = [&](std::size_t k) { return std::stod(words[k]); };
        if (number(6) == 0) {
            Row& row = rows.emplace_back();
            row.box = words[0];
            row.first = static_cast<std::size_t>(number(1)), row.second = static_cast<std::size_t>(number(2));
            row.other = words[3];
            row.contact = number(4);
            row.stranger = number(5) != 0;
            row.confidence = number(9);
        }
        rows.back().right.push_back(number(7) != 0);
        rows.back().log_odds.push_back(number(8));
        Features features;
        for (std::size_t k = 0; k < features.size(); ++k) features[k] = number(before + k);
        rows.back().features.push_back(features);
    }
    return rows;
}

void report(const std::vector<Row>& rows, const std::string& what, std::ostream& out) {
    std::size_t sure = 0, sure_right = 0, even = 0, even_right = 0, joins = 0, found = 0, reached = 0, strangers = 0,
                strangers_sure = 0, strangers_even = 0;
    double error = 0, seconds = 0;
    std::array<std::array<double, 3>, 10> bins{};
    for (const Row& row : rows) {
        const bool right = !row.right.empty() && row.right.front();
        seconds += row.seconds;
        if (row.confidence >= 0.9) ++sure, sure_right += right ? 1 : 0;
        if (row.confidence >= 0.5) ++even, even_right += right ? 1 : 0;
        if (row.stranger)
            ++strangers, strangers_sure += row.confidence > 0.9 ? 1 : 0, strangers_even += row.confidence >= 0.5 ? 1 : 0;
        if (row.contact > 0.1) {
            ++joins;
            found += right && row.confidence >= 0.5 ? 1 : 0;
            reached += std::find(row.right.begin(), row.right.end(), true) != row.right.end() ? 1 : 0;
        }
        auto& bin = bins[static_cast<std::size_t>(std::min(9.0, 10 * row.confidence))];
        ++bin[0], bin[1] += row.confidence, bin[2] += right ? 1 : 0;
    }
    for (const auto& bin : bins) error += std::abs(bin[1] - bin[2]);
    const auto share = [](std::size_t x, std::size_t y) {
        return y > 0 ? 100.0 * static_cast<double>(x) / static_cast<double>(y) : 0;
    };
    out << format(
               "| %s | %zu | %zu of %zu (%.1f %%) | %zu of %zu (%.1f %%) | %zu, %zu of %zu | %zu of %zu (%.0f %%), among "
               "candidates %zu | %.3f | %.2f |\n",
               what.c_str(), rows.size(), sure_right, sure, share(sure_right, sure), even_right, even, share(even_right, even),
               strangers_sure, strangers_even, strangers, found, joins, share(found, joins), reached,
               error / static_cast<double>(std::max<std::size_t>(1, rows.size())),
               seconds / static_cast<double>(std::max<std::size_t>(1, rows.size())))
        << std::flush;
}

/// Evaluates each scanned or published object by a model trained without it, and synthetic objects by five-fold
/// cross-validation.
void report_left_out(const std::vector<Row>& rows) {
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
    for (const auto& [name, those] : boxes) report(those, name, std::cout);
    report(all_made, "made, left out", std::cout);
    report(all_real, "scanned and published, left out", std::cout);
}

}  // namespace

void joins(const JoinExperiment& options) {
    std::vector<Row> all;
    std::cout
        << "| box | pairs | right of those at 0.9 | right of those at 0.5 | strangers above 0.9, at 0.5, of | true joins found | "
           "calibration error | s of processor a pair |\n|---|---|---|---|---|---|---|---|\n";
    Box before;
    std::vector<PreparedBreak> prepared_before;
    std::ostringstream csv;
    csv << "box,first,second,other,contact,stranger,candidate,right,log_odds,confidence";
    for (const std::string& name : JoinEvidence::names()) csv << ',' << name;
    csv << '\n';
    std::uint64_t seed = options.seed;
    for (const std::string& source : options.boxes) {
        Box box;
        ++seed;
        try {
            const bool found = options.facets == "found" || (options.facets == "both" && seed % 2 == 0);
            box = read_box(source, options.pieces, seed, found ? FacetChoice::found : FacetChoice::known);
        } catch (const Error& error) {
            std::cerr << source << " is left out: " << error.what() << '\n';
            continue;
        }
        Random random(seed, 9);
        std::vector<PreparedBreak> prepared, moved_ones;
        std::vector<Motion> motions;
        std::vector<std::size_t> index;
        for (std::size_t k = 0; k < box.fragments.size(); ++k) {
            const Motion motion = random_motion(random, 2 * box.diagonal);
            Fragment there = box.fragments[k];
            there.mesh = moved(there.mesh, motion);
            try {
                PreparedBreak here(box.fragments[k]), away(there);
                prepared.push_back(std::move(here));
                moved_ones.push_back(std::move(away));
            } catch (const Error& error) {
                std::cerr << box.name << ' ' << box.fragments[k].name << " has no part in it: " << error.what() << '\n';
                continue;
            }
            motions.push_back(motion);
            index.push_back(k);
        }
        std::vector<Row> rows;
        for (std::size_t i = 0; i < index.size(); ++i)
            for (std::size_t j = i + 1; j < index.size(); ++j) {
                if (options.adjacent_only && !(box.contact[index[i]][index[j]] > 0.1)) continue;
                rows.push_back(try_pair(box, index[i], box, index[j], prepared[i], moved_ones[j], motions[j]));
            }
        // Pairs with fragments of the previous box, which are unrelated.
        constexpr std::size_t met = 5;
        for (std::size_t i = 0; i < std::min(met, prepared_before.size()); ++i)
            for (std::size_t j = 0; j < std::min(met, index.size()); ++j)
                rows.push_back(try_pair(before, i, box, index[j], prepared_before[i], moved_ones[j], motions[j]));
        report(rows, box.name + box.level, std::cout);
        for (const Row& row : rows)
            for (std::size_t c = 0; c < row.right.size(); ++c) {
                csv << row.box << ',' << row.first << ',' << row.second << ',' << row.other << ',' << row.contact << ','
                    << row.stranger << ',' << c << ',' << row.right[c] << ',' << row.log_odds[c] << ',' << row.confidence;
                for (const double x : row.features[c]) csv << ',' << x;
                csv << '\n';
            }
        all.insert(all.end(), rows.begin(), rows.end());
        before = std::move(box);
        prepared_before = std::move(prepared);
    }
    if (!options.boxes.empty()) {
        report(all, "all", std::cout);
        std::filesystem::create_directories(options.output);
        write_file(Path(options.output) / "joins.csv", csv.str());
    }
    for (const std::string& file : options.rows)
        for (Row& row : read_rows(file)) all.push_back(std::move(row));
    if (options.model.empty()) return;
    if (!options.rows.empty()) report_left_out(all);
    write_model(options.model, train(all), options.recipe);
}

}  // namespace ostraka::experiments

// study moulds: groups heads by the mould they come from.
#include "operations/study/common.h"

#include "ostraka/collection/mould_study.h"
#include "ostraka/figures/dendrogram.h"
#include "ostraka/figures/heat_map.h"
#include "ostraka/figures/plot.h"
#include "ostraka/figures/table.h"
#include "ostraka/files/npy.h"

#include <fmt/core.h>

#include <algorithm>

namespace ostraka {

namespace {

struct StudyMoulds final : StudyOperation {
    void declare(Parameters& p) override {
        files.declare(p, true);
        part.declare(p);
        p.options("similarity", similarity,
                  "similarity by which heads are grouped: number of matches, number of consistent matches, distance after "
                  "registration, or a combination",
                  Choices(mould_similarity_names()));
        p.options("leave-out", leave_out, "faces with these labels are left out of the analysis, for example beards").words();
        p.options("choices", choices,
                  "also write a table of the groups that result from every similarity, method and rule for epsilon");
        compare.declare_options(p.options);
        group.declare_options(p.options);
        stability.declare_options(p.options);
        for (const char* word : {"similarity", "method", "epsilonRule"}) p.report.values(text(word));
        for (const char* figure : {"epsilon", "featureSize", "silhouette", "adjustedRandIndex"}) p.report.values(number(figure));
        p.report.values(boolean("clear"));
        p.report.table("groups", integer("group"), texts("heads"), number("stability", "", "mean Jaccard overlap"),
                       number("recovered", "", "fraction of the resamples"),
                       number("dissolved", "", "fraction of the resamples"));
        p.report.table("heads", text("name"), integer("group"), number("silhouette"), integer("secondGroup"),
                       number("relativeSize"), text("label"));
    }

    void check() const override {
        StudyOperation::check();
        part.check();
    }

    void run(Context& context, Report& report) override {
        const Collection collection = files.read(context, true);
        const PreparedCollection prepared =
            prepare_collection(collection, compare, leave_out, files.store("features"), part.parts());
        if (!prepared.waits_for.empty()) {
            report.line(fmt::format(
                "shard {}: its {} are done; once all shards have theirs, run them again for the steps that depend on all",
                files.shard(), prepared.waits_for));
            return;
        }
        const std::size_t failed = report_failures(report, collection, prepared.results);
        if (prepared.heads.size() < 2)
            fail_input(files.collection.file(), std::to_string(prepared.heads.size()) + " of its objects can be compared",
                       "a study of moulds needs at least two");
        MouldMatrices matrices =
            compare_heads(prepared.names, prepared.heads, prepared.options, files.store("pairs"), prepared.checksums);
        if (files.is_part()) {
            report.line(fmt::format("shard {}: its pairs are compared; once all shards have theirs, run it without --shard",
                                    files.shard()));
            return;
        }
        const MouldStudy study = study_moulds(std::move(matrices), similarity, group, stability);
        std::vector<std::string> answers;
        for (const std::size_t i : prepared.objects) answers.push_back(collection.objects[i].label);
        const KnownAnswers known_answers(answers);

        write_matrix("matches", study.matrices.names, study.matrices.matches);
        write_matrix("consistent", study.matrices.names, study.matrices.consistent);
        write_matrix("registration", study.matrices.names, study.matrices.registration);
        write_matrix("distances", study.matrices.names, study.distances);
        const TextTable groups = group_table(study);
        groups.write(files.output.path(), "groups", "Groups of heads by " + similarity);
        head_table(study, answers, known_answers).write(files.output.path(), "heads", "Heads and their groups");
        draw(study, known_answers.labelled > 0 ? answers : std::vector<std::string>{});
        if (choices)
            choice_table(study, answers, known_answers)
                .write(files.output.path(), "choices", "Groups by every similarity and epsilon");

        report("similarity", similarity)("method", option_text(group, "method"))("epsilonRule", group.epsilon)(
            "epsilon", study.groups.epsilon)("featureSize", prepared.options.features.size)(
            "silhouette", study.groups.silhouette)("clear", study.groups.clear);
        known_answers.add_to(report);
        const double agreement = known_answers.scorable() ? agreement_with_answers(study.groups.labels, answers) : 0;
        if (known_answers.scorable()) report("adjustedRandIndex", agreement);
        const std::string single = report_groups(report, study, answers);
        write_report(report, context.provenance());

        report.table(groups);
        const int count = study.group_count();
        report.line(fmt::format("{} of {} heads at epsilon {}, mean silhouette {}{}",
                                counted(static_cast<std::size_t>(count), "group"), answers.size(),
                                number(study.groups.epsilon, 3), number(study.groups.silhouette, 3),
                                known_answers.scorable() ? ", adjusted Rand index " + number(agreement, 4) : ""));
        known_answers.report_result(report);
        if (!single.empty()) report.line("belongs to no group: " + single);
        if (!study.groups.clear) {
            const Eigen::MatrixXd distances = mould_distances(study.matrices, "consistent");
            const auto n = static_cast<double>(distances.rows());
            report.line(
                fmt::format("the groups are not clearly separated: all heads come from one mould, or each from its own mould; "
                            "the mean distance by consistent matches is {} (near 1: one mould per head; small: one mould)",
                            number(distances.sum() / (n * (n - 1)), 3)));
            report.answer_no();
        }
        if (failed > 0) report.line(std::to_string(failed) + " objects were left out");
    }

    /// Returns the heads that form a group of their own.
    [[nodiscard]] std::string report_groups(Report& report, const MouldStudy& study,
                                            const std::vector<std::string>& answers) const {
        std::string single;
        std::size_t group_number = 0;
        for (const MouldGroupSummary& summary : summarise_groups(study)) {
            const ClusterStability& resampled = study.stability[group_number++];
            Report::Row row = report.row("groups")("group", group_number)("heads", summary.members);
            if (summary.members.size() == 1) single += (single.empty() ? "" : ", ") + summary.members.front();
            else if (resampled.resamples > 0)
                row("stability", resampled.jaccard)("recovered", resampled.recovered)("dissolved", resampled.dissolved);
        }
        for (std::size_t i = 0; i < answers.size(); ++i) {
            Report::Row row = report.row("heads")("name", study.matrices.names[i])("group", study.groups.labels[i] + 1)(
                "silhouette", study.groups.head_silhouettes[i]);
            if (const int second = study.second_group(i).first; second >= 0) row("secondGroup", second + 1);
            if (compare.consistent.shrinkage > 0) row("relativeSize", study.sizes[i]);
            if (!answers[i].empty()) row("label", answers[i]);
        }
        return single;
    }

    void write_report(const Report& report, const Provenance& provenance) const {
        Json document = json_document("mould-study");
        auto& allocator = document.GetAllocator();
        JsonValue result(report.result(), allocator), failed(result["failed"], allocator);
        result.EraseMember("failed");
        add_members(result, allocator, "failed", std::move(failed));  // last member of the file
        add_members(document, allocator, "provenance", provenance.to_json(allocator), "result", std::move(result));
        validate(document, "mould-study", "moulds.json");
        write_json(files.in("moulds.json"), document);
    }

    void write_matrix(const std::string& name, const std::vector<std::string>& names, const Eigen::MatrixXd& m) const {
        const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows = m;
        write_npy(files.in(name + ".npy"), std::span<const double>(rows.data(), static_cast<std::size_t>(rows.size())),
                  {static_cast<std::size_t>(m.rows()), static_cast<std::size_t>(m.cols())});
        std::vector<std::string> columns{"name"};
        columns.insert(columns.end(), names.begin(), names.end());
        TextTable table(columns);
        for (Eigen::Index i = 0; i < m.rows(); ++i) {
            std::vector<TableCell> cells{names[static_cast<std::size_t>(i)]};
            for (Eigen::Index j = 0; j < m.cols(); ++j) cells.push_back(number_cell(m(i, j), 8));
            table.add(cells);
        }
        write_file(files.in(name + ".csv"), table.csv());
    }

    /// One row per group.
    static TextTable group_table(const MouldStudy& study) {
        TextTable table({"group", "heads", "distance within", "nearest group", "distance to it", "silhouette", "stability",
                         "dissolved", "members"});
        std::size_t group = 0;
        for (const MouldGroupSummary& summary : summarise_groups(study)) {
            const ClusterStability& stability = study.stability[group++];
            const bool resampled = stability.resamples > 0 && summary.members.size() > 1;
            const auto if_resampled = [&](double value) { return resampled ? std::optional(value) : std::nullopt; };
            table.add({std::to_string(group), std::to_string(summary.members.size()), number_cell(summary.within, 3),
                       number_cell(summary.nearest ? std::optional<double>(*summary.nearest + 1) : std::nullopt, 6),
                       number_cell(summary.to_nearest, 3), number_cell(summary.silhouette, 3),
                       number_cell(if_resampled(stability.jaccard), 3), percent_cell(if_resampled(stability.dissolved), 0),
                       joined(summary.members, " ")});
        }
        return table;
    }

    /// One row per head.
    [[nodiscard]] TextTable head_table(const MouldStudy& study, const std::vector<std::string>& answers,
                                       const KnownAnswers& known_answers) const {
        const bool sizes = compare.consistent.shrinkage > 0;
        std::vector<std::string> columns{"head", "group", "silhouette", "second group", "distance to own", "distance to second"};
        if (sizes) columns.emplace_back("relative size");
        if (known_answers.labelled > 0) columns.emplace_back("truth");
        TextTable table(columns);
        for (std::size_t i = 0; i < answers.size(); ++i) {
            const auto [second, distance] = study.second_group(i);
            std::vector<TableCell> cells{study.matrices.names[i], std::to_string(study.groups.labels[i] + 1),
                                         number_cell(study.groups.head_silhouettes[i], 3)};
            cells.push_back(number_cell(second < 0 ? std::nullopt : std::optional<double>(second + 1), 6));
            cells.push_back(number_cell(study.mean_distance(i, study.groups.labels[i]), 3));
            cells.push_back(number_cell(second < 0 ? std::nullopt : std::optional(distance), 3));
            if (sizes) cells.push_back(number_cell(study.sizes[i], 4));
            if (known_answers.labelled > 0) cells.emplace_back(answers[i]);
            table.add(cells);
        }
        return table;
    }

    /// One row per similarity, method and epsilon.
    [[nodiscard]] TextTable choice_table(const MouldStudy& study, const std::vector<std::string>& answers,
                                         const KnownAnswers& known_answers) const {
        std::vector<std::string> columns{"similarity", "method", "epsilon", "value", "groups", "silhouette"};
        if (known_answers.scorable()) columns.emplace_back("adjusted Rand index");
        TextTable table(columns);
        for (const auto& similarity_name : mould_similarity_names()) {
            const Eigen::MatrixXd distances = mould_distances(study.matrices, similarity_name);
            for (const char* method : {"linkage", "dbscan", "embedding"}) {
                for (const char* epsilon : {"0.1", "knn", "volume", "knee", "silhouette", "nested"}) {
                    GroupOptions options = group;
                    set_option(options, "method", method);
                    options.epsilon = epsilon;
                    if (options.epsilon == "volume" && options.method != GroupOptions::Method::embedding) continue;
                    const MouldGroups groups = group_heads(distances, options);
                    const int count = *std::max_element(groups.labels.begin(), groups.labels.end()) + 1;
                    std::vector<TableCell> cells{similarity_name,
                                                 method,
                                                 epsilon,
                                                 number_cell(groups.epsilon, 3),
                                                 std::to_string(count),
                                                 number_cell(groups.silhouette, 3)};
                    if (known_answers.scorable()) cells.push_back(fixed_cell(agreement_with_answers(groups.labels, answers), 3));
                    table.add(cells);
                }
            }
        }
        return table;
    }

    void draw(const MouldStudy& study, const std::vector<std::string>& truth) const {
        const auto& names = study.matrices.names;
        const std::vector<int> order = leaf_order(study.groups.tree);
        HeatMap map;
        map.title = fmt::format("Distances by {}, heads in the order of the tree", similarity);
        map.label = "distance";
        map.minimum = 0, map.maximum = 1;
        const auto n = static_cast<Eigen::Index>(order.size());
        map.values.resize(n, n);
        for (Eigen::Index i = 0; i < n; ++i) {
            const auto head = static_cast<std::size_t>(order[static_cast<std::size_t>(i)]);
            map.rows.push_back(names[head]);
            map.groups.push_back(study.groups.labels[head]);
            for (Eigen::Index j = 0; j < n; ++j)
                map.values(i, j) = study.distances(order[static_cast<std::size_t>(i)], order[static_cast<std::size_t>(j)]);
        }
        map.columns = map.rows;
        write_plot(files.plot("distances"), map);

        Dendrogram tree;
        tree.title = group.method == GroupOptions::Method::linkage ? "Average linkage of the distances"
                                                                   : "Single linkage, which DBSCAN uses";
        tree.tree = study.groups.tree;
        tree.names = names;
        tree.groups = study.groups.labels;
        if (group.method != GroupOptions::Method::embedding) {  // epsilon of an embedding is not a distance in this tree
            tree.cut = study.groups.epsilon;
            tree.cut_label = "epsilon " + significant(study.groups.epsilon, 3);
        }
        tree.classes = truth;
        write_plot(files.plot("dendrogram"), tree);

        const auto& coordinates = study.groups.coordinates;
        for (int second = 1; second < std::min<int>(static_cast<int>(coordinates.cols()), 3); ++second) {
            Plot plot;
            plot.title = "Spectral embedding of the distances";
            plot.equal = true;
            plot.width = plot.height = 640;
            plot.x.label = "eigenvector " + std::to_string(second == 1 ? 1 : 2);
            plot.y.label = "eigenvector " + std::to_string(second + 1);
            for (int group_index = 0; group_index < study.group_count(); ++group_index) {
                PlotSeries series{.name = "group " + std::to_string(group_index + 1), .joined = false};
                for (std::size_t i = 0; i < names.size(); ++i) {
                    if (study.groups.labels[i] != group_index) continue;
                    const auto row = static_cast<Eigen::Index>(i);
                    series.points.push_back({coordinates(row, second == 1 ? 0 : 1), coordinates(row, second)});
                    series.labels.push_back(names[i]);
                }
                plot.series.push_back(std::move(series));
            }
            write_plot(files.plot("embedding-" + std::string(second == 1 ? "1-2" : "2-3")), plot);
        }
    }

    std::string similarity = "combined";
    std::vector<int> leave_out;
    bool choices = false;
    StudyPart part;
    CompareOptions compare;
    GroupOptions group;
    StabilityOptions stability;
};

}  // namespace

std::unique_ptr<Operation> make_study_moulds() { return make<StudyMoulds>(); }

}  // namespace ostraka

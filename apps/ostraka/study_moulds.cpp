#include "study.h"

#include "ostraka/collection/moulds.h"
#include "ostraka/core/npy.h"
#include "ostraka/report/dendrogram.h"
#include "ostraka/report/heat_map.h"
#include "ostraka/report/plot.h"
#include "ostraka/report/table.h"
#include "ostraka/stats/scores.h"

#include <algorithm>
#include <iostream>
#include <map>
#include <memory>

namespace ostraka::app {

namespace {

struct MouldInput {
    StudyFiles files;
    std::string similarity = "combined";
    std::vector<int> leave_out;
    bool choices = false;
    CompareOptions compare;
    GroupOptions group;
    StabilityOptions stability;
};

/// What is known at the end.
struct MouldAnswer {
    MouldMatrices matrices;
    Eigen::MatrixXd distances;
    MouldGroups groups;
    std::vector<ClusterStability> stability;
    std::vector<double> sizes;
    std::vector<std::string> labels;  ///< known answers, empty where there is none
    [[nodiscard]] KnownAnswers known() const { return KnownAnswers(labels); }
    [[nodiscard]] int group_count() const {
        return groups.labels.empty() ? 0 : *std::max_element(groups.labels.begin(), groups.labels.end()) + 1;
    }
    /// Over the heads whose answer is known.
    [[nodiscard]] double agreement(const std::vector<int>& found) const {
        std::map<std::string, int> numbers;
        std::vector<int> some, truth;
        for (std::size_t i = 0; i < labels.size(); ++i) {
            if (labels[i].empty()) continue;
            some.push_back(found[i]);
            truth.push_back(numbers.try_emplace(labels[i], static_cast<int>(numbers.size())).first->second);
        }
        return adjusted_rand_index(some, truth);
    }
    /// Mean distance of a head to the members of a group, itself left out; NaN for none.
    [[nodiscard]] double mean_distance(std::size_t head, int group) const {
        double sum = 0;
        int count = 0;
        for (std::size_t j = 0; j < labels.size(); ++j) {
            if (groups.labels[j] != group || j == head) continue;
            sum += distances(static_cast<Eigen::Index>(head), static_cast<Eigen::Index>(j));
            ++count;
        }
        return count > 0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
    }
    /// The nearest group that is not its own and the mean distance to it; -1 for none.
    [[nodiscard]] std::pair<int, double> second_group(std::size_t head) const {
        std::pair<int, double> best{-1, 0};
        for (int group = 0; group < group_count(); ++group) {
            if (group == groups.labels[head]) continue;
            const double d = mean_distance(head, group);
            if (best.first < 0 || d < best.second) best = {group, d};
        }
        return best;
    }
};

void write_matrix(const StudyFiles& files, const std::string& name, const std::vector<std::string>& names,
                  const Eigen::MatrixXd& m) {
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

std::vector<std::string> truth_of(const MouldAnswer& answer) {
    return answer.known().labelled > 0 ? answer.labels : std::vector<std::string>{};
}

void draw(const MouldInput& input, const MouldAnswer& answer) {
    const auto& names = answer.matrices.names;
    const std::vector<int> order = leaf_order(answer.groups.tree);
    HeatMap map;
    map.title = "Distances by " + input.similarity + ", heads in the order of the tree";
    map.label = "distance";
    map.minimum = 0, map.maximum = 1;
    const auto n = static_cast<Eigen::Index>(order.size());
    map.values.resize(n, n);
    for (Eigen::Index i = 0; i < n; ++i) {
        const auto head = static_cast<std::size_t>(order[static_cast<std::size_t>(i)]);
        map.rows.push_back(names[head]);
        map.groups.push_back(answer.groups.labels[head]);
        for (Eigen::Index j = 0; j < n; ++j)
            map.values(i, j) = answer.distances(order[static_cast<std::size_t>(i)], order[static_cast<std::size_t>(j)]);
    }
    map.columns = map.rows;
    write_plot(input.files.plot("distances"), map);

    Dendrogram tree;
    tree.title = input.group.method == "linkage" ? "Average linkage of the distances" : "Single linkage, which DBSCAN goes by";
    tree.tree = answer.groups.tree;
    tree.names = names;
    tree.groups = answer.groups.labels;
    if (input.group.method != "embedding") {  // whose epsilon is no distance of this tree
        tree.cut = answer.groups.epsilon;
        tree.cut_label = "epsilon " + significant(answer.groups.epsilon, 3);
    }
    tree.classes = truth_of(answer);
    write_plot(input.files.plot("dendrogram"), tree);

    const auto& places = answer.groups.coordinates;
    for (int second = 1; second < std::min<int>(static_cast<int>(places.cols()), 3); ++second) {
        Plot plot;
        plot.title = "Spectral embedding of the distances";
        plot.equal = true;
        plot.width = plot.height = 640;
        plot.x.label = "eigenvector " + std::to_string(second == 1 ? 1 : 2);
        plot.y.label = "eigenvector " + std::to_string(second + 1);
        for (int group = 0; group < answer.group_count(); ++group) {
            PlotSeries series;
            series.joined = false;
            series.name = "group " + std::to_string(group + 1);
            for (std::size_t i = 0; i < names.size(); ++i) {
                if (answer.groups.labels[i] != group) continue;
                const auto row = static_cast<Eigen::Index>(i);
                series.points.push_back({places(row, second == 1 ? 0 : 1), places(row, second)});
                series.labels.push_back(names[i]);
            }
            plot.series.push_back(std::move(series));
        }
        write_plot(input.files.plot("embedding-" + std::string(second == 1 ? "1-2" : "2-3")), plot);
    }
}

/// One row a group.
TextTable group_table(const MouldAnswer& answer) {
    TextTable table({"group", "heads", "distance within", "nearest group", "distance to it", "silhouette", "stability",
                     "dissolved", "members"});
    for (int group = 0; group < answer.group_count(); ++group) {
        double within = 0, silhouette = 0;
        int size = 0, pairs = 0;
        std::vector<double> to(static_cast<std::size_t>(answer.group_count()), 0);
        std::vector<int> counts(to.size(), 0);
        std::string members;
        for (std::size_t i = 0; i < answer.labels.size(); ++i) {
            if (answer.groups.labels[i] != group) continue;
            ++size;
            silhouette += answer.groups.head_silhouettes[i];
            members += (members.empty() ? "" : " ") + answer.matrices.names[i];
            for (std::size_t j = 0; j < answer.labels.size(); ++j) {
                const double d = answer.distances(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
                if (answer.groups.labels[j] != group)
                    to[static_cast<std::size_t>(answer.groups.labels[j])] += d,
                        ++counts[static_cast<std::size_t>(answer.groups.labels[j])];
                else if (j != i) within += d, ++pairs;
            }
        }
        int nearest = -1;
        for (std::size_t g = 0; g < to.size(); ++g) {
            if (counts[g] == 0) continue;
            to[g] /= counts[g];
            if (nearest < 0 || to[g] < to[static_cast<std::size_t>(nearest)]) nearest = static_cast<int>(g);
        }
        const auto& stability = answer.stability[static_cast<std::size_t>(group)];
        const auto if_known = [](bool known, double value) { return known ? std::optional(value) : std::nullopt; };
        const bool alone = nearest<0, resampled = stability.resamples> 0 && size > 1;
        table.add({std::to_string(group + 1), std::to_string(size), number_cell(if_known(pairs > 0, within / pairs), 3),
                   number_cell(if_known(!alone, nearest + 1), 6),
                   number_cell(if_known(!alone, alone ? 0 : to[static_cast<std::size_t>(nearest)]), 3),
                   number_cell(silhouette / size, 3), number_cell(if_known(resampled, stability.jaccard), 3),
                   percent_cell(if_known(resampled, stability.dissolved), 0), members});
    }
    return table;
}

/// One row a head.
TextTable head_table(const MouldAnswer& answer, bool sizes) {
    std::vector<std::string> columns{"head", "group", "silhouette", "second group", "distance to own", "distance to second"};
    if (sizes) columns.emplace_back("relative size");
    if (answer.known().labelled > 0) columns.emplace_back("truth");
    TextTable table(columns);
    for (std::size_t i = 0; i < answer.labels.size(); ++i) {
        const auto [second, distance] = answer.second_group(i);
        const double own = answer.mean_distance(i, answer.groups.labels[i]);
        std::vector<TableCell> cells{answer.matrices.names[i], std::to_string(answer.groups.labels[i] + 1),
                                     number_cell(answer.groups.head_silhouettes[i], 3)};
        cells.push_back(number_cell(second < 0 ? std::nullopt : std::optional<double>(second + 1), 6));
        cells.push_back(number_cell(own, 3));
        cells.push_back(number_cell(second < 0 ? std::nullopt : std::optional(distance), 3));
        if (sizes) cells.push_back(number_cell(answer.sizes[i], 4));
        if (answer.known().labelled > 0) cells.emplace_back(answer.labels[i]);
        table.add(cells);
    }
    return table;
}

/// Every similarity, method and epsilon.
TextTable choice_table(const MouldInput& input, const MouldAnswer& answer) {
    std::vector<std::string> columns{"similarity", "method", "epsilon", "value", "groups", "silhouette"};
    if (answer.known().scorable()) columns.emplace_back("adjusted Rand index");
    TextTable table(columns);
    for (const auto& similarity : mould_similarities()) {
        const Eigen::MatrixXd distances = mould_distances(answer.matrices, similarity);
        for (const char* method : {"linkage", "dbscan", "embedding"}) {
            for (const char* epsilon : {"0.1", "knn", "volume", "knee", "silhouette", "nested"}) {
                GroupOptions options = input.group;
                options.method = method;
                options.epsilon = epsilon;
                if (options.epsilon == "volume" && options.method != "embedding") continue;
                const MouldGroups groups = group_heads(distances, options);
                const int count = *std::max_element(groups.labels.begin(), groups.labels.end()) + 1;
                std::vector<TableCell> cells{similarity,
                                             method,
                                             epsilon,
                                             number_cell(groups.epsilon, 3),
                                             std::to_string(count),
                                             number_cell(groups.silhouette, 3)};
                if (answer.known().scorable()) cells.push_back(fixed_cell(answer.agreement(groups.labels), 3));
                table.add(cells);
            }
        }
    }
    return table;
}

JsonValue report_of(const MouldInput& input, const MouldAnswer& answer, double size, JsonAllocator& allocator) {
    JsonValue result(rapidjson::kObjectType), groups(rapidjson::kArrayType), heads(rapidjson::kArrayType);
    add_member(result, "similarity", input.similarity, allocator);
    add_member(result, "method", input.group.method, allocator);
    add_member(result, "epsilonRule", input.group.epsilon, allocator);
    add_member(result, "epsilon", JsonValue(answer.groups.epsilon), allocator);
    add_member(result, "featureSize", JsonValue(size), allocator);
    add_member(result, "silhouette", JsonValue(answer.groups.silhouette), allocator);
    add_member(result, "clear", JsonValue(answer.groups.clear), allocator);
    answer.known().add_to(result, allocator);
    if (answer.known().scorable())
        add_member(result, "adjustedRandIndex", JsonValue(answer.agreement(answer.groups.labels)), allocator);
    for (int group = 0; group < answer.group_count(); ++group) {
        JsonValue entry(rapidjson::kObjectType), members(rapidjson::kArrayType);
        add_member(entry, "group", JsonValue(group + 1), allocator);
        for (std::size_t i = 0; i < answer.labels.size(); ++i)
            if (answer.groups.labels[i] == group) members.PushBack(json_string(answer.matrices.names[i], allocator), allocator);
        add_member(entry, "heads", std::move(members), allocator);
        const auto& stability = answer.stability[static_cast<std::size_t>(group)];
        if (stability.resamples > 0 && entry["heads"].Size() > 1) {
            add_member(entry, "stability", JsonValue(stability.jaccard), allocator);
            add_member(entry, "recovered", JsonValue(stability.recovered), allocator);
            add_member(entry, "dissolved", JsonValue(stability.dissolved), allocator);
        }
        groups.PushBack(std::move(entry), allocator);
    }
    for (std::size_t i = 0; i < answer.labels.size(); ++i) {
        JsonValue entry(rapidjson::kObjectType);
        add_member(entry, "name", answer.matrices.names[i], allocator);
        add_member(entry, "group", JsonValue(answer.groups.labels[i] + 1), allocator);
        add_member(entry, "silhouette", JsonValue(answer.groups.head_silhouettes[i]), allocator);
        const auto [second, distance] = answer.second_group(i);
        if (second >= 0) add_member(entry, "secondGroup", JsonValue(second + 1), allocator);
        if (input.compare.consistent.shrinkage > 0) add_member(entry, "relativeSize", JsonValue(answer.sizes[i]), allocator);
        if (!answer.labels[i].empty()) add_member(entry, "label", answer.labels[i], allocator);
        heads.PushBack(std::move(entry), allocator);
    }
    add_member(result, "groups", std::move(groups), allocator);
    add_member(result, "heads", std::move(heads), allocator);
    return result;
}

/// The heads that are alone in their group; empty for none.
std::string single_heads(const MouldAnswer& answer) {
    std::string names;
    for (std::size_t i = 0; i < answer.labels.size(); ++i)
        if (std::count(answer.groups.labels.begin(), answer.groups.labels.end(), answer.groups.labels[i]) == 1)
            names += (names.empty() ? "" : ", ") + answer.matrices.names[i];
    return names;
}

/// Of a matrix with zeros on its diagonal.
double mean_of_pairs(const Eigen::MatrixXd& distances) {
    const auto n = static_cast<double>(distances.rows());
    return n > 1 ? distances.sum() / (n * (n - 1)) : 0;
}

int run(const MouldInput& input, const Session& session) {
    Provenance provenance;
    provenance.command = "study moulds";
    provenance.options.emplace_back("similarity", input.similarity);
    for (const int label : input.leave_out) provenance.options.emplace_back("leave-out", std::to_string(label));
    for (const auto& list : {list_options(input.compare), list_options(input.group), list_options(input.stability)})
        provenance.options.insert(provenance.options.end(), list.begin(), list.end());
    const Collection collection = input.files.read(session, provenance);
    const PreparedCollection prepared =
        prepare_collection(collection, input.compare, input.leave_out, input.files.store("features"));
    Json document;
    document.SetObject();
    auto& allocator = document.GetAllocator();
    JsonValue failures(rapidjson::kObjectType);
    const std::size_t failed = report_failures(session, collection, prepared.results, failures, allocator);
    if (prepared.heads.size() < 2)
        throw Error(ErrorKind::input, input.files.collection,
                    std::to_string(prepared.heads.size()) + " of its objects can be compared",
                    "a study of moulds needs at least two");
    MouldAnswer answer;
    answer.matrices =
        compare_heads(prepared.names, prepared.heads, prepared.options, input.files.store("pairs"), prepared.checksums);
    answer.distances = mould_distances(answer.matrices, input.similarity);
    answer.groups = group_heads(answer.distances, input.group);
    answer.stability = group_stability(answer.distances, answer.groups, input.group, input.stability);
    answer.sizes = relative_sizes(answer.matrices, answer.groups.labels);
    for (const std::size_t i : prepared.objects) answer.labels.push_back(collection.objects[i].label);

    const auto& names = answer.matrices.names;
    write_matrix(input.files, "matches", names, answer.matrices.matches);
    write_matrix(input.files, "consistent", names, answer.matrices.consistent);
    write_matrix(input.files, "registration", names, answer.matrices.registration);
    write_matrix(input.files, "distances", names, answer.distances);
    const bool sizes = input.compare.consistent.shrinkage > 0;
    const TextTable groups = group_table(answer), heads = head_table(answer, sizes);
    groups.write(input.files.output, "groups", "Groups of heads by " + input.similarity);
    heads.write(input.files.output, "heads", "Heads and their groups");
    draw(input, answer);
    if (input.choices) choice_table(input, answer).write(input.files.output, "choices", "Groups by every similarity and epsilon");

    JsonValue result = report_of(input, answer, prepared.options.features.size, allocator);
    add_member(result, "failed", std::move(failures["failed"]), allocator);
    add_member(document, "format", "ostraka-mould-study", allocator);
    add_member(document, "version", JsonValue(1), allocator);
    add_member(document, "provenance", provenance.to_json(allocator), allocator);
    JsonValue copy(result, allocator);
    add_member(document, "result", std::move(copy), allocator);
    validate(document, "mould-study", "moulds.json");
    write_json(input.files.in("moulds.json"), document);

    if (session.json) {
        session.print_report(provenance, document, result);
    } else {
        std::cout << groups.plain() << answer.group_count() << (answer.group_count() == 1 ? " group of " : " groups of ")
                  << names.size() << " heads at epsilon " << number(answer.groups.epsilon, 3) << ", mean silhouette "
                  << number(answer.groups.silhouette, 3);
        if (answer.known().scorable()) std::cout << ", adjusted Rand index " << number(answer.agreement(answer.groups.labels), 4);
        std::cout << "\n" << answer.known().words();
        const std::string single = single_heads(answer);
        if (!single.empty()) std::cout << "belongs to no group: " << single << '\n';
        if (!answer.groups.clear)
            std::cout
                << "the groups do not stand out: one mould, or each head its own; the mean distance by consistent matches is "
                << number(mean_of_pairs(mould_distances(answer.matrices, "consistent")), 3)
                << " (near 1: each its own; small: one mould)\n";
        if (failed > 0) std::cout << failed << " objects were left out\n";
    }
    return answer.groups.clear ? done : answer_is_no;
}

}  // namespace

void add_study_moulds(CLI::App& study, Session& session) {
    auto input = std::make_shared<MouldInput>();
    CLI::App* command =
        session.add(study, "moulds", "which heads come from one mould", [input, &session] { return run(*input, session); });
    add_study_files(command, input->files, true);
    command->add_option("--similarity", input->similarity, "what the groups are found by")
        ->check(CLI::IsMember(mould_similarities()))
        ->capture_default_str();
    command->add_option("--leave-out", input->leave_out, "labels of faces that are left out, such as beards")->delimiter(',');
    command->add_flag("--choices", input->choices, "write a table of the groups by every similarity, method and epsilon as well");
    add_flags(command, input->compare);
    add_flags(command, input->group);
    add_flags(command, input->stability);
}

}  // namespace ostraka::app

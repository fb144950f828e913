// ostraka study proportions: which proportions of a collection are fixed.
#include "commands.h"
#include "study.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/collection/proportion_graph.h"
#include "ostraka/core/text.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/report/dendrogram.h"
#include "ostraka/report/heat_map.h"
#include "ostraka/report/plot.h"
#include "ostraka/report/table.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <memory>

namespace ostraka::app {

namespace {

/// "low to high", two columns in the CSV.
TableCell interval_cell(const std::optional<Interval>& interval, double factor, int digits_shown) {
    if (!interval) return {"-", {"", ""}};
    const double low = factor * interval->low, high = factor * interval->high;
    return {significant(low, digits_shown) + " to " + significant(high, digits_shown), {digits(low), digits(high)}};
}
/// The same of shares, which are percentages for people.
TableCell share_interval_cell(const std::optional<Interval>& interval) {
    if (!interval) return {"-", {"", ""}};
    return {fixed(100 * interval->low, 1) + " to " + percent(interval->high), {digits(interval->low), digits(interval->high)}};
}
TableColumn variation_interval_column() { return {"cv interval", {"cv low", "cv high"}}; }

/// Table 3.1: measures, then ratios in per cent, each with its uncertainty.
TextTable table_3_1(const ProportionStudy& study) {
    TextTable table({"measure",
                     "unit",
                     "objects",
                     "average",
                     "min",
                     "max",
                     "median",
                     "st. deviation",
                     {"95 % interval", {"st. deviation low", "st. deviation high"}},
                     "cv",
                     variation_interval_column()});
    const auto add = [&](const MeasureRow& row, double factor, const std::string& unit) {
        const std::optional<Summary>& s = row.summary;
        std::vector<TableCell> cells{row.name, unit, std::to_string(s ? s->count : 0)};
        for (const auto& value : {s ? std::optional(s->mean) : std::nullopt, s ? std::optional(s->min) : std::nullopt,
                                  s ? std::optional(s->max) : std::nullopt, s ? std::optional(s->median) : std::nullopt,
                                  s ? s->deviation : std::nullopt})
            cells.push_back(number_cell(value ? std::optional(factor * *value) : std::nullopt, 4));
        cells.push_back(interval_cell(row.deviation_interval, factor, 3));
        cells.push_back(percent_cell(s ? s->variation : std::nullopt));
        cells.push_back(share_interval_cell(row.variation_interval));
        table.add(cells);
    };
    for (const MeasureRow& row : study.measures) add(row, 1, row.unit);
    for (const RatioRow& ratio : study.ratios) add(ratio.row, 100, "%");
    return table;
}

std::vector<const RatioRow*> by_deviation(const ProportionStudy& study) {
    std::vector<const RatioRow*> rows;
    for (const RatioRow& ratio : study.ratios)
        if (ratio.row.summary && ratio.row.summary->count > 1) rows.push_back(&ratio);
    std::stable_sort(rows.begin(), rows.end(), [](const auto* a, const auto* b) { return a->log_deviation < b->log_deviation; });
    return rows;
}

TextTable verdicts(const ProportionStudy& study, double false_discoveries) {
    TextTable table({"ratio", "objects", "average", "cv", variation_interval_column(), "p pairing", "p others", "p size", "q",
                     "verdict", "failed"});
    for (const RatioRow* ratio : by_deviation(study)) {
        const Summary& s = *ratio->row.summary;
        table.add({ratio->row.name, std::to_string(s.count), number_cell(s.mean, 4), percent_cell(s.variation),
                   share_interval_cell(ratio->row.variation_interval), number_cell(ratio->p_pairing, 2),
                   number_cell(ratio->p_others, 2), number_cell(ratio->p_size, 2), number_cell(ratio->q, 2),
                   to_string(ratio->fixedness), not_fixed_because(*ratio, false_discoveries)});
    }
    return table;
}

/// Coefficients of variation with their intervals, a colour a verdict.
Plot variation_plot(const ProportionStudy& study, const std::string& title) {
    Plot plot{title, {""}, {"coefficient of variation, %"}, {}};
    std::vector<const RatioRow*> rows = by_deviation(study);
    if (rows.size() > 60) rows.resize(60);
    const Fixedness order[] = {Fixedness::fixed, Fixedness::stable, Fixedness::with_size, Fixedness::free, Fixedness::unknown};
    for (const RatioRow* row : rows) plot.x.names.push_back(row->row.name);
    for (std::size_t k = 0; k < std::size(order); ++k) {
        PlotSeries series{to_string(order[k]), {}};
        series.joined = false;
        series.colour = std::array<std::size_t, 5>{2, 0, 5, 6, 3}[k];
        for (std::size_t i = 0; i < rows.size(); ++i) {
            if (rows[i]->fixedness != order[k] || !rows[i]->row.summary->variation) continue;
            series.points.push_back({static_cast<double>(i), 100 * *rows[i]->row.summary->variation});
            const auto& interval = rows[i]->row.variation_interval;
            series.intervals.push_back(interval ? std::optional(std::array{100 * interval->low, 100 * interval->high})
                                                : std::nullopt);
        }
        if (!series.points.empty()) plot.series.push_back(std::move(series));
    }
    plot.y.minimum = 0;
    plot.width = std::max(760, static_cast<int>(260 + 22 * rows.size()));
    plot.height = 560;
    return plot;
}

JsonValue interval_json(const std::optional<Interval>& interval, JsonAllocator& allocator) {
    if (!interval) return {};
    JsonValue list(rapidjson::kArrayType);
    list.PushBack(interval->low, allocator).PushBack(interval->high, allocator);
    return list;
}
JsonValue optional_json(const std::optional<double>& value) { return value ? JsonValue(*value) : JsonValue(); }

JsonValue row_json(const MeasureRow& row, JsonAllocator& allocator) {
    JsonValue object(rapidjson::kObjectType);
    add_member(object, "name", row.name, allocator);
    if (!row.unit.empty()) add_member(object, "unit", row.unit, allocator);
    add_member(object, "objects", JsonValue(static_cast<std::uint64_t>(row.summary ? row.summary->count : 0)), allocator);
    if (!row.summary) return object;
    const Summary& s = *row.summary;
    for (const auto& [name, value] : {std::pair{"average", s.mean}, {"min", s.min}, {"max", s.max}, {"median", s.median}})
        add_member(object, name, JsonValue(value), allocator);
    add_member(object, "deviation", optional_json(s.deviation), allocator);
    add_member(object, "deviationInterval", interval_json(row.deviation_interval, allocator), allocator);
    add_member(object, "variation", optional_json(s.variation), allocator);
    add_member(object, "variationInterval", interval_json(row.variation_interval, allocator), allocator);
    if (row.own_deviation) add_member(object, "ownDeviation", JsonValue(*row.own_deviation), allocator);
    return object;
}

JsonValue strings_json(const std::vector<std::string>& list, JsonAllocator& allocator) {
    JsonValue array(rapidjson::kArrayType);
    for (const auto& text : list) array.PushBack(json_string(text, allocator), allocator);
    return array;
}

struct StudyProportions {
    StudyFiles files;
    std::string measures, mesh, annotations, graph, graph_in, annotations_out;
    ProportionOptions options;
    ProposalOptions proposals;

    int run(const Session& session) const {
        const bool from_table = extension(files.collection) == ".csv";
        check(from_table);
        Provenance provenance{"study proportions", list_options(options), {}};
        Json document(rapidjson::kObjectType);
        auto& allocator = document.GetAllocator();
        JsonValue result(rapidjson::kObjectType);
        MeasureDefinitions definitions;
        MeasureTable table;
        std::vector<std::string> notes;
        std::size_t failures = 0;
        if (from_table) {
            provenance.add_input(files.collection);
            files.check();
            table = read_measure_table(files.collection);
            files.open(provenance);
            add_member(result, "failed", JsonValue(rapidjson::kArrayType), allocator);
        } else {
            provenance.add_input(measures);
            definitions = read_measure_definitions(measures);
            table = take(session, provenance, definitions, result, allocator, notes, failures);
        }
        ProportionStudy study = study_proportions(table, options);
        notes.insert(notes.end(), study.notes.begin(), study.notes.end());
        for (const auto& note : notes) session.note("note: " + note);

        write_file(files.in("values.csv"), measure_table_to_csv(table));
        table_3_1(study).write(files.output, "table-3-1", "Measures and their ratios");
        verdicts(study, options.false_discoveries)
            .write(files.output, "ratios", "Ratios by their variation, and whether they are fixed");
        draw(session, study);

        JsonValue rows(rapidjson::kArrayType), ratios(rapidjson::kArrayType);
        for (const MeasureRow& row : study.measures) rows.PushBack(row_json(row, allocator), allocator);
        std::size_t count = 0;
        for (const RatioRow& ratio : study.ratios) {
            JsonValue object = row_json(ratio.row, allocator);
            add_member(object, "numerator", study.measures[ratio.numerator].name, allocator);
            add_member(object, "denominator", study.measures[ratio.denominator].name, allocator);
            add_member(object, "logDeviation", JsonValue(ratio.log_deviation), allocator);
            if (ratio.row.summary)
                add_member(object, "range", interval_json(Interval{ratio.low, ratio.high}, allocator), allocator);
            add_member(object, "pPairing", JsonValue(ratio.p_pairing), allocator);
            add_member(object, "pOthers", JsonValue(ratio.p_others), allocator);
            add_member(object, "pSize", optional_json(ratio.p_size), allocator);
            add_member(object, "q", JsonValue(ratio.q), allocator);
            add_member(object, "verdict", to_string(ratio.fixedness), allocator);
            ratios.PushBack(object, allocator);
            count += ratio.fixedness == Fixedness::fixed ? 1 : 0;
        }
        add_member(result, "objects", JsonValue(static_cast<std::uint64_t>(table.objects.size())), allocator);
        add_member(result, "measures", std::move(rows), allocator);
        add_member(result, "ratios", std::move(ratios), allocator);
        add_member(result, "sizeDeviation", optional_json(study.size_deviation), allocator);
        if (!graph.empty()) propose(session, provenance, definitions, study, result, allocator, notes);
        add_member(result, "notes", strings_json(notes, allocator), allocator);
        write_study_report(files.in("proportions.json"), "proportions", result, provenance);

        if (session.json) {
            session.print_report(provenance, document, result);
        } else {
            std::cout << verdicts(study, options.false_discoveries).plain()
                      << "q: the larger of 'p others' and 'p size', corrected for the number of ratios; fixed: q of at most "
                      << options.false_discoveries << ". failed: the tests that speak against it\n\n";
            std::cout << count << " of " << study.ratios.size() << " ratios are fixed, of " << table.objects.size() << " objects"
                      << (failures > 0 ? " (" + std::to_string(failures) + " failed)" : "") << '\n';
            if (study.size_deviation) std::cout << "common size varies by " << percent(*study.size_deviation) << '\n';
        }
        return count > 0 ? done : answer_is_no;
    }

private:
    void check(bool from_table) const {
        if (from_table && !measures.empty()) fail_usage("--measures with a table", "a table holds the measures already");
        if (!from_table && measures.empty())
            fail_usage("--measures is missing", "name the measures to be taken (.measures.json)");
        if (graph.empty() && !(mesh.empty() && annotations.empty() && annotations_out.empty() && graph_in.empty()))
            fail_usage("a template without --graph", "name the graph file to write");
        if (graph.empty()) return;
        if (from_table) fail_usage("--graph with a table", "proposals need measures that are defined on annotations");
        if (mesh.empty() || annotations.empty() || annotations_out.empty())
            fail_usage("--graph without a template", "give --template-mesh, --template-annotations and --annotations-out");
        check_outputs({mesh, annotations, graph_in.empty() ? mesh : graph_in}, {graph, annotations_out});
    }

    MeasureTable take(const Session& session, Provenance& provenance, const MeasureDefinitions& definitions, JsonValue& result,
                      JsonAllocator& allocator, std::vector<std::string>& notes, std::size_t& failures) const {
        const Collection collection = files.read(session, provenance);
        const std::vector<ObjectResult> taken = for_each_object(
            collection, files.store(), {"measures", definitions.text},
            [&](const CollectionObject& object) { return object_measures_to_json(take_measures(object, definitions)); });
        failures = report_failures(session, collection, taken, result, allocator);
        std::vector<std::string> names;
        std::vector<std::optional<ObjectMeasures>> objects;
        std::map<std::string, std::vector<std::string>> told;  // one line for what is the same in many objects
        std::vector<std::string> order;
        for (std::size_t i = 0; i < taken.size(); ++i) {
            names.push_back(collection.objects[i].name);
            objects.push_back(taken[i].problem.empty() ? std::optional(object_measures_from_json(taken[i].result))
                                                       : std::nullopt);
            if (!objects.back()) continue;
            for (const auto& note : objects.back()->notes) {
                if (told[note].empty()) order.push_back(note);
                told[note].push_back(names.back());
            }
        }
        for (const auto& note : order) {
            const auto& of = told[note];
            notes.push_back(of.front() + (of.size() == 1 ? "" : " and " + std::to_string(of.size() - 1) + " more") + ": " + note);
        }
        if (std::none_of(taken.begin(), taken.end(), [](const ObjectResult& each) { return each.problem.empty(); }))
            throw Error(ErrorKind::input, files.collection, "not one object could be measured",
                        "the first: " + taken.front().problem);
        return measure_table(names, objects, definitions, notes);
    }

    void draw(const Session& session, const ProportionStudy& study) const {
        // Measures without a value have no row.
        std::vector<Eigen::Index> rows(study.measures.size(), -1);
        Eigen::Index m = 0;
        for (const RatioRow& ratio : study.ratios) rows[ratio.numerator] = rows[ratio.denominator] = 0;
        for (Eigen::Index& row : rows)
            if (row == 0) row = m++;
        if (by_deviation(study).empty()) return;
        write_plot(files.plot("variation"), variation_plot(study, "How much each ratio varies, with 95 % intervals"));
        HeatMap map{"Standard deviation of the logarithm of each ratio", {}, {}, {}, "standard deviation"};
        map.values.setConstant(m, m, std::numeric_limits<double>::quiet_NaN());
        bool complete = true;
        for (const RatioRow& ratio : study.ratios) {
            const auto a = rows[ratio.numerator], b = rows[ratio.denominator];
            if (ratio.row.summary && ratio.row.summary->count > 1) map.values(a, b) = map.values(b, a) = ratio.log_deviation;
        }
        for (std::size_t j = 0; j < rows.size(); ++j)
            if (rows[j] >= 0) map.rows.push_back(study.measures[j].name);
        map.columns = map.rows;
        map.numbers = true;
        map.minimum = 0;
        write_plot(files.plot("deviations"), map);
        for (Eigen::Index j = 0; j < m; ++j) map.values(j, j) = 0;
        complete = map.values.allFinite();
        if (complete && m > 1)
            write_plot(files.plot("measures"),
                       Dendrogram{"Measures by how fixed their ratios are (average linkage)", average_linkage(map.values),
                                  map.rows, "standard deviation of the logarithm of ratios"});
        else session.note("note: no plot 'measures': not each two measures have a ratio known of two objects or more");
    }

    void propose(const Session& session, Provenance& provenance, const MeasureDefinitions& definitions,
                 const ProportionStudy& study, JsonValue& result, JsonAllocator& allocator,
                 std::vector<std::string>& notes) const {
        provenance.add_input(mesh);
        provenance.add_input(annotations);
        const MeshFile file = read_mesh(mesh);
        const AnnotationSet set = read_annotations(annotations, file.mesh);
        RelationGraph before;
        if (!graph_in.empty()) {
            provenance.add_input(graph_in);
            before = read_graph(graph_in, set);
        }
        const Proposals made = propose_proportions(file.mesh, set, std::move(before), definitions, study, proposals);
        for (const auto& note : made.notes) session.note("note: " + note), notes.push_back(note);
        OutputTransaction outputs;
        write_annotations(annotations_out, made.set, file.mesh, mesh, provenance);
        write_graph(graph, made.graph, made.set, provenance);
        outputs.commit();
        add_member(result, "proposed", JsonValue(static_cast<std::uint64_t>(made.proposed)), allocator);
        session.note("proposed constraints: " + std::to_string(made.proposed));
    }
};

}  // namespace

void add_study_proportions(CLI::App& study, Session& session) {
    const auto work = std::make_shared<StudyProportions>();
    CLI::App* command =
        session.add(study, "proportions",
                    "which ratios of measures are fixed over a collection (or a table of measures, .csv); exit code 3 if none is",
                    [&session, work] { return work->run(session); });
    add_study_files(command, work->files, false);
    command->get_option("collection")
        ->description("folder of meshes, a list of objects (.study.json), or a table of measures (.csv)");
    command->add_option("--measures", work->measures, "the measures to take on every object (.measures.json)");
    command->add_option("--template-mesh", work->mesh, "mesh of the template that proportions are proposed for");
    command->add_option("--template-annotations", work->annotations, "its annotations");
    command->add_option("--template-graph", work->graph_in, "its relationships, to which proposals are added");
    command->add_option("--graph", work->graph, "graph to write: fixed proportions as constraints on the template");
    command->add_option("--annotations-out", work->annotations_out,
                        "the template's annotations, with the measures that the constraints name");
    add_flags(command, work->options);
    add_flags(command, work->proposals);
}

}  // namespace ostraka::app

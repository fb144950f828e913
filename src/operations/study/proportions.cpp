// study proportions: finds the proportions that are fixed in a collection.
#include "operations/study/common.h"

#include "ostraka/collection/proportion_graph.h"
#include "ostraka/core/text.h"
#include "ostraka/figures/dendrogram.h"
#include "ostraka/figures/heat_map.h"
#include "ostraka/figures/plot.h"
#include "ostraka/figures/table.h"

#include <fmt/core.h>

#include <algorithm>

namespace ostraka {

namespace {

/// Interval as "low to high"; two columns in the CSV.
TableCell interval_cell(const std::optional<Interval>& interval, double factor, int digits_shown) {
    if (!interval) return {"-", {"", ""}};
    const double low = factor * interval->low, high = factor * interval->high;
    return {fmt::format("{} to {}", significant(low, digits_shown), significant(high, digits_shown)),
            {digits(low), digits(high)}};
}
/// The same for a share, shown as percentages.
TableCell share_interval_cell(const std::optional<Interval>& interval) {
    if (!interval) return {"-", {"", ""}};
    return {fmt::format("{} to {}", fixed(100 * interval->low, 1), percent(interval->high)),
            {digits(interval->low), digits(interval->high)}};
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
                                  s ? s->standard_deviation : std::nullopt})
            cells.push_back(number_cell(value ? std::optional(factor * *value) : std::nullopt, 4));
        cells.push_back(interval_cell(row.deviation_interval, factor, 3));
        cells.push_back(percent_cell(s ? s->coefficient_of_variation : std::nullopt));
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

TextTable verdict_table(const ProportionStudy& study, double false_discoveries) {
    TextTable table({"ratio", "objects", "average", "cv", variation_interval_column(), "p pairing", "p others", "p size", "q",
                     "verdict", "failed"});
    for (const RatioRow* ratio : by_deviation(study)) {
        const Summary& s = *ratio->row.summary;
        table.add({ratio->row.name, std::to_string(s.count), number_cell(s.mean, 4), percent_cell(s.coefficient_of_variation),
                   share_interval_cell(ratio->row.variation_interval), number_cell(ratio->p_pairing, 2),
                   number_cell(ratio->p_others, 2), number_cell(ratio->p_size, 2), number_cell(ratio->q, 2),
                   to_string(ratio->fixedness), reason_not_fixed(*ratio, false_discoveries)});
    }
    return table;
}

/// Coefficients of variation with their intervals, coloured by verdict.
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
            if (rows[i]->fixedness != order[k] || !rows[i]->row.summary->coefficient_of_variation) continue;
            series.points.push_back({static_cast<double>(i), 100 * *rows[i]->row.summary->coefficient_of_variation});
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

struct StudyProportions final : StudyOperation {
    void declare(Parameters& p) override {
        files.declare(p, false, "folder of meshes, a list of objects (.study.json), or a table of measures (.csv)");
        vocabulary.declare(p, "used to match tags of annotations with the names in --measures");
        p.input_option("measures", Kind::text, measures, "definitions of the measures to take on every object (.measures.json)");
        p.input_option("template-mesh", Kind::mesh, mesh, "mesh of the template for which proportions are proposed");
        p.input_option("template-annotations", Kind::annotations, annotations, "annotations of the template (.ant.json)");
        p.input_option("template-graph", Kind::graph, graph_in,
                       "relationships of the template (.graph.json), to which the proposed constraints are added");
        p.output_option("graph", Kind::graph, graph,
                        "graph to write (.graph.json): fixed proportions as constraints on the template");
        p.output_option("annotations-out", Kind::annotations, annotations_out,
                        "annotations of the template to write (.ant.json), with the measures to which the constraints refer");
        options.declare_options(p.options);
        proposals.declare_options(p.options);
        p.report.values(integer("objects"));
        std::vector<Field> columns{text("name"),       text("unit"),
                                   integer("objects"), number("average"),
                                   number("min"),      number("max"),
                                   number("median"),   number("ownDeviation"),
                                   any("deviation"),   any("deviationInterval"),
                                   any("variation"),   any("variationInterval")};
        p.report.table("measures", columns);
        columns.insert(columns.end(), {text("numerator"), text("denominator"), text("verdict"), number("logDeviation"),
                                       number("pPairing"), number("pOthers"), number("q"), any("range"), any("pSize")});
        p.report.table("ratios", columns);
        p.report.values(any("sizeDeviation"), integer("proposed", "proposed constraints"));
    }

    void check() const override {
        StudyOperation::check();
        if (from_table() && measures) fail_usage("--measures with a table", "a table already contains the measures");
        if (!from_table() && !measures) fail_usage("--measures is missing", "name the measures to be taken (.measures.json)");
        if (!graph && (mesh || annotations || annotations_out || graph_in))
            fail_usage("a template without --graph", "name the graph file to write");
        if (!graph) return;
        if (from_table()) fail_usage("--graph with a table", "proposals need measures that are defined on annotations");
        if (!mesh || !annotations || !annotations_out)
            fail_usage("--graph without a template", "give --template-mesh, --template-annotations and --annotations-out");
    }

    void run(Context& context, Report& report) override {
        MeasureTable table;
        std::vector<std::string> notes;
        std::size_t failures = 0;
        if (from_table()) {
            table = files.collection.load<MeasureTable>([](const Path& file) { return read_measure_table(file); });
            files.output.open();
            report.empty_table("failed");
        } else {
            const Collection collection = files.read(context);
            const TagMatcher words = vocabulary.words();
            const std::vector<ObjectResult> measured =
                take_measures(collection, definitions(), files.store(), vocabulary ? &words : nullptr, vocabulary.checksum());
            if (files.ends_with_part(report, measured)) return;
            failures = report_failures(report, collection, measured);
            table = measure_table(collection, measured, definitions(), notes, files.collection.file());
        }
        const ProportionStudy study = study_proportions(table, options);
        notes.insert(notes.end(), study.notes.begin(), study.notes.end());
        report.notes(notes);

        const TextTable verdicts = verdict_table(study, options.false_discoveries);
        write_file(files.in("values.csv"), measure_table_to_csv(table));
        table_3_1(study).write(files.output.path(), "table-3-1", "Measures and their ratios");
        verdicts.write(files.output.path(), "ratios", "Ratios by their variation, and whether they are fixed");
        draw(report, study);

        report.table(verdicts);
        report.line(
            fmt::format("q: the larger of 'p others' and 'p size', corrected for the number of ratios; fixed: q of at most {}. "
                        "failed: the tests that the ratio failed\n",
                        number(options.false_discoveries, 6)));
        const auto count = std::count_if(study.ratios.begin(), study.ratios.end(),
                                         [](const RatioRow& ratio) { return ratio.fixedness == Fixedness::fixed; });
        report.line(fmt::format("{} of {} ratios are fixed, of {} objects{}", count, study.ratios.size(), table.objects.size(),
                                failures > 0 ? fmt::format(" ({} failed)", failures) : ""));
        if (study.size_deviation) report.line("common size varies by " + percent(*study.size_deviation));
        if (count == 0) report.answer_no();
        report("objects", table.objects.size());
        report_result(report, study);
        if (graph) propose(report, study, notes);
        write_report(report, notes, context.provenance());
    }

    [[nodiscard]] bool from_table() const { return extension(files.collection.file()) == ".csv"; }
    [[nodiscard]] const MeasureDefinitions& definitions() const {
        return measures.load<MeasureDefinitions>([](const Path& file) { return read_measure_definitions(file); });
    }

    static void report_result(Report& report, const ProportionStudy& study) {
        const auto optional = [&](const auto& value) { return json_value(value, report.allocator()); };
        const auto interval = [&](const std::optional<Interval>& bounds) {
            return optional(bounds ? std::optional(std::array{bounds->low, bounds->high}) : std::nullopt);
        };
        const auto describe = [&](Report::Row row, const MeasureRow& measure_row) {
            row("name", measure_row.name);
            if (!measure_row.unit.empty()) row("unit", measure_row.unit);
            row("objects", measure_row.summary ? measure_row.summary->count : 0);
            if (!measure_row.summary) return row;
            const Summary& s = *measure_row.summary;
            row("average", s.mean)("min", s.min)("max", s.max)("median", s.median)("deviation", optional(s.standard_deviation))(
                "deviationInterval", interval(measure_row.deviation_interval))("variation", optional(s.coefficient_of_variation))(
                "variationInterval", interval(measure_row.variation_interval));
            if (measure_row.own_deviation) row("ownDeviation", *measure_row.own_deviation);
            return row;
        };
        for (const char* table : {"measures", "ratios"}) report.empty_table(table);
        for (const MeasureRow& row : study.measures) describe(report.row("measures"), row);
        for (const RatioRow& ratio : study.ratios) {
            Report::Row row = describe(report.row("ratios"), ratio.row);
            row("numerator", study.measures[ratio.numerator].name)("denominator", study.measures[ratio.denominator].name)(
                "logDeviation", ratio.log_deviation);
            if (ratio.row.summary) row("range", interval(Interval{ratio.low, ratio.high}));
            row("pPairing", ratio.p_pairing)("pOthers", ratio.p_others)("pSize", optional(ratio.p_size))("q", ratio.q)(
                "verdict", to_string(ratio.fixedness));
        }
        report("sizeDeviation", optional(study.size_deviation));
    }

    void propose(Report& report, const ProportionStudy& study, std::vector<std::string>& notes) const {
        const AnnotationSet& set = annotations.on(mesh->mesh);
        RelationGraph graph_before;
        if (graph_in) graph_before.relationships = graph_in.on(set).relationships;
        Proposals new_proposals =
            propose_proportions({mesh->mesh, set}, std::move(graph_before), definitions(), study, proposals);
        report.notes(new_proposals.notes);
        notes.insert(notes.end(), new_proposals.notes.begin(), new_proposals.notes.end());
        report("proposed", new_proposals.proposed);
        graph.write(std::move(new_proposals.graph), new_proposals.set);
        annotations_out.write(std::move(new_proposals.set), mesh->mesh, mesh.file());
    }

    void write_report(const Report& report, const std::vector<std::string>& notes, const Provenance& provenance) const {
        Json result;
        result.CopyFrom(report.result(), result.GetAllocator());
        add_members(result, result.GetAllocator(), "notes", notes);
        write_study_report(files.in("proportions.json"), "proportions", result, provenance);
    }

    void draw(Report& report, const ProportionStudy& study) const {
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
        if (map.values.allFinite() && m > 1)
            write_plot(files.plot("measures"),
                       Dendrogram{"Measures by how fixed their ratios are (average linkage)", linkage(map.values), map.rows,
                                  "standard deviation of the logarithm of ratios"});
        else report.note("no plot 'measures': some pairs of measures have no ratio that is known for two or more objects");
    }

    FileInput measures;
    MeshInput mesh;
    AnnotationsInput annotations;
    GraphInput graph_in;
    GraphOutput graph;
    AnnotationsOutput annotations_out;
    VocabularyOption vocabulary;
    ProportionOptions options;
    ProposalOptions proposals;
};

}  // namespace

std::unique_ptr<Operation> make_study_proportions() { return make<StudyProportions>(); }

}  // namespace ostraka

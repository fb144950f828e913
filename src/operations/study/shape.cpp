// study shape: what shape depends on: Procrustes analysis of variance, allometry, symmetry and measurement error.
#include "operations/study/landmark_study.h"

#include "ostraka/collection/covariates.h"
#include "ostraka/figures/plot.h"
#include "ostraka/figures/table.h"
#include "ostraka/morphometrics/allometry.h"
#include "ostraka/morphometrics/symmetry.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace ostraka {

namespace {

constexpr const char *size_name = "size", *log_size_name = "log(size)", *label_name = "label";

enum class SymmetryKind { none, object, matching };

/// Specimens of the analysis with their variables.
struct Specimens {
    LandmarkShapes shapes;
    SpecimenVariables known;
    [[nodiscard]] const std::vector<std::string>& labels_of(const std::string& variable) const {
        return known.named(variable).labels;
    }
};

struct StudyShape final : StudyOperation {
    void declare(Parameters& p) override {
        study.declare(p, files);
        p.input_option("table", Kind::table, table, "variables of the specimens: CSV, the first column has their names");
        p.options("model", model,
                  "what shape depends on: columns of the table, 'size', 'log(size)' and 'label', joined by + : and *, such as "
                  "'log(size) + species * site'");
        p.options("factors", factors, "columns of numbers that are factors").words();
        p.options("error", errors, "TERM=TERM: the term by whose mean square a term is tested, instead of the residuals").words();
        p.options(
            "symmetry", symmetry,
            "separate symmetric and asymmetric shape: of objects with two mirrored halves (--pairs), or of matching pairs of "
            "objects such as hands (--individual, --side)",
            Choices{"none", "object", "matching"});
        p.options("individual", individual, "column with the individual of each specimen; repeated measurements give the error");
        p.options("side", side, "column with the side of each specimen (matching symmetry)");
        p.options("groups", groups, "column whose levels the plots distinguish; allometry is that within these groups");
        permutations.declare_options(p.options);
        for (const char* count : {"objects", "landmarks", "dimension"}) p.report.values(integer(count));
        p.report.values(number("sumOfSquares"));
        p.report.values(number("allometry.share"), number("symmetry.share"), number("symmetry.directional"),
                        number("repeatability.repeatability"), number("repeatability.errorShare"),
                        number("repeatability.repeats"), integer("repeatability.individuals"));
        for (const char* anova : {"anova", "sizeAnova", "symmetryAnova"})
            p.report.table(anova, text("term"), integer("freedom"), number("squares"), number("mean"), number("share"),
                           number("f"), number("z"), number("p"), text("error"));
    }

    void check() const override {
        StudyOperation::check();
        if (model.empty() && symmetry == SymmetryKind::none && individual.empty())
            fail_usage("there is nothing to analyse", "give --model, --symmetry or --individual");
        if (symmetry == SymmetryKind::matching && (individual.empty() || side.empty()))
            fail_usage("--symmetry matching without --individual and --side", "name the columns of the table");
        if (symmetry != SymmetryKind::matching && !side.empty())
            fail_usage("--side without --symmetry matching", "leave it out, or use --symmetry matching");
        for (const std::string& error : errors)
            if (error.find('=') == std::string::npos)
                fail_usage(fmt::format("--error '{}' is not TERM=TERM", printable(error, 60)), "give two terms of the model");
    }

    void run(Context& context, Report& report) override {
        const auto read = study.read(context, report, files, true);
        if (!read) return;
        const Specimens specimens = with_variables(context, report, *read);
        const LandmarkShapes& shapes = specimens.shapes;
        const GeneralisedProcrustes aligned = generalised_procrustes(shapes.configurations, shapes.sample().procrustes_options());
        write_aligned(files.output, "aligned", shapes, aligned.aligned, aligned.centroid_sizes);
        report("objects", shapes.objects.size())("landmarks", shapes.names.size())("dimension", shapes.dimension)(
            "sumOfSquares", aligned.sum_of_squares);
        report.empty_table("anova", false);
        report.empty_table("sizeAnova", false);
        report.empty_table("symmetryAnova", false);
        if (!model.empty()) analyse_model(report, specimens, aligned);
        if (symmetry != SymmetryKind::none) analyse_symmetry(report, specimens);
        else if (!individual.empty()) analyse_error(report, specimens, aligned);
    }

private:
    /// Columns of the table that the analysis needs.
    [[nodiscard]] std::vector<std::string> needed_columns() const {
        std::vector<std::string> names;
        const auto add = [&](const std::string& name) {
            if (!name.empty() && name != size_name && name != log_size_name && name != label_name &&
                std::find(names.begin(), names.end(), name) == names.end())
                names.push_back(name);
        };
        if (!model.empty())
            for (const std::string& name : names_in_model(model)) add(name);
        for (const std::string* name : {&individual, &side, &groups}) add(*name);
        return names;
    }

    Specimens with_variables(Context& context, Report& report, const LandmarkShapes& shapes) {
        Specimens result{shapes, {}};
        std::vector<std::string> needed = needed_columns();
        CovariateTable covariates;
        if (table) {
            context.record([&] { covariates = read_covariates(table.path()); });
        } else {  // labels in the landmark file
            covariates.where = files.collection.file();
            covariates.specimens = shapes.objects;
            for (const auto& [key, value] : shapes.properties.front()) covariates.columns.push_back(key);
            for (const auto& properties : shapes.properties) {
                auto& cells = covariates.cells.emplace_back();
                for (const std::string& column : covariates.columns) {
                    const auto value = properties.find(column);
                    cells.push_back(value == properties.end() ? std::string() : value->second);
                }
            }
        }
        if (needed.empty()) {
            for (std::size_t i = 0; i < shapes.objects.size(); ++i) result.known.kept.push_back(i);
        } else {
            result.known = variables_of(covariates, shapes.objects, needed, factors);
            std::vector<ShapeOutlier> removed;
            for (const auto& [specimen, reason] : result.known.left_out) {
                report.note(fmt::format("left out: {}: {}", specimen, reason));
                removed.push_back({specimen, reason, true, {}, {}, {}, {}});
            }
            result.shapes = without(shapes, removed);
        }
        ModelVariable sizes{size_name, false, {}, {}}, log_sizes{log_size_name, false, {}, {}}, labels{label_name, true, {}, {}};
        for (std::size_t i = 0; i < result.shapes.objects.size(); ++i) {
            sizes.values.push_back(centroid_size(result.shapes.configurations[i]));
            log_sizes.values.push_back(std::log(sizes.values.back()));
            labels.labels.push_back(result.shapes.labels[i]);
        }
        for (const ModelVariable& variable : {sizes, log_sizes, labels}) result.known.variables.push_back(variable);
        return result;
    }

    void analyse_model(Report& report, const Specimens& specimens, const GeneralisedProcrustes& aligned) const {
        const std::vector<ModelTerm> terms = parse_model(model, specimens.known.variables);
        std::map<std::string, std::string> error_terms;
        for (const std::string& error : errors) {
            const std::size_t equals = error.find('=');
            error_terms[std::string(trimmed(error.substr(0, equals)))] = trimmed(error.substr(equals + 1));
        }
        const Anova anova =
            permuted_anova(shape_rows(aligned.aligned), specimens.known.variables, terms, permutations, error_terms);
        report_anova(report, "anova", anova, "Procrustes analysis of variance of shape: " + model);
        const bool with_size = std::any_of(terms.begin(), terms.end(), [&](const ModelTerm& term) {
            return term.variables.size() == 1 && (term.name == log_size_name || term.name == size_name);
        });
        if (with_size) analyse_allometry(report, specimens, aligned);
    }

    void analyse_allometry(Report& report, const Specimens& specimens, const GeneralisedProcrustes& aligned) const {
        const LandmarkShapes& shapes = specimens.shapes;
        const std::vector<std::string> none(shapes.objects.size());
        const std::vector<std::string>& labels = groups.empty() ? none : specimens.labels_of(groups);
        const Allometry result = allometry(aligned, groups.empty() ? std::vector<std::string>{} : labels);
        report("allometry.share", result.share);
        TextTable scores({"specimen", "log centroid size", "regression score", "predicted"});
        std::map<std::string, PlotSeries> series;
        for (std::size_t i = 0; i < shapes.objects.size(); ++i) {
            scores.add({shapes.objects[i], number_cell(result.log_sizes[i], 12), number_cell(result.scores[i], 10),
                        number_cell(result.predicted[i], 10)});
            series[labels[i]].points.push_back({result.log_sizes[i], result.scores[i]});
        }
        scores.write(files.output.path(), "allometry", "Allometry: regression scores of shape on log centroid size");
        Plot plot{"Allometry", {"log centroid size"}, {"regression score, " + percent(result.share) + " of the variation"}, {}};
        for (auto& [label, points] : series) {
            points.name = label;
            points.joined = false;
            plot.series.push_back(points);
        }
        write_plot(files.plot("allometry"), plot);
        write_shapes(files.output, "allometry-shapes.tps", shapes, {"smallest", "largest"}, {result.smallest, result.largest});
        write_shapes(files.output, "corrected-for-size.tps", shapes, shapes.objects, result.residuals);
    }

    void analyse_symmetry(Report& report, const Specimens& specimens) const {
        const LandmarkShapes& shapes = specimens.shapes;
        SymmetryDesign design;
        design.individuals = individual.empty() ? shapes.objects : specimens.labels_of(individual);
        if (symmetry == SymmetryKind::matching) design.sides = specimens.labels_of(side);
        else design.pairs = study.pairs(shapes.names);
        const SymmetryAnalysis result = symmetry_analysis(shapes.sample(), design, permutations);
        report.notes(result.notes);
        report_anova(report, model.empty() ? "anova" : "symmetryAnova", result.shape,
                     "Procrustes analysis of variance of symmetry");
        if (result.size) report_anova(report, "sizeAnova", *result.size, "Analysis of variance of log centroid size");
        report("symmetry.share", result.symmetric_share)("symmetry.directional", (result.directional - result.mean).norm());
        if (result.replicate) report_repeatability(report, *result.replicate);
        TextTable table_of_individuals({"individual", "asymmetry", "fluctuating asymmetry"});
        for (std::size_t i = 0; i < result.individuals.size(); ++i)
            table_of_individuals.add(
                {result.individuals[i], number_cell(result.asymmetry[i], 10), number_cell(result.fluctuating[i], 10)});
        table_of_individuals.write(files.output.path(), "asymmetry",
                                   "Asymmetry of individuals: norms of half the difference of sides");
        write_shapes(files.output, "symmetric.tps", shapes, result.individuals, result.symmetric);
        write_shapes(files.output, "asymmetric.tps", shapes, result.individuals, result.asymmetric);
        write_shapes(files.output, "mean.tps", shapes, {"symmetric", "directional asymmetry"}, {result.mean, result.directional});
    }

    void analyse_error(Report& report, const Specimens& specimens, const GeneralisedProcrustes& aligned) const {
        const std::vector<std::string>& individuals = specimens.labels_of(individual);
        const Eigen::MatrixXd shapes = shape_rows(aligned.aligned);
        if (const auto result = repeatability(shapes, individuals)) report_repeatability(report, *result);
        else report.note(fmt::format("'{}' has no repeated measurements: the error of measurement is unknown", individual));
        if (!model.empty()) return;
        const Anova anova = permuted_anova(shapes, {{individual, true, individuals, {}}}, {{individual, {0}}}, permutations);
        report_anova(report, "anova", anova,
                     "Procrustes analysis of variance of individuals; residuals are errors of measurement");
    }

    static void report_repeatability(Report& report, const Repeatability& result) {
        report("repeatability.repeatability", result.repeatability)("repeatability.errorShare", result.error_share)(
            "repeatability.repeats", result.repeats)("repeatability.individuals", result.individuals);
        report.line(
            fmt::format("repeatability {}: {} of the variance is error of measurement ({} individuals, {} measurements each)",
                        significant(result.repeatability, 4), percent(result.error_share), result.individuals,
                        significant(result.repeats, 3)));
    }

    void report_anova(Report& report, const std::string& name, const Anova& anova, const std::string& title) const {
        report.notes(anova.notes);
        TextTable shown({"term", "df", "SS", "MS", "R2", "F", "Z", "p", "error term"});
        for (const AnovaRow& row : anova.rows) {
            shown.add({row.term, std::to_string(row.degrees_of_freedom), number_cell(row.sum_of_squares, 6),
                       number_cell(row.mean_square, 6), number_cell(row.r_squared, 5), number_cell(row.f, 6),
                       number_cell(row.z, 4), number_cell(row.p, 4), row.error});
            report.row(name)("term", row.term)("freedom", row.degrees_of_freedom)("squares", row.sum_of_squares)(
                "mean", row.mean_square)("share", row.r_squared)("f", row.f)("z", row.z)("p", row.p)("error", row.error);
        }
        shown.write(files.output.path(),
                    name == "anova"       ? "anova"
                    : name == "sizeAnova" ? "size-anova"
                                          : "symmetry-anova",
                    title);
        report.line(title);
        report.table(shown);
    }

    LandmarkStudy study;
    FileInput table;
    std::string model, individual, side, groups;
    std::vector<std::string> factors, errors;
    SymmetryKind symmetry = SymmetryKind::none;
    PermutationOptions permutations;
};

}  // namespace

std::unique_ptr<Operation> make_study_shape() { return make<StudyShape>(); }

}  // namespace ostraka

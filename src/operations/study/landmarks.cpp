// study landmarks: generalised Procrustes analysis of landmarks: mean shape and variation.
#include "operations/study/common.h"

#include "ostraka/collection/landmark_shapes.h"
#include "ostraka/figures/plot.h"
#include "ostraka/figures/table.h"
#include "ostraka/interchange/landmarks.h"
#include "ostraka/stats/embedding.h"
#include "ostraka/stats/summary.h"

#include <fmt/core.h>

#include <cmath>

namespace ostraka {

namespace {

struct StudyLandmarks final : StudyOperation {
    void declare(Parameters& p) override {
        files.declare(p, true);
        p.options("components", components, "number of principal components to write", Range{1, 1000});
        options.list_options(p.options);
        for (const char* count : {"objects", "landmarks", "iterations"}) p.report.values(integer(count));
        for (const char* size : {"meanCentroidSize", "meanNorm", "sumOfSquares"}) p.report.values(number(size));
        p.report.values(boolean("converged"), numbers("components"));
        p.report.table("odd", text("name"), text("why"), boolean("leftOut"));
        p.options("leave-odd-out", leave_odd_out,
                  "exclude objects whose landmarks are mirrored, or whose size differs from the median by a factor of three");
    }

    void run(Context& context, Report& report) override {
        const Collection collection = files.read(context);
        const std::vector<ObjectResult> read = read_object_landmarks(collection, files.store("landmarks"));
        if (files.ends_with_part(report, read)) return;
        report_failures(report, collection, read);
        LandmarkShapes shapes = common_landmarks(collection, read, options.scaling, files.collection.file());
        report.notes(shapes.notes);
        report_unusual(report, shapes);
        const GeneralisedProcrustes shape = generalised_procrustes(shapes.configurations, options);
        if (!shape.converged) report.note(fmt::format("the mean had not converged after {} iterations", shape.iterations));
        const PrincipalComponents principal = principal_components(shape_rows(shape.aligned), components);

        LandmarkSet mean;
        mean.unit = options.scaling ? "" : shapes.unit;
        for (std::size_t k = 0; k < shapes.names.size(); ++k) {
            const Eigen::RowVector3d position = shape.mean.row(static_cast<Eigen::Index>(k));
            mean.landmarks.push_back({shapes.names[k], {position.x(), position.y(), position.z()}, std::nullopt});
        }
        std::vector<std::string> unused;
        write_file(files.in("mean.mrk.json"), landmarks_to_text(mean, LandmarkFormat::mrk, "", context.provenance(), unused));
        write(shapes, shape, principal);

        const Summary sizes = summarise(shape.centroid_sizes, "centroid sizes");
        report("objects", shapes.objects.size());
        KnownAnswers(shapes.labels).add_to(report);
        report("landmarks", shapes.names.size())("meanCentroidSize", sizes.mean)("meanNorm", shape.mean.norm())(
            "sumOfSquares", shape.sum_of_squares)("iterations", shape.iterations)("converged", shape.converged);
        std::vector<double> explained;
        for (const double variance : principal.variances)
            explained.push_back(principal.total_variance > 0 ? variance / principal.total_variance : 0);
        report("components", explained);
        TextTable table({"landmarks", "of", "mean centroid size", "size of the mean", "sum of squares"});
        table.add({std::to_string(shapes.names.size()), std::to_string(shapes.objects.size()) + " objects",
                   significant(sizes.mean, 10) + (shapes.unit.empty() ? "" : " " + shapes.unit),
                   significant(shape.mean.norm(), 10), significant(shape.sum_of_squares, 10)});
        report.table(table);
    }

    /// Reports odd specimens, and removes them if requested.
    void report_unusual(Report& report, LandmarkShapes& shapes) const {
        std::vector<ShapeOutlier> specimens = shape_outliers(shapes);
        if (leave_odd_out && specimens.size() < shapes.objects.size()) {
            shapes = without(shapes, specimens);
            for (ShapeOutlier& specimen : specimens) specimen.left_out = true;
        }
        specimens.insert(specimens.begin(), shapes.odd.begin(), shapes.odd.end());
        report.empty_table("odd");
        for (const ShapeOutlier& specimen : specimens) {
            report.row("odd")("name", specimen.name)("why", specimen.why)("leftOut", specimen.left_out);
            report.note(fmt::format("{}: {}: {}", specimen.left_out ? "left out" : "unusual", specimen.name, specimen.why));
        }
    }

    /// Writes the table of objects and the plot of the first two components.
    void write(const LandmarkShapes& shapes, const GeneralisedProcrustes& shape, const PrincipalComponents& principal) const {
        const Eigen::MatrixXd& scores = principal.scores;
        const Eigen::Index count = scores.cols();
        std::vector<std::string> head{"object", "centroid size", "distance from the mean"};
        for (Eigen::Index c = 0; c < count; ++c) head.push_back("component " + std::to_string(c + 1));
        TextTable table(head);
        std::map<std::string, PlotSeries> classes;
        for (std::size_t i = 0; i < shapes.objects.size(); ++i) {
            const auto row = static_cast<Eigen::Index>(i);
            std::vector<TableCell> cells{shapes.objects[i], number_cell(shape.centroid_sizes[i], 12),
                                         number_cell(std::sqrt(shape.maps[i].sum_of_squares), 10)};
            for (Eigen::Index c = 0; c < count; ++c) cells.push_back(number_cell(scores(row, c), 10));
            table.add(cells);
            PlotSeries& series = classes[shapes.labels[i]];
            series.points.push_back({scores(row, 0), count > 1 ? scores(row, 1) : 0});
            series.labels.push_back(shapes.objects[i]);
        }
        table.write(files.output.path(), "objects", "Landmarks: sizes, distances from the mean shape, principal components");
        const auto explained = [&](Eigen::Index c) {
            return c < count && principal.total_variance > 0 ? ", " + percent(principal.variances[c] / principal.total_variance)
                                                             : "";
        };
        Plot plot{"Shapes of landmarks", {"first component" + explained(0)}, {"second component" + explained(1)}, {}};
        for (auto& [label, series] : classes) {
            series.name = label;
            series.joined = false;
            plot.series.push_back(series);
        }
        plot.equal = true;
        write_plot(files.plot("components"), plot);
    }

    int components = 5;
    bool leave_odd_out = false;
    ProcrustesOptions options;
};

}  // namespace

std::unique_ptr<Operation> make_study_landmarks() { return make<StudyLandmarks>(); }

}  // namespace ostraka

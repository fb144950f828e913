// study landmarks: generalised Procrustes analysis of landmarks: mean shape and variation.
#include "operations/study/landmark_study.h"

#include "ostraka/figures/plot.h"
#include "ostraka/figures/table.h"
#include "ostraka/interchange/landmarks.h"
#include "ostraka/stats/summary.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace ostraka {

namespace {

struct StudyLandmarks final : StudyOperation {
    void declare(Parameters& p) override {
        study.declare(p, files);
        p.options("components", components, "number of principal components to write", Range{1, 1000});
        options.declare_options(p.options);
        for (const char* count : {"objects", "landmarks", "dimension", "iterations"}) p.report.values(integer(count));
        for (const char* size : {"meanCentroidSize", "meanNorm", "sumOfSquares"}) p.report.values(number(size));
        p.report.values(boolean("converged"), numbers("components"));
    }

    void run(Context& context, Report& report) override {
        const auto read = study.read(context, report, files, options.scaling);
        if (!read) return;
        const LandmarkShapes& shapes = *read;
        options.planar = shapes.dimension == 2;
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
        write_aligned(files.output, "aligned", shapes, shape.aligned, shape.centroid_sizes);
        write_ends(shapes, shape, principal);

        const Summary sizes = summarise(shape.centroid_sizes, "centroid sizes");
        report("objects", shapes.objects.size());
        KnownAnswers(shapes.labels).add_to(report);
        report("landmarks", shapes.names.size())("dimension", shapes.dimension)("meanCentroidSize", sizes.mean)(
            "meanNorm", shape.mean.norm())("sumOfSquares", shape.sum_of_squares)("iterations", shape.iterations)("converged",
                                                                                                                 shape.converged);
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
        Plot plot{"Shapes of landmarks",
                  {"first component" + explained(principal, 0)},
                  {"second component" + explained(principal, 1)},
                  {}};
        for (auto& [label, series] : classes) {
            series.name = label;
            series.joined = false;
            plot.series.push_back(series);
        }
        plot.equal = true;
        write_plot(files.plot("components"), plot);
    }

    static std::string explained(const PrincipalComponents& principal, Eigen::Index c) {
        return c < principal.scores.cols() && principal.total_variance > 0
                   ? ", " + percent(principal.variances[c] / principal.total_variance)
                   : "";
    }

    /// Writes the plot of the first two components with the shapes at the ends of the axes, and these shapes as TPS.
    void write_ends(const LandmarkShapes& shapes, const GeneralisedProcrustes& shape,
                    const PrincipalComponents& principal) const {
        const Eigen::MatrixXd& scores = principal.scores;
        ShapePlot plot{"Shapes at the ends of the components",
                       "first component" + explained(principal, 0),
                       "second component" + explained(principal, 1),
                       {},
                       {},
                       {},
                       {},
                       {}};
        std::map<std::string, ScatterGroup> groups;
        for (std::size_t i = 0; i < shapes.objects.size(); ++i) {
            const auto row = static_cast<Eigen::Index>(i);
            groups[shapes.labels[i]].points.push_back({scores(row, 0), scores.cols() > 1 ? scores(row, 1) : 0});
        }
        for (auto& [label, group] : groups) {
            group.name = label;
            plot.groups.push_back(group);
        }
        Landmarks mean = Landmarks::Zero(shape.mean.rows(), 3);
        for (const Landmarks& aligned : shape.aligned) mean += aligned / static_cast<double>(shape.aligned.size());
        std::vector<std::string> names{"mean"};
        std::vector<Landmarks> ends{mean};
        for (Eigen::Index c = 0; c < std::min<Eigen::Index>(2, scores.cols()); ++c)
            for (const bool high : {false, true}) {
                const double amount = high ? scores.col(c).maxCoeff() : scores.col(c).minCoeff();
                ends.push_back(moved_shape(mean, principal.directions.col(c), amount));
                names.push_back(fmt::format("component {} {}", c + 1, high ? "high" : "low"));
                const DrawnShape drawn = drawn_shape(names.back(), mean, ends.back(), shapes.dimension);
                (c == 0 ? (high ? plot.right : plot.left) : (high ? plot.top : plot.bottom)) = drawn;
            }
        write_shape_plot(files.plot("shapes"), plot);
        write_shapes(files.output, "shapes.tps", shapes, names, ends);
    }

    LandmarkStudy study;
    int components = 5;
    ProcrustesOptions options;
};

}  // namespace

std::unique_ptr<Operation> make_study_landmarks() { return make<StudyLandmarks>(); }

}  // namespace ostraka

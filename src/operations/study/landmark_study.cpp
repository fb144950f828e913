#include "operations/study/landmark_study.h"

#include "ostraka/algebra/dense.h"
#include "ostraka/core/text.h"
#include "ostraka/files/csv.h"
#include "ostraka/morphometrics/thin_plate.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>

namespace ostraka {

void LandmarkStudy::declare(Parameters& p, StudyFiles& files) {
    files.declare(
        p, true,
        "landmark file with several specimens (.tps, .nts, .dta, .pts, .csv, Morphologika), folder of landmark files and "
        "meshes, or a list of objects (.study.json)");
    p.input_option("pairs", Kind::table, pairs_file_,
                   "landmarks on both sides: CSV with two columns, names or numbers; by default names with 'left' and 'right'");
    p.input_option("sliders", Kind::table, sliders_,
                   "semi-landmarks on curves: CSV with the columns before, slide, after, names or numbers of landmarks");
    p.options(
        "missing", missing_,
        "missing landmarks: leave them out of all specimens, or estimate them by the thin-plate spline of the mean of complete "
        "specimens, by regression on the landmarks present, or by the mirrored other side",
        Choices{"leave-out", "tps", "regression", "mirror"});
    reading_.declare_options(p.options);
    p.options("slide-curves", slide_curves_, "slide the interior points of the curves of the landmark files");
    p.options("surface-landmarks", surface_, "semi-landmarks on the surface: names, numbers, ranges such as 12-40").words();
    sliding_.declare_options(p.options);
    p.options(
        "leave-odd-out", leave_odd_out_,
        "exclude specimens whose landmarks are mirrored, exchanged or displaced, or whose size differs from the median by a "
        "factor of three; specimens that are outliers without such an explanation stay");
    p.report.table("odd", text("name"), text("why"), boolean("leftOut"), text("cause"), texts("landmarks"), number("distance"),
                   number("corrected"));
    p.report.table("missing", text("specimen"), text("landmark"), text("how"));
    p.report.values(integer("sliding.iterations"), boolean("sliding.converged"), number("sliding.moved"),
                    number("sliding.energyBefore"), number("sliding.energyAfter"));
}

LandmarkPairs LandmarkStudy::pairs(const std::vector<std::string>& landmarks) const { return landmark_pairs(landmarks, pairs_); }

std::optional<LandmarkShapes> LandmarkStudy::read(Context& context, Report& report, const StudyFiles& files, bool scaling) {
    const Collection collection = files.read(context, false, true);
    const std::vector<ObjectResult> read = read_object_landmarks(collection, files.store("landmarks"), reading_);
    if (files.ends_with_part(report, read)) return {};
    report_failures(report, collection, read);
    if (pairs_file_)
        context.record([&] {
            const std::string text = read_file(pairs_file_.path());
            for (const CsvRow& row : csv_rows(text, csv_separator(text), pairs_file_.file())) {
                if (row.cells.size() != 2)
                    fail_input(fmt::format("{}, line {}", pairs_file_.file(), row.line),
                               fmt::format("has {} cells", row.cells.size()), "give two landmarks in each row");
                const auto cell = [&](std::size_t c) { return unescape_formula(std::string(trimmed(row.cells[c]))); };
                if (pairs_.empty() && lower_case(cell(0)) == "left") continue;  // a header
                pairs_.push_back({cell(0), cell(1)});
            }
        });
    CommonLandmarks options{scaling, missing_, pairs_};
    LandmarkShapes shapes = common_landmarks(collection, read, options, files.collection.file());
    report.notes(shapes.notes);
    report.empty_table("missing");
    std::map<std::string, std::vector<std::string>> by_specimen;
    for (const MissingRecord& missing : shapes.missing) {
        report.row("missing")("specimen", missing.specimen)("landmark", missing.landmark)("how", missing.how);
        by_specimen[missing.specimen].push_back(fmt::format("'{}' ({})", missing.landmark, missing.how));
    }
    for (const auto& [specimen, landmarks] : by_specimen) report.note(fmt::format("{} lacks {}", specimen, joined(landmarks)));
    std::string sliders;
    if (sliders_) context.record([&] { sliders = read_file(sliders_.path()); });
    SemiLandmarks semi = semi_landmarks(shapes, sliders, sliders_ ? sliders_.file() : "", slide_curves_, surface_);
    if (slide_curves_ && shapes.curves.empty()) report.note("no curve is common to all specimens: no curve slides");
    std::vector<std::size_t> sliding = semi.surface;
    for (const Slider& slider : semi.curves) sliding.push_back(slider.slides);
    report_unusual(report, shapes, sliding);
    if (!semi.empty()) slide(report, collection, shapes, std::move(semi));
    return shapes;
}

void LandmarkStudy::report_unusual(Report& report, LandmarkShapes& shapes, const std::vector<std::size_t>& sliding) const {
    std::vector<ShapeOutlier> specimens = shape_outliers(shapes, sliding);
    if (leave_odd_out_) {
        std::vector<ShapeOutlier> removed;
        for (const ShapeOutlier& specimen : specimens)
            if (specimen.cause != "outlier") removed.push_back(specimen);
        if (removed.size() < shapes.objects.size()) {
            shapes = without(shapes, removed);
            for (ShapeOutlier& specimen : specimens) specimen.left_out = specimen.cause != "outlier";
        }
    }
    specimens.insert(specimens.begin(), shapes.odd.begin(), shapes.odd.end());
    report.empty_table("odd");
    for (const ShapeOutlier& specimen : specimens) {
        report.row("odd")("name", specimen.name)("why", specimen.why)("leftOut", specimen.left_out)("cause", specimen.cause)(
            "landmarks", specimen.landmarks)("distance", specimen.distance)("corrected", specimen.corrected);
        report.note(fmt::format("{}: {}: {}", specimen.left_out ? "left out" : "unusual", specimen.name, specimen.why));
    }
}

void LandmarkStudy::slide(Report& report, const Collection& collection, LandmarkShapes& shapes, SemiLandmarks semi) const {
    std::vector<std::string> notes;
    if (!semi.surface.empty()) semi.surface_of = specimen_surfaces(collection, shapes, notes);
    report.notes(notes);
    const SlidSample slid = slide_semilandmarks(shapes.sample(), semi, sliding_);
    if (!slid.converged)
        report.note(
            fmt::format("semi-landmarks were still sliding after {} iterations: raise --slide-iterations", slid.iterations));
    shapes.configurations = slid.sample.configurations;
    report("sliding.iterations", slid.iterations)("sliding.converged", slid.converged)("sliding.moved", slid.moved)(
        "sliding.energyBefore", slid.energy_before)("sliding.energyAfter", slid.energy_after);
}

void write_aligned(const FolderOutput& output, const std::string& name, const LandmarkShapes& shapes,
                   const std::vector<Landmarks>& aligned, const std::vector<double>& sizes) {
    std::vector<std::string> head{"specimen", "label", "centroid size"};
    for (const std::string& landmark : shapes.names)
        for (int c = 0; c < shapes.dimension; ++c) head.push_back(fmt::format("{}.{}", landmark, "XYZ"[c]));
    std::string text = csv_row(head);
    for (std::size_t i = 0; i < aligned.size(); ++i) {
        std::vector<std::string> cells{shapes.objects[i], shapes.labels[i], digits(sizes[i])};
        for (Eigen::Index k = 0; k < aligned[i].rows(); ++k)
            for (int c = 0; c < shapes.dimension; ++c) cells.push_back(digits(aligned[i](k, c)));
        text += csv_row(cells);
    }
    write_file(output.in(name + ".csv"), text);
    write_shapes(output, name + ".tps", shapes, shapes.objects, aligned);
}

void write_shapes(const FolderOutput& output, const std::string& file, const LandmarkShapes& shapes,
                  const std::vector<std::string>& names, const std::vector<Landmarks>& configurations) {
    LandmarkSpecimens set;
    set.dimension = shapes.dimension;
    for (std::size_t i = 0; i < configurations.size(); ++i) {
        LandmarkSpecimen& specimen = set.specimens.emplace_back();
        specimen.name = names[i];
        specimen.landmarks = shapes.names;
        for (Eigen::Index k = 0; k < configurations[i].rows(); ++k)
            specimen.positions.push_back(
                std::array<double, 3>{configurations[i](k, 0), configurations[i](k, 1), configurations[i](k, 2)});
    }
    write_file(output.in(file), specimens_to_tps(set));
}

DrawnShape drawn_shape(const std::string& title, const Landmarks& mean, const Landmarks& shape, int dimension) {
    DrawnShape drawn{title, {}, {}, {}};
    Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
    if (dimension == 2) {
        drawn.grid = deformation_grid(mean, shape);
    } else {
        const Landmarks centred = mean.rowwise() - mean.colwise().mean();
        const SymmetricEigen3 eigen(centred.transpose() * centred);
        axes.col(0) = eigen.eigenvectors().col(2);
        axes.col(1) = eigen.eigenvectors().col(1);
        for (int c = 0; c < 2; ++c) {
            // The sign of an axis is arbitrary: its largest coordinate is made positive.
            Eigen::Index largest = 0;
            axes.col(c).cwiseAbs().maxCoeff(&largest);
            if (axes(largest, c) < 0) axes.col(c) *= -1;
        }
    }
    const auto place = [&](const Landmarks& x, Eigen::Index k) {
        const Eigen::RowVector3d p = x.row(k) * axes;
        return std::array<double, 2>{p.x(), p.y()};
    };
    for (Eigen::Index k = 0; k < shape.rows(); ++k) {
        drawn.points.push_back(place(shape, k));
        if (dimension == 3) drawn.lines.push_back({place(mean, k), place(shape, k)});
    }
    return drawn;
}

Landmarks moved_shape(const Landmarks& mean, const Eigen::VectorXd& direction, double amount) {
    Landmarks shape = mean;
    for (Eigen::Index k = 0; k < shape.rows(); ++k) shape.row(k) += amount * direction.segment<3>(3 * k).transpose();
    return shape;
}

}  // namespace ostraka

// Common to studies of landmarks: reading, missing landmarks, unusual specimens, sliding, and results for other programs.
#pragma once

#include "operations/study/common.h"

#include "ostraka/collection/landmark_shapes.h"
#include "ostraka/figures/shape_plot.h"
#include "ostraka/stats/embedding.h"

namespace ostraka {

/// Options and inputs by which specimens are made comparable.
class LandmarkStudy {
public:
    /// Declares inputs, options and the tables "failed", "odd" and "missing" of the report.
    void declare(Parameters& p, StudyFiles& files);
    /// Reads the landmarks of a collection, completes them, reports unusual specimens and slides semi-landmarks. `scaling`: sizes
    /// and units do not matter. None if this run processes a shard only.
    [[nodiscard]] std::optional<LandmarkShapes> read(Context& context, Report& report, const StudyFiles& files, bool scaling);
    /// Indices of the pairs of landmarks.
    [[nodiscard]] LandmarkPairs pairs(const std::vector<std::string>& landmarks) const;
    /// Whether pairs were given.
    [[nodiscard]] bool has_pairs() const { return !pairs_.empty(); }

private:
    void report_unusual(Report& report, LandmarkShapes& shapes, const std::vector<std::size_t>& sliding) const;
    void slide(Report& report, const Collection& collection, LandmarkShapes& shapes, SemiLandmarks semi) const;

    LandmarkReading reading_;
    MissingMethod missing_ = MissingMethod::leave_out;
    FileInput pairs_file_, sliders_;
    std::vector<std::array<std::string, 2>> pairs_;
    bool slide_curves_ = false, leave_odd_out_ = false;
    std::vector<std::string> surface_;
    SlidingOptions sliding_;
};

/// Writes superimposed landmarks for other programs: NAME.csv (one row per specimen: name, label, centroid size, then x, y (, z)
/// of each landmark, as R packages order them) and NAME.tps.
void write_aligned(const FolderOutput& output, const std::string& name, const LandmarkShapes& shapes,
                   const std::vector<Landmarks>& aligned, const std::vector<double>& sizes);
/// Writes shapes with names as a TPS file.
void write_shapes(const FolderOutput& output, const std::string& file, const LandmarkShapes& shapes,
                  const std::vector<std::string>& names, const std::vector<Landmarks>& configurations);

/// A shape as drawn beside a plot: in two dimensions with the thin-plate spline grid from the mean, in three as seen along the
/// shortest principal axis of the mean, with lines from the mean to the shape.
DrawnShape drawn_shape(const std::string& title, const Landmarks& mean, const Landmarks& shape, int dimension);

/// A shape from the mean and the direction of a principal component.
Landmarks moved_shape(const Landmarks& mean, const Eigen::VectorXd& direction, double amount);

}  // namespace ostraka

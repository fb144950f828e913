// Landmark configurations of the objects of a collection.
#pragma once

#include "ostraka/collection/objects.h"
#include "ostraka/interchange/specimens.h"
#include "ostraka/morphometrics/doubtful_specimens.h"
#include "ostraka/morphometrics/missing_landmarks.h"
#include "ostraka/morphometrics/sliding.h"

namespace ostraka {

/// How landmark files are read.
struct LandmarkReading {
    SpecimenOptions specimens;
    int curve_points = 0;  ///< resamples each curve to this number of points at equal distances; 0: as in the file
    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// Reads the landmarks of every object: from its landmark file, which may hold several specimens; otherwise from the point
/// annotations of its mesh. Files of annotations in other formats (web, ant, fct, glb) are placed on the mesh first. The result
/// of an object with two landmarks of the same name in one specimen is an error.
std::vector<ObjectResult> read_object_landmarks(const Collection& collection, const ResultStore& store = ResultStore(),
                                                const LandmarkReading& reading = {});

/// A specimen whose shape differs from the other specimens.
struct ShapeOutlier {
    std::string name, why;               ///< name of the specimen; message with the difference and the remedy
    bool left_out = false;               ///< true: the specimen was left out of the analysis
    std::string cause = {};              ///< "incomplete", "unit", "size", "mirrored", "exchanged", "displaced", "outlier"
    std::vector<std::string> landmarks;  ///< names of the landmarks concerned
    std::optional<double> distance = {}, corrected = {};  ///< Procrustes distance from the mean, before and after correction
};

/// A missing landmark of a specimen.
struct MissingRecord {
    std::string specimen, landmark, how;  ///< how: "left out", or the method by which it was estimated
};

/// Specimens with the landmarks that all of them share, or that were estimated.
struct LandmarkShapes {
    /// For each specimen: its name; its known class label (empty: unknown).
    std::vector<std::string> objects, labels;
    std::vector<std::string> names;         ///< names of the landmarks, in the order of the first specimen that has them
    std::string unit;                       ///< unit of all landmarks; empty if the units differ or are not given
    std::vector<Landmarks> configurations;  ///< landmarks of each specimen, in the order of `names`
    std::vector<std::string> notes;         ///< messages about landmarks that were left out
    std::vector<ShapeOutlier> odd;          ///< specimens that were left out, with reasons
    int dimension = 3;                      ///< 2: all z are 0
    std::vector<MissingRecord> missing;     ///< every missing landmark of the specimens that were kept
    std::vector<SpecimenCurve> curves;      ///< curves that all specimens have, with indices into `names`
    std::vector<std::size_t> sources;       ///< for each specimen, the index of its object in the collection
    /// For each specimen, further data of its file, such as labels of Morphologika.
    std::vector<std::map<std::string, std::string>> properties;

    [[nodiscard]] ShapeSample sample() const { return {dimension, names, objects, configurations}; }
};

/// How specimens are made comparable.
struct CommonLandmarks {
    bool scaling = false;  ///< true: sizes and units do not matter
    MissingMethod missing = MissingMethod::leave_out;
    /// Pairs of landmarks on both sides, by name or number; empty: by their names.
    std::vector<std::array<std::string, 2>> pairs = {};
};

/// Selects the landmarks common to all specimens in `read` (the result of `read_object_landmarks`), or estimates missing
/// landmarks that at least half of the specimens have. Specimens are left out (member `odd`) if they have fewer than half of the
/// landmarks that at least half of the specimens have. Without `scaling`, specimens are also left out if their unit is not the
/// unit of more than half of the specimens. Throws Error (input) if no object could be read, if specimens have different
/// dimensions, if fewer than three landmarks are common to all specimens, and, without `scaling`, if units differ and none of
/// them is the unit of more than half of the specimens; and the errors of complete_landmarks. `where` names the source of the
/// collection in error messages.
LandmarkShapes common_landmarks(const Collection& collection, const std::vector<ObjectResult>& read,
                                const CommonLandmarks& options, const std::string& where);
/// The same without estimates.
LandmarkShapes common_landmarks(const Collection& collection, const std::vector<ObjectResult>& read, bool scaling,
                                const std::string& where);

/// Pairs of landmarks by names or numbers (from 1), or by their names if `pairs` is empty. Throws Error (usage) for a landmark
/// that does not exist.
LandmarkPairs landmark_pairs(const std::vector<std::string>& landmarks, const std::vector<std::array<std::string, 2>>& pairs);
/// Index of a landmark given by its name, or by its number from 1. Throws Error (usage) if there is none.
std::size_t landmark_index(const std::vector<std::string>& landmarks, const std::string& name_or_number);

/// Finds specimens whose landmarks are mirrored (the mirror image is less than half as far from the mean of the other specimens
/// as the specimen itself), specimens whose centroid size is more than three times or less than a third of the median, and
/// doubtful specimens (morphometrics/doubtful_specimens.h): two landmarks exchanged, one landmark displaced, outliers. `sliding`:
/// landmarks that slide and are not tested. The specimens found are reported, not removed.
std::vector<ShapeOutlier> shape_outliers(const LandmarkShapes& shapes, const std::vector<std::size_t>& sliding = {});

/// A copy of `shapes` without the specimens listed in `outliers`.
LandmarkShapes without(const LandmarkShapes& shapes, const std::vector<ShapeOutlier>& outliers);

/// Semi-landmarks: rows of "before, slide, after" from a table (names or numbers, with or without a header); the interior points
/// of the curves of the files if `slide_curves`; landmarks on surfaces by names, numbers and ranges of numbers ("12-40, 55").
/// Throws Error (input or usage) for landmarks that do not exist.
SemiLandmarks semi_landmarks(const LandmarkShapes& shapes, const std::string& sliders_table, const std::string& where,
                             bool slide_curves, const std::vector<std::string>& surface);
/// The meshes of the specimens as surfaces for sliding; none, with a note in `notes`, unless each specimen has a mesh of its own.
SurfaceOfSpecimen specimen_surfaces(const Collection& collection, const LandmarkShapes& shapes, std::vector<std::string>& notes);

}  // namespace ostraka

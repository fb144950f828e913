// Landmark files with one or several specimens, as geometric morphometrics uses them: TPS, NTS, DTA, PTS, Morphologika, tables,
// 3D Slicer markups and MeshLab's picked points. doc/landmarks.md states what each format stores.
#pragma once

#include "ostraka/interchange/landmarks.h"

#include <map>

namespace ostraka {

/// A curve of a specimen, through some of its landmarks.
struct SpecimenCurve {
    std::string name;                 ///< name of the curve
    bool closed = false;              ///< true: the last point is connected to the first point
    std::vector<std::size_t> points;  ///< indices into LandmarkSpecimen::positions, in the order of the curve
};

/// The landmarks of one specimen.
struct LandmarkSpecimen {
    std::string name;                                             ///< name of the specimen, unique in its file
    std::vector<std::string> landmarks;                           ///< name of each landmark; numbered if the file has no names
    std::vector<std::optional<std::array<double, 3>>> positions;  ///< coordinates; none: the landmark is missing; 2D: z is 0
    std::vector<SpecimenCurve> curves;                            ///< curves; their points follow the other landmarks
    std::map<std::string, std::string> properties;                ///< further data of the specimen: image, labels, groups
};

/// The content of a landmark file.
struct LandmarkSpecimens {
    int dimension = 3;                        ///< 2 or 3
    std::string unit;                         ///< unit of the coordinates; empty if the file does not give it
    std::vector<LandmarkSpecimen> specimens;  ///< in the order of the file
    std::vector<std::string> notes;           ///< messages about content that was interpreted or not kept
};

/// Options for reading specimens.
struct SpecimenOptions {
    /// True: a landmark with a negative coordinate is missing, as digitising programs mark it.
    bool negative_missing = false;
    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// The named points of a set as one specimen without a name; points of curves become landmarks `CURVE 1`, `CURVE 2`, ...
LandmarkSpecimens one_specimen(const LandmarkSet& set);

/// Whether the file name ends as a landmark file does: .mrk.json, .fcsv, .pp, .tps, .nts, .dta, .pts, .csv, .txt, .morphologika.
bool is_specimen_file(const Path& file);

/// Reads all specimens of a landmark file; the format is determined by the extension. A landmark is missing if the file has NA or
/// NaN for it, or -999, -9999 or 9999 for all its coordinates, or the code that the file declares for missing values. Specimens
/// without a name are named after the file; a name that occurs twice gets a number, with a note. Throws Error (input) with file,
/// line and remedy for damaged files, a file without specimens, and specimens of different dimension.
LandmarkSpecimens read_specimens(const Path& file, const SpecimenOptions& options = {});

/// Reads the specimens from the bytes of a landmark file; `where` names the file: its extension determines the format.
LandmarkSpecimens specimens_from_text(const std::string& bytes, const std::string& where, const SpecimenOptions& options = {});

/// The specimens as a TPS file (LM= or LM3=, with NA for missing landmarks, then ID=); names of landmarks are in the comment of
/// the first specimen.
std::string specimens_to_tps(const LandmarkSpecimens& set);

}  // namespace ostraka

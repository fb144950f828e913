// The readers behind specimens_from_text, one per format.
#pragma once

#include "ostraka/interchange/specimens.h"

#include <string_view>

namespace ostraka::interchange {

/// A specimen of a TPS file.
struct TpsSpecimen {
    int dimension = 3;
    std::vector<std::optional<std::array<double, 3>>> points;  ///< landmarks; none: missing
    std::vector<std::size_t> lines;                            ///< line numbers of the landmarks
    std::vector<std::vector<std::optional<std::array<double, 3>>>> curves;
    std::string id, image, comment, variables;
    double scale = 1;
    bool scaled = false;  ///< true: the file states a scale
};
/// The specimens of a TPS file (Rohlf): LM= or LM3=, points, then CURVES=, POINTS=, SCALE=, ID=, IMAGE=, COMMENT= in any order.
std::vector<TpsSpecimen> tps_specimens(const std::string& bytes, const std::string& where);
/// Names of landmarks in the comment of files that this toolkit writes; empty for any other comment.
std::vector<std::string> tps_names(const TpsSpecimen& specimen, const std::string& where);

LandmarkSpecimens read_tps_specimens(const std::string& bytes, const std::string& where);
LandmarkSpecimens read_nts(const std::string& bytes, const std::string& where);
LandmarkSpecimens read_pts(const std::string& bytes, const std::string& where);
LandmarkSpecimens read_morphologika(const std::string& bytes, const std::string& where);
LandmarkSpecimens read_specimen_table(const std::string& bytes, const std::string& where);

/// The words as a point of two or three coordinates; none if it is missing (NA or NaN, or a code for missing values in all
/// coordinates). Throws Error (input), naming `location`, for another number of words or words that are not numbers.
std::optional<std::array<double, 3>> point_of_words(const std::vector<std::string_view>& words, const std::string& location,
                                                    std::optional<double> code = {});
/// Whether the text stands for a missing value.
bool is_missing_word(std::string_view word);

}  // namespace ostraka::interchange

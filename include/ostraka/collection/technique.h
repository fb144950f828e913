// How a tubular body was made, thrown on the wheel or built by hand: what the slices of its lower part say (thesis, sections 3.2
// and 3.2.1).
#pragma once

#include "ostraka/core/json.h"
#include "ostraka/core/mesh.h"
#include "ostraka/core/options.h"

#include <array>
#include <limits>
#include <string>
#include <vector>

namespace ostraka {

struct TechniqueOptions {
    int slices = 100;
    double from = 0.02, to = 0.4;
    double min_turn = 0.8;
    int min_slices = 20;

    void describe(OptionList& visit);
};

/// One slice of the body; lengths are relative to the radius of the circle that fits its outline. NaN where a value is not known.
struct TechniqueSlice {
    static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    double height = 0;                                ///< share of the object's height
    double turn = 0;                                  ///< share of the full turn that the outline covers: 1 for a closed one
    double radius = unknown;                          ///< of the fitted circle, in the mesh's unit
    std::array<double, 2> centre{unknown, unknown};   ///< of the fitted circle, in the mesh's unit
    double roundness = unknown;                       ///< mean distance from the fitted circle
    double roundness_equivalent = unknown;            ///< from the circle of the same area; closed outlines only
    double eccentricity = unknown;                    ///< m / M of the smallest rectangle; closed outlines only
    std::array<double, 2> ovality{unknown, unknown};  ///< second harmonic of the radius over the angle, cosine and sine
    double marks = unknown;                           ///< root mean square of harmonics 3 to 6
    double thickness = unknown;                       ///< mean distance to the cavity, where the slice has a closed one
    double thickness_deviation = unknown;             ///< its standard deviation around the slice
};

/// One number of an object, with the number of slices it stands on.
struct TechniqueDescriptor {
    std::string name;  ///< as in technique_descriptors()
    double value = TechniqueSlice::unknown;
    std::size_t slices = 0;
};

struct TechniqueMeasures {
    std::vector<TechniqueSlice> slices;  ///< those that were used, from below
    std::size_t asked = 0, empty = 0, too_open = 0, open_used = 0;
    std::vector<TechniqueDescriptor> descriptors;  ///< all, in the order of technique_descriptors(); NaN where unknown
    [[nodiscard]] double value(const std::string& descriptor) const;
};

/// A descriptor and what it says.
struct DescriptorMeaning {
    std::string name, words;
    bool positive;  ///< compared by its logarithm
};
/// "roundness mean" and "roundness variance" (over the slices, as the thesis has them), "equivalent roundness mean" and
/// "variance", "eccentricity mean" and "variance", "ovality" and "marks" (root mean squares over the slices), "coherence" (length
/// of the mean ovality vector over their mean length: 1 if all slices are oval in one direction), "straightness" (root mean
/// square distance of the outlines' centres from the straight line that fits them), "upright straightness" (mean distance from
/// the upright line through their mean, as in the thesis), "wall variation" (root mean square deviation of the thickness around
/// each slice, over the mean thickness). Variances are of relative lengths, without unit.
const std::vector<DescriptorMeaning>& technique_descriptors();

/// Cuts the body across `up` at evenly spaced heights. Of each slice the longest contour that is not a hole is taken for the
/// body's outline: an arm that hangs beside it is left out. A closed outline is used, an open one if it covers `min_turn`;
/// descriptors that need a closed outline or wall leave it out. Throws Error (input) for a mesh without faces or height, or with
/// too few slices that can be used; the message says why.
TechniqueMeasures measure_technique(const Mesh& mesh, const Vector& up, const TechniqueOptions& options = {});

/// Descriptors from slices: what measure_technique ends with.
void describe_technique(TechniqueMeasures& measures);

/// To keep them.
Json technique_to_json(const TechniqueMeasures& measures);
TechniqueMeasures technique_from_json(const JsonValue& json);

}  // namespace ostraka

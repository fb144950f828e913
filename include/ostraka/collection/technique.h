// Forming technique of a tubular body, wheel-thrown or hand-built, measured on slices of its lower part (thesis, sections 3.2
// and 3.2.1).
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/files/json.h"
#include "ostraka/mesh/mesh.h"

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

/// One slice of the body. Lengths are relative to the radius of the circle fitted to its outline. Unknown values are NaN.
struct TechniqueSlice {
    static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    double height = 0;                                ///< fraction of the object's height
    double turn = 0;                                  ///< fraction of the full turn covered by the outline; 1 if closed
    double radius = unknown;                          ///< radius of the fitted circle, in the mesh's unit
    std::array<double, 2> centre{unknown, unknown};   ///< centre of the fitted circle, in the mesh's unit
    double roundness = unknown;                       ///< mean distance from the fitted circle
    double roundness_equivalent = unknown;            ///< mean distance from the circle of equal area; closed outlines only
    double eccentricity = unknown;                    ///< m / M of the smallest enclosing rectangle; closed outlines only
    std::array<double, 2> ovality{unknown, unknown};  ///< second harmonic of the radius over the angle, cosine and sine
    double marks = unknown;                           ///< root mean square of harmonics 3 to 6
    double thickness = unknown;                       ///< mean distance to the cavity; slices with a closed cavity only
    double thickness_deviation = unknown;             ///< standard deviation of the thickness around the slice
};

/// One descriptor of an object, with the number of slices it is computed from.
struct TechniqueDescriptor {
    std::string name;  ///< as in technique_descriptors()
    double value = TechniqueSlice::unknown;
    std::size_t slices = 0;
};

struct TechniqueMeasures {
    std::vector<TechniqueSlice> slices;  ///< the used slices, from bottom to top
    std::size_t asked = 0, empty = 0, too_open = 0, open_used = 0;
    std::vector<TechniqueDescriptor> descriptors;  ///< all, in the order of technique_descriptors(); NaN where unknown
    [[nodiscard]] double value(const std::string& descriptor) const;
};

/// A descriptor and its meaning.
struct DescriptorMeaning {
    std::string name, words;
    bool positive;  ///< compared by its logarithm
};
/// All descriptors: "roundness mean" and "roundness variance" (over the slices, as in the thesis), "equivalent roundness mean"
/// and "variance", "eccentricity mean" and "variance", "ovality" and "marks" (root mean squares over the slices), "coherence"
/// (length of the mean ovality vector over the mean length: 1 if all slices are oval in the same direction), "straightness"
/// (root mean square distance of the outlines' centres from their fitted line), "upright straightness" (mean distance from the
/// upright line through the mean centre, as in the thesis), "wall variation" (root mean square deviation of the thickness
/// around each slice, over the mean thickness). Variances are of relative lengths, without unit.
const std::vector<DescriptorMeaning>& technique_descriptors();

/// Slices the body across `up` at evenly spaced heights. In each slice the longest contour that is not a hole is the outline of
/// the body; a separate contour such as an arm is ignored. A closed outline is used; an open outline is used if it covers
/// `min_turn`, and is skipped by the descriptors that need a closed outline or a wall. Throws Error (input), with the reason,
/// for a mesh without faces or height, or if too few slices can be used.
TechniqueMeasures measure_technique(const Mesh& mesh, const Vector& up, const TechniqueOptions& options = {});

/// Computes the descriptors from the slices; the last step of measure_technique.
void describe_technique(TechniqueMeasures& measures);

/// Serialisation for the result store.
Json technique_to_json(const TechniqueMeasures& measures);
TechniqueMeasures technique_from_json(const JsonValue& json);

}  // namespace ostraka

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

/// Options of `measure_technique`.
struct TechniqueOptions {
    int slices = 100;              ///< number of slices per object
    double from = 0.02, to = 0.4;  ///< ends of the sliced range, as fractions of the height
    double min_turn = 0.8;         ///< open outlines that cover a smaller fraction of the full turn are not used
    int min_slices = 20;           ///< min number of usable slices per object

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// One slice of the body. Lengths are relative to the radius of the circle fitted to its outline. Unknown values are NaN.
struct TechniqueSlice {
    /// Marks a value that is not known.
    static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    double height = 0;                               ///< height of the slice, as a fraction of the object's height
    double turn = 0;                                 ///< fraction of the full turn covered by the outline; 1 if closed
    double radius = unknown;                         ///< radius of the fitted circle, in the mesh's unit
    std::array<double, 2> centre{unknown, unknown};  ///< centre of the fitted circle, in the mesh's unit
    double roundness = unknown;                      ///< mean distance of the outline from the fitted circle
    /// Mean distance of the outline from the circle of equal area around its barycentre, relative to the radius of that circle;
    /// closed outlines only.
    double roundness_equivalent = unknown;
    /// Short side divided by long side of the smallest enclosing rectangle; closed outlines only.
    double eccentricity = unknown;
    std::array<double, 2> ovality{unknown, unknown};  ///< second harmonic of the radius over the angle, cosine and sine
    double marks = unknown;                           ///< root mean square of harmonics 3 to 6 of the radius
    /// Mean distance of the outline from the cavity; slices with a closed cavity only.
    double thickness = unknown;
    double thickness_deviation = unknown;  ///< standard deviation of the thickness around the slice
};

/// Value of one descriptor of an object.
struct TechniqueDescriptor {
    std::string name;                        ///< name of the descriptor (technique_descriptors)
    double value = TechniqueSlice::unknown;  ///< value of the descriptor; NaN if unknown
    std::size_t slices = 0;                  ///< number of slices from which the value is computed
};

/// Slices and descriptors of one object.
struct TechniqueMeasures {
    std::vector<TechniqueSlice> slices;  ///< the used slices, from bottom to top
    /// Numbers of slices: requested (asked); without an outline (empty); with an open outline and not used (too_open); with an
    /// open outline and used (open_used).
    std::size_t asked = 0, empty = 0, too_open = 0, open_used = 0;
    std::vector<TechniqueDescriptor> descriptors;  ///< all descriptors, in the order of technique_descriptors()
    [[nodiscard]] double value(const std::string& descriptor) const;  ///< value of the descriptor of this name
};

/// A descriptor, with a description of its meaning.
struct DescriptorMeaning {
    std::string name, words;  ///< name of the descriptor; its meaning in words
    bool positive;            ///< true: the descriptor is positive and compared by its logarithm
};
/// All descriptors: "roundness mean" and "roundness variance" (over the slices, as in the thesis), "equivalent roundness mean"
/// and "variance", "eccentricity mean" and "variance", "ovality" and "marks" (root mean squares over the slices), "coherence"
/// (length of the mean ovality vector over the mean length: 1 if all slices are oval in the same direction), "straightness" (root
/// mean square distance of the outlines' centres from their fitted line), "upright straightness" (mean distance from the upright
/// line through the mean centre, as in the thesis), "wall variation" (root mean square deviation of the thickness around each
/// slice, over the mean thickness). All variances are variances of relative lengths, without unit.
const std::vector<DescriptorMeaning>& technique_descriptors();

/// Slices the body across `up` at evenly spaced heights. In each slice the longest contour that is not a hole is the outline of
/// the body; a separate contour such as an arm is ignored. A closed outline is always used. An open outline is used if it
/// covers at least `min_turn` of the full turn, but not to compute descriptors that need a closed outline or a wall. Throws
/// Error (input), with the reason, for a mesh without faces or height, or if too few slices can be used.
TechniqueMeasures measure_technique(const Mesh& mesh, const Vector& up, const TechniqueOptions& options = {});

/// Computes the descriptors from the slices; the last step of measure_technique.
void describe_technique(TechniqueMeasures& measures);

/// The measures as JSON for the result store.
Json technique_to_json(const TechniqueMeasures& measures);
TechniqueMeasures technique_from_json(const JsonValue& json);

}  // namespace ostraka

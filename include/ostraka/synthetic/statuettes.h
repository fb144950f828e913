// Synthetic scans of votive statuettes with known technique and sizes: wheel-thrown and hand-built bodies (modelled on the
// terracottas of Ayia Irini; thesis, chapter 3).
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/geom/surface_point.h"
#include "ostraka/synthetic/make_mesh.h"
#include "ostraka/synthetic/synthetic_object.h"

#include <memory>
#include <string>
#include <vector>

namespace ostraka {

/// One statuette. Lengths are in millimetres; z is up, the base lies at z = 0, the face looks along +x. The tube is the body
/// between base and shoulders; the radius of the tube is 0.33 base diameters.
struct StatuetteParameters {
    enum class Technique { wheel, hand } technique = Technique::wheel;           ///< how the body was made
    double height = 200, base_diameter = 58, arm_length = 82, head_height = 44;  ///< sizes, mm
    /// The tube's radius is r (1 + ovality cos 2(a - direction)) at the angle a; the maximum is along `direction`.
    double ovality = 0;
    double ovality_drift = 0;  ///< rotation of the ovality's direction from base to shoulders, degrees
    double finger_marks = 0;   ///< root mean square of waves with 3 to 7 periods per turn, as a share of the tube's radius
    double sway = 0;  ///< root mean square deviation of the tube's centres from a straight axis, as a share of the tube's radius
    double grooves = 0;      ///< height of throwing grooves, mm
    double wall = 5;         ///< mean wall thickness, mm; 0: solid
    double wall_noise = 0;   ///< root mean square variation of the wall thickness, as a share of the mean thickness
    double off_centre = 0;   ///< offset of the cavity from the tube's centre, as a share of the wall thickness
    double cavity_seen = 1;  ///< share of the cavity's depth that the scan contains, 0 to 1
    enum class Interior { closed, open } interior = Interior::closed;  ///< end of the scanned cavity: a flat wall, or open
    double scan_noise = 0;   ///< standard deviation of the vertex displacement along the normal, mm
    int holes = 0;           ///< number of patches of the body that are missing in the scan
    double hole_radius = 5;  ///< radius of the missing patches, mm
    enum class Pose { forward, offering, raised, down } pose = Pose::forward;  ///< arm pose; offering: the hands hold a bowl
    enum class Hat { cone, cap, none } hat = Hat::cone;                        ///< shape of the hat
    bool beard = false;                                                        ///< true: the head has a beard
    std::uint64_t seed = 1;          ///< random seed of wave phases, noise, holes and mesh lattice
    std::uint64_t vertices = 10000;  ///< target number of vertices

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// A named landmark on the surface.
struct StatuetteLandmark {
    std::string name;         ///< name of the landmark
    Index vertex = no_index;  ///< nearest vertex of the mesh
    SurfacePoint place;       ///< position in a face
};

/// A generated statuette with its ground truth.
struct Statuette {
    StatuetteParameters parameters;                         ///< parameters of the statuette
    std::vector<std::string> parts;                         ///< names of the parts
    std::vector<std::array<std::uint8_t, 3>> part_colours;  ///< red, green, blue of each part
    Mesh mesh;  ///< oriented, manifold, connected; closed unless a part of the surface is missing in the scan
    std::vector<std::int32_t> face_labels;  ///< for each face, the index of its part
    /// Landmarks: "base right", "base left" (ends of the longest diameter), "base centre" (not for open bases), "top of the
    /// head", "head joint" (at the back of the neck), and for each arm "arm joint", "arm outside 1" to "arm outside 5", "hand
    /// end", each followed by " right" or " left". Landmarks in a missing part of the surface are left out.
    std::vector<StatuetteLandmark> landmarks;
};

/// The implicit object of a statuette: body, cavity (down to the scanned depth), head, arms. Throws Error (usage) for parameters
/// out of range or inconsistent parameters (a wall thicker than the body).
std::unique_ptr<const SyntheticObject> statuette_object(const StatuetteParameters& parameters);

/// Generates the scan of a statuette. Throws the errors of statuette_object and make_mesh.
Statuette generate_statuette(const StatuetteParameters& parameters);

/// Medians, over a population of one technique, of the parameters that distinguish the techniques.
struct TechniqueLevel {
    double ovality, ovality_drift, finger_marks, sway, wall_noise, off_centre;
};
/// Parameters of both techniques at one level of difficulty.
struct StatuetteLevel {
    TechniqueLevel wheel, hand;  ///< parameters of wheel-thrown and of hand-built statuettes
    double spread;  ///< standard deviation of the natural logarithm of each parameter; parameters are drawn independently
};
/// Parameters of the techniques at a level from 1 (large difference) to 5 (small difference). Throws Error (usage) for other
/// levels.
StatuetteLevel statuette_level(int level);

/// Options of a population of wheel-thrown and hand-built statuettes.
struct PopulationOptions {
    int objects = 100;               ///< number of statuettes, half of them of each technique
    int level = 1;                   ///< difference between the techniques, from 1 (large) to 5 (small)
    std::uint64_t seed = 1;          ///< random seed
    std::uint64_t vertices = 10000;  ///< target number of vertices of each statuette
    double scan_noise = 0.05;        ///< standard deviation of the vertex displacement along the normal, mm
    /// End of the scanned cavities. closed: a flat wall; open: open; mixed: alternately closed and open.
    enum class Interior { mixed, closed, open } interior = Interior::mixed;
    double cavity_seen = 0.35;  ///< min share of a cavity's depth that a scan contains, 0 to 1
    int holes = 0;              ///< max number of patches that are missing in a scan
    double size_spread = 0.07;  ///< standard deviation of the logarithm of each size

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// Parameters of every statuette of a population; the parameters of statuette i do not depend on the number of statuettes.
std::vector<StatuetteParameters> draw_population(const PopulationOptions& options);

/// Options of a population of wheel-thrown statuettes. Each statuette has a common size factor and individual factors for its
/// sizes; some sizes are in fixed proportion.
struct ProportionedOptions {
    int objects = 40;  ///< number of statuettes
    /// Names of the sizes that are in fixed proportion to each other, from `size_names`.
    std::vector<std::string> fixed{"arm length", "base diameter"};
    bool no_fixed_ratios = false;  ///< true: no size is in fixed proportion
    /// Standard deviations of the logarithm: of the common size, of ratios that are not fixed, and of fixed ratios; standard
    /// deviation of the vertex displacement along the normal, mm.
    double size_deviation = 0.12, ratio_deviation = 0.15, planted_deviation = 0.03, scan_noise = 0.05;
    std::uint64_t seed = 1, vertices = 10000;

    /// Names of the four sizes.
    static constexpr std::array<const char*, 4> size_names{"total height", "base diameter", "arm length", "head height"};
    /// True if this size is in fixed proportion to other sizes.
    [[nodiscard]] bool is_fixed(const std::string& size) const;
    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// Parameters of a population whose sizes have the medians of Table 3.1 of the thesis; the parameters of statuette i do not
/// depend on the number of statuettes. Throws Error (usage) for options out of range, or if only a single size is in `fixed`.
std::vector<StatuetteParameters> draw_population(const ProportionedOptions& options);

}  // namespace ostraka

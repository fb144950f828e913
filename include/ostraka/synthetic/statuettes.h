// Synthetic populations of votive statuettes with known technique and sizes: wheel-thrown and hand-built bodies as scanned
// (after the terracottas of Ayia Irini; thesis, chapter 3).
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
/// between base and shoulders; its radius is 0.33 base diameters.
struct StatuetteParameters {
    enum class Technique { wheel, hand } technique = Technique::wheel;
    double height = 200, base_diameter = 58, arm_length = 82, head_height = 44;
    double ovality = 0;        ///< tube radius r (1 + ovality cos 2(a - direction)); the maximum is along `direction`
    double ovality_drift = 0;  ///< rotation of the direction from base to shoulders, degrees
    double finger_marks = 0;   ///< root mean square of waves with 3 to 7 periods per turn, relative to the radius
    double sway = 0;           ///< root mean square deviation of the centres from a straight axis, relative to the tube's radius
    double grooves = 0;        ///< height of throwing grooves, mm
    double wall = 5;           ///< mean thickness, mm; 0: solid
    double wall_noise = 0;     ///< root mean square variation of the thickness, relative to the wall
    double off_centre = 0;     ///< offset of the cavity, relative to the wall
    double cavity_seen = 1;    ///< fraction of the cavity's depth that was scanned
    enum class Interior { closed, open } interior = Interior::closed;  ///< end of the scanned cavity: a flat wall, or open
    double scan_noise = 0;   ///< standard deviation of the vertex displacement along the normal, mm
    int holes = 0;           ///< number of patches of the body missing in the scan
    double hole_radius = 5;  ///< radius of the missing patches, mm
    enum class Pose { forward, offering, raised, down } pose = Pose::forward;  ///< arm pose; offering: the hands hold a bowl
    enum class Hat { cone, cap, none } hat = Hat::cone;
    bool beard = false;
    std::uint64_t seed = 1;  ///< random seed of wave phases, noise, holes and mesh lattice
    std::uint64_t vertices = 10000;

    void list_options(OptionList& list);
};

/// A named point on the surface.
struct StatuetteLandmark {
    std::string name;
    Index vertex = no_index;  ///< nearest vertex of the mesh
    SurfacePoint place;       ///< in a face
};

struct Statuette {
    StatuetteParameters parameters;
    std::vector<std::string> parts;
    std::vector<std::array<std::uint8_t, 3>> part_colours;
    Mesh mesh;                              ///< oriented, manifold, connected; closed unless something is missing
    std::vector<std::int32_t> face_labels;  ///< part of each face
    /// "base right", "base left" (ends of the longest diameter), "base centre" (not for open bases), "top of the head", "head
    /// joint" (at the back of the neck), and for each arm "arm joint", "arm outside 1" to "arm outside 5", "hand end" with "
    /// right" or " left". Landmarks in a hole are left out.
    std::vector<StatuetteLandmark> landmarks;
};

/// The implicit object: body, cavity (down to the scanned depth), head, arms. Throws Error (usage) for parameters out of range
/// or inconsistent parameters (a wall thicker than the body).
std::unique_ptr<const SyntheticObject> statuette_object(const StatuetteParameters& parameters);

/// The scan of the statuette. Throws the errors of statuette_object and make_mesh.
Statuette generate_statuette(const StatuetteParameters& parameters);

/// Parameters of one technique: medians over a population.
struct TechniqueLevel {
    double ovality, ovality_drift, finger_marks, sway, wall_noise, off_centre;
};
struct StatuetteLevel {
    TechniqueLevel wheel, hand;
    double spread;  ///< standard deviation of the natural logarithm of each parameter, drawn independently
};
/// Difference between the techniques, from level 1 (large) to 5 (small). Throws Error (usage) for other levels.
StatuetteLevel statuette_level(int level);

struct PopulationOptions {
    int objects = 100;
    int level = 1;
    std::uint64_t seed = 1;
    std::uint64_t vertices = 10000;
    double scan_noise = 0.05;
    enum class Interior { mixed, closed, open } interior = Interior::mixed;
    double cavity_seen = 0.35;
    int holes = 0;
    double size_spread = 0.07;

    void list_options(OptionList& list);
};

/// Parameters of every statuette of a population; object i does not depend on the number of objects.
std::vector<StatuetteParameters> draw_population(const PopulationOptions& options);

/// Options of wheel-thrown statuettes whose sizes vary with a common size and individually, some in fixed proportion.
struct ProportionedOptions {
    int objects = 40;
    /// Sizes in fixed proportion to each other, from `size_names`.
    std::vector<std::string> fixed{"arm length", "base diameter"};
    bool none = false;  ///< no size is in fixed proportion
    double size_deviation = 0.12, ratio_deviation = 0.15, planted_deviation = 0.03, scan_noise = 0.05;
    std::uint64_t seed = 1, vertices = 10000;

    static constexpr std::array<const char*, 4> size_names{"total height", "base diameter", "arm length", "head height"};
    /// Whether this size is in fixed proportion to others.
    [[nodiscard]] bool is_fixed(const std::string& size) const;
    void list_options(OptionList& list);
};

/// Medians as in Table 3.1 of the thesis; object i does not depend on the number of objects. Throws Error (usage) for options
/// out of range, or if only a single size is to be fixed.
std::vector<StatuetteParameters> draw_population(const ProportionedOptions& options);

}  // namespace ostraka

// Generated populations of votive statuettes whose technique and sizes are known: bodies thrown on the wheel and bodies built by
// hand, as a scanner sees them (after the terracottas of Ayia Irini; thesis, chapter 3).
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/synthetic/make_mesh.h"
#include "ostraka/synthetic/synthetic_object.h"

#include <memory>
#include <string>
#include <vector>

namespace ostraka {

/// One statuette. Lengths are millimetres; z points up, the base stands at z = 0, the face looks along +x. "Tube" is the body
/// between base and shoulders; its radius is 0.33 base diameters.
struct StatuetteParameters {
    enum class Technique { wheel, hand } technique = Technique::wheel;
    double height = 200, base_diameter = 58, arm_length = 82, head_height = 44;
    double ovality = 0;        ///< the tube's radius is r (1 + ovality cos 2(a - direction)): its longest is along `direction`
    double ovality_drift = 0;  ///< degrees by which the direction turns from the base to the shoulders
    double finger_marks = 0;   ///< root mean square of waves of 3 to 7 periods in a turn, relative to the radius
    double sway = 0;           ///< root mean square of the centres' way off a straight axis, relative to the tube's radius
    double grooves = 0;        ///< height of throwing grooves, mm
    double wall = 5;           ///< mean thickness, mm; 0: solid
    double wall_noise = 0;     ///< root mean square of the thickness's waves, relative to the wall
    double off_centre = 0;     ///< of the cavity, relative to the wall
    double cavity_seen = 1;    ///< share of the cavity's depth that the scanner saw
    enum class Interior {
        closed,
        open
    } interior = Interior::closed;  ///< where the scanner's sight ends: a flat wall, or nothing
    double scan_noise = 0;          ///< standard deviation of each vertex along its normal, mm
    int holes = 0;                  ///< patches of the body that the scan misses
    double hole_radius = 5;         ///< mm
    enum class Pose { forward, offering, raised, down } pose = Pose::forward;  ///< of the arms; offering: the hands hold a bowl
    enum class Hat { cone, cap, none } hat = Hat::cone;
    bool beard = false;
    std::uint64_t seed = 1;  ///< of the waves' phases, the noise, the holes and the mesh's lattice
    std::uint64_t vertices = 10000;

    void describe(OptionList& visit);
};

/// A named place on the surface.
struct StatuetteLandmark {
    std::string name;
    Index vertex = no_index;                     ///< of the mesh, nearest to the place
    Index face = no_index;                       ///< that holds the place
    std::array<double, 3> barycentric{1, 0, 0};  ///< weights of corners(mesh, face)
    Point place{0, 0, 0};
};

struct Statuette {
    StatuetteParameters parameters;
    std::vector<std::string> parts;
    std::vector<std::array<std::uint8_t, 3>> part_colours;
    Mesh mesh;                              ///< oriented, manifold, one piece; closed unless something is missing
    std::vector<std::int32_t> face_labels;  ///< part of each face
    /// "base right", "base left" (the ends of the longest diameter), "base centre" (open bases have none), "top of the head",
    /// "head joint" (at the back of the neck), and for each arm "arm joint", "arm outside 1" to "arm outside 5", "hand end" with
    /// " right" or " left". Those in a hole are left out.
    std::vector<StatuetteLandmark> landmarks;
};

/// The implicit object alone: body, cavity (as deep as it is seen), head, arms. Throws Error (usage) for parameters out of range
/// or that do not fit each other (a wall thicker than the body).
std::unique_ptr<const SyntheticObject> statuette_object(const StatuetteParameters& parameters);

/// The statuette as its scan. Throws Error as statuette_object and make_mesh do.
Statuette generate_statuette(const StatuetteParameters& parameters);

/// How far the two techniques lie apart: medians over a population, with the standard deviation of their logarithms.
struct TechniqueLevel {
    double ovality, ovality_drift, finger_marks, sway, wall_noise, off_centre;
};
struct StatuetteLevel {
    TechniqueLevel wheel, hand;
    double spread;  ///< standard deviation of the natural logarithm of each, drawn independently
};
/// Levels 1 (far apart) to 5 (nearly alike). Throws Error (usage) for others.
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

    void describe(OptionList& visit);
};

/// Parameters of every statuette of a population; object i is the same whatever the number of objects.
std::vector<StatuetteParameters> draw_population(const PopulationOptions& options);

/// Statuettes thrown on the wheel whose sizes vary with a common size and by themselves, some of them in fixed proportion.
struct ProportionedOptions {
    int objects = 40;
    std::vector<std::string> fixed{"arm length", "base diameter"};  ///< in fixed proportion to each other, of `size_names`
    bool none = false;                                              ///< none is
    double size_deviation = 0.12, ratio_deviation = 0.15, planted_deviation = 0.03, scan_noise = 0.05;
    std::uint64_t seed = 1, vertices = 10000;

    static constexpr std::array<const char*, 4> size_names{"total height", "base diameter", "arm length", "head height"};
    /// Whether the size of this name is one of those in fixed proportion.
    [[nodiscard]] bool is_fixed(const std::string& size) const;
    void describe(OptionList& visit);
};

/// Medians as in the thesis's Table 3.1; object i is the same whatever the number of objects. Throws Error (usage) for options
/// out of range and where a single size is to be fixed.
std::vector<StatuetteParameters> draw_population(const ProportionedOptions& options);

}  // namespace ostraka

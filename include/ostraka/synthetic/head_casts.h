// Synthetic casts of heads from moulds. Each cast is individually deformed, shrunk, worn, scanned and broken off.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/synthetic/heads.h"
#include "ostraka/synthetic/make_mesh.h"

#include <array>

namespace ostraka {

/// Height of a head without hat and neck, mm; options given as a share of the head's height refer to it.
inline constexpr double head_height = 44;

struct CastOptions {
    double wear = 0;  ///< max wear: standard deviation of the smoothing, as a share of the head's height
    /// Deformation of the soft clay: standard deviation of the relative stretches along the axes and of a bend.
    double pressure = 0;
    double shrinkage = 0;            ///< max linear shrinkage of the cast, as a share of the archetype's size
    double noise = 0;                ///< standard deviation of the scan noise, as a share of the head's height
    double beard = 0;                ///< share of the casts that have a beard, 0 to 1
    double chunk = 0;                ///< share of the casts with a missing piece, 0 to 1
    int dents = 0;                   ///< max number of dents on the front
    bool body = false;               ///< true: the cast includes a body, and the head is not broken off
    bool keep_pose = false;          ///< true: no rigid motion is applied
    std::uint64_t vertices = 10000;  ///< target number of vertices
    std::uint64_t seed = 1;          ///< random seed

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// A cast with its random parameters.
struct HeadCast {
    Mesh mesh;  ///< closed except at the neck, where the head was broken off from its body, and at a missing piece
    std::vector<std::int32_t> face_labels;  ///< for each face, index of its part in head_part_names()
    double wear = 0, shrinkage = 0;         ///< random wear and shrinkage of this cast
    bool beard = false, chunk = false;      ///< true: the cast has a beard; a piece is missing
    std::array<double, 3> up{0, 0, 1};      ///< upward direction of the cast in its pose
};

/// Generates one cast of an archetype. The front of the cast is that of the archetype; the back of the head, the beard and the
/// dents are random for every cast. Order of operations: dents and beard in the solid, meshing, wear, bending and stretching,
/// shrinkage, scan noise, breakage, rigid motion. Throws Error (usage) for options out of range or too few vertices.
HeadCast cast_head(const HeadShape& shape, const CastOptions& options = {});

/// Options of a population of heads from several moulds.
struct MouldPopulationOptions {
    int objects = 40;        ///< number of moulded heads
    int moulds = 4;          ///< number of moulds
    int hand_made = 0;       ///< number of additional hand-formed heads
    double difference = 1;   ///< variation between the archetypes of the moulds, see ArchetypeOptions
    std::uint64_t seed = 1;  ///< random seed

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// Specification of one head of a population, before it is generated.
struct PlannedHead {
    std::string name;   ///< head-001, head-002 ...
    std::string mould;  ///< mould-1, mould-2 ...; for hand-formed heads "hand" and the hat
    HeadShape shape;    ///< archetype of the mould
    CastOptions cast;   ///< options of the cast
};
/// Plans a population: heads are assigned to the moulds cyclically and named in random order, so that their names carry no
/// information.
std::vector<PlannedHead> plan_heads(const MouldPopulationOptions& population, const CastOptions& cast);

}  // namespace ostraka

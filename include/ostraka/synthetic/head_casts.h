// Casts of heads as they are found: each individually pressed, shrunk, worn, scanned and cut.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/synthetic/heads.h"
#include "ostraka/synthetic/make_mesh.h"

#include <array>

namespace ostraka {

/// Height of a head without hat and neck, mm. Values relative to the head's height refer to it.
inline constexpr double head_height = 44;

struct CastOptions {
    double wear = 0;       ///< standard deviation of the smoothing, relative to the head's height
    double pressure = 0;   ///< stretching and bending of the soft clay
    double shrinkage = 0;  ///< linear shrinkage of the cast relative to its archetype
    double noise = 0;      ///< scan noise, relative to the head's height
    double beard = 0;      ///< fraction of the casts with a beard
    double chunk = 0;      ///< fraction of the casts with a missing piece
    int dents = 0;         ///< maximum number of dents on the front
    bool body = false;     ///< the head has its own body, and nothing is broken off
    bool keep_pose = false;
    std::uint64_t vertices = 10000;
    std::uint64_t seed = 1;

    void list_options(OptionList& list);
};

/// A cast with its random parameters.
struct HeadCast {
    Mesh mesh;  ///< closed except at the neck, where it was broken off from its body, and at a missing piece
    std::vector<std::int32_t> face_labels;  ///< indices into head_part_names()
    double wear = 0, shrinkage = 0;         ///< as drawn
    bool beard = false, chunk = false;
    std::array<double, 3> up{0, 0, 1};  ///< up direction in its pose
};

/// Generates one cast. Its front is the archetype's; its back, beard and dents are new for every cast. Order of operations:
/// dents and beard in the solid, meshing, wear, bending and stretching, shrinkage, scan noise, breakage, rigid motion. Throws
/// Error (usage) for options out of range or too few vertices.
HeadCast cast_head(const HeadShape& shape, const CastOptions& options = {});

/// Options of a population.
struct MouldPopulationOptions {
    int objects = 40;
    int moulds = 4;
    int hand_made = 0;
    double difference = 1;
    std::uint64_t seed = 1;

    void list_options(OptionList& list);
};

/// Specification of one head of a population.
struct PlannedHead {
    std::string name;   ///< head-001 ...
    std::string mould;  ///< mould-1 ...; "hand" and the hat for hand-formed heads
    HeadShape shape;
    CastOptions cast;
};
/// Plans a population: heads are assigned to the moulds cyclically and named in random order, so that names carry no information.
std::vector<PlannedHead> plan_heads(const MouldPopulationOptions& population, const CastOptions& cast);

}  // namespace ostraka

// Casts of heads as they come to us: each pressed, shrunk, worn, scanned and cut on its own.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/synthetic/heads.h"
#include "ostraka/synthetic/make_mesh.h"

#include <array>

namespace ostraka {

/// Height of a head without hat and neck, mm: what shares of the head's height refer to.
inline constexpr double head_height = 44;

struct CastOptions {
    double wear = 0;       ///< standard deviation of the smoothing, as a share of the head's height
    double pressure = 0;   ///< stretch and bend of the soft clay
    double shrinkage = 0;  ///< linear, of the cast against its archetype
    double noise = 0;      ///< of the scan, as a share of the head's height
    double beard = 0;      ///< share of the casts that bear one
    double chunk = 0;      ///< share of the casts that miss a piece
    int dents = 0;         ///< on the front, up to
    bool body = false;     ///< the head stands on a body of its own, and nothing is broken off
    bool keep_pose = false;
    std::uint64_t vertices = 10000;
    std::uint64_t seed = 1;

    void describe(OptionList& visit);
};

/// A cast, and what was drawn for it.
struct HeadCast {
    Mesh mesh;  ///< closed but for the neck, where it was broken off from its body, and a missing piece
    std::vector<std::int32_t> face_labels;  ///< as head_part_names()
    double wear = 0, shrinkage = 0;         ///< as drawn
    bool beard = false, chunk = false;
    std::array<double, 3> up{0, 0, 1};  ///< in its pose
};

/// One cast. Its front is the archetype's; its back, its beard and its dents are made anew for every cast. Order of what befalls
/// it: dents and beard in the solid, meshed on its own, worn, bent and stretched, shrunk, scanned with noise, broken, turned and
/// moved. Throws Error (usage) for options out of range or too few vertices.
HeadCast cast_head(const HeadShape& shape, const CastOptions& options = {});

/// One whole population.
struct MouldPopulationOptions {
    int objects = 40;
    int moulds = 4;
    int hand_made = 0;
    double difference = 1;
    std::uint64_t seed = 1;

    void describe(OptionList& visit);
};

/// What one head of a population is made of.
struct PlannedHead {
    std::string name;   ///< head-001 ...
    std::string mould;  ///< mould-1 ...; "hand" and the hat for those formed by hand
    HeadShape shape;
    CastOptions cast;
};
/// The plan: heads dealt to the moulds in turn and named in an order drawn by the seed, so that names tell nothing.
std::vector<PlannedHead> plan_heads(const MouldPopulationOptions& population, const CastOptions& cast);

}  // namespace ostraka

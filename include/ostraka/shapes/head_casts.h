// Casts of heads as they come to us: each pressed, shrunk, worn, scanned and cut on its own.
#pragma once

#include "ostraka/shapes/heads.h"
#include "ostraka/shapes/make_mesh.h"

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
    bool keep_pose = false;
    std::uint64_t vertices = 10000;
    std::uint64_t seed = 1;

    template <class Visitor>
    void describe(Visitor& visit) {
        visit("wear", wear,
              "how worn a cast is at most: standard deviation of a Gaussian that smooths its surface, as a share of the head's "
              "height; each cast has half of it to all of it, and half of that at some places",
              Range{0, 0.1});
        visit("pressure", pressure,
              "soft clay gives way: standard deviation of stretches along the axes and of a bend, as a share", Range{0, 0.1});
        visit("shrinkage", shrinkage, "casts are smaller than their archetype by up to this share", Range{0, 0.3});
        visit("noise", noise, "scan noise: standard deviation along the normal, as a share of the head's height", Range{0, 0.01});
        visit("beard", beard, "share of the casts that bear a beard added by hand", Range{0, 1});
        visit("chunk", chunk, "share of the casts that miss a piece of the face", Range{0, 1});
        visit("dents", dents, "small dents in the front, up to", Range{0, 20});
        visit("keep-pose", keep_pose, "leave heads upright, looking along x, instead of turned and moved at random", Anything{});
        visit("vertices", vertices, "number of vertices of the whole head", Range{1500, 1e6});
        visit("cast-seed", seed, "draws all of it, and the mesh", Range{0, 9007199254740992.0});
    }
};

/// A cast, and what was drawn for it.
struct HeadCast {
    Mesh mesh;                              ///< closed but for the neck, where it was broken off, and a missing piece
    std::vector<std::int32_t> face_labels;  ///< as head_part_names()
    double wear = 0, shrinkage = 0;         ///< as drawn
    bool beard = false, chunk = false;
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

    template <class Visitor>
    void describe(Visitor& visit) {
        visit("objects", objects, "number of moulded heads", Range{1, 100000});
        visit("moulds", moulds, "number of moulds; every other one has long hair", Range{1, 1000});
        visit("hand-made", hand_made, "heads formed by hand besides", Range{0, 100000});
        visit("difference", difference, "how far archetypes lie apart: 1 = proportions vary by about 8 %", Range{0, 3});
        visit("seed", seed, "draws everything", Range{0, 9007199254740992.0});
    }
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

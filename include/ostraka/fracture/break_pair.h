// Two fragments that share a break, fitted together by it.
#pragma once

#include "ostraka/core/json.h"
#include "ostraka/core/options.h"
#include "ostraka/fracture/fragment.h"

#include <string>
#include <vector>

namespace ostraka {

struct PairOptions {
    int frames = 160;             ///< places along the rim of each fragment's fracture
    int samples = 2000;           ///< points on the fracture of the second fragment, and on the rest of its surface
    int starts = 200;             ///< poses that are refined quickly, the best of all
    int refined = 24;             ///< poses that are refined to the end
    double search_radius = 0.05;  ///< farthest that faces of a break lie apart at first, share of the smaller fragment's size
    double last_search_radius = 0.025;  ///< at the end
    double edges = 1;                   ///< weight of the rims against the fracture surfaces
    double min_contact = 0.1;           ///< of the smaller fracture that must be in contact
    double min_confidence = 0.5;        ///< below it cannot be determined how the fragments go together
    int candidates = 5;                 ///< reported

    void describe(OptionList& visit);
};

/// A way to lay the second fragment onto the first.
struct PairCandidate {
    Motion pose;          ///< rigid: the second fragment onto the first
    double score = 0;     ///< contact + rim - penetration, as shares of the smaller fracture and its rim
    double contact = 0;   ///< share of the smaller fracture's area within the last search radius of the other, facing it
    double rim = 0;       ///< share of the shorter rim within the last search radius of the other, sides continued
    double residual = 0;  ///< root mean square distance of what is in contact, in the unit of the fragments
    double penetration =
        0;  ///< area of the second fragment deeper in the first than the last search radius, share of the smaller fracture
    double depth = 0;  ///< of the deepest point, in the unit of the fragments
};

struct BreakPair {
    std::vector<PairCandidate> candidates;  ///< best first, each of another place
    double confidence = 0;                  ///< 0 to 1: contact of the best, and how far it is ahead of the next
    std::string undecided;                  ///< why it cannot be determined, in words; empty: the first candidate is the answer
    double fracture_a = 0, fracture_b = 0;  ///< areas
    double size = 0;                        ///< square root of the area of the smaller fragment
    std::size_t tried = 0;                  ///< poses
    [[nodiscard]] bool decided() const { return undecided.empty(); }
};

/// Along the rims of the fractures stand frames: the normal of the outer (or inner) surface, that of the fracture, and the rim.
/// Each frame of the second fragment aligned with each of the first with the same side, fractures facing each other, is a pose;
/// all are scored by the fracture that comes into contact and by what would lie inside the other fragment. The best are refined
/// by closest points, point to plane, between fractures that face each other, and between rims, whose sides continue each other;
/// the search radius falls to its last value. Facets must be known (facets.h, or annotations). No chance is involved, and places
/// and poses of the fragments do not matter. Throws Error (input) for a fragment without fracture, or without a rim.
BreakPair pair_breaks(const Fragment& a, const Fragment& b, const PairOptions& options = {});

/// The report of a pair (doc/schema/pair.schema.json): verdict, confidence, candidates with their poses (4 x 4).
JsonValue pair_to_json(const BreakPair& pair, const std::string& a, const std::string& b, JsonAllocator& allocator);

}  // namespace ostraka

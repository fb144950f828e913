// Boxes of fragments with known positions: objects broken by simulation, and scanned fragments in assembled layout.
#pragma once

#include "ostraka/core/file.h"
#include "ostraka/fracture/fragment.h"

#include <string>
#include <vector>

namespace ostraka::experiments {

struct Box {
    std::string name;
    std::string level;                ///< description of noise and wear; empty if the box was not broken by simulation
    std::vector<Fragment> fragments;  ///< in their true positions; facets known, or found if `scanned`
    double diagonal = 0;              ///< of the whole object
    double gap = 0;                   ///< max distance between neighbours
    bool scanned = false;
    /// Contact area of each pair as a share of the smaller fragment's fracture surface, [i][j], i < j.
    std::vector<std::vector<double>> contact;
};

enum class FacetChoice { known, found };

/// The files of a folder of fragments in assembled layout, in order.
std::vector<Path> fragment_files(const std::string& folder);

/// `source`: "pot:SHAPE", "plate:SHAPE", "stone:SHAPE", "made:NAME" or a mesh file, broken into `pieces` with noise and wear
/// derived from `seed` (three levels each, wear up to 3 % of a piece's size); or a folder of fragments in assembled layout.
/// Throws Error if the object cannot be broken.
Box read_box(const std::string& source, int pieces, std::uint64_t seed, FacetChoice facets);

/// Computes `contact`.
void find_contacts(Box& box);

}  // namespace ostraka::experiments

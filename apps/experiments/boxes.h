// Boxes of fragments whose places are known: objects broken on the computer, and scanned ones in assembled layout.
#pragma once

#include "ostraka/core/file.h"
#include "ostraka/fracture/fragment.h"

#include <string>
#include <vector>

namespace ostraka::experiments {

struct Box {
    std::string name;
    std::string level;                ///< of noise and wear, in words; of a box that was not broken here empty
    std::vector<Fragment> fragments;  ///< where they belong, facets known (or found, where they are `scanned`)
    double diagonal = 0;              ///< of the whole
    double gap = 0;                   ///< between neighbours, at most
    bool scanned = false;
    /// Share of the smaller one's fracture on which each pair touches, [i][j], i < j.
    std::vector<std::vector<double>> contact;
};

enum class FacetChoice { known, found };

/// Of a folder of fragments in their assembled layout, in order.
std::vector<Path> fragment_files(const std::string& folder);

/// `source`: "pot:SHAPE", "plate:SHAPE", "stone:SHAPE", "made:NAME" or a mesh file, broken into `pieces` with noise and wear that
/// follow from `seed` (three levels each, wear up to 3 % of a piece's size); or a folder of fragments in assembled layout. Throws
/// Error where it cannot be broken.
Box read_box(const std::string& source, int pieces, std::uint64_t seed, FacetChoice facets);

/// Measures `contact`.
void find_contacts(Box& box);

}  // namespace ostraka::experiments

// Fragments that landmarks do not place, placed by a search (doc/pose-search.md).
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/fracture/fragment.h"
#include "ostraka/reconstruction/placement.h"
#include "ostraka/reconstruction/pose_searches.h"

#include <optional>
#include <vector>

namespace ostraka {

struct SearchOptions {
    enum class Search { automatic, always, never };
    Search search = Search::automatic;  ///< where a fragment has fewer than three landmarks
    PoseSearchOptions poses;

    void describe(OptionList& visit);
};

/// Searches the poses of fragments that have fewer than three landmarks (of all, with "always") on the template and writes them
/// into `placed`; one that cannot be decided keeps a `problem` that says why. `scale` is that of the landmarks where some
/// fragment is placed by them; else it is searched in the range of the options, becomes the middle one of the fragments decided,
/// and all are searched again with it. Breaks (`Facet::fracture`) do not count. The results, one a fragment: nothing where none
/// was searched. `searches` are those of the template with these options: what it has is not searched again.
std::vector<std::optional<PoseSearchResult>> place_by_search(PoseSearches& searches,
                                                             const std::vector<const Fragment*>& fragments,
                                                             const SearchOptions& options, double& scale,
                                                             std::vector<FragmentPlacement>& placed);

/// What the shape leaves open of a pose that was found, decided by the landmarks there are, be it one: rotated about or
/// translated along each way so that their squared distances from the template's are least. False, and nothing is changed, where
/// nothing is open, or where they are still farther off than `limit`, a length. `scale` of the template.
bool close_by_landmarks(const std::vector<LandmarkPair>& pairs, double scale, double limit, PoseSearchResult& search,
                        FragmentPlacement& placed);

/// The same without earlier searches.
std::vector<std::optional<PoseSearchResult>> place_by_search(const Mesh& mesh, const std::vector<const Fragment*>& fragments,
                                                             const SearchOptions& options, double& scale,
                                                             std::vector<FragmentPlacement>& placed);

}  // namespace ostraka

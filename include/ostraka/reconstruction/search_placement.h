// Places fragments without sufficient landmarks by a pose search (doc/pose-search.md).
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
    Search search = Search::automatic;  ///< automatic: for fragments with fewer than three landmarks
    PoseSearchOptions poses;

    void describe(OptionList& visit);
};

/// Searches the poses of fragments with fewer than three landmarks (of all, with "always") on the template and writes them to
/// `placed`; an undecided fragment keeps a `problem` with the reason. `scale` is that of the landmarks if they place any
/// fragment; otherwise it is searched in the range of the options, set to the median of the decided fragments, and all are
/// searched again with it. Fractures (`Facet::fracture`) are ignored. Returns one result per fragment: nothing if it was not
/// searched. `searches` is the cache of the template with these options: cached searches are not repeated.
std::vector<std::optional<PoseSearchResult>> place_by_search(PoseSearches& searches,
                                                             const std::vector<const Fragment*>& fragments,
                                                             const SearchOptions& options, double& scale,
                                                             std::vector<FragmentPlacement>& placed);

/// Determines the motions that a found pose leaves open from the landmarks, even a single one: rotates about or translates
/// along each slippable direction to minimise their squared distances from the template's. Returns false, and changes nothing,
/// if nothing is open or if they remain farther apart than `limit`, a length. `scale` of the template.
bool resolve_open_motions(const std::vector<LandmarkPair>& pairs, double scale, double limit, PoseSearchResult& search,
                          FragmentPlacement& placed);

/// The same without a cache.
std::vector<std::optional<PoseSearchResult>> place_by_search(const Mesh& mesh, const std::vector<const Fragment*>& fragments,
                                                             const SearchOptions& options, double& scale,
                                                             std::vector<FragmentPlacement>& placed);

}  // namespace ostraka

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
    /// Fragments for which a pose search is made; automatic: those with fewer than three landmarks.
    Search search = Search::automatic;
    PoseSearchOptions poses;  ///< options of each pose search

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// Searches the poses of fragments with fewer than three landmarks (of all fragments, with "always") on the template and writes
/// the poses to `placed`; an undecided fragment keeps a `problem` with the reason. If landmarks place at least one fragment,
/// they determine the `scale` of the template. Otherwise the scale is searched in the range of the options and set to the
/// median over the decided fragments, and all fragments are searched again with this scale. Fractures (`Facet::fracture`) are
/// ignored. Returns for each fragment the result of the search; empty: not searched. `searches`: cache for the template with
/// these options; cached searches are not repeated.
std::vector<std::optional<PoseSearchResult>> place_by_search(PoseSearches& searches,
                                                             const std::vector<const Fragment*>& fragments,
                                                             const SearchOptions& options, double& scale,
                                                             std::vector<FragmentPlacement>& placed);

/// Determines the motions that a pose search left undetermined from the landmarks, even from a single landmark: rotates about or
/// translates along each slippable direction to minimise the squared distances of the fragment's landmarks from the template's.
/// Returns false, without any change, if no motion is undetermined or if a landmark remains farther than `limit` (a length)
/// from its counterpart. `scale`: scale of the template.
bool resolve_open_motions(const std::vector<LandmarkPair>& pairs, double scale, double limit, PoseSearchResult& search,
                          FragmentPlacement& placed);

/// Places fragments by pose searches without a cache; `mesh` is the template.
std::vector<std::optional<PoseSearchResult>> place_by_search(const Mesh& mesh, const std::vector<const Fragment*>& fragments,
                                                             const SearchOptions& options, double& scale,
                                                             std::vector<FragmentPlacement>& placed);

}  // namespace ostraka

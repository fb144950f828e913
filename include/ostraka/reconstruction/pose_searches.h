// Cache of pose searches on one template: in memory, or in a file beside a result.
#pragma once

#include "ostraka/files/json.h"
#include "ostraka/fracture/fragment.h"
#include "ostraka/registration/pose_search.h"

#include <map>
#include <optional>
#include <string>

namespace ostraka {

/// Results of pose searches by key. The key is a checksum of all inputs of a search: the version of the toolkit, the template's
/// faces and vertices, the options, the range of scales, and the fragment's vertices, faces and facets. If any input has changed,
/// the search is repeated.
class PoseSearches {
public:
    /// `mesh` is the template; it must outlive this object unchanged. The search data of the template are built with the first
    /// search.
    PoseSearches(const Mesh& mesh, const PoseSearchOptions& options);
    ~PoseSearches();
    PoseSearches(PoseSearches&&) noexcept;

    /// Searches the pose of a fragment on the template, with scales of the template in this range, or returns the cached result.
    /// Returns nothing if all faces of the fragment are fracture surface. Throws the same errors as PoseSearch::find.
    std::optional<PoseSearchResult> find(const Fragment& fragment, double min_scale, double max_scale);

    [[nodiscard]] std::size_t made() const { return made_; }      ///< number of searches that `find` ran
    [[nodiscard]] std::size_t reused() const { return reused_; }  ///< number of searches found in the cache
    [[nodiscard]] bool empty() const { return stored_.empty(); }  ///< true if the cache holds no results

    /// JSON of the cached results (doc/schema/searches.schema.json); `add` restores the numbers bit by bit.
    [[nodiscard]] JsonValue to_json(JsonAllocator& allocator) const;
    /// Adds the cached results in a JSON document that belong to this template and these options; `file` names the document in
    /// errors. An entry that does not match its checksum was edited or damaged, and is skipped. Returns the number of skipped
    /// entries. Throws Error (input) for a document of another kind.
    std::size_t add(const JsonValue& document, const std::string& file);

private:
    struct StoredSearch {
        std::string fragment;  ///< name of the fragment, for readers of the file
        PoseSearchResult result;
    };
    struct TemplateSearch;
    /// Key of a search with this range of scales.
    [[nodiscard]] std::string key_of(const Fragment& fragment, double min_scale, double max_scale) const;

    const Mesh& mesh_;  ///< the template
    PoseSearchOptions options_;
    std::string template_key_;  ///< checksum of the inputs that all keys have in common
    std::unique_ptr<TemplateSearch> template_search_;
    std::map<std::string, StoredSearch> stored_;  ///< from the key of a search to its result
    /// Number of searches that `find` ran, and number found in the cache.
    std::size_t made_ = 0, reused_ = 0;
};

}  // namespace ostraka

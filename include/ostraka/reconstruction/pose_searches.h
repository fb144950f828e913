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
/// faces and vertices, the options, the range of scales, and the fragment's vertices, faces and facets. If any of these has
/// changed, the search is repeated.
class PoseSearches {
public:
    /// `mesh` is the template; it must outlive this object unchanged. The data for searching is built with the first search.
    PoseSearches(const Mesh& mesh, const PoseSearchOptions& options);
    ~PoseSearches();
    PoseSearches(PoseSearches&&) noexcept;

    /// Nothing if the whole fragment is fracture. Throws Error as PoseSearch::find.
    std::optional<PoseSearchResult> find(const Fragment& fragment, double min_scale, double max_scale);

    [[nodiscard]] std::size_t made() const { return made_; }      ///< number of searches that `find` ran
    [[nodiscard]] std::size_t reused() const { return reused_; }  ///< number of searches found in the cache
    [[nodiscard]] bool empty() const { return stored_.empty(); }

    /// doc/schema/searches.schema.json. Numbers are restored to the bit.
    [[nodiscard]] JsonValue to_json(JsonAllocator& allocator) const;
    /// Adds the results of a file that belong to this template and these options. An entry that does not match its checksum was
    /// edited or damaged: it is skipped. Returns the number of such entries. Throws Error (input) for a file of another kind.
    std::size_t add(const JsonValue& document, const std::string& file);

private:
    struct StoredSearch {
        std::string fragment;  ///< name of the fragment, for the reader of the file
        PoseSearchResult result;
    };
    struct TemplateSearch;
    [[nodiscard]] std::string key_of(const Fragment& fragment, double min_scale, double max_scale) const;

    const Mesh& mesh_;
    PoseSearchOptions options_;
    std::string template_key_;  ///< checksum of the part common to all keys
    std::unique_ptr<TemplateSearch> template_search_;
    std::map<std::string, StoredSearch> stored_;  ///< by key
    std::size_t made_ = 0, reused_ = 0;
};

}  // namespace ostraka

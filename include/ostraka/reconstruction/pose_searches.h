// Searches of poses on one template, each made once: in memory, or in a file beside a result.
#pragma once

#include "ostraka/core/json.h"
#include "ostraka/fracture/fragment.h"
#include "ostraka/registration/pose_search.h"

#include <map>
#include <optional>
#include <string>

namespace ostraka {

/// What was searched, and found. A search is known by its key: a checksum of all that its result depends on, which is the version
/// of the toolkit, the template's faces and vertices, the options, the range of scales, and the fragment's vertices, faces and
/// facets. Where any of these has changed it is made anew.
class PoseSearches {
public:
    /// `mesh` is the template; it outlives this and does not change. What a search needs of it is made with the first one.
    PoseSearches(const Mesh& mesh, const PoseSearchOptions& options);
    ~PoseSearches();
    PoseSearches(PoseSearches&&) noexcept;

    /// Nothing where all of the fragment is of breaks. Throws Error as PoseSearch::find.
    std::optional<PoseSearchResult> find(const Fragment& fragment, double min_scale, double max_scale);

    [[nodiscard]] std::size_t made() const { return made_; }      ///< searches that `find` made
    [[nodiscard]] std::size_t reused() const { return reused_; }  ///< and those that it had already
    [[nodiscard]] bool empty() const { return stored_.empty(); }

    /// doc/schema/searches.schema.json. Numbers come back to the bit.
    [[nodiscard]] JsonValue to_json(JsonAllocator& allocator) const;
    /// Adds those of a file that are of this template and these options. An entry whose numbers are not those of its checksum
    /// was changed by hand or damaged: it is left out. Returns how many were. Throws Error (input) for what is no such file.
    std::size_t add(const JsonValue& document, const std::string& file);

private:
    struct StoredSearch {
        std::string fragment;  ///< its name, for people
        PoseSearchResult result;
    };
    struct Whole;
    [[nodiscard]] std::string key_of(const Fragment& fragment, double min_scale, double max_scale) const;

    const Mesh& mesh_;
    PoseSearchOptions options_;
    std::string of_template_;  ///< checksum of what is common to all keys
    std::unique_ptr<Whole> whole_;
    std::map<std::string, StoredSearch> stored_;  ///< by key
    std::size_t made_ = 0, reused_ = 0;
};

}  // namespace ostraka

// Ids of annotations, attributes and relationships.
#pragma once

#include <algorithm>
#include <limits>
#include <set>

namespace ostraka {

/// The largest id that the schemas allow.
inline constexpr int max_id = std::numeric_limits<int>::max();

/// Generates unused ids for a list of entries with a member `id`: one more than the largest id in use, at least 0; if `max_id` is
/// in use, the smallest unused id from 0.
class FreeIds {
public:
    template <class Entries>
    explicit FreeIds(const Entries& entries) {
        for (const auto& entry : entries) used_.insert(entry.id);
    }
    int next() {
        const bool above = used_.empty() || *used_.rbegin() < max_id;
        if (!above)
            while (used_.contains(gap_)) ++gap_;
        const int id = used_.empty() ? 0 : above ? std::max(0, *used_.rbegin() + 1) : gap_;
        used_.insert(id);
        return id;
    }

private:
    std::set<int> used_;
    int gap_ = 0;
};

/// The id that FreeIds would give next for the entries.
template <class Entries>
int next_free_id(const Entries& entries) {
    int largest = -1;
    for (const auto& entry : entries) largest = std::max(largest, entry.id);
    return largest < max_id ? largest + 1 : FreeIds(entries).next();
}

}  // namespace ostraka

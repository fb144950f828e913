// Ids of annotations, attributes and relationships.
#pragma once

#include <algorithm>
#include <limits>
#include <set>

namespace ostraka {

/// As the schemas have it.
inline constexpr int largest_id = std::numeric_limits<int>::max();

/// Ids that no entry (with a member `id`) has, one after the other: one more than the largest, at least 0; where the largest id
/// is taken, the lowest from 0 that is free.
class FreeIds {
public:
    template <class Entries>
    explicit FreeIds(const Entries& entries) {
        for (const auto& entry : entries) used_.insert(entry.id);
    }
    int next() {
        const bool above = used_.empty() || *used_.rbegin() < largest_id;
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

template <class Entries>
int next_free_id(const Entries& entries) {
    int largest = -1;
    for (const auto& entry : entries) largest = std::max(largest, entry.id);
    return largest < largest_id ? largest + 1 : FreeIds(entries).next();
}

}  // namespace ostraka

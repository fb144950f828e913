// Disjoint-set forest (union-find).
#pragma once

#include "ostraka/mesh/mesh.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace ostraka {

/// Disjoint sets of the elements 0, 1, ...; initially each element is its own set. A set is represented by one of its members,
/// called its root.
class DisjointSets {
public:
    explicit DisjointSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), Index{0}); }

    [[nodiscard]] std::size_t size() const { return parent_.size(); }  ///< number of elements

    /// The root of the set of element i.
    Index find(std::size_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return static_cast<Index>(i);
    }

    /// Joins the sets of two elements; the smaller of the two roots becomes the root. If sets are joined by this function only,
    /// every root is the smallest member of its set, whatever the order of the calls. Returns false if both elements were in the
    /// same set already.
    bool unite(std::size_t a, std::size_t b) {
        const auto [low, high] = std::minmax({find(a), find(b)});
        parent_[high] = low;
        return low != high;
    }

    /// Joins the sets of two elements; the root of the set of `target` becomes the root.
    void unite_into(std::size_t target, std::size_t source) { parent_[find(source)] = find(target); }

private:
    std::vector<Index> parent_;
};

}  // namespace ostraka

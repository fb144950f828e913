// A binary min-heap over the indices 0 .. n-1 with mutable keys; ties are in the order of the indices.
#pragma once

#include "ostraka/mesh/mesh.h"

#include <vector>

namespace ostraka {

/// Min-heap of indices by key. Takes 16 bytes per index. `set` and `remove` are O(log n).
class IndexedHeap {
public:
    explicit IndexedHeap(std::size_t count) : key_(count, 0), place_(count, no_index) { heap_.reserve(count); }

    [[nodiscard]] bool empty() const { return heap_.empty(); }                    ///< true: the heap holds no index
    [[nodiscard]] bool contains(Index i) const { return place_[i] != no_index; }  ///< whether the heap holds index i
    [[nodiscard]] Index top() const { return heap_.front(); }                     ///< index with the smallest key

    /// Sets the key of an index, and adds the index if the heap does not contain it.
    void set(Index i, double key) {
        key_[i] = key;
        if (!contains(i)) {
            place_[i] = static_cast<Index>(heap_.size());
            heap_.push_back(i);
        }
        down(up(place_[i]));
    }
    /// Removes an index if the heap holds it.
    void remove(Index i) {
        const Index hole = place_[i];
        if (hole == no_index) return;
        place_[i] = no_index;
        const Index last = heap_.back();
        heap_.pop_back();
        if (last == i) return;
        heap_[hole] = last;
        place_[last] = hole;
        down(up(hole));
    }

private:
    /// Whether index a precedes index b.
    [[nodiscard]] bool before(Index a, Index b) const { return key_[a] < key_[b] || (key_[a] == key_[b] && a < b); }
    /// Stores index i at a position of the heap.
    void put(Index place, Index i) {
        heap_[place] = i;
        place_[i] = place;
    }
    /// Moves the index at a position towards the top; returns the new position.
    Index up(Index place) {
        const Index i = heap_[place];
        while (place > 0) {
            const Index parent = (place - 1) / 2;
            if (!before(i, heap_[parent])) break;
            put(place, heap_[parent]);
            place = parent;
        }
        put(place, i);
        return place;
    }
    /// Moves the index at a position towards the leaves.
    void down(Index place) {
        const Index i = heap_[place];
        const auto size = static_cast<Index>(heap_.size());
        for (;;) {
            Index child = 2 * place + 1;
            if (child >= size) break;
            if (child + 1 < size && before(heap_[child + 1], heap_[child])) ++child;
            if (!before(heap_[child], i)) break;
            put(place, heap_[child]);
            place = child;
        }
        put(place, i);
    }

    std::vector<double> key_;   ///< key of each index
    std::vector<Index> place_;  ///< for each index, its position in `heap_`; no_index: not in the heap
    std::vector<Index> heap_;   ///< indices in heap order
};

}  // namespace ostraka

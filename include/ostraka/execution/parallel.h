// Parallel loops with results that do not depend on the number of threads.
#pragma once

#include <cstddef>
#include <functional>

namespace ostraka {

/// Sets the number of threads of parallel loops; 0: as many as the machine has. Throws Error (usage) below 0 or above 1024.
void set_threads(int threads);
int threads();  ///< number of threads of parallel loops

/// Calls body(begin, end) for blocks of fixed size that cover [0, count). The result does not depend on the assignment of blocks
/// to threads as long as each call of `body` writes only to elements of its own block. If blocks fail, rethrows the exception of
/// the failed block with the smallest `begin`.
void parallel_blocks(std::size_t count, std::size_t block, const std::function<void(std::size_t, std::size_t)>& body);

/// Calls body(i) for each i in [0, count), in parallel blocks of `block` indices.
template <class Body>
void parallel_for(std::size_t count, std::size_t block, Body&& body) {
    parallel_blocks(count, block, [&body](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) body(i);
    });
}
template <class Body>
void parallel_for(std::size_t count, Body&& body) {
    parallel_for(count, 256, body);
}

}  // namespace ostraka

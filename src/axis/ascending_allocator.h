// Allocator that returns ascending addresses in the order of the requests, so that containers sorted by address are reproducible.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <new>
#include <vector>

namespace ostraka::detail {

/// Memory for the small objects that AscendingAllocator creates on this thread during the lifetime of this object. Freed memory
/// is reused, the block freed last first, so that the order of addresses depends on the requests alone. Requests beyond the total
/// of `bytes` are served from the heap.
class AscendingMemory {
public:
    explicit AscendingMemory(std::size_t bytes)
        : begin_(static_cast<std::byte*>(::operator new(bytes))), next_(begin_), end_(begin_ + bytes), before_(current()) {
        current() = this;
    }
    ~AscendingMemory() {
        current() = before_;
        ::operator delete(begin_);
    }
    AscendingMemory(const AscendingMemory&) = delete;
    AscendingMemory& operator=(const AscendingMemory&) = delete;

    /// The innermost object alive on this thread; null if there is none.
    static AscendingMemory*& current() {
        thread_local AscendingMemory* memory = nullptr;
        return memory;
    }

    /// Allocates a block; null if there is no room.
    void* take(std::size_t bytes) {
        bytes = rounded(bytes);
        std::vector<std::byte*>& free = free_[bytes];
        if (!free.empty()) {
            std::byte* p = free.back();
            free.pop_back();
            return p;
        }
        if (static_cast<std::size_t>(end_ - next_) < bytes) return nullptr;
        std::byte* p = next_;
        next_ += bytes;
        return p;
    }
    /// Returns a block for reuse; false if this object did not allocate the block.
    bool give_back(void* p, std::size_t bytes) {
        auto* address = static_cast<std::byte*>(p);
        if (std::less<>()(address, begin_) || !std::less<>()(address, end_)) return false;
        free_[rounded(bytes)].push_back(address);
        return true;
    }

private:
    static std::size_t rounded(std::size_t bytes) {
        constexpr std::size_t step = alignof(std::max_align_t);
        return (bytes + step - 1) / step * step;
    }
    std::byte *begin_, *next_, *end_;
    AscendingMemory* before_;
    std::map<std::size_t, std::vector<std::byte*>> free_;
};

/// Standard allocator that uses the thread's current AscendingMemory, or the heap if there is none.
template <class T>
struct AscendingAllocator {
    using value_type = T;
    AscendingAllocator() = default;
    template <class U>
    AscendingAllocator(const AscendingAllocator<U>& /*other*/) {}  // NOLINT(google-explicit-constructor): as allocators are

    T* allocate(std::size_t count) {
        void* p = count == 1 && AscendingMemory::current() != nullptr ? AscendingMemory::current()->take(sizeof(T)) : nullptr;
        return static_cast<T*>(p != nullptr ? p : ::operator new(count * sizeof(T)));
    }
    void deallocate(T* p, std::size_t count) {
        if (AscendingMemory::current() == nullptr || !AscendingMemory::current()->give_back(p, count * sizeof(T)))
            ::operator delete(p);
    }
    bool operator==(const AscendingAllocator& /*other*/) const { return true; }
};

}  // namespace ostraka::detail

// Cancellable version of CGAL's search for shortest paths on a surface.
#pragma once

#include "ostraka/core/error.h"
#include "ostraka/core/memory.h"
#include "ostraka/core/progress.h"
#include "ostraka/core/text.h"
#include "ostraka/mesh/mesh.h"

#include <CGAL/Surface_mesh_shortest_path.h>

#include <algorithm>
#include <cmath>
#include <memory_resource>
#include <string>

namespace ostraka::detail {

using PlainTraits = CGAL::Surface_mesh_shortest_path_traits<Kernel, Mesh>;

/// Remedy in messages about memory.
inline constexpr const char* coarser = "measure along edges, up to a limit, or on a coarser copy (ostraka mesh simplify)";

/// Checks that memory suffices for the windows of a search: at least 6 kB per face on a rough surface, where windows end soon; on
/// a smooth surface the memory grows with the power 1.5 of the number of faces (measured: 11 kB per face at 40 thousand faces, 17
/// kB at 90 thousand, 31 kB at 400 thousand).
inline void require_for_search(double faces) {
    require_memory(std::max(6e3 * faces, 15 * std::pow(faces, 1.5)),
                   "the exact shortest path over " + std::to_string(static_cast<long long>(faces)) + " faces", coarser);
}

/// Checks for cancellation at every call and, every 262 144 calls, the memory limit.
class SearchCheck {
public:
    void operator()() {
        cancelled_();
        if ((++steps_ & 0x3FFFFU) != 0) return;
        if (const double limit = memory_limit(); limit > 0 && resident_memory() > limit)
            fail_work(
                "", "the exact shortest path takes more than the " + digits(limit / 1e9, 2) + " GB of memory that are available",
                coarser);
    }

private:
    CancelCheck cancelled_;
    unsigned steps_ = 0;
};

/// Traits of CGAL's search that call a SearchCheck whenever a window is propagated across an edge.
struct WatchedTraits : PlainTraits {
    [[nodiscard]] Construct_triangle_3_along_segment_2_flattening construct_triangle_3_along_segment_2_flattening_object() const {
        check();
        return PlainTraits::construct_triangle_3_along_segment_2_flattening_object();
    }
    mutable SearchCheck check;
};

/// Memory pool of the events of a search. CGAL leaks pending events if a search is interrupted; with this pool, pending events
/// are freed with the pool. Each thread may run one search at a time.
class EventMemory {
public:
    EventMemory() : outer_(current) { current = this; }
    ~EventMemory() { current = outer_; }
    EventMemory(const EventMemory&) = delete;
    EventMemory& operator=(const EventMemory&) = delete;

    static void* take(std::size_t size) { return current->memory_.allocate(size); }
    static void give_back(void* place, std::size_t size) { current->memory_.deallocate(place, size); }

private:
    inline static thread_local EventMemory* current = nullptr;
    EventMemory* outer_;
    std::pmr::unsynchronized_pool_resource memory_;
};

}  // namespace ostraka::detail

/// CGAL's event of a search, allocated in the EventMemory of the search.
// NOLINTBEGIN(readability-identifier-naming): the names that CGAL uses.
template <>
struct CGAL::Surface_mesh_shortest_paths_3::internal::Cone_expansion_event<ostraka::detail::WatchedTraits> {
    using Traits = ostraka::detail::WatchedTraits;
    using Segment_2 = Traits::Segment_2;
    using FT = Traits::FT;
    enum Expansion_type { LEFT_CHILD, RIGHT_CHILD, PSEUDO_SOURCE };

    Cone_tree_node<Traits>* m_parent;
    FT m_distanceEstimate;
    Expansion_type m_type;
    Segment_2 m_windowSegment;
    bool m_cancelled = false;

    Cone_expansion_event(Cone_tree_node<Traits>* parent, const FT& distance, Expansion_type type, const Segment_2& window = {})
        : m_parent(parent), m_distanceEstimate(distance), m_type(type), m_windowSegment(window) {}

    static void* operator new(std::size_t size) { return ostraka::detail::EventMemory::take(size); }
    static void operator delete(void* place, std::size_t size) { ostraka::detail::EventMemory::give_back(place, size); }
};
// NOLINTEND(readability-identifier-naming)

namespace ostraka::detail {

/// Exact shortest paths from sources on a mesh. Throws Error (failure) if the search would need too much memory. Building the
/// search may throw Error (cancelled, failure); the object must not be used afterwards.
class ExactSearch : private EventMemory, public CGAL::Surface_mesh_shortest_path<WatchedTraits> {
public:
    explicit ExactSearch(const Mesh& mesh) : Surface_mesh_shortest_path(checked(mesh)) {}

private:
    static const Mesh& checked(const Mesh& mesh) {
        require_for_search(static_cast<double>(mesh.number_of_faces()));
        return mesh;
    }
};

}  // namespace ostraka::detail

// Poses of one break against another: refined and judged.
#pragma once

#include "break_side.h"
#include "ostraka/fracture/break_pair.h"
#include "ostraka/geom/surface_search.h"

namespace ostraka {

/// Aligns the second fragment's fracture and rim with those of the first.
class BreakAligner {
public:
    /// The first fragment with its search trees; they outlive this.
    struct Target {
        const BreakSide& side;
        const PointTree &fracture, &frames;
        const SurfaceSearch* surface;  ///< none where nothing penetrates
    };
    BreakAligner(const Target& a, const BreakSide& side_b, double search_radius, double last_search_radius, double edges)
        : a_(a.side),
          b_(side_b),
          search_radius_(search_radius),
          last_search_radius_(last_search_radius),
          edges_(edges),
          fracture_(a.fracture),
          frames_(a.frames),
          surface_(a.surface) {}

    /// Closest points, point to plane, with at most `samples` points of the fracture; the search radius falls over `steps` steps.
    /// With `hold`, the intact surface stays where `start` has it, but for sliding on itself, with that weight against the
    /// breaks.
    [[nodiscard]] Motion align(const Motion& start, std::size_t samples, int steps, double hold = 0) const;
    /// In contact counts by how close it is: `close` times the last search radius is a standard deviation.
    [[nodiscard]] PairCandidate judge(const Motion& pose, std::size_t samples, double close) const;

private:
    /// Calls visit(place, frame, squared distance) for each frame of the second, posed, that continues one of the first
    /// within 1.5 search radii: where it is, and that one.
    template <class Visit>
    void for_each_continued(const Motion& pose, double search_radius, Visit&& visit) const;

    const BreakSide &a_, &b_;
    double search_radius_, last_search_radius_, edges_;
    const PointTree &fracture_, &frames_;
    const SurfaceSearch* surface_;
};

/// Trees of a side that are made for one alignment.
struct BreakTrees {
    /// Without a mesh (empty) nothing penetrates.
    BreakTrees(Mesh mesh, const BreakSide& side);
    [[nodiscard]] BreakAligner::Target target() const { return {side_, fracture_, frames_, surface_.get()}; }

private:
    Mesh mesh_;
    const BreakSide& side_;
    PointTree fracture_, frames_;
    std::unique_ptr<SurfaceSearch> surface_;
};

}  // namespace ostraka

// Poses of one break against another: refined and judged.
#pragma once

#include "break_side.h"
#include "ostraka/fracture/break_pair.h"
#include "ostraka/geom/surface_search.h"

namespace ostraka {

/// Aligns the second fragment's fracture and rim with those of the first.
class BreakAligner {
public:
    /// Without a mesh (empty) nothing penetrates.
    BreakAligner(const Mesh& a, const BreakSide& side_a, const BreakSide& side_b, double search_radius, double last_search_radius,
                 double edges);

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
    PointTree fractures_, frames_;
    Mesh whole_;
    std::unique_ptr<SurfaceSearch> surface_;  ///< none where there is no mesh
};

}  // namespace ostraka

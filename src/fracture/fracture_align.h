// Refines and scores poses of one fracture against another.
#pragma once

#include "fracture/fracture_side.h"
#include "ostraka/fracture/pair_registration.h"
#include "ostraka/geom/surface_search.h"

namespace ostraka {

/// Aligns the second fragment's fracture and rim with those of the first.
class FractureAligner {
public:
    /// The first fragment with its search trees; both must outlive the aligner.
    struct Target {
        const FractureSide& side;
        const PointTree &fracture, &frames;
        const SurfaceSearch* surface;  ///< null: penetration is not tested
    };
    FractureAligner(const Target& a, const FractureSide& side_b, double search_radius, double last_search_radius, double edges)
        : a_(a.side),
          b_(side_b),
          search_radius_(search_radius),
          last_search_radius_(last_search_radius),
          edges_(edges),
          fracture_(a.fracture),
          frames_(a.frames),
          surface_(a.surface) {}

    /// ICP, point to plane, with at most `samples` points of the fracture; the search radius falls over `steps` steps. With
    /// `anchor_weight`, a constraint of that weight keeps the intact surface where `start` has it, up to sliding along itself.
    [[nodiscard]] Motion align(const Motion& start, std::size_t samples, int steps, double anchor_weight = 0) const;
    /// Contact is weighted by its distance, with a standard deviation of `close` times the last search radius.
    [[nodiscard]] PairCandidate judge(const Motion& pose, std::size_t samples, double close) const;

private:
    /// Calls visit(place, frame, squared distance) for each frame of the second fragment that, posed, continues a frame of the
    /// first within 1.5 search radii: its position, and the frame of the first.
    template <class Visit>
    void for_each_continued(const Motion& pose, double search_radius, Visit&& visit) const;

    const FractureSide &a_, &b_;
    double search_radius_, last_search_radius_, edges_;
    const PointTree &fracture_, &frames_;
    const SurfaceSearch* surface_;
};

/// Search trees of a side for one alignment.
struct FractureTrees {
    /// With an empty mesh, penetration is not tested.
    FractureTrees(Mesh mesh, const FractureSide& side);
    [[nodiscard]] FractureAligner::Target target() const { return {side_, fracture_, frames_, surface_.get()}; }

private:
    Mesh mesh_;
    const FractureSide& side_;
    PointTree fracture_, frames_;
    std::unique_ptr<SurfaceSearch> surface_;
};

}  // namespace ostraka

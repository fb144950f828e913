// Refines and scores poses of one fracture against another.
#pragma once

#include "fracture/fracture_side.h"
#include "ostraka/fracture/pair_registration.h"
#include "ostraka/geom/surface_search.h"

namespace ostraka {

/// Aligns the fracture and rim of a second fragment with the fracture and rim of a first fragment.
class FractureAligner {
public:
    /// The first fragment with its search trees. Fragment and trees must outlive the aligner.
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

    /// ICP, point to plane, with at most `samples` points of the fracture; the search radius falls from its initial to its last
    /// value over `steps` steps. A constraint of weight `anchor_weight` keeps the intact surface where `start` places it, except
    /// that the surface may slide along itself.
    [[nodiscard]] Motion align(const Motion& start, std::size_t samples, int steps, double anchor_weight = 0) const;
    /// Scores a pose. Contact is weighted by a Gaussian of the distance, with a standard deviation of `close` times the last
    /// search radius.
    [[nodiscard]] PairCandidate judge(const Motion& pose, std::size_t samples, double close) const;

private:
    /// Calls visit(place, frame, squared distance) for each rim frame of the second fragment that, after the motion `pose`,
    /// continues a rim frame of the first fragment within 1.5 search radii. `place`: moved position of the second fragment's
    /// frame; `frame`: the first fragment's frame.
    template <class Visit>
    void for_each_continued(const Motion& pose, double search_radius, Visit&& visit) const;

    const FractureSide &a_, &b_;
    double search_radius_, last_search_radius_, edges_;
    const PointTree &fracture_, &frames_;
    const SurfaceSearch* surface_;
};

/// Search trees of one fragment, as target of alignments.
struct FractureTrees {
    /// Builds the trees; with an empty mesh, penetration is not tested.
    FractureTrees(Mesh mesh, const FractureSide& side);
    [[nodiscard]] FractureAligner::Target target() const { return {side_, fracture_, frames_, surface_.get()}; }

private:
    Mesh mesh_;
    const FractureSide& side_;
    PointTree fracture_, frames_;
    std::unique_ptr<SurfaceSearch> surface_;
};

}  // namespace ostraka

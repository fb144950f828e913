// One surface registered to another, and how far they are apart then.
#pragma once

#include "ostraka/core/mesh.h"
#include "ostraka/core/options.h"
#include "ostraka/geom/rigid_fit.h"

#include <memory>
#include <vector>

namespace ostraka {

struct AlignOptions {
    double shrinkage = 0;  ///< surfaces may differ in size by up to this share; 0: rigid
    double trim = 0.8;     ///< share of the pairs that count, the nearest ones: beards, dents and what is missing stay out
    double angle = 45;     ///< pairs whose normals differ by more are none, degrees
    int samples = 1000;    ///< on each surface
    int iterations = 60;

    void describe(OptionList& visit);
};

/// What is asked of a surface again and again: points evenly spread over it, and the nearest vertex of any place.
class AlignSurface {
public:
    /// Throws Error (input) for a mesh without area. The mesh need not outlive it.
    explicit AlignSurface(const Mesh& mesh, int samples = 1000);
    ~AlignSurface();
    AlignSurface(AlignSurface&&) noexcept;

    [[nodiscard]] double size() const;  ///< square root of the area
    struct State;
    [[nodiscard]] const State& state() const { return *state_; }

private:
    std::unique_ptr<State> state_;
};

struct Alignment {
    Motion motion;        ///< of the first surface onto the second
    double distance = 0;  ///< root mean square of the pairs that count, both ways, as a share of the mean size
    double overlap = 0;   ///< share of the samples that have a pair
    int iterations = 0;
    bool settled = false;  ///< the last step moved nothing any more
};

/// Trimmed iterative closest points (Chetverikov, Stepanov and Krsek 2005), point to plane (Chen and Medioni 1992), both ways at
/// once: points of either surface are paired with the nearest vertex of the other, pairs at a border or with other normals left
/// out (Rusinkiewicz and Levoy 2001), the nearest `trim` of them kept; each step is a linear least squares problem for turn,
/// shift and, if there may be shrinkage, scale. Tries all `starts` (for none: the principal axes, four ways) and takes the one
/// with the least distance.
Alignment align(const AlignSurface& a, const AlignSurface& b, const std::vector<Motion>& starts,
                const AlignOptions& options = {});

/// The principal axes of one aligned with those of the other, in the four ways that are rotations.
std::vector<Motion> principal_starts(const AlignSurface& a, const AlignSurface& b);

}  // namespace ostraka

// Registers one surface to another and measures their distance.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/geom/rigid_fit.h"
#include "ostraka/mesh/mesh.h"

#include <memory>
#include <vector>

namespace ostraka {

struct AlignOptions {
    double shrinkage = 0;  ///< surfaces may differ in size by up to this share; 0: rigid
    double trim = 0.8;     ///< share of the pairs that are kept, the nearest ones: excludes beards, dents and missing parts
    double angle = 45;     ///< max angle between the normals of a pair, degrees
    int samples = 1000;    ///< number of points on each surface
    int iterations = 60;

    void describe(OptionList& visit);
};

/// Precomputed data of a surface: points evenly spread over it, and a search tree for the nearest vertex.
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
    Motion motion;        ///< maps the first surface onto the second
    double distance = 0;  ///< root mean square over the kept pairs, both ways, as a share of the mean size
    double overlap = 0;   ///< share of the samples that have a pair
    int iterations = 0;
    bool settled = false;  ///< the last step changed nothing
};

/// Trimmed ICP (Chetverikov, Stepanov and Krsek 2005), point to plane (Chen and Medioni 1992), in both directions at once:
/// points of either surface are paired with the nearest vertex of the other; pairs at a border or with incompatible normals are
/// rejected (Rusinkiewicz and Levoy 2001) and the nearest `trim` of them kept. Each step is a linear least squares problem for
/// rotation, translation and, with `shrinkage`, scale. Tries all `starts` (if none: the principal axes, four ways) and returns
/// the result with the smallest distance.
Alignment align(const AlignSurface& a, const AlignSurface& b, const std::vector<Motion>& starts,
                const AlignOptions& options = {});

/// Motions that align the principal axes of one surface with those of the other, in the four ways that are rotations.
std::vector<Motion> principal_starts(const AlignSurface& a, const AlignSurface& b);

}  // namespace ostraka

// Registers one surface to another and measures their distance.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/geom/rigid_fit.h"
#include "ostraka/mesh/mesh.h"

#include <memory>
#include <vector>

namespace ostraka {

struct AlignOptions {
    double shrinkage = 0;  ///< max relative difference in size between the surfaces; 0: rigid registration
    /// Share of the pairs that are kept: those of smallest distance. Pairs at parts that only one surface has, and at dents,
    /// are excluded in this way.
    double trim = 0.8;
    double angle = 45;    ///< max angle between the normals of a pair, degrees
    int samples = 1000;   ///< number of points on each surface
    int iterations = 60;  ///< max number of iterations

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// Precomputed data of a surface for `align`: points evenly spread over the surface, and a search tree for the nearest vertex.
class AlignSurface {
public:
    /// `samples`: number of points spread over the mesh. Throws Error (input) for a mesh without area. The mesh need not outlive
    /// this object.
    explicit AlignSurface(const Mesh& mesh, int samples = 1000);
    ~AlignSurface();
    AlignSurface(AlignSurface&&) noexcept;

    [[nodiscard]] double size() const;  ///< square root of the surface's area
    struct State;
    [[nodiscard]] const State& state() const { return *state_; }

private:
    std::unique_ptr<State> state_;
};

/// Result of `align`.
struct Alignment {
    Motion motion;  ///< maps the first surface onto the second
    /// Root mean square distance of the kept pairs, in both directions, as a share of the mean size of the surfaces.
    double distance = 0;
    double overlap = 0;      ///< share of the samples of both surfaces that have a pair
    int iterations = 0;      ///< number of iterations
    bool converged = false;  ///< true: the iteration converged, that is the last step did not change the motion
};

/// Registers surface `a` to surface `b` by trimmed ICP (Chetverikov, Stepanov and Krsek 2005), point to plane (Chen and Medioni
/// 1992), in both directions at once: points of either surface are paired with the nearest vertex of the other surface; pairs at
/// a border or with incompatible normals are rejected (Rusinkiewicz and Levoy 2001) and the share `trim` of smallest distance is
/// kept. Each step is a linear least squares problem for rotation, translation and, with `shrinkage`, scale. Tries all initial
/// motions in `starts` (if empty: the four alignments of the principal axes) and returns the result with the smallest distance.
Alignment align(const AlignSurface& a, const AlignSurface& b, const std::vector<Motion>& starts,
                const AlignOptions& options = {});

/// The four rotations, with translations, that align the principal axes of surface `a` with the principal axes of surface `b`.
std::vector<Motion> principal_starts(const AlignSurface& a, const AlignSurface& b);

}  // namespace ostraka

// Two meshes of one object, in other units and places, brought onto each other: rotation, translation and scale.
#pragma once

#include "ostraka/core/mesh.h"
#include "ostraka/core/options.h"
#include "ostraka/geom/rigid_fit.h"
#include "ostraka/registration/slippable_motions.h"

#include <string>
#include <vector>

namespace ostraka {

struct MeshRegistrationOptions {
    bool scale = true;     ///< the meshes may be in different units; else they have one size
    double tolerance = 0;  ///< what lies nearer is the same, as a share of the target's diagonal; 0: by the meshes' resolution
    int samples = 4000;    ///< points of both meshes together by which they are registered, and of each by which that is judged

    void describe(OptionList& visit);
};

enum class RegistrationVerdict {
    aligned,     ///< one surface, up to what the resolutions explain
    mirrored,    ///< not by any motion, but by a reflection
    inside_out,  ///< one of the meshes has its faces turned round
    different    ///< not the same object
};
std::string to_string(RegistrationVerdict verdict);

/// How near two surfaces lie to each other, by points spread over both. Lengths are in the target's unit.
struct SurfaceAgreement {
    double rms = 0;      ///< root mean square distance, both ways; points without a partner count with the farthest searched
    double largest = 0;  ///< distance that 99 % of the points keep, the worse of both ways
    double share = 0;    ///< of the points that lie within the tolerance, the worse of both ways
    double close = 0;    ///< that lie within a third of it
};

struct MeshRegistration {
    RegistrationVerdict verdict = RegistrationVerdict::different;
    Motion motion;               ///< of the source onto the target: the best one found, whatever the verdict
    SurfaceAgreement agreement;  ///< under that motion
    double tolerance = 0;        ///< in the target's unit: what the resolutions explain, or as given
    SurfaceAgreement mirrored;   ///< under the best motion of the source's mirror image
    std::vector<Motion> others;  ///< that fit as well: a symmetric object; at most 7
    SlippableMotions slippable;  ///< motions that the target's shape leaves open, in its place: a vessel about its axis
};

/// Both surfaces are brought to one centre and size by the moments of their area; all rotations (16384, evenly spread: super-
/// Fibonacci spirals, Alexa 2022) are scored by points on a grid, the best that differ are refined there (point to plane), and
/// the best of those on the faces, both ways, the coarser mesh's vertices counting more, as the area of its faces: what the flat
/// faces of both leave of a curved surface cancels in the scale. The same is done for the source's mirror image. They are one
/// surface where nearly all of either lies within the tolerance of the other. Of poses that fit equally the one that moves the
/// source least is taken. Same result for any number of threads; O(n) beside a search of constant size. Throws Error (usage) for
/// options out of range, (input) for a mesh without area, or flat, which nothing but its border would hold.
MeshRegistration register_mesh(const Mesh& source, const Mesh& target, const MeshRegistrationOptions& options = {});

/// The verdict and what it rests on, in one sentence; `diagonal`: of the target.
std::string in_words(const MeshRegistration& found, double diagonal);
/// What is to be known of an alignment: poses that fit equally, motions that the shape leaves open.
std::vector<std::string> remarks_on(const MeshRegistration& found);

}  // namespace ostraka

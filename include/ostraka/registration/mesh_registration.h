// Registers two meshes of one object that differ in unit and pose: rotation, translation and scale.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/geom/rigid_fit.h"
#include "ostraka/mesh/mesh.h"
#include "ostraka/registration/slippable_motions.h"

#include <string>
#include <vector>

namespace ostraka {

struct MeshRegistrationOptions {
    bool scale = true;     ///< estimate the scale, as for meshes in different units; else the meshes have the same size
    double tolerance = 0;  ///< tolerance for equal surfaces, share of the target's diagonal; 0: from the resolution of the meshes
    int samples = 4000;    ///< number of registration points on both meshes together, and number of evaluation points on each

    void describe(OptionList& visit);
};

enum class RegistrationVerdict {
    aligned,     ///< one surface, up to differences explained by the resolutions
    mirrored,    ///< not by any motion, but by a reflection
    inside_out,  ///< the faces of one mesh are flipped
    different    ///< not the same object
};
std::string to_string(RegistrationVerdict verdict);

/// Distances between two surfaces, at points spread over both. Lengths are in the target's unit.
struct SurfaceAgreement {
    double rms = 0;      ///< root mean square distance, both ways; points without a partner count with the search radius
    double largest = 0;  ///< 99th percentile of the distances, the worse of both directions
    double share = 0;    ///< share of the points within the tolerance, the worse of both directions
    double close = 0;    ///< share of the points within a third of the tolerance
};

struct MeshRegistration {
    RegistrationVerdict verdict = RegistrationVerdict::different;
    Motion motion;               ///< maps the source onto the target: the best motion found, whatever the verdict
    SurfaceAgreement agreement;  ///< under that motion
    double tolerance = 0;        ///< in the target's unit: from the resolutions, or as given
    SurfaceAgreement mirrored;   ///< under the best motion of the source's mirror image
    std::vector<Motion> others;  ///< motions that fit as well, for a symmetric object; at most 7
    SlippableMotions slippable;  ///< motions that the target's shape leaves open, in the target's frame: a vessel about its axis
};

/// Normalises both surfaces to one centre and size by the moments of their area. Scores all rotations (16384, evenly spread:
/// super-Fibonacci spirals, Alexa 2022) by points on a grid, refines the best distinct ones there (point to plane), and the
/// best of those on the faces, in both directions; the vertices of the coarser mesh get more weight, by the area of its faces,
/// so that the offsets of the flat faces of both meshes from the curved surface cancel in the scale. The same is done for the
/// source's mirror image. The meshes are one surface if nearly all of either lies within the tolerance of the other. Of poses
/// that fit equally, the one that moves the source least is returned. Same result for any number of threads; O(n) besides a
/// search of constant size. Throws Error (usage) for options out of range, (input) for a mesh without area, or for a flat mesh,
/// which only its border would constrain.
MeshRegistration register_mesh(const Mesh& source, const Mesh& target, const MeshRegistrationOptions& options = {});

/// The verdict and its reasons as one sentence; `diagonal`: of the target.
std::string in_words(const MeshRegistration& registration, double diagonal);
/// Remarks on an alignment: poses that fit equally, motions that the shape leaves open.
std::vector<std::string> remarks_on(const MeshRegistration& registration);

}  // namespace ostraka

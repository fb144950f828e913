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
    bool scale = true;  ///< true: estimate the scale, as for meshes in different units; false: the meshes have the same unit
    /// Surfaces within this distance of each other count as equal; a share of the target's diagonal. 0: derived from the
    /// resolution of the meshes.
    double tolerance = 0;
    int samples = 4000;  ///< number of points on both meshes together for registration, and on each mesh for evaluation

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// Whether two meshes show the same object.
enum class RegistrationVerdict {
    aligned,   ///< the meshes are one surface, up to differences explained by the resolutions
    mirrored,  ///< the meshes coincide only after a reflection
    different  ///< the meshes are not the same object
};
std::string to_string(RegistrationVerdict verdict);

/// Distances between two registered surfaces, at points spread over both. Lengths are in the target's unit.
struct SurfaceAgreement {
    double rms = 0;  ///< root mean square distance, in both directions; a point without a partner counts with the search radius
    double largest = 0;  ///< 99th percentile of the distances from one surface to the other, the larger of both directions
    double share = 0;    ///< share of the points of one surface within the tolerance of the other, the smaller of both directions
    double close = 0;    ///< share of the points within a third of the tolerance of the other surface
};

/// Uncertainty of a registration: standard deviations, each of the whole quantity (root of the sum over the three axes).
struct RegistrationUncertainty {
    double rotation = 0;     ///< of the rotation, in radians
    double translation = 0;  ///< of the target's centre of area, in the target's unit
    double scale = 0;        ///< of the scale, as a fraction of the scale; 0 if the scale was given
    double placement = 0;    ///< of the points of the surface: root mean square displacement, in the target's unit
    int undetermined = 0;    ///< number of independent motions that the surfaces do not determine; they are not included
};

/// Result of `register_mesh`.
struct MeshRegistration {
    RegistrationVerdict verdict = RegistrationVerdict::different;  ///< whether the meshes show the same object
    Motion motion;                        ///< maps the source onto the target; the best motion found, whatever the verdict
    SurfaceAgreement agreement;           ///< distances between the surfaces under `motion`
    RegistrationUncertainty uncertainty;  ///< standard deviations of `motion`
    double tolerance = 0;                 ///< distance within which surfaces count as equal, in the target's unit
    SurfaceAgreement mirrored;            ///< distances under the best motion of the source's mirror image
    std::vector<Motion> others;           ///< other motions that fit as well, for a symmetric object; at most 7
    /// Motions under which the target's shape does not change, in the target's coordinates; for example the rotations of a
    /// vessel about its axis.
    SlippableMotions slippable;
    /// True: the faces of one mesh point to the other side; the source was registered with its faces turned over.
    bool turned_over = false;
    enum class InsideOut { unknown, source, target } inside_out = InsideOut::unknown;  ///< which mesh, if `turned_over`
};

/// Registers `source` to `target`. Normalises both surfaces to one centre and size by the moments of their area. Scores all
/// rotations (16384, evenly spread: super-Fibonacci spirals, Alexa 2022) by points on a grid, refines the best distinct rotations
/// on the grid (point to plane), and the best of the refined motions on the faces, in both directions; points on the coarser
/// mesh get a larger weight, proportional to the area of its faces, so that the offsets of flat faces from the curved surface
/// do not bias the scale. The source's mirror image is registered in the same way. The meshes are one surface if nearly all of
/// either lies within the tolerance of the other; if one of them is inside out, the source's faces are turned over in memory.
/// Among poses that fit equally, the pose that moves the source least is returned. The uncertainty follows from the equations of
/// the last step (point to plane), with the residuals of one part of the surface taken as correlated: H^-1 (sum over parts of g
/// g^T) H^-1 with the gradient g of each part (Liang and Zeger 1986), or from independent residuals if that is larger. The result
/// is the same for any number of threads. Time: O(n), plus a search of constant size. Throws Error (usage) for options out of
/// range, (input) for a mesh without area, and for a flat mesh, whose pose only its border could determine.
MeshRegistration register_mesh(const Mesh& source, const Mesh& target, const MeshRegistrationOptions& options = {});

/// The verdict and its reasons as one sentence; `diagonal`: diagonal of the target.
std::string message_about(const MeshRegistration& registration, double diagonal);
/// Messages about a registration: further poses that fit equally well, and motions that the shape does not determine.
std::vector<std::string> remarks_on(const MeshRegistration& registration);

}  // namespace ostraka

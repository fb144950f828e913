// Registration of a template to a whole object of its class: vertex correspondence and residual distances.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/core/options.h"
#include "ostraka/reconstruction/fit.h"
#include "ostraka/reconstruction/placement.h"
#include "ostraka/registration/align.h"
#include "ostraka/shape_classes/deviating_regions.h"

#include <memory>
#include <optional>

namespace ostraka {

struct MemberFitOptions {
    PlacementOptions placement;          ///< options for registering the template by landmarks
    AlignOptions alignment;              ///< options for registering the template by its surface
    NonRigidOptions fit;                 ///< options for the non-rigid fit
    AnnotationMatchOptions annotations;  ///< options for matching annotations
    bool ignore_landmarks = false;       ///< true: register the template by its surface even if there are landmarks
    int tries = 1;                       ///< without landmarks: number of initial poses that are fitted; the best fit is kept
    double observed = 0.02;              ///< surfaces within this distance lie on each other; a share of the diagonal
    double max_off = 0.125;              ///< the template lies on the object if FitResiduals::off is at most this value
    MemberFitOptions() {
        fit.counterparts = NonRigidOptions::Counterparts::surface;  // the thresholds of classes were measured with this setting
        alignment.shrinkage = 0.3;
        fit.search_radius = 0.2;
        fit.last_search_radius = 0.05;
    }

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// An object that is not a fragment; it may have no annotations.
struct WholeObject : AnnotatedMesh {
    std::string name;  ///< name of the object, see object_name
};

/// Differences between template and object after the fit. Lengths are relative to the bounding box diagonal of the template at
/// the object's scale; areas are shares of the total area, 0 to 1.
struct FitResiduals {
    double distance = 0;     ///< area-weighted root mean square distance from the vertices of the fitted template to the object
    double back = 0;         ///< area-weighted root mean square distance from the object's surface to the fitted template
    double unmatched = 0;    ///< share of the template's area that does not lie on the object
    double unexplained = 0;  ///< share of the object's area on which no part of the template lies
    /// Root mean square logarithm of the principal stretches of the triangles relative to the scaled template; 0.1 is about ten
    /// per cent.
    double stretch = 0;
    double bend = 0;  ///< root mean square change of the dihedral angles relative to the scaled template, radians
    /// Mean of the shares of the two surfaces that do not lie on the other surface.
    [[nodiscard]] double off() const { return 0.5 * (unmatched + unexplained); }
};

/// Treatment of objects that have the same triangles as the template (are in correspondence). given: the vertices of the object
/// are used without a fit; fitted: the template is fitted; automatic: as `given` if the object has the template's triangles,
/// otherwise as `fitted`.
enum class CorrespondenceChoice { automatic, given, fitted };

/// Registration of a template to an object.
struct MemberFit {
    std::vector<Point> points;       ///< positions of the template's vertices on the object
    double scale = 1;                ///< scale of the template
    std::string placed_by;           ///< how the template was registered: by "correspondence", "landmarks" or "surface"
    std::string problem;             ///< reason if the template could not be fitted, with the remedy; empty if it is fitted
    std::vector<std::string> notes;  ///< remarks on the registration
    std::optional<FitResiduals> residuals;  ///< empty for members in correspondence
    double contact_distance = 0;            ///< distance within which surfaces lie on each other, in the object's unit
    /// Share of the object's surface that is the inner side of walls, as in a hollow figurine (inner_wall_faces). The inner
    /// side is excluded from the residuals and from the measures of the whole shape. `outer` is the object without the inner
    /// side, closed where it was cut off; null if the object is not hollow.
    double cavity = 0;
    std::shared_ptr<const Mesh> outer;
    /// `foreign`: regions of the object that do not lie on the template; `missing`: regions of the fitted template that do not
    /// lie on the object. Both are in the object's coordinates, and empty for an object in correspondence.
    std::vector<DeviatingRegion> foreign, missing;
};

/// If FitResiduals::off is above this value, the fit gives no information about the object.
inline constexpr double uninformative_fit = 0.5;

/// Message, with numbers, that the template does not lie on the object because `off()` is above `maximum`; empty if `off()` is
/// not above, or if there are no residuals.
std::string fit_off_message(const MemberFit& fit, double maximum);

/// Messages about a fit, one per line: the share of the object that lies on the template, the share of the template that lies
/// on the object, the distance threshold, and for each deviating region its position, area, distance and the nearest part of
/// the template. Empty for an object in correspondence.
std::vector<std::string> fit_explanation(const MemberFit& fit);

/// True if a member has the template's triangles: the same number of vertices, and the same faces in the same order.
bool in_correspondence(const Mesh& mesh, const Mesh& member);

/// Registers the template (`mesh`, `set`) to the object by a similarity and then fits it (`fit_template`). The similarity comes
/// from three or more common landmarks (`place_by_landmarks`) or, without landmarks, from the surfaces: the template is scaled to
/// the object's area and aligned by trimmed iterative closest points in both directions (`align`, with free scale within
/// `shrinkage`), started from the four orientations of the principal axes and from the given pose. The residuals are measured on
/// the surfaces. Throws Error (input) for an object or a template without area.
MemberFit fit_member(AnnotatedMeshView object, const WholeObject& member, const MemberFitOptions& options = {});

/// Fit of a member in correspondence: the points are the member's own vertices.
MemberFit member_in_correspondence(const Mesh& mesh, const WholeObject& member);

/// Sets the members stretch and bend of `residuals` for the deformation from the mesh scaled by `scale` to `points`.
void measure_distortion(const Mesh& mesh, const std::vector<Point>& points, double scale, FitResiduals& residuals);

}  // namespace ostraka

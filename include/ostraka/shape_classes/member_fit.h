// A template registered to a whole object of its class: correspondence of vertices, and how far the two are apart.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/reconstruction/fit.h"
#include "ostraka/reconstruction/placement.h"
#include "ostraka/registration/align.h"
#include "ostraka/shape_classes/off_regions.h"

#include <memory>
#include <optional>

namespace ostraka {

struct MemberFitOptions {
    PlacementOptions placement;
    AlignOptions alignment;
    NonRigidOptions fit;
    AnnotationMatchOptions annotations;
    bool ignore_landmarks = false;
    int tries = 1;
    double observed = 0.02;
    double max_off = 0.125;
    MemberFitOptions() {
        fit.counterparts = NonRigidOptions::Counterparts::surface;  // what thresholds of classes were measured with
        alignment.shrinkage = 0.3;
        fit.search_radius = 0.2;
        fit.last_search_radius = 0.05;
    }

    void describe(OptionList& visit);
};

/// A whole object.
struct WholeObject {
    std::string name;
    Mesh mesh;
    AnnotationSet annotations;  ///< may be empty
};

/// How far template and object are apart after the fit. Lengths are shares of the box diagonal of the template at the object's
/// scale; areas are shares of the whole.
struct FitResiduals {
    double distance = 0;     ///< root mean square from the fitted template's vertices, weighted by area, to the object
    double back = 0;         ///< the same from the object's surface to the fitted template
    double unmatched = 0;    ///< area of the template that does not lie on the object
    double unexplained = 0;  ///< area of the object that no part of the template lies on
    double stretch = 0;      ///< root mean square of the logarithms of the stretches along the two principal directions of each
                             ///< triangle, against the scaled template: 0.1 is about ten per cent
    double bend = 0;         ///< root mean square of the change of the angles between faces at edges, radians
    /// Share of both surfaces that is off the other.
    [[nodiscard]] double off() const { return 0.5 * (unmatched + unexplained); }
};

/// Whether an object whose triangles are the template's is taken as it is: where it has them, always, or never.
enum class CorrespondenceChoice { automatic, given, fitted };

struct MemberFit {
    std::vector<Point> points;  ///< of the template's vertices, where the object is
    double scale = 1;           ///< of the template
    std::string placed_by;      ///< "correspondence", "landmarks" or "surface"
    std::string problem;        ///< why it is not fitted, in words with the remedy; empty if it is
    std::vector<std::string> notes;
    std::optional<FitResiduals> residuals;  ///< none in correspondence
    double near = 0;                        ///< surfaces farther apart do not lie on each other, in the object's unit
    /// Share of the object's surface that is the inside of walls whose outside lies on the template, as of a hollow figurine
    /// (insides_of_walls). It is left out of the residuals and of the numbers of the whole shape: `outer` is the object without
    /// it, where it was cut off closed. None: there is no such inside.
    double cavity = 0;
    std::shared_ptr<const Mesh> outer;
    /// Regions of the object that no part of the template lies on, and of the fitted template that do not lie on the object,
    /// where the object is. None in correspondence.
    std::vector<OffRegion> foreign, missing;
};

/// Above this share of both surfaces that is off the other (FitResiduals::off) a fit says nothing of the object.
inline constexpr double hopeless_fit = 0.5;

/// In words with the numbers why the template does not lie on the object: `off()` is above `maximum`. Empty where it does, or
/// where there are no residuals.
std::string fit_is_off(const MemberFit& fit, double maximum);

/// In words how much of the object the template explains and how much of it lies on the object, within which distance, and which
/// regions do not: where they are, how much, how far off, and the nearest part of the template. A line each; none in
/// correspondence.
std::vector<std::string> explained_text(const MemberFit& fit);

/// Whether an object has the template's triangles: as many vertices, and the same faces in the same order.
bool in_correspondence(const Mesh& mesh, const Mesh& member);

/// Lays the template onto the object by a similarity: by three or more common landmarks (`place_by_landmarks`) or, without them,
/// by the surfaces: scaled to the object's area, from the four ways of the principal axes and from the way the files have it,
/// trimmed iterative closest points both ways (`align`, the size free within `shrinkage`). Then `fit_template`. The residuals are
/// measured on the surfaces. Throws Error (input) for an object or a template without area.
MemberFit fit_member(const Mesh& mesh, const AnnotationSet& set, const WholeObject& member, const MemberFitOptions& options = {});

/// A member in correspondence: its own points.
MemberFit member_in_correspondence(const Mesh& mesh, const WholeObject& member);

/// Stretch and bend of `points` against the mesh times `scale`, as in FitResiduals.
void measure_distortion(const Mesh& mesh, const std::vector<Point>& points, double scale, FitResiduals& residuals);

}  // namespace ostraka

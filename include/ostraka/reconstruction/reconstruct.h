// From fragments to the whole object: placement, non-rigid fit, constraints, completion, verdict (thesis, section 5.3.1).
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/reconstruction/complete.h"
#include "ostraka/reconstruction/open_rotations.h"
#include "ostraka/reconstruction/placement.h"
#include "ostraka/reconstruction/shape_prior.h"
#include "ostraka/reconstruction/template_cage.h"
#include "ostraka/registration/part_alignment.h"
#include "ostraka/semantic/deform.h"

#include <map>
#include <memory>

namespace ostraka {

struct ReconstructOptions {
    PlacementOptions placement;
    SearchOptions search;
    bool refine = true;  ///< poses are refined by the surface, with the landmarks as anchors
    PartAlignmentOptions alignment;
    RotationMatchOptions rotations;
    AnnotationMatchOptions annotations;
    PriorOptions prior;
    NonRigidOptions fit;
    CompleteOptions completion;   ///< its tolerance is `observed`
    double observed = 0.02;       ///< farthest that an observed vertex lies from its match, as a share of the diagonal
    double scale_tolerance = 10;  ///< per cent by which a fragment's own scale may differ from that of all
    double slack = 3;             ///< per cent by which a proportion or measure may be out of its range
    double residual = 0.25;       ///< of landmarks, as a share of the spread of a fragment's landmarks: more is rejected
    double lying = 50;            ///< per cent of a fragment's outer surface that lies on the fitted template, at least
    double overlap = 20;          ///< per cent of it that lies where another fragment is seen, at most
    bool restore = true;          ///< constraints are solved for what was not observed

    void describe(OptionList& visit);
};

/// Causes before what follows from them.
enum class ObjectionKind { placement, size, landmarks, surface, overlap, constraint };
std::string to_string(ObjectionKind kind);
/// A finding that speaks against a fragment, or against all of them together.
struct Objection {
    ObjectionKind kind = ObjectionKind::placement;
    int fragment = -1;    ///< -1: none by itself
    int constraint = -1;  ///< id of a relationship of the graph; -1: geometry
    double strain = 0;    ///< how far off, in times of what is allowed; 0: cannot be determined
    std::string text;
};

enum class Compatibility { compatible, incompatible, undecided };
std::string to_string(Compatibility compatibility);

struct Reconstruction {
    CommonPlacement placement;
    std::vector<std::optional<PoseSearchResult>> searched;  ///< of each fragment whose pose was searched
    std::vector<PartAlignment> alignment;                   ///< of each fragment placed, where poses were refined
    std::optional<RotationMatch> rotations;                 ///< where rotations about the template's axis were open
    std::vector<std::vector<AnnotationMatch>> annotations;  ///< of each fragment
    std::vector<std::vector<std::string>> notes;            ///< of each fragment
    std::optional<PriorFit> prior;                          ///< where a class was given
    NonRigidFit fit;
    std::vector<Point> points;     ///< of the template's vertices at the end, in the unit of the fragments
    std::vector<double> distance;  ///< of each of them from its fragment; none where it was not observed: -1
    CompletedObject object;
    std::vector<std::size_t> joined;  ///< faces of each fragment that are in it
    double observed_share = 0;        ///< of the completed object's area
    std::size_t crossings = 0;  ///< pairs of faces of the object that cross, but for those of the template and of each fragment
    std::vector<ConstraintReport> constraints;
    std::vector<ConstraintConflict> conflicts;
    double strain = 0;  ///< the largest of all that was tested, in times of what is allowed: above 1 something speaks against it
    Compatibility verdict = Compatibility::undecided;
    std::vector<Objection> objections;
    std::string undecided;                  ///< why
    std::map<std::string, double> seconds;  ///< by phase
};

struct KnownObject;

/// Fragments of one object on its template, which come and go. What depends on the template alone (its simplified mesh, linear
/// systems with their symbolic factorisation, what poses are searched with) or on it and one fragment (common landmarks, poses
/// that were searched, search trees) is made once; what depends on the common scale as well (refined poses, matches of
/// annotations) is used again where scale and pose are the same to the bit. So the result is that of a new object with the same
/// fragments in the same order, to the bit.
class Reconstructor {
public:
    /// All but the options outlive it and do not change; so do fragments for as long as they are there. Throws Error (usage) for
    /// options out of range, and for cage space without a cage or with a prior; (input) for a template that is inside out, and as
    /// ShapePrior::check.
    Reconstructor(const Mesh& mesh, const AnnotationSet& set, const RelationGraph& graph, const ReconstructOptions& options = {},
                  const ShapePrior* prior = nullptr, const TemplateCage* cage = nullptr);
    /// What is given is referred to.
    Reconstructor(const Mesh& mesh, const AnnotationSet& set, RelationGraph&& graph, const ReconstructOptions& options = {},
                  const ShapePrior* prior = nullptr, const TemplateCage* cage = nullptr) = delete;
    ~Reconstructor();
    Reconstructor(Reconstructor&&) noexcept;

    /// Puts a fragment behind the others. Throws Error (input) if it is inside out.
    void add(const Fragment& fragment, std::vector<StatedMatch> stated = {});
    /// By position; those behind it move up. Throws Error (usage) where there is none.
    void remove(std::size_t position);
    [[nodiscard]] std::size_t size() const;

    /// Searches of poses, to keep them in a file or to take them from one.
    [[nodiscard]] PoseSearches& searches();

    /// See `reconstruct`. Throws Error (usage) without a fragment.
    Reconstruction run();

private:
    std::unique_ptr<KnownObject> known_;
};

/// With a `prior`, the template takes the most probable shape of its class before it is deformed freely, and the fragments are
/// registered to that shape anew, in two rounds: what is not observed is then as in the class's members that look so where it is.
///
/// A proportion changes the part of the two that was observed less, whichever the graph names first.
///
/// Places every fragment by the landmarks it has in common with the template, refines the poses by the
/// surface, matches annotations, deforms the scaled template to all fragments placed, holds what was observed, solves the
/// graph's constraints for the rest, and joins both into one surface. Fragments that cannot be placed are left out and said. The
/// verdict: incompatible where a constraint fails, a fragment's own scale or its landmarks contradict the others; undecided where
/// no fragment is placed, or there is but one and no constraint. Throws Error (input) for a template that does not fit its
/// annotations.
Reconstruction reconstruct(const Mesh& mesh, const AnnotationSet& set, const RelationGraph& graph,
                           const std::vector<const Fragment*>& fragments, const ReconstructOptions& options = {},
                           const std::vector<std::vector<StatedMatch>>& stated = {}, const ShapePrior* prior = nullptr,
                           const TemplateCage* cage = nullptr);

/// The template's annotations on the completed object, carried over from the fitted template, where it has them: measures are
/// those taken before (`refresh_measures`).
AnnotationSet carry_annotations(const Mesh& mesh, const AnnotationSet& set, const Reconstruction& result);

}  // namespace ostraka

// Reconstructs an object from fragments: placement, non-rigid fit, constraints, completion, verdict (thesis, section 5.3.1).
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
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
    PlacementOptions placement;      ///< options for placing fragments by landmarks
    SearchOptions search;            ///< options for pose searches
    bool refine = true;              ///< true: refine the poses by registration of the surfaces, with the landmarks as anchors
    PartAlignmentOptions alignment;  ///< options for refining poses on the surface
    RotationMatchOptions rotations;  ///< options for rotations about the template's axis
    AnnotationMatchOptions annotations;  ///< options for matching annotations
    PriorOptions prior;                  ///< options of the fit of the shape prior
    NonRigidOptions fit;                 ///< options of the non-rigid fit
    CompleteOptions completion;          ///< the tolerance of the completion is replaced by `observed`
    double observed = 0.02;       ///< max distance of an observed vertex from its match, as a share of the template's diagonal
    double scale_tolerance = 10;  ///< max deviation of a fragment's own scale from the common scale, per cent
    double min_tolerance = 3;     ///< a proportion or measure may deviate from its allowed range by this many per cent
    /// Max residual of a fragment's landmarks, as a share of the landmarks' spread; a fragment with a larger residual is
    /// rejected.
    double residual = 0.25;
    double min_on_template = 50;  ///< min share of a fragment's outer surface that lies on the fitted template, per cent
    double overlap = 20;  ///< max share of a fragment's outer surface that lies where another fragment is observed, per cent
    bool restore = true;  ///< true: deform the unobserved part so that the constraints are satisfied

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// Kinds of evidence against a common object, ordered from causes to effects.
enum class ObjectionKind { placement, size, landmarks, surface, overlap, constraint };
std::string to_string(ObjectionKind kind);
/// Evidence that a fragment, or all fragments together, do not form one object with the template.
struct Objection {
    ObjectionKind kind = ObjectionKind::placement;  ///< kind of evidence
    int fragment = -1;                              ///< index of the fragment; -1: the evidence concerns no single fragment
    int constraint = -1;                            ///< id of the violated relationship of the graph; -1: geometric evidence
    double strain = 0;                              ///< deviation as a multiple of its tolerance; 0: cannot be determined
    std::string text;                               ///< the evidence as a sentence
};

/// Whether the fragments belong to one object.
enum class Compatibility { compatible, incompatible, undecided };
std::string to_string(Compatibility compatibility);

/// Result of a reconstruction.
struct Reconstruction {
    CommonPlacement placement;  ///< scale of the template, and poses of the fragments
    /// For each fragment, the result of its pose search; empty: not searched.
    std::vector<std::optional<PoseSearchResult>> searched;
    std::vector<PartAlignment> alignment;    ///< for each placed fragment, the refinement of its pose; empty: not refined
    std::optional<RotationMatch> rotations;  ///< rotations about the template's axis; empty: none was undetermined
    std::vector<std::vector<AnnotationMatch>> annotations;  ///< for each fragment, the matches of its annotations
    std::vector<std::vector<std::string>> notes;            ///< for each fragment, remarks
    std::optional<PriorFit> prior;                          ///< the most probable shape of the class; empty: no class was given
    NonRigidFit fit;                                        ///< deformation of the template to the fragments
    std::vector<Point> points;     ///< final positions of the template's vertices, in the unit of the fragments
    std::vector<double> distance;  ///< for each vertex of the template, its distance from the matched fragment; -1: not observed
    CompletedObject object;        ///< the completed object
    std::vector<std::size_t> joined;  ///< for each fragment, number of its faces in the completed object
    double observed_share = 0;        ///< observed share of the completed object's area
    /// Number of pairs of intersecting faces in the completed object; pairs in which both faces come from the template, or both
    /// from the same fragment, are not counted.
    std::size_t crossings = 0;
    std::vector<ConstraintReport> constraints;  ///< state of the graph's constraints after the deformation
    std::vector<ConstraintConflict> conflicts;  ///< constraints that contradict each other
    double strain = 0;  ///< largest tested deviation, as a multiple of its tolerance; above 1: evidence against a common object
    Compatibility verdict = Compatibility::undecided;  ///< whether the fragments belong to one object
    std::vector<Objection> objections;                 ///< evidence against a common object
    std::string undecided;                             ///< reason for the verdict "undecided"; empty for other verdicts
    std::map<std::string, double> seconds;             ///< from each phase to its computing time in seconds
};

struct ReconstructionState;

/// Reconstructs an object repeatedly while fragments are added and removed. Data that depend on the template alone (its
/// simplified mesh, linear systems with their symbolic factorisation, the data for pose searches) or on the template and one
/// fragment (common landmarks, pose searches, search trees) are computed once; data that also depend on the common scale
/// (refined poses, matches of annotations) are reused if scale and pose are bitwise equal. The result is bitwise equal to the
/// result of a new Reconstructor with the same fragments in the same order.
class Reconstructor {
public:
    /// All arguments but the options must outlive the object unchanged, and so must each added fragment until it is removed.
    /// Throws Error (usage) for options out of range, and for cage space without a cage or with a prior; (input) for a template
    /// that is inside out, and the errors of ShapePrior::check.
    Reconstructor(AnnotatedMeshView template_object, const RelationGraph& graph, const ReconstructOptions& options = {},
                  const ShapePrior* prior = nullptr, const TemplateCage* cage = nullptr);
    /// Deleted, since the object stores references to its arguments.
    Reconstructor(AnnotatedMeshView template_object, RelationGraph&& graph, const ReconstructOptions& options = {},
                  const ShapePrior* prior = nullptr, const TemplateCage* cage = nullptr) = delete;
    ~Reconstructor();
    Reconstructor(Reconstructor&&) noexcept;

    /// Appends a fragment; `stated`: matches of its annotations stated by the user. Throws Error (input) if the fragment is
    /// inside out.
    void add(const Fragment& fragment, std::vector<StatedMatch> stated = {});
    /// Removes the fragment at this position; the following fragments move up by one position. Throws Error (usage) for an
    /// invalid position.
    void remove(std::size_t position);
    /// Number of fragments.
    [[nodiscard]] std::size_t size() const;

    /// The cached pose searches, for saving to or loading from a file.
    [[nodiscard]] PoseSearches& searches();

    /// Reconstructs the object from the current fragments, as `reconstruct` does. Throws Error (usage) without a fragment.
    Reconstruction run();

private:
    std::unique_ptr<ReconstructionState> known_;
};

/// Reconstructs an object. With a `prior`, the template takes the most probable shape of its class before the free deformation,
/// and the fragments are registered to that shape again, in two rounds: the unobserved part then resembles the members of the
/// class that are similar in the observed part. To satisfy a constraint on a proportion, the part of which less is observed is
/// changed, independent of the order of the parts in the graph. The steps: places every fragment by the landmarks that it has
/// in common with the template, refines the poses on the surface, matches annotations, deforms the scaled template to all
/// placed fragments, fixes the observed part, solves the graph's constraints for the rest, and joins fragments and template
/// into one surface. Fragments that cannot be placed are left out and reported. The verdict is "incompatible" if a constraint
/// is violated, or if a fragment's own scale or its landmarks contradict the other fragments. The verdict is "undecided" if no
/// fragment is placed, or if only one is placed and there is no constraint. Throws Error (input) if the annotations do not
/// belong to the template.
Reconstruction reconstruct(AnnotatedMeshView template_object, const RelationGraph& graph,
                           const std::vector<const Fragment*>& fragments, const ReconstructOptions& options = {},
                           const std::vector<std::vector<StatedMatch>>& stated = {}, const ShapePrior* prior = nullptr,
                           const TemplateCage* cage = nullptr);

/// Transfers the template's annotations to the completed object. The values of measures are still those of the template;
/// `refresh_measures` recomputes them.
AnnotationSet completed_annotations(AnnotatedMeshView template_object, const Reconstruction& result);

}  // namespace ostraka

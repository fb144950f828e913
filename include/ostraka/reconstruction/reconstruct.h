// Reconstructs the whole object from fragments: placement, non-rigid fit, constraints, completion, verdict (thesis, section
// 5.3.1).
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
    PlacementOptions placement;
    SearchOptions search;
    bool refine = true;  ///< refine poses on the surface, with the landmarks as anchors
    PartAlignmentOptions alignment;
    RotationMatchOptions rotations;
    AnnotationMatchOptions annotations;
    PriorOptions prior;
    NonRigidOptions fit;
    CompleteOptions completion;   ///< its tolerance is `observed`
    double observed = 0.02;       ///< max distance of an observed vertex from its match, as a share of the diagonal
    double scale_tolerance = 10;  ///< max deviation of a fragment's own scale from the common scale, per cent
    double slack = 3;             ///< max deviation of a proportion or measure from its range, per cent
    double residual = 0.25;       ///< max residual of landmarks, as a share of the spread of a fragment's landmarks; above it the
                                  ///< fragment is rejected
    double lying = 50;            ///< min per cent of a fragment's outer surface that lies on the fitted template
    double overlap = 20;          ///< max per cent of it that lies where another fragment is observed
    bool restore = true;          ///< solve constraints for the unobserved part

    void describe(OptionList& visit);
};

/// In the order of cause and effect.
enum class ObjectionKind { placement, size, landmarks, surface, overlap, constraint };
std::string to_string(ObjectionKind kind);
/// Evidence against a fragment, or against all of them together.
struct Objection {
    ObjectionKind kind = ObjectionKind::placement;
    int fragment = -1;    ///< -1: no single fragment
    int constraint = -1;  ///< id of a relationship of the graph; -1: geometry
    double strain = 0;    ///< deviation as a multiple of the tolerance; 0: cannot be determined
    std::string text;
};

enum class Compatibility { compatible, incompatible, undecided };
std::string to_string(Compatibility compatibility);

struct Reconstruction {
    CommonPlacement placement;
    std::vector<std::optional<PoseSearchResult>> searched;  ///< per fragment, if its pose was searched
    std::vector<PartAlignment> alignment;                   ///< per placed fragment, if poses were refined
    std::optional<RotationMatch> rotations;                 ///< if rotations about the template's axis were open
    std::vector<std::vector<AnnotationMatch>> annotations;  ///< per fragment
    std::vector<std::vector<std::string>> notes;            ///< per fragment
    std::optional<PriorFit> prior;                          ///< if a class was given
    NonRigidFit fit;
    std::vector<Point> points;     ///< final positions of the template's vertices, in the unit of the fragments
    std::vector<double> distance;  ///< distance of each from its fragment; -1: not observed
    CompletedObject object;
    std::vector<std::size_t> joined;  ///< per fragment, number of its faces in the object
    double observed_share = 0;        ///< share of the completed object's area
    std::size_t crossings = 0;  ///< intersecting pairs of faces of the object, without those within the template or a fragment
    std::vector<ConstraintReport> constraints;
    std::vector<ConstraintConflict> conflicts;
    double strain = 0;  ///< largest tested deviation, as a multiple of its tolerance: above 1 is evidence against the object
    Compatibility verdict = Compatibility::undecided;
    std::vector<Objection> objections;
    std::string undecided;                  ///< reason for "undecided"
    std::map<std::string, double> seconds;  ///< by phase
};

struct ReconstructionState;

/// Fragments of one object on its template, which can be added and removed. Data that depends on the template alone (its
/// simplified mesh, linear systems with their symbolic factorisation, the data for pose searches) or on the template and one
/// fragment (common landmarks, pose searches, search trees) is computed once; data that also depends on the common scale
/// (refined poses, matches of annotations) is reused if scale and pose are the same to the bit. The result is that of a new
/// object with the same fragments in the same order, to the bit.
class Reconstructor {
public:
    /// All arguments but the options must outlive it unchanged; so must fragments while they are part of it. Throws Error
    /// (usage) for options out of range, and for cage space without a cage or with a prior; (input) for a template that is
    /// inside out, and as ShapePrior::check.
    Reconstructor(AnnotatedMeshView template_object, const RelationGraph& graph, const ReconstructOptions& options = {},
                  const ShapePrior* prior = nullptr, const TemplateCage* cage = nullptr);
    /// Stores references to its arguments.
    Reconstructor(AnnotatedMeshView template_object, RelationGraph&& graph, const ReconstructOptions& options = {},
                  const ShapePrior* prior = nullptr, const TemplateCage* cage = nullptr) = delete;
    ~Reconstructor();
    Reconstructor(Reconstructor&&) noexcept;

    /// Appends a fragment. Throws Error (input) if it is inside out.
    void add(const Fragment& fragment, std::vector<StatedMatch> stated = {});
    /// Removes by position; the following ones move up. Throws Error (usage) for an invalid position.
    void remove(std::size_t position);
    [[nodiscard]] std::size_t size() const;

    /// The pose searches, for saving to or loading from a file.
    [[nodiscard]] PoseSearches& searches();

    /// See `reconstruct`. Throws Error (usage) without a fragment.
    Reconstruction run();

private:
    std::unique_ptr<ReconstructionState> known_;
};

/// With a `prior`, the template takes the most probable shape of its class before the free deformation, and the fragments are
/// registered to that shape again, in two rounds: the unobserved part then follows the class's members that are similar in the
/// observed part.
///
/// A proportion changes the less observed of its two parts, whichever the graph names first.
///
/// Places every fragment by the landmarks common with the template, refines the poses on the surface, matches annotations,
/// deforms the scaled template to all placed fragments, fixes the observed part, solves the graph's constraints for the rest,
/// and joins both into one surface. Fragments that cannot be placed are left out and reported. The verdict: incompatible if a
/// constraint fails, or if a fragment's own scale or its landmarks contradict the others; undecided if no fragment is placed,
/// or only one and there is no constraint. Throws Error (input) for a template that does not fit its annotations.
Reconstruction reconstruct(AnnotatedMeshView template_object, const RelationGraph& graph,
                           const std::vector<const Fragment*>& fragments, const ReconstructOptions& options = {},
                           const std::vector<std::vector<StatedMatch>>& stated = {}, const ShapePrior* prior = nullptr,
                           const TemplateCage* cage = nullptr);

/// The template's annotations transferred from the fitted template to the completed object; measures keep their earlier values
/// (`refresh_measures`).
AnnotationSet completed_annotations(AnnotatedMeshView template_object, const Reconstruction& result);

}  // namespace ostraka

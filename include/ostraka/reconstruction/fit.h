// Deforms a template to fragments registered to it (thesis, equation 5.2, as an optimal-step non-rigid registration).
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/core/options.h"
#include "ostraka/fracture/fragment.h"
#include "ostraka/reconstruction/annotation_matches.h"
#include "ostraka/reconstruction/vertex_assignment.h"

#include <memory>
#include <vector>

namespace ostraka {

class FragmentTrees;
struct TemplateCage;

struct NonRigidOptions {
    enum class Space { mesh, cage, both };
    Space space = Space::mesh;  ///< unknowns: the template's vertices, those of its cage, or the cage first and the vertices in
                                ///< the last levels
    double start = 0.3;         ///< smoothing length of the first level, as a share of the template's diagonal
    double end = 0.01;          ///< smoothing length of the last level, likewise
    int levels = 6;
    int steps = 3;               ///< max iterations of matching and solving per level
    double stay = 0.5;           ///< length over which the deformation of the first level fades where nothing is observed
    double fade = 3;             ///< length over which the deformation of later levels fades, in their smoothing lengths
    double search_radius = 0.1;  ///< max distance of a match in the first level, as a share of the diagonal
    double last_search_radius = 0.02;
    double angle = 60;  ///< max angle between the normals of a match, degrees
    enum class Counterparts { sliding, surface, best, one_to_one };
    Counterparts counterparts = Counterparts::sliding;  ///< surface points along which vertices may slide, closest points, or in
                                                        ///< matched annotations the vertices of equation 5.1
    VertexAssignmentOptions vertices;                   ///< its weights; search radius and angle are those of the level
    double correspondences = 1;                         ///< weight of outlines and landmarks of matched annotations
    bool outlines = true;                               ///< match lines and outlines by the position along the curve

    void describe(OptionList& visit);
};

/// A fragment on the template, with its matches.
struct PlacedFragment {
    Mesh mesh;                                   ///< in the template's frame
    const AnnotationSet* annotations = nullptr;  ///< must outlive this object
    std::vector<Facet> facets;
    std::vector<AnnotationMatch> matches;
    Motion pose{};                           ///< maps the coordinates of the search trees to `mesh`
    std::shared_ptr<FragmentTrees> trees{};  ///< search trees in the fragment's original frame; null: they are built
};

/// The match of a template vertex on a fragment.
struct VertexMatch {
    int fragment = -1;      ///< -1: not observed
    Index face = no_index;  ///< face of the fragment
    Eigen::Vector3d place = Eigen::Vector3d::Zero();
    double distance = 0;  ///< distance from the deformed vertex
};

struct NonRigidFit {
    std::vector<Point> points;         ///< positions of the template's vertices
    std::vector<VertexMatch> matches;  ///< per vertex, after the last level
    struct Level {
        std::size_t vertices = 0;  ///< number of vertices of the mesh it was solved on
        double smoothing = 0;      ///< smoothing length, in the mesh's unit
        std::size_t matched = 0;
        double residual = 0;  ///< root mean square distance of the matches after the level
        int steps = 0;
    };
    std::vector<Level> levels;
    double seconds_matching = 0, seconds_solving = 0, seconds_coarsening = 0;
};

/// Fits of one template. All that depends on the template alone is computed once, on demand, and reused: the simplified
/// template, areas and cotangent weights, the linear systems with their fill-reducing order and symbolic factorisation. Results
/// do not depend on earlier fits, to the bit.
class TemplateFitter {
public:
    /// All arguments must outlive it unchanged; fits in cage space need a cage. Throws Error (input) for a mesh without faces,
    /// (usage) for coordinates with a normal term or of another mesh or cage.
    TemplateFitter(AnnotatedMeshView template_object, const TemplateCage* cage = nullptr);
    ~TemplateFitter();
    TemplateFitter(TemplateFitter&&) noexcept;

    /// As `fit_template` for the template scaled by `scale`. In cage space, x = W c, the same sum is minimised over the cage's
    /// vertices c; point-to-plane steps follow the last level, in which unmatched vertices are held at their positions after
    /// the levels. Throws Error (usage) for cage space without a cage.
    NonRigidFit fit(double scale, const std::vector<PlacedFragment>& fragments, const NonRigidOptions& options = {});

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Minimises, level by level,  sum over vertices of A_i (w_i |x_i - q_i|^2 + (s/t)^4 |x_i - p_i|^2 + s^4 |Delta x_i - R_i Delta
/// r_i|^2): the three costs of equation 5.2 (match, stay, Laplacian displacement of the template r) with areas A_i, so that the
/// result does not depend on the resolution. s is the smoothing length of the level; R_i is the rotation of each vertex's
/// neighbourhood. In the first level p is the template and t the transition length; later p is the result of the previous level
/// and t = `fade` s, so that the change of a level, including the noise at a fragment's edge, ends near the observed surface.
/// Matches are the closest points with a compatible normal on the fragments' outer facets, within the same matched annotation
/// on either side (the smallest one that contains the vertex), never at a border. With `sliding` a vertex is attracted to the
/// plane of its match, not to the point; where two annotations meet, to the curve where their counterparts meet; and Laplacian
/// displacements scale with what was observed around them. If the faces of a fragment are the template's (a copy in another
/// shape), each vertex is matched to its own. Levels that are smooth relative to a mesh of 4000 vertices are solved on such a
/// mesh (quadric error simplification); the template follows it and takes up the remaining deformation. `scaled` is the template
/// at the scale of the placement.
NonRigidFit fit_template(AnnotatedMeshView scaled, const std::vector<PlacedFragment>& fragments,
                         const NonRigidOptions& options = {});

}  // namespace ostraka

// A template deformed to fragments that lie on it (thesis, equation 5.2, as an optimal-step non-rigid registration).
#pragma once

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
    Space space = Space::mesh;  ///< unknowns: the template's vertices, those of its cage, or first these and at last those
    double start = 0.3;         ///< smoothing length of the first level, as a share of the template's diagonal
    double end = 0.01;          ///< of the last
    int levels = 6;
    int steps = 3;               ///< matches and solutions in each level, at most
    double stay = 0.5;           ///< length over which the deformation of the first level fades where nothing is observed
    double fade = 3;             ///< what a later level adds fades over so many of its smoothing lengths
    double search_radius = 0.1;  ///< farthest match in the first level, as a share of the diagonal
    double last_search_radius = 0.02;
    double angle = 60;  ///< of normals of matches, degrees
    enum class Counterparts { sliding, surface, best, one_to_one };
    Counterparts counterparts = Counterparts::sliding;  ///< places of the surface from which vertices may slide, closest places,
                                                        ///< or in matched annotations the vertices of equation 5.1
    VertexAssignmentOptions vertices;                   ///< its weights; search radius and angle are those of the level
    double correspondences = 1;                         ///< weight of outlines and landmarks of matched annotations
    bool outlines = true;                               ///< lines and outlines correspond by the position along them

    void describe(OptionList& visit);
};

/// A fragment on the template, and what it is matched with.
struct PlacedFragment {
    Mesh mesh;                                   ///< moved to where the template is
    const AnnotationSet* annotations = nullptr;  ///< outlives it
    std::vector<Facet> facets;
    std::vector<AnnotationMatch> matches;
    Motion pose{};                           ///< of `mesh`, from the coordinates of the trees
    std::shared_ptr<FragmentTrees> trees{};  ///< of the fragment before it was moved, where they are kept; else they are made
};

/// Where a template vertex was found on a fragment.
struct VertexMatch {
    int fragment = -1;      ///< none: not observed
    Index face = no_index;  ///< of the fragment
    Eigen::Vector3d place = Eigen::Vector3d::Zero();
    double distance = 0;  ///< from the deformed vertex
};

struct NonRigidFit {
    std::vector<Point> points;         ///< of the template's vertices
    std::vector<VertexMatch> matches;  ///< of each vertex after the last level
    struct Level {
        std::size_t vertices = 0;  ///< of the mesh that it was solved on
        double smoothing = 0;      ///< length, in the mesh's unit
        std::size_t matched = 0;
        double residual = 0;  ///< root mean square of the matches' distances after it
        int steps = 0;
    };
    std::vector<Level> levels;
    double seconds_matching = 0, seconds_solving = 0, seconds_coarsening = 0;
};

/// Fits of one template. What depends on the template alone is made once, when first needed, and used again: the simplified
/// template, areas and cotangent weights, the linear systems with the order of their unknowns and their symbolic factorisation.
/// A fit is the same to the bit whatever was fitted before it.
class TemplateFitter {
public:
    /// All outlive it and do not change; fits in the space of the cage need one. Throws Error (input) for a mesh without faces,
    /// (usage) for coordinates with a normal term or of another mesh or cage.
    TemplateFitter(const Mesh& mesh, const AnnotationSet& set, const TemplateCage* cage = nullptr);
    ~TemplateFitter();
    TemplateFitter(TemplateFitter&&) noexcept;

    /// As `fit_template` for the template `scale` times as large. Through the cage, x = W c, the same sum is minimised over the
    /// cage's vertices c; after the last level point-to-plane steps follow, which hold what was not matched where the levels have
    /// left it. Throws Error (usage) for cage space without a cage.
    NonRigidFit fit(double scale, const std::vector<PlacedFragment>& fragments, const NonRigidOptions& options = {});

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Minimises, level by level,  sum over vertices of A_i (w_i |x_i - q_i|^2 + (s/t)^4 |x_i - p_i|^2 + s^4 |Delta x_i - R_i Delta
/// r_i|^2): the three costs of equation 5.2 (match, stay, Laplacian displacement of the template r) with areas A_i, so that the
/// result does not depend on the resolution. s is the smoothing length of the level; R_i follows the rotation of each vertex's
/// surroundings. In the first level p is the template and t the length of transition; later p is what the level before left and t
/// = `fade` s, so that what a level adds, and with it the noise of a fragment's edge, ends near what was observed. Matches are
/// the closest points of the fragments' outer facets with a like normal, within the same matched annotations on either side (the
/// smallest one that holds the vertex), never at a border. With `sliding` a vertex is drawn to the plane of its match, not to the
/// place, where two annotations meet to the curve where their counterparts meet, and Laplacian displacements grow with what
/// was observed around them; of a fragment whose faces are the template's (a copy in another shape) each vertex goes to its own.
/// Levels that are smooth against a mesh of 4000 vertices are solved on such a one (quadric error simplification); the template
/// follows it, and takes up the rest. `scaled` is the template at the scale of the placement.
NonRigidFit fit_template(const Mesh& scaled, const AnnotationSet& set, const std::vector<PlacedFragment>& fragments,
                         const NonRigidOptions& options = {});

}  // namespace ostraka

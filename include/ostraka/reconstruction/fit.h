// Deforms a template to the fragments registered to the template (thesis, equation 5.2, as an optimal-step non-rigid
// registration).
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
    /// Unknowns: the vertices of the template, the vertices of its cage, or both in turn: first the cage, in the last levels the
    /// template.
    Space space = Space::mesh;
    double start = 0.3;  ///< smoothing length of the first level, as a share of the template's diagonal
    double end = 0.01;   ///< smoothing length of the last level, as a share of the template's diagonal
    int levels = 6;      ///< number of levels from `start` to `end`
    int steps = 3;       ///< max iterations of matching and solving per level
    /// Length over which the deformation of the first level fades where nothing is observed, as a share of the diagonal.
    double stay = 0.5;
    double fade = 3;  ///< length over which the deformation of a later level fades, in multiples of the level's smoothing length
    double search_radius = 0.1;        ///< max distance of a match in the first level, as a share of the template's diagonal
    double last_search_radius = 0.02;  ///< max distance of a match in the last level, as a share of the template's diagonal
    double angle = 60;                 ///< max angle between the normals of a match, degrees
    enum class Counterparts { sliding, surface, best, one_to_one };
    /// Targets of vertices: surface points along which vertices may slide, closest points, or in matched annotations the vertices
    /// of equation 5.1.
    Counterparts counterparts = Counterparts::sliding;
    VertexAssignmentOptions vertices;  ///< weights of equation 5.1; search radius and angle are taken from the level
    double correspondences = 1;        ///< weight of outlines and landmarks of matched annotations
    bool outlines = true;              ///< match lines and outlines by the position along the curve

    void list_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// A fragment registered to the template, with matches of its annotations.
struct PlacedFragment {
    Mesh mesh;                                   ///< in the template's frame
    const AnnotationSet* annotations = nullptr;  ///< must outlive this object
    std::vector<Facet> facets;                   ///< facet of each face of the fragment
    std::vector<AnnotationMatch> matches;        ///< matches of the fragment's annotations with the template's
    Motion pose{};                               ///< maps the coordinates of the search trees to `mesh`
    std::shared_ptr<FragmentTrees> trees{};      ///< search trees in the fragment's original frame; null: the fit builds them
};

/// The match of a template vertex on a fragment.
struct VertexMatch {
    int fragment = -1;                                ///< index of the fragment; -1: the vertex is not observed
    Index face = no_index;                            ///< face of the fragment
    Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< matched point on the fragment
    double distance = 0;                              ///< distance of the matched point from the deformed vertex
};

/// Result of a non-rigid fit.
struct NonRigidFit {
    std::vector<Point> points;         ///< positions of the template's vertices
    std::vector<VertexMatch> matches;  ///< for each vertex of the template, its match after the last level
    struct Level {
        std::size_t vertices = 0;  ///< number of vertices of the mesh on which the level was solved
        double smoothing = 0;      ///< smoothing length, in the unit of the mesh
        std::size_t matched = 0;   ///< number of matched vertices
        double residual = 0;       ///< root mean square distance of the matches after the level
        int steps = 0;             ///< number of iterations of matching and solving
    };
    std::vector<Level> levels;  ///< one record per level
    /// Computing times in seconds.
    double seconds_matching = 0, seconds_solving = 0, seconds_coarsening = 0;
};

/// Fits of one template. All data that depend on the template alone are computed once, on demand, and reused: the simplified
/// template, areas and cotangent weights, the linear systems with their fill-reducing order and symbolic factorisation. Results
/// do not depend on earlier fits, to the bit.
class TemplateFitter {
public:
    /// All arguments must outlive the fitter unchanged; fits in cage space need a cage. Throws Error (input) for a mesh without
    /// faces, (usage) for coordinates with a normal term or coordinates of another mesh or cage.
    TemplateFitter(AnnotatedMeshView template_object, const TemplateCage* cage = nullptr);
    ~TemplateFitter();
    TemplateFitter(TemplateFitter&&) noexcept;

    /// Fits the template scaled by `scale`, as `fit_template` does. In cage space, x = W c, the sum of costs is minimised over
    /// the positions c of the cage's vertices; point-to-plane steps follow the last level, in which unmatched vertices are held
    /// at their positions after the levels. Throws Error (usage) for cage space without a cage.
    NonRigidFit fit(double scale, const std::vector<PlacedFragment>& fragments, const NonRigidOptions& options = {});

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Fits the template level by level. Each level minimises  sum over vertices of A_i (w_i |x_i - q_i|^2 + (s/t)^4 |x_i - p_i|^2 +
/// s^4 |Delta x_i - R_i Delta r_i|^2): the three costs of equation 5.2 (match, stay, Laplacian displacement of the template r)
/// with areas A_i, so that the result does not depend on the resolution. s is the smoothing length of the level; R_i is the
/// rotation of the neighbourhood of vertex i. In the first level p is the template and t the transition length; later p is the
/// result of the previous level and t = `fade` s, so that the change of a level, including the noise at a fragment's edge, ends
/// near the observed surface. The match of a vertex is the closest point with a compatible normal on the fragments' outer facets,
/// never at a border, within the counterpart of the smallest matched annotation that contains the vertex. With `sliding` a vertex
/// is attracted to the plane of its match, not to the point; where two annotations meet, to the curve where their counterparts
/// meet; and Laplacian displacements scale with the observed change of size around the vertex. If a fragment has the template's
/// own faces (a copy in another shape), each vertex is matched to the same vertex of the fragment. Levels that are smooth
/// relative to a mesh of 4000 vertices are solved on such a mesh (quadric error simplification); the template follows that mesh
/// and takes up the remaining deformation. `scaled`: the template at the scale of the placement.
NonRigidFit fit_template(AnnotatedMeshView scaled, const std::vector<PlacedFragment>& fragments,
                         const NonRigidOptions& options = {});

}  // namespace ostraka

// Deforms a template so that it matches fragments already registered to it (thesis, equation 5.2, solved as an optimal-step
// non-rigid registration).
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
    /// Unknowns of the fit: the vertices of the template (mesh), the vertices of its cage (cage), or first the vertices of the
    /// cage and in the last levels those of the template (both).
    Space space = Space::mesh;
    double start = 0.3;  ///< smoothing length of the first level, as a share of the template's diagonal
    double end = 0.01;   ///< smoothing length of the last level, as a share of the template's diagonal
    int levels = 6;      ///< number of levels from `start` to `end`
    int steps = 3;       ///< max iterations of matching and solving per level
    /// In the first level, the deformation decreases with this length into the unobserved part; a share of the template's
    /// diagonal.
    double first_decay_length = 0.5;
    /// In later levels, the deformation decreases with this length into the unobserved part; in multiples of the level's
    /// smoothing length.
    double later_decay_lengths = 3;
    double search_radius = 0.1;        ///< max distance of a match in the first level, as a share of the template's diagonal
    double last_search_radius = 0.02;  ///< max distance of a match in the last level, as a share of the template's diagonal
    double angle = 60;                 ///< max angle between the normals of a match, degrees
    enum class Counterparts { sliding, surface, best, one_to_one };
    /// Targets of template vertices: sliding: the tangent plane of the closest point; surface: the closest point; best,
    /// one_to_one: in matched annotations, the fragment vertices assigned by equation 5.1.
    Counterparts counterparts = Counterparts::sliding;
    VertexAssignmentOptions vertices;  ///< weights of equation 5.1; search radius and angle are taken from the level
    double correspondences = 1;        ///< weight of outlines and landmarks of matched annotations
    bool outlines = true;  ///< true: lines and outlines of matched annotations are matched by the position along the curve

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// A fragment registered to the template, with matches of its annotations.
struct PlacedFragment {
    Mesh mesh;                                   ///< the fragment's mesh in the coordinates of the template
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

/// Fits one template several times. Data that depend only on the template are computed once, on demand, and reused: the
/// simplified template, areas and cotangent weights, and the linear systems with their fill-reducing order and symbolic
/// factorisation. The results are bitwise independent of earlier fits.
class TemplateFitter {
public:
    /// All arguments must outlive the fitter unchanged; fits in cage space need a cage. Throws Error (input) for a mesh without
    /// faces, (usage) for coordinates with a normal term or coordinates of another mesh or cage.
    TemplateFitter(AnnotatedMeshView template_object, const TemplateCage* cage = nullptr);
    ~TemplateFitter();
    TemplateFitter(TemplateFitter&&) noexcept;

    /// Fits the template scaled by `scale`, as `fit_template` does. In cage space, the positions of the template's vertices are
    /// x = W c, and the sum of costs is minimised over the positions c of the cage's vertices. After the last level come
    /// point-to-plane steps, which hold unmatched vertices at their positions. Throws Error (usage) for cage space without a
    /// cage.
    NonRigidFit fit(double scale, const std::vector<PlacedFragment>& fragments, const NonRigidOptions& options = {});

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Fits the template level by level. Each level minimises the sum over vertices of A_i (w_i |x_i - q_i|^2 + (s/t)^4 |x_i -
/// p_i|^2 + s^4 |Delta x_i - R_i Delta r_i|^2). The terms are the three costs of equation 5.2: distance from the match q_i,
/// distance from the previous position p_i, and change of the Laplacian of the template r. The areas A_i make the result
/// independent of the resolution. s is the smoothing length of the level; R_i is the rotation of the neighbourhood of vertex i.
/// In the first level p is the template and t is `first_decay_length` (as a length). In later levels p is the result of the
/// previous level and t = `later_decay_lengths` s, so that the change made by a level, including the noise at a fragment's
/// border, is confined to the neighbourhood of the observed surface. The match of a vertex is the closest point with a compatible
/// normal on the fragments' outer facets, never at a border, within the counterpart of the smallest matched annotation that
/// contains the vertex. With `sliding` a vertex is attracted to the tangent plane of its match instead of the point; on the
/// common border of two annotations it is attracted to the common border of their counterparts. The Laplacians are scaled with
/// the observed change of size around the vertex. If a fragment has the same faces as the template (a deformed copy), each vertex
/// is matched to the same vertex of the fragment. Levels whose smoothing length is large compared to the edges of a mesh of 4000
/// vertices are solved on such a simplified mesh (quadric error simplification); its deformation is then transferred to the
/// template, which takes up the remaining deformation. `scaled`: the template, scaled to the common scale of the placement.
NonRigidFit fit_template(AnnotatedMeshView scaled, const std::vector<PlacedFragment>& fragments,
                         const NonRigidOptions& options = {});

}  // namespace ostraka

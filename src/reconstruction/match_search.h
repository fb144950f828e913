// Matches the template's vertices with points on the fragments.
#pragma once

#include "reconstruction/fragment_trees.h"
#include "reconstruction/joint_curves.h"

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/reconstruction/fit.h"
#include "ostraka/reconstruction/vertex_assignment.h"
#include "ostraka/solver/constraint.h"

#include <map>
#include <memory>
#include <vector>

namespace ostraka {

/// Target position of a template vertex from annotations: a landmark, or a point of an outline.
struct CorrespondenceConstraint {
    Index vertex = no_index;  ///< index of the template's vertex
    Eigen::Vector3d place;    ///< target position
    double length = 0;        ///< length of the outline that the vertex represents; 0 for a landmark
    int fragment = 0;         ///< index of the fragment
    bool outline = false;     ///< true: the target is a point of the outline of a region
};

/// A sample of a fragment's outer surface; all samples represent the same area.
struct FragmentSample {
    Eigen::Vector3d place, normal;  ///< position and unit normal
    int label = -1;  ///< label of the template's faces among which the counterpart of the sample lies; -1: no annotation
};

/// Directions in which a vertex may slide from its match at `place`: a position x is allowed if x - place is in the image of
/// `free`.
struct Slide {
    Eigen::Matrix3d free = Eigen::Matrix3d::Zero();
    bool on_curve = false;  ///< true: the match is on a curve where two annotations meet
};

/// Finds matches within corresponding annotations: vertices in a matched annotation on the faces of its counterpart, all other
/// vertices on faces outside matched annotations.
class MatchSearch {
public:
    /// The unit of the template, whose unit is `scale` times the unit of the placed fragments; all positions and lengths in calls
    /// and results are in the template's unit. The search trees that fragments bring along are in the fragments' own coordinates.
    /// `Guides`: correspondences from landmarks alone, or also from points along matched lines and outlines.
    enum class Guides { landmarks, paths };
    MatchSearch(AnnotatedMeshView template_object, const std::vector<PlacedFragment>& fragments, double scale = 1,
                Guides guides = Guides::landmarks);
    ~MatchSearch();
    MatchSearch(const MatchSearch&) = delete;
    MatchSearch& operator=(const MatchSearch&) = delete;

    /// Labels that restrict matches: label of each face, and labels of the faces around each vertex.
    struct Labels {
        std::vector<int> of_face;                 ///< label of each face
        std::vector<std::vector<int>> of_vertex;  ///< for each vertex, the labels of its adjacent faces
        /// For each vertex, its position on a fragment that has the template's own faces; fragment -1: no such fragment.
        std::vector<VertexMatch> shared;
    };
    /// Labels of a mesh derived from the template. `face_origin`: for each face of `mesh`, its face of the template;
    /// `vertex_map`: for each vertex of the template, its vertex of `mesh` (both empty: `mesh` is the template).
    [[nodiscard]] Labels labels(const Mesh& mesh, const std::vector<Index>& face_origin,
                                const std::vector<Index>& vertex_map = {}) const;
    /// Enables the detection of fragments that have the template's own faces: their vertices are identified with the template's
    /// vertices, and their landmarks, which would count twice, are not used as correspondences.
    void recognise_shared_faces();
    /// For each vertex at its position in `current`, the nearest match on all fragments; fragment -1 if no point within
    /// `search_radius` has a compatible normal and is not at a border.
    [[nodiscard]] std::vector<VertexMatch> matches(const Points& current, const Mesh& connectivity, const Labels& labels,
                                                   double search_radius, double min_cosine) const;
    /// Matches as `matches` returns them, and in `slides` for each vertex the directions in which it may slide from its match:
    /// along the surface; for vertices where two labels meet on the template, along the curve where the labels meet on the
    /// fragment; no direction on a fragment that has the template's own faces.
    [[nodiscard]] std::vector<VertexMatch> sliding_matches(const Points& current, const Mesh& connectivity, const Labels& labels,
                                                           double search_radius, double min_cosine,
                                                           std::vector<Slide>& slides) const;
    /// Replaces the matches of vertices in matched annotations by the counterparts of equation 5.1, with these options; removes
    /// the match if the counterpart is at the end of the fragment.
    void assign(const Points& current, const Mesh& connectivity, const Labels& labels, const VertexAssignmentOptions& options,
                std::vector<VertexMatch>& matches) const;
    /// Unit normal of the fragment's face at the match.
    [[nodiscard]] Eigen::Vector3d normal(const VertexMatch& match) const;
    /// Samples of all fragments together, about `count`.
    [[nodiscard]] std::vector<FragmentSample> samples(int count) const;
    /// Target positions from landmarks of matched point annotations, followed by points along matched outlines and lines.
    [[nodiscard]] std::vector<CorrespondenceConstraint> correspondences() const { return correspondences_; }

private:
    /// The faces of one fragment that have one label.
    struct Part {
        int fragment = 0;  ///< index of the fragment
        const FragmentPart* part = nullptr;
    };
    /// From a label (id of the template's annotation, -1 for none) to the faces of the fragments.
    std::map<int, std::vector<Part>> parts_;
    std::vector<std::shared_ptr<FragmentTrees>> trees_;  ///< trees of each fragment
    /// For each fragment: motion from the coordinates of its trees to the template, and back.
    std::vector<Motion> to_template_, to_fragment_;
    /// Ratio of the template's unit to the fragments' unit.
    double scale_;
    /// A region of a fragment and the label of its counterpart.
    struct Counterpart {
        int fragment = 0, label = 0;  ///< index of the fragment; label of the template's annotation
        Annotation region;            ///< faces of the fragment with the label
    };
    /// Adds points along matched outlines and lines to the correspondences.
    void add_path_correspondences(const AnnotationSet& set);
    /// For each vertex, its position on a fragment with the template's own faces.
    [[nodiscard]] std::vector<VertexMatch> shared_matches(const Mesh& mesh, const std::vector<Index>& vertex_map) const;

    const Mesh& template_;
    const std::vector<PlacedFragment>& fragments_;
    /// For each fragment, the template's vertex of each of its vertices; empty if the faces are not shared.
    std::vector<std::vector<Index>> shared_;
    JointCurves joints_;                     ///< curves where annotations meet
    std::vector<Counterpart> counterparts_;  ///< regions of fragments with a counterpart
    /// Vertices of the template and of the fragment, in the order of `correspondences_`.
    std::vector<std::pair<Index, Index>> landmarks_;
    std::vector<int> landmark_fragment_;  ///< for each landmark, the index of its fragment
    std::vector<int> face_labels_;        ///< label of each face of the template
    std::vector<CorrespondenceConstraint> correspondences_;
};

}  // namespace ostraka

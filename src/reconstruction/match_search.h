// Matches of the template's vertices on the fragments.
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

/// Positional constraint on a template vertex from annotations: a landmark, or a point of an outline.
struct CorrespondenceConstraint {
    Index vertex = no_index;
    Eigen::Vector3d place;
    double length = 0;  ///< length of the outline that it represents; 0 for a landmark
    int fragment = 0;
    bool outline = false;  ///< a place along the outline of a region
};

/// A sample of a fragment's outer surface, each representing the same area.
struct FragmentSample {
    Eigen::Vector3d place, normal;
    int label = -1;  ///< label of the template's faces that contain its counterpart
};

/// Directions in which a vertex may slide from its match: x is allowed if x - place is in the image of `free`.
struct Slide {
    Eigen::Matrix3d free = Eigen::Matrix3d::Zero();
    bool on_curve = false;
};

/// Matches within corresponding annotations: vertices in a matched annotation to the faces of its counterpart, all others to
/// faces in none.
class MatchSearch {
public:
    /// The unit of the template is `scale` times that of the placed fragments: all that is queried and returned is in
    /// the template's. Trees are those of the fragments, in their own coordinates, where they bring them along. What
    /// correspondences there are: of landmarks alone, or of places along matched lines and outlines, too.
    enum class Guides { landmarks, paths };
    MatchSearch(AnnotatedMeshView template_object, const std::vector<PlacedFragment>& fragments, double scale = 1,
                Guides guides = Guides::landmarks);
    ~MatchSearch();
    MatchSearch(const MatchSearch&) = delete;
    MatchSearch& operator=(const MatchSearch&) = delete;

    /// Labels of the faces, and of each vertex by its adjacent faces, among which matches are searched.
    struct Labels {
        std::vector<int> of_face;
        std::vector<std::vector<int>> of_vertex;
        /// Position of a vertex on a fragment whose faces are the template's; fragment -1: on none.
        std::vector<VertexMatch> shared;
    };
    /// Labels of a mesh derived from the template: its faces come from the template's faces `face_origin`, and `vertex_map`
    /// maps the template's vertices to its vertices (both empty: the template itself).
    [[nodiscard]] Labels labels(const Mesh& mesh, const std::vector<Index>& face_origin,
                                const std::vector<Index>& vertex_map = {}) const;
    /// Enables the detection of fragments whose faces are the template's: their vertices are identified with the template's,
    /// and their landmarks, which would count twice, are no correspondences.
    void recognise_shared_faces();
    /// The nearest match on all fragments for each vertex at `current`; fragment -1 if there is none within `search_radius` with
    /// a compatible normal that is not at a border.
    [[nodiscard]] std::vector<VertexMatch> matches(const Points& current, const Mesh& connectivity, const Labels& labels,
                                                   double search_radius, double min_cosine) const;
    /// As `matches`, with a projection per vertex onto the directions in which it may slide from there: those of the surface;
    /// for vertices where two labels meet on the template, those of the curve where they meet; none at the vertices of a
    /// fragment whose faces are the template's.
    [[nodiscard]] std::vector<VertexMatch> sliding_matches(const Points& current, const Mesh& connectivity, const Labels& labels,
                                                           double search_radius, double min_cosine,
                                                           std::vector<Slide>& slides) const;
    /// Replaces the matches of vertices in matched annotations by the counterparts of equation 5.1, as set in the options; none
    /// if the counterpart is at the end of the fragment.
    void assign(const Points& current, const Mesh& connectivity, const Labels& labels, const VertexAssignmentOptions& options,
                std::vector<VertexMatch>& matches) const;
    /// Unit normal of the matched face of the fragment.
    [[nodiscard]] Eigen::Vector3d normal(const VertexMatch& match) const;
    /// About this number of samples on all fragments together.
    [[nodiscard]] std::vector<FragmentSample> samples(int count) const;
    /// Landmarks of matched point annotations, then points along outlines and lines.
    [[nodiscard]] std::vector<CorrespondenceConstraint> correspondences() const { return correspondences_; }

private:
    /// The faces of one fragment with one label.
    struct Part {
        int fragment = 0;
        const FragmentPart* part = nullptr;
    };
    std::map<int, std::vector<Part>> parts_;             ///< by label: the id of the template's annotation, -1 for none
    std::vector<std::shared_ptr<FragmentTrees>> trees_;  ///< per fragment
    std::vector<Motion> to_template_, to_fragment_;      ///< per fragment: from the coordinates of its trees, and back
    double scale_;
    /// A region of a fragment and its counterpart's label.
    struct Counterpart {
        int fragment = 0, label = 0;
        Annotation region;  ///< its faces with the label
    };
    void add_path_correspondences(const AnnotationSet& set);
    [[nodiscard]] std::vector<VertexMatch> shared_matches(const Mesh& mesh, const std::vector<Index>& vertex_map) const;

    const Mesh& template_;
    const std::vector<PlacedFragment>& fragments_;
    std::vector<std::vector<Index>> shared_;  ///< per fragment and vertex, the template's vertex, if the faces are shared
    JointCurves joints_;
    std::vector<Counterpart> counterparts_;
    std::vector<std::pair<Index, Index>> landmarks_;  ///< vertices of the template and of the fragment, as correspondences_
    std::vector<int> landmark_fragment_;
    std::vector<int> face_labels_;  ///< of the template
    std::vector<CorrespondenceConstraint> correspondences_;
};

}  // namespace ostraka

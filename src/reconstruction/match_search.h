// Where on the fragments the template's vertices are.
#pragma once

#include "fragment_trees.h"
#include "joint_curves.h"

#include "ostraka/reconstruction/fit.h"
#include "ostraka/reconstruction/vertex_assignment.h"
#include "ostraka/solver/constraint.h"

#include <map>
#include <memory>
#include <vector>

namespace ostraka {

/// A template vertex with a place that annotations name: a landmark, or a place of an outline.
struct CorrespondenceConstraint {
    Index vertex = no_index;
    Eigen::Vector3d place;
    double length = 0;  ///< of the outline that it stands for; 0 for a landmark
    int fragment = 0;
    bool outline = false;  ///< a place along the outline of a region
};

/// A place of a fragment's outer surface, each for the same area.
struct FragmentSample {
    Eigen::Vector3d place, normal;
    int label = -1;  ///< of the template's faces among which its counterpart is
};

/// How a vertex may go on from its match: x may be anywhere with x - place in the image of `free`.
struct Slide {
    Eigen::Matrix3d free = Eigen::Matrix3d::Zero();
    bool on_curve = false;
};

/// Like is looked for among like: vertices in a matched annotation on the faces of its counterpart, all others on faces in none.
class MatchSearch {
public:
    /// `mesh` is the template, whose unit is `scale` times that of the placed fragments: all that is asked and answered is in the
    /// template's. Trees are those of the fragments, in their own coordinates, where they bring them along.
    /// What correspondences there are: of landmarks alone, or of places along matched lines and outlines, too.
    enum class Guides { landmarks, paths };
    MatchSearch(const Mesh& mesh, const AnnotationSet& set, const std::vector<PlacedFragment>& fragments, double scale = 1,
                Guides guides = Guides::landmarks);
    ~MatchSearch();
    MatchSearch(const MatchSearch&) = delete;
    MatchSearch& operator=(const MatchSearch&) = delete;

    /// What each face, and each vertex by the faces around it, is to be matched among.
    struct Labels {
        std::vector<int> of_face;
        std::vector<std::vector<int>> of_vertex;
        /// Where a vertex is on a fragment whose faces are the template's; fragment -1: on none.
        std::vector<VertexMatch> shared;
    };
    /// Of a mesh of the template whose faces come from `face_origin` of the template's, and into whose vertices those of the
    /// template went by `vertex_map` (both empty: it is the template).
    [[nodiscard]] Labels labels(const Mesh& mesh, const std::vector<Index>& face_origin,
                                const std::vector<Index>& vertex_map = {}) const;
    /// Fragments whose faces are the template's are recognised from here on: their vertices are its vertices, and their
    /// landmarks, which would count twice, are no correspondences.
    void recognise_shared_faces();
    /// The nearest of all fragments for each vertex at `now`; fragment -1 where there is none within `search_radius` whose normal
    /// agrees and that is not at a border.
    [[nodiscard]] std::vector<VertexMatch> matches(const Points& now, const Mesh& connectivity, const Labels& labels,
                                                   double search_radius, double min_cosine) const;
    /// As `matches`, and for each vertex a projection onto the directions in which it may slide from there: those of the surface;
    /// those of the curve where two labels meet, for vertices where they meet on the template; none at the vertices of a fragment
    /// whose faces are the template's.
    [[nodiscard]] std::vector<VertexMatch> sliding_matches(const Points& now, const Mesh& connectivity, const Labels& labels,
                                                           double search_radius, double min_cosine,
                                                           std::vector<Slide>& slides) const;
    /// Puts the counterparts of equation 5.1 in the place of those matches whose vertices are in a matched annotation, as the
    /// options say; none where the counterpart is where the fragment ends.
    void assign(const Points& now, const Mesh& connectivity, const Labels& labels, const VertexAssignmentOptions& options,
                std::vector<VertexMatch>& matches) const;
    /// Unit normal of the fragment's face that was matched.
    [[nodiscard]] Eigen::Vector3d normal(const VertexMatch& match) const;
    /// About this many places of all fragments together.
    [[nodiscard]] std::vector<FragmentSample> samples(int count) const;
    /// Landmarks of matched point annotations, then places along outlines and lines.
    [[nodiscard]] std::vector<CorrespondenceConstraint> correspondences() const { return correspondences_; }

private:
    /// The faces of one fragment that carry one label.
    struct Part {
        int fragment = 0;
        const FragmentPart* part = nullptr;
    };
    std::map<int, std::vector<Part>> parts_;             ///< by label: the id of the template's annotation, -1 for none
    std::vector<std::shared_ptr<FragmentTrees>> trees_;  ///< of each fragment
    std::vector<Motion> to_template_, to_fragment_;      ///< of each: from the coordinates of its trees, and back
    double scale_;
    /// A region of a fragment and its counterpart's label.
    struct Counterpart {
        int fragment = 0, label = 0;
        Annotation region;  ///< its faces that carry the label
    };
    void add_path_correspondences(const AnnotationSet& set);
    [[nodiscard]] std::vector<VertexMatch> shared_of(const Mesh& mesh, const std::vector<Index>& vertex_map) const;

    const Mesh& template_;
    const std::vector<PlacedFragment>& fragments_;
    std::vector<std::vector<Index>> shared_;  ///< of each fragment: of its vertices that of the template, where all its faces are
    JointCurves joints_;
    std::vector<Counterpart> counterparts_;
    std::vector<std::pair<Index, Index>> landmarks_;  ///< vertices of the template and of the fragment, as correspondences_
    std::vector<int> landmark_fragment_;
    std::vector<int> face_labels_;  ///< of the template
    std::vector<CorrespondenceConstraint> correspondences_;
};

}  // namespace ostraka

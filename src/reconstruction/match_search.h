// Where on the fragments the template's vertices are.
#pragma once

#include "fragment_trees.h"

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
};

/// A place of a fragment's outer surface, each for the same area.
struct FragmentSample {
    Eigen::Vector3d place, normal;
    int label = -1;  ///< of the template's faces among which its counterpart is
};

/// Like is looked for among like: vertices in a matched annotation on the faces of its counterpart, all others on faces in none.
class MatchSearch {
public:
    /// `mesh` is the template, whose unit is `scale` times that of the placed fragments: all that is asked and answered is in the
    /// template's. Trees are those of the fragments, in their own coordinates, where they bring them along.
    /// `outlines`: correspondences are not only landmarks, but also the places along matched outlines and lines.
    MatchSearch(const Mesh& mesh, const AnnotationSet& set, const std::vector<PlacedFragment>& fragments, double scale = 1,
                bool outlines = false);
    ~MatchSearch();
    MatchSearch(const MatchSearch&) = delete;
    MatchSearch& operator=(const MatchSearch&) = delete;

    /// What each face, and each vertex by the faces around it, is to be matched among.
    struct Labels {
        std::vector<int> of_face;
        std::vector<std::vector<int>> of_vertex;
    };
    /// Of a mesh of the template whose faces come from `face_origin` of the template's (empty: they are the template's).
    [[nodiscard]] Labels labels(const Mesh& mesh, const std::vector<Index>& face_origin) const;
    /// The nearest of all fragments for each vertex at `now`; fragment -1 where there is none within `search_radius` whose normal
    /// agrees and that is not at a border.
    [[nodiscard]] std::vector<VertexMatch> matches(const Points& now, const Mesh& connectivity, const Labels& labels,
                                                   double search_radius, double min_cosine) const;
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
    void add_outline_correspondences(const Mesh& mesh, const AnnotationSet& set);

    const std::vector<PlacedFragment>& fragments_;
    std::vector<Counterpart> counterparts_;
    std::vector<std::pair<Index, Index>> landmarks_;  ///< vertices of the template and of the fragment, as correspondences_
    std::vector<int> landmark_fragment_;
    std::vector<int> face_labels_;  ///< of the template
    std::vector<CorrespondenceConstraint> correspondences_;
};

}  // namespace ostraka

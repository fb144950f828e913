// Where on the fragments the template's vertices are.
#pragma once

#include "ostraka/fitting/fit.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/solver/constraint.h"

#include <map>
#include <memory>
#include <vector>

namespace ostraka {

/// A template vertex with a place that annotations name: a landmark, or a place of an outline.
struct Guide {
    Index vertex = no_index;
    Eigen::Vector3d place;
    double length = 0;  ///< of the outline that it stands for; 0 for a landmark
};

/// Like is looked for among like: vertices in a matched annotation on the faces of its counterpart, all others on faces in none.
class MatchSearch {
public:
    MatchSearch(const Mesh& scaled, const AnnotationSet& set, const std::vector<PlacedFragment>& fragments);
    ~MatchSearch();
    MatchSearch(const MatchSearch&) = delete;
    MatchSearch& operator=(const MatchSearch&) = delete;

    /// For each vertex what it is to be matched among: the labels of the faces around it.
    using Labels = std::vector<std::vector<int>>;
    /// Of a mesh of the template whose faces come from `face_origin` of the template's (empty: they are the template's).
    [[nodiscard]] Labels labels(const Mesh& mesh, const std::vector<Index>& face_origin) const;
    /// The nearest of all fragments for each vertex at `now`; fragment -1 where there is none within `reach` whose normal agrees
    /// and that is not at a border.
    [[nodiscard]] std::vector<VertexMatch> matches(const Points& now, const Mesh& connectivity, const Labels& labels,
                                                   double reach, double min_cosine) const;
    /// Landmarks of matched point annotations.
    [[nodiscard]] std::vector<Guide> guides() const { return guides_; }

private:
    /// The faces of one fragment that carry one label.
    struct Part {
        int fragment = 0;
        std::vector<Index> faces;  ///< of the fragment, for each of the part
        Mesh mesh;
        std::unique_ptr<SurfaceSearch> search;
        std::vector<bool> edge_breaks, vertex_breaks;  ///< of the part's edges and vertices: where the outer surface ends
    };
    std::map<int, std::vector<std::unique_ptr<Part>>> parts_;  ///< by label: the id of the template's annotation, -1 for none
    std::vector<int> face_labels_;                             ///< of the template
    std::vector<Guide> guides_;
};

}  // namespace ostraka

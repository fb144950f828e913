// Search trees over the faces of a fragment, one tree for each face label, in the fragment's own coordinates.
#pragma once

#include "ostraka/fracture/fragment.h"
#include "ostraka/geom/surface_search.h"

#include <map>
#include <memory>
#include <vector>

namespace ostraka {

/// The faces of a fragment that have one label, without fractures.
struct FragmentPart {
    std::vector<Index> faces;                  ///< for each face of `mesh`, its face of the fragment
    Mesh mesh;                                 ///< mesh of the part
    std::unique_ptr<SurfaceSearch> search;     ///< search tree over `mesh`
    std::vector<bool> edge_ends, vertex_ends;  ///< for each edge and each vertex of `mesh`: whether the outer surface ends there
};

/// Search trees of one fragment, kept while its face labels are unchanged.
class FragmentTrees {
public:
    using Parts = std::map<int, FragmentPart>;  ///< from a label to the faces with the label

    /// `mesh` and `facets` (facet of each face; empty: all outer) must outlive the trees unchanged.
    FragmentTrees(const Mesh& mesh, const std::vector<Facet>& facets) : mesh_(mesh), facets_(facets) {}

    [[nodiscard]] const Mesh& mesh() const { return mesh_; }
    /// For each vertex of the fragment, whether the outer surface ends there.
    [[nodiscard]] const std::vector<bool>& end_vertices();
    /// Search trees for these face labels of the fragment, without fracture faces; valid until queried with other labels.
    [[nodiscard]] const Parts& parts(const std::vector<int>& labels);

private:
    /// Whether the face is not part of a fracture.
    [[nodiscard]] bool outer(Face face) const { return facets_.empty() || facets_[face] != Facet::fracture; }

    const Mesh& mesh_;
    const std::vector<Facet>& facets_;
    std::vector<int> labels_;  ///< label of each face for which `parts_` was built
    Parts parts_;
    std::vector<bool> end_vertices_;  ///< for each vertex, whether the outer surface ends there
};

}  // namespace ostraka

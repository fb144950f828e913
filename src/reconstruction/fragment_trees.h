// Search trees over the faces of a fragment, one per label, in the fragment's own coordinates.
#pragma once

#include "ostraka/fracture/fragment.h"
#include "ostraka/geom/surface_search.h"

#include <map>
#include <memory>
#include <vector>

namespace ostraka {

/// The faces of a fragment with one label, without fractures.
struct FragmentPart {
    std::vector<Index> faces;  ///< per face of the part, its face of the fragment
    Mesh mesh;
    std::unique_ptr<SurfaceSearch> search;
    std::vector<bool> edge_ends, vertex_ends;  ///< per edge and vertex of the part: where the outer surface ends
};

/// Trees of one fragment, kept while its labels are unchanged.
class FragmentTrees {
public:
    using Parts = std::map<int, FragmentPart>;  ///< by label

    /// `mesh` and `facets` (per face; empty: all outer) must outlive it unchanged.
    FragmentTrees(const Mesh& mesh, const std::vector<Facet>& facets) : mesh_(mesh), facets_(facets) {}

    [[nodiscard]] const Mesh& mesh() const { return mesh_; }
    /// Per vertex, whether the outer surface ends there.
    [[nodiscard]] const std::vector<bool>& end_vertices();
    /// One part per label of the faces that are not fracture; valid until queried with other labels.
    [[nodiscard]] const Parts& parts(const std::vector<int>& labels);

private:
    [[nodiscard]] bool outer(Face face) const { return facets_.empty() || facets_[face] != Facet::fracture; }

    const Mesh& mesh_;
    const std::vector<Facet>& facets_;
    std::vector<int> labels_;
    Parts parts_;
    std::vector<bool> end_vertices_;
};

}  // namespace ostraka

// Search trees over the faces of a fragment, by what they are to be matched with, in the fragment's own coordinates.
#pragma once

#include "ostraka/fracture/fragment.h"
#include "ostraka/geom/surface_search.h"

#include <map>
#include <memory>
#include <vector>

namespace ostraka {

/// The faces of a fragment that carry one label, but for its breaks.
struct FragmentPart {
    std::vector<Index> faces;  ///< of the fragment, for each of the part
    Mesh mesh;
    std::unique_ptr<SurfaceSearch> search;
    std::vector<bool> edge_breaks, vertex_breaks;  ///< of the part's edges and vertices: where the outer surface ends
};

/// Trees of one fragment, kept for as long as its labels are the same.
class FragmentTrees {
public:
    using Parts = std::map<int, FragmentPart>;  ///< by label

    /// `mesh` and `facets` (of each face; empty: all outer) outlive it and do not change.
    FragmentTrees(const Mesh& mesh, const std::vector<Facet>& facets) : mesh_(mesh), facets_(facets) {}

    [[nodiscard]] const Mesh& mesh() const { return mesh_; }
    /// Of vertices: where the outer surface ends.
    [[nodiscard]] const std::vector<bool>& breaks();
    /// One part a label that any face has which is no fracture; valid until asked for with other labels.
    [[nodiscard]] const Parts& parts(const std::vector<int>& labels);

private:
    [[nodiscard]] bool outer(Face face) const { return facets_.empty() || facets_[face] != Facet::fracture; }

    const Mesh& mesh_;
    const std::vector<Facet>& facets_;
    std::vector<int> labels_;
    Parts parts_;
    std::vector<bool> breaks_;
};

}  // namespace ostraka

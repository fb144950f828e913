// A patch of one surface put in the place of what it covers of another.
#pragma once

#include "ostraka/geom/submesh.h"
#include "ostraka/geom/surface_search.h"

#include <optional>
#include <string>
#include <vector>

namespace ostraka {

/// Faces of a mesh whose borders are simple loops.
class Patch {
public:
    /// Of the faces marked, pieces with at least the share `least` of the mesh's area. The mesh outlives it.
    Patch(const Mesh& mesh, std::vector<bool> keep, double least);

    [[nodiscard]] const Mesh& mesh() const { return mesh_; }
    [[nodiscard]] bool has(Index face) const { return keep_[face]; }
    [[nodiscard]] std::size_t size() const;  ///< faces
    /// Border loops as vertices, with the patch to the left.
    [[nodiscard]] const std::vector<std::vector<Vertex>>& loops() const { return loops_; }
    /// A face of each piece that has no border.
    [[nodiscard]] const std::vector<Face>& closed() const { return closed_; }
    /// Takes away all faces at these vertices, and so on for as many rings.
    void erode(std::vector<Vertex> vertices, int rings);

private:
    /// `stack`: vertices whose faces may be in several fans.
    void regularise(std::vector<Vertex> stack);

    const Mesh& mesh_;
    std::vector<bool> keep_;
    double least_;
    std::vector<std::vector<Vertex>> loops_;
    std::vector<Face> closed_;
};

struct Joint {
    Mesh mesh;
    std::vector<Index> old_face;    ///< of the surface, which each face is or is cut from; no_index: the patch's
    std::vector<Index> patch_face;  ///< the same of the patch
    std::size_t patch_faces = 0;    ///< of the patch that are left
    std::string problem;            ///< why there is none
};

/// The surface with the patch in place of what it covers. `places` of the patch's vertices on the surface; vertices of the
/// surface within `width` of the seam follow it but for those `frozen`. Erodes the patch where its border is not simple, and
/// where faces near the seam cross; where that does not end, the joint with the fewest crossings is taken.
Joint join_patch(const Mesh& surface, Patch patch, const std::vector<std::optional<SurfaceHit>>& places, double width,
                 const std::vector<bool>& frozen);

}  // namespace ostraka

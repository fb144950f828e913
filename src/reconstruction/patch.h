// Part of a surface bounded by simple loops.
#pragma once

#include "ostraka/mesh/mesh.h"

#include <vector>

namespace ostraka {

/// A set of faces of a mesh whose borders are simple loops.
class Patch {
public:
    /// Keeps those connected pieces of the faces marked in `keep` that have at least the share `minimum` of the mesh's area. The
    /// mesh must outlive the patch.
    Patch(const Mesh& mesh, std::vector<bool> keep, double minimum);

    [[nodiscard]] const Mesh& mesh() const { return mesh_; }
    [[nodiscard]] bool has(Index face) const { return keep_[face]; }  ///< whether the face is in the patch
    [[nodiscard]] std::size_t size() const;                           ///< number of faces
    /// Border loops as lists of vertices, with the patch to the left.
    [[nodiscard]] const std::vector<std::vector<Vertex>>& loops() const { return loops_; }
    /// One face of each connected piece without a border.
    [[nodiscard]] const std::vector<Face>& closed() const { return closed_; }
    /// Removes all faces at these vertices and, `rings` - 1 times, all faces at the corners of removed faces; keeps borders
    /// simple.
    void erode(std::vector<Vertex> vertices, int rings);

private:
    /// Connected components of the kept faces.
    struct Pieces {
        std::vector<int> of_face;  ///< for each face, index of its piece; -1: not kept
        std::vector<double> area;  ///< area of each piece
    };
    /// Whether the face of the halfedge is in the patch.
    [[nodiscard]] bool keeps(Halfedge h) const;
    /// Whether the halfedge is on the border of the patch, with the patch to its left.
    [[nodiscard]] bool is_border(Halfedge h) const { return keeps(h) && !keeps(mesh_.opposite(h)); }
    /// Restores simple borders; `stack`: vertices at which the faces of the patch may form several fans.
    void regularise(std::vector<Vertex> stack);
    /// Removes the faces of vertices at which the faces of the patch form several fans, repeatedly, as a removal may create
    /// further such vertices.
    void open_fans(std::vector<Vertex> stack);
    Pieces drop_small_pieces();              ///< removes pieces below the min area; returns the remaining pieces
    void find_closed(const Pieces& pieces);  ///< sets closed_
    void find_loops();                       ///< sets loops_

    const Mesh& mesh_;
    std::vector<bool> keep_;  ///< for each face, whether it is in the patch
    double minimum_;          ///< min area of a piece, as a share of the mesh's area
    std::vector<std::vector<Vertex>> loops_;
    std::vector<Face> closed_;
};

}  // namespace ostraka

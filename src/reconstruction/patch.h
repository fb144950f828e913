// Part of a surface bounded by simple loops.
#pragma once

#include "ostraka/mesh/mesh.h"

#include <vector>

namespace ostraka {

/// Faces of a mesh whose borders are simple loops.
class Patch {
public:
    /// Keeps pieces of the marked faces with at least the share `minimum` of the mesh's area. The mesh must outlive it.
    Patch(const Mesh& mesh, std::vector<bool> keep, double minimum);

    [[nodiscard]] const Mesh& mesh() const { return mesh_; }
    [[nodiscard]] bool has(Index face) const { return keep_[face]; }
    [[nodiscard]] std::size_t size() const;  ///< number of faces
    /// Border loops as vertices, with the patch to the left.
    [[nodiscard]] const std::vector<std::vector<Vertex>>& loops() const { return loops_; }
    /// One face of each piece without a border.
    [[nodiscard]] const std::vector<Face>& closed() const { return closed_; }
    /// Removes all faces at these vertices, repeated for `rings` rings.
    void erode(std::vector<Vertex> vertices, int rings);

private:
    /// Connected components of the kept faces.
    struct Pieces {
        std::vector<int> of_face;  ///< -1: none
        std::vector<double> area;
    };
    [[nodiscard]] bool keeps(Halfedge h) const;
    [[nodiscard]] bool is_border(Halfedge h) const { return keeps(h) && !keeps(mesh_.opposite(h)); }
    /// `stack`: vertices whose faces may form several fans.
    void regularise(std::vector<Vertex> stack);
    /// Removes the faces of vertices at which the patch has several fans; this may create further such vertices.
    void open_fans(std::vector<Vertex> stack);
    Pieces drop_small_pieces();
    void find_closed(const Pieces& pieces);
    void find_loops();

    const Mesh& mesh_;
    std::vector<bool> keep_;
    double minimum_;
    std::vector<std::vector<Vertex>> loops_;
    std::vector<Face> closed_;
};

}  // namespace ostraka

// Texture coordinates of corners, carried through edge collapses.
#pragma once

#include "ostraka/io/mesh_file.h"

namespace ostraka {

/// Texture coordinates of the corner at the target of each halfedge, in its face; property map of a mesh during a change.
inline constexpr const char* halfedge_texture = "h:file-texture";

/// Attaches the texture coordinates (three per face; empty: none) to the halfedges of the mesh.
void attach_texture(Mesh& mesh, const std::vector<TexturePoint>& corner_texture);
/// Texture coordinates of the mesh's corners, in the order of MeshExtras::corner_texture, and removes the property map; empty if
/// there is none.
std::vector<TexturePoint> detach_texture(Mesh& mesh);

/// Updates the texture coordinates in a collapse. The corners of the remaining vertex get the coordinates of the nearest point of
/// the surface before the collapse, separately on each side of a seam.
class CornerTexture {
public:
    explicit CornerTexture(const Mesh& mesh) : texture_(mesh.property_map<Halfedge, TexturePoint>(halfedge_texture).first) {}
    /// As CollapseVisitor::place_vertex.
    void place_vertex(const Mesh& mesh, Halfedge h, const Point& position);
    /// As CollapseVisitor::replace_halfedge.
    void replace_halfedge(Halfedge kept, Halfedge replaced) { texture_[kept] = TexturePoint(texture_[replaced]); }

private:
    Mesh::Property_map<Halfedge, TexturePoint> texture_;
    std::vector<std::pair<Halfedge, TexturePoint>> changes_;
};

}  // namespace ostraka

// Texture coordinates that meshes have, and their texel sizes.
#include "ostraka/core/error.h"
#include "ostraka/texture/atlas.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

/// Area of a face in texture coordinates.
double texture_area(const std::vector<TexturePoint>& corner_texture, std::size_t face) {
    const auto corner = [&](std::size_t k) {
        return Vector2d(static_cast<double>(corner_texture[3 * face + k][0]), static_cast<double>(corner_texture[3 * face + k][1]));
    };
    const Vector2d first = corner(1) - corner(0), second = corner(2) - corner(0);
    return std::abs(first.x() * second.y() - first.y() * second.x()) / 2;
}

/// Image of a face's base colour; null: none.
const Image* image_of_face(const MeshExtras& extras, std::size_t face) {
    const Index material = extras.face_materials.empty() ? no_index : extras.face_materials[face];
    if (material >= extras.appearance.materials.size()) return nullptr;
    const Index image = extras.appearance.materials[material].image;
    return image < extras.appearance.images.size() ? extras.appearance.images[image].get() : nullptr;
}

}  // namespace

TextureLayout layout_of(const MeshFile& file, const std::string& where) {
    const MeshExtras& extras = file.extras;
    TextureLayout layout;
    layout.corner_texture = extras.corner_texture;
    layout.images = extras.appearance.materials.size();
    if (!extras.corner_texture.empty()) {
        layout.face_image.assign(file.mesh.number_of_faces(), no_index);
        for (std::size_t face = 0; face < layout.face_image.size(); ++face) {
            const Image* image = image_of_face(extras, face);
            if (image == nullptr) continue;
            layout.face_image[face] = extras.face_materials[face];
            layout.width = std::max(layout.width, image->width);
            layout.height = std::max(layout.height, image->height);
        }
    }
    if (layout.width == 0)
        fail_input(where, "has no texture coordinates with an image to bake into", "leave out the option, for a new atlas");
    return layout;
}

double texel_size(const MeshFile& file) {
    double surface = 0, texels = 0;
    for (const Face face : file.mesh.faces()) {
        const Image* image = file.extras.corner_texture.empty() ? nullptr : image_of_face(file.extras, face);
        if (image == nullptr) continue;
        surface += face_area(file.mesh, face);
        texels += texture_area(file.extras.corner_texture, face) * image->width * image->height;
    }
    if (surface > 0 && texels > 0) return std::sqrt(surface / texels);
    return mean_edge_length(file.mesh) / 2;
}

double texel_size(const Mesh& mesh, const TextureLayout& layout) {
    double surface = 0, texels = 0;
    for (const Face face : mesh.faces()) {
        if (layout.image_of(face) == no_index) continue;
        surface += face_area(mesh, face);
        texels += texture_area(layout.corner_texture, face) * layout.width * layout.height;
    }
    return surface > 0 && texels > 0 ? std::sqrt(surface / texels) : 0;
}

}  // namespace ostraka

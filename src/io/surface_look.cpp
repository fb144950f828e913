#include "ostraka/io/surface_look.h"

#include <algorithm>

namespace ostraka {

bool has_texture(const MeshExtras& extras) {
    const Appearance& appearance = extras.appearance;
    if (appearance.empty()) return false;
    std::vector<bool> is_seen;
    for (const Material& material : appearance.materials) {
        const bool has_image = !extras.corner_texture.empty() && material.image < appearance.images.size() &&
                               appearance.images[material.image] != nullptr;
        is_seen.push_back(has_image || material.base_colour != std::array<float, 4>{1, 1, 1, 1});
    }
    return std::any_of(extras.face_materials.begin(), extras.face_materials.end(),
                       [&](Index material) { return material < is_seen.size() && is_seen[material]; });
}

bool has_own_colours(const MeshExtras& extras) { return !extras.face_colours.empty() || !extras.vertex_colours.empty(); }

}  // namespace ostraka

// Materials, textures and images of a glTF file.
#pragma once

#include "ostraka/io/glb.h"
#include "ostraka/io/mesh_file.h"

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace ostraka::io {

/// An affine map of texture coordinates (KHR_texture_transform), in glTF's coordinates, whose v grows downwards.
struct TextureMap {
    std::array<double, 6> rows{1, 0, 0, 0, 1, 0};  ///< u' = rows[0] u + rows[1] v + rows[2], v' likewise
    /// The coordinates in ours, whose v grows upwards.
    [[nodiscard]] TexturePoint operator()(double u, double v) const;
    friend bool operator==(const TextureMap&, const TextureMap&) = default;
};

/// Reads the materials that the faces of a mesh refer to.
class GltfMaterials {
public:
    /// Images become images of `soup`, notes its notes.
    GltfMaterials(const glb::Reader& reader, const Path& file, PolygonSoup& soup);

    /// The texture coordinates that a material uses.
    struct Coordinates {
        std::size_t set = 0;  ///< number n of the attribute TEXCOORD_n
        TextureMap map;       ///< applied to the coordinates of the file
    };
    /// Reads the material of this index, unless it was read before.
    const Coordinates& coordinates(std::size_t material, const std::string& pointer);
    /// Completes the appearance of the soup: `soup.extras.face_materials` has indices of the file (no_index: none) and gets
    /// indices of the appearance. Materials that are white and have no image give no appearance.
    void finish();

private:
    struct Parsed {
        Material material;
        Coordinates coordinates;
        bool plain = false;  ///< white, without image and further properties
    };
    Parsed parsed(const JsonValue& entry, const std::string& pointer);
    void read_base(const JsonValue& entry, Parsed& result, std::optional<Coordinates>& base, const std::string& pointer);
    void read_alpha(const JsonValue& entry, Material& material, const std::string& pointer);
    void read_sampler(const JsonValue& texture_info, Material& material, const std::string& pointer);
    [[nodiscard]] Coordinates coordinates_of(const JsonValue& texture_info, const std::string& pointer) const;
    void read_rest(JsonValue& value, std::optional<Coordinates>& kept, const std::string& pointer);
    bool keeps_texture(JsonValue& texture_info, std::optional<Coordinates>& kept, const std::string& pointer);
    Index image_of_texture(std::size_t texture, const std::string& pointer);
    Index image(std::size_t index, const std::string& pointer);
    Index embedded_image(const JsonValue& entry, const std::string& name, const std::string& pointer);
    [[nodiscard]] std::array<float, 4> factor(const JsonValue& object, const char* name, const std::string& pointer) const;

    const glb::Reader& reader_;
    const Path& file_;
    PolygonSoup& soup_;
    JsonAllocator allocator_;
    std::map<std::size_t, Parsed> parsed_;  ///< materials by their index in the file
    std::map<std::size_t, Index> images_;   ///< images of the soup by their index in the file
    bool dropped_textures_ = false, dropped_gloss_ = false;
};

}  // namespace ostraka::io

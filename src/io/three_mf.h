// The model parts of a 3MF file (3D Manufacturing Format, core specification 1.3, materials extension 1.2, production extension
// 1.1).
#pragma once

#include "io/zip_archive.h"
#include "ostraka/io/mesh_file.h"

#include <map>

namespace ostraka::io {

/// An affine map by rows of three columns, as in 3MF: point * matrix, the last row is the translation.
using Placement = std::array<double, 12>;
inline constexpr Placement no_placement{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};

/// Names an object: the part of the archive and the number in it.
using ObjectKey = std::pair<std::string, std::uint32_t>;
/// An object that is part of another one or of the build.
struct PlacedObject {
    ObjectKey object;
    Placement placement = no_placement;
};

/// An object of a model: a mesh or a composition of other objects. Lists of triangles are empty or complete.
struct ModelObject {
    std::vector<std::array<double, 3>> points;
    std::vector<std::array<Index, 3>> triangles;
    std::vector<Colour> colours;                           ///< one colour per triangle
    std::vector<Index> textures;                           ///< index in Model::textures of each triangle's image, or no_index
    std::vector<std::array<TexturePoint, 3>> coordinates;  ///< texture coordinates of the triangles
    std::vector<PlacedObject> components;
};

/// An image that the model names.
struct ModelTexture {
    std::string path;  ///< part of the archive
    TextureWrap wrap_u = TextureWrap::repeat, wrap_v = TextureWrap::repeat;
    bool nearest = false;
};

/// The model parts of a 3MF file.
struct Model {
    std::string unit = "millimeter";
    std::map<ObjectKey, ModelObject> objects;
    std::vector<PlacedObject> build;
    std::vector<ModelTexture> textures;
    std::vector<std::string> notes;
};

/// Name of a part in the archive, from its path: without the slash at its beginning.
inline std::string part_name(std::string_view path) {
    while (path.starts_with('/')) path.remove_prefix(1);
    return std::string(path);
}

/// Reads the model parts of a 3MF file, beginning with the one that the relationships of the archive name. Throws Error (input)
/// with part and line. The memory is bounded by `max_bytes`.
Model read_model(const ZipArchive& archive, const std::string& file, std::size_t max_bytes);

}  // namespace ostraka::io

// Materials, textures and images in the JSON of a GLB file.
#pragma once

#include "ostraka/image/appearance.h"
#include "ostraka/io/glb.h"

#include <map>
#include <set>
#include <string>
#include <vector>

namespace ostraka::io {

/// Writes the materials of a mesh, with the images that they use.
class GlbMaterials {
public:
    /// `used`: indices of the materials to write, in the order in which they are written; no_index stands for the default
    /// material. `where`: file for messages. Images in formats that glTF does not support are encoded again.
    GlbMaterials(const Appearance& appearance, std::vector<Index> used, const std::string& where);

    [[nodiscard]] std::size_t bytes() const;  ///< size of all images
    /// Adds materials, textures, samplers and images to the JSON; announces a view for each image. `translucent`: true if
    /// vertex colours have an opacity below 1; the default material is then drawn with transparency.
    void add_to(glb::Builder& builder, bool translucent);
    /// The contents of the announced views, in their order.
    [[nodiscard]] const std::vector<SharedImage>& images() const { return images_; }
    [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }  ///< messages about data that were not kept

private:
    void take_images(const JsonValue& value);
    void take_image(Index image);
    [[nodiscard]] JsonValue material(std::size_t number, bool translucent, JsonAllocator& allocator);
    void convert_textures(JsonValue& value, const Material& material, JsonAllocator& allocator);
    /// Index of the texture that shows an image of the appearance as a material does; -1: the image is not written.
    int texture(Index image, const Material& material, JsonAllocator& allocator);
    int sampler(const Material& material, JsonAllocator& allocator);

    const Appearance& appearance_;
    std::vector<Index> used_;
    std::string where_;
    std::vector<Json> unread_material_json_;  ///< what the file said of each used material
    std::vector<SharedImage> images_;         ///< images to write
    std::map<Index, int> place_of_image_;     ///< of an image of the appearance in `images_`; -1: not written
    std::vector<std::string> notes_;
    JsonValue textures_{rapidjson::kArrayType}, samplers_{rapidjson::kArrayType};
    std::map<std::pair<int, int>, int> texture_of_;  ///< (image, sampler) -> texture
    std::map<std::array<int, 3>, int> sampler_of_;   ///< (wrap, wrap, filter) -> sampler
    std::set<std::string> extensions_;               ///< names of the extensions in the materials
};

}  // namespace ostraka::io

#include "ostraka/io/glb_materials.h"

#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"
#include "ostraka/files/json_build.h"

#include <fmt/core.h>

#include <algorithm>

namespace ostraka::io {

namespace {

constexpr const char* webp_extension = "EXT_texture_webp";

bool is_texture_info(const JsonValue& name, const JsonValue& value) {
    const JsonValue* index = find_member(value, "index");
    return index != nullptr && index->IsUint() && text_of(name).ends_with("Texture");
}

int wrap_code(TextureWrap wrap) {
    constexpr int repeat = 10497, clamp_to_edge = 33071, mirrored_repeat = 33648;
    return wrap == TextureWrap::clamp ? clamp_to_edge : wrap == TextureWrap::mirror ? mirrored_repeat : repeat;
}

/// The member of this name, added as an empty object if there is none.
JsonValue& object_member(JsonValue& object, const char* name, JsonAllocator& allocator) {
    const auto member = object.FindMember(name);
    if (member != object.MemberEnd() && member->value.IsObject()) return member->value;
    object.RemoveMember(name);
    add_member(object, name, JsonValue(rapidjson::kObjectType), allocator);
    return object[name];
}

}  // namespace

GlbMaterials::GlbMaterials(const Appearance& appearance, std::vector<Index> used, const std::string& where)
    : appearance_(appearance), used_(std::move(used)), where_(where) {
    bool drops_mtl = false;
    for (const Index m : used_) {
        Json& rest = unread_material_json_.emplace_back();
        rest.SetObject();
        if (m == no_index) continue;
        const Material& material = appearance_.materials[m];
        if (!material.gltf_rest.empty()) rest = parse_json(material.gltf_rest, where_ + ", material " + material.name);
        if (!rest.IsObject()) rest.SetObject();
        drops_mtl = drops_mtl || !material.mtl_rest.empty();
        take_image(material.image);
        take_images(rest);
    }
    if (drops_mtl) notes_.emplace_back("GLB cannot store what MTL materials say beyond colour, opacity and image");
    const auto written =
        static_cast<std::size_t>(std::count_if(used_.begin(), used_.end(), [](Index m) { return m != no_index; }));
    if (written < appearance_.materials.size())
        notes_.push_back(fmt::format("{} of {} materials are not written: no face has them",
                                     appearance_.materials.size() - written, appearance_.materials.size()));
}

/// Takes the images of the textures in the rest of a material.
void GlbMaterials::take_images(const JsonValue& value) {
    if (value.IsArray())
        for (const JsonValue& element : value.GetArray()) take_images(element);
    if (!value.IsObject()) return;
    for (const auto& member : value.GetObject()) {
        const std::string name = text_of(member.name);
        if (is_texture_info(member.name, member.value)) take_image(member.value["index"].GetUint());
        if (name != "extras") take_images(member.value);
        if (name == "extensions" && member.value.IsObject())
            for (const auto& extension : member.value.GetObject()) extensions_.insert(text_of(extension.name));
    }
}

void GlbMaterials::take_image(Index image) {
    if (image >= appearance_.images.size() || place_of_image_.contains(image)) return;
    SharedImage taken = appearance_.images[image];
    if (taken != nullptr && taken->format == ImageFormat::gif) {
        taken = std::make_shared<const Image>(encode(decode(*taken, where_), ImageFormat::png, taken->name));
        notes_.push_back(fmt::format("the image {} was encoded as PNG: glTF does not know GIF", printable(taken->name, 100)));
    }
    if (taken == nullptr) notes_.push_back(fmt::format("image {} is missing and not written", image));
    else if (taken->format == ImageFormat::webp) extensions_.insert(webp_extension);
    place_of_image_[image] = taken == nullptr ? -1 : static_cast<int>(images_.size());
    if (taken != nullptr) images_.push_back(std::move(taken));
}

std::size_t GlbMaterials::bytes() const {
    std::size_t sum = 0;
    for (const SharedImage& image : images_) sum += image->bytes.size() + 4;
    return sum;
}

void GlbMaterials::add_to(glb::Builder& builder, bool translucent) {
    auto& allocator = builder.allocator();
    JsonValue materials(rapidjson::kArrayType), images(rapidjson::kArrayType);
    for (std::size_t i = 0; i < used_.size(); ++i) materials.PushBack(material(i, translucent, allocator), allocator);
    for (const SharedImage& image : images_) {
        JsonValue entry = json_object(allocator, "bufferView", builder.announce_view(image->bytes.size()), "mimeType",
                                      media_type(image->format));
        add_nonempty_members(entry, allocator, "name", image->name);
        images.PushBack(entry, allocator);
    }
    Json& root = builder.document();
    add_members(root, allocator, "materials", std::move(materials));
    add_nonempty_members(root, allocator, "textures", std::move(textures_), "images", std::move(images), "samplers",
                         std::move(samplers_), "extensionsUsed", extensions_);
    if (extensions_.contains(webp_extension)) add_members(root, allocator, "extensionsRequired", std::array{webp_extension});
}

/// The JSON of material `number` of those that are written.
JsonValue GlbMaterials::material(std::size_t number, bool translucent, JsonAllocator& allocator) {
    if (used_[number] == no_index) {
        JsonValue plain =
            json_object(allocator, "pbrMetallicRoughness", json_object(allocator, "metallicFactor", 0, "roughnessFactor", 1));
        add_nonempty_members(plain, allocator, "alphaMode", std::string(translucent ? "BLEND" : ""), "doubleSided", true);
        return plain;
    }
    const Material& source = appearance_.materials[used_[number]];
    JsonValue result(unread_material_json_[number], allocator);
    convert_textures(result, source, allocator);
    JsonValue& pbr = object_member(result, "pbrMetallicRoughness", allocator);
    if (source.gltf_rest.empty()) add_members(pbr, allocator, "metallicFactor", 0, "roughnessFactor", 1);
    if (source.base_colour != std::array<float, 4>{1, 1, 1, 1})
        add_members(pbr, allocator, "baseColorFactor", source.base_colour);
    if (const int base = texture(source.image, source, allocator); base >= 0)
        add_members(pbr, allocator, "baseColorTexture", json_object(allocator, "index", base));
    if (pbr.ObjectEmpty()) result.RemoveMember("pbrMetallicRoughness");
    const char* const mode = source.alpha == Material::Alpha::mask    ? "MASK"
                             : source.alpha == Material::Alpha::blend ? "BLEND"
                                                                      : "";
    add_nonempty_members(result, allocator, "name", source.name, "alphaMode", std::string(mode), "doubleSided",
                         source.double_sided);
    if (source.alpha == Material::Alpha::mask && source.alpha_cutoff != 0.5F)
        add_members(result, allocator, "alphaCutoff", source.alpha_cutoff);
    return result;
}

/// Replaces the images in the rest of a material by textures; removes those whose image is not written.
void GlbMaterials::convert_textures(JsonValue& value, const Material& material, JsonAllocator& allocator) {
    if (value.IsArray())
        for (JsonValue& element : value.GetArray()) convert_textures(element, material, allocator);
    if (!value.IsObject()) return;
    for (auto member = value.MemberBegin(); member != value.MemberEnd();) {
        if (is_texture_info(member->name, member->value)) {
            const int index = texture(member->value["index"].GetUint(), material, allocator);
            if (index < 0) {
                member = value.EraseMember(member);
                continue;
            }
            member->value["index"].SetInt(index);
        } else if (text_of(member->name) != "extras") {
            convert_textures(member->value, material, allocator);
        }
        ++member;
    }
}

int GlbMaterials::texture(Index image, const Material& material, JsonAllocator& allocator) {
    const auto place = place_of_image_.find(image);
    if (place == place_of_image_.end() || place->second < 0) return -1;
    const int filter = sampler(material, allocator);
    const auto [entry, is_new] = texture_of_.try_emplace({place->second, filter}, static_cast<int>(textures_.Size()));
    if (!is_new) return entry->second;
    JsonValue result(rapidjson::kObjectType);
    if (filter >= 0) add_members(result, allocator, "sampler", filter);
    if (images_[static_cast<std::size_t>(place->second)]->format == ImageFormat::webp)
        add_members(result, allocator, "extensions",
                    json_object(allocator, webp_extension, json_object(allocator, "source", place->second)));
    else add_members(result, allocator, "source", place->second);
    textures_.PushBack(result, allocator);
    return entry->second;
}

/// Index of the sampler of a material; -1: the usual one, which repeats the image.
int GlbMaterials::sampler(const Material& material, JsonAllocator& allocator) {
    constexpr int nearest = 9728, linear = 9729, linear_mipmaps = 9987;
    const std::array<int, 3> key{wrap_code(material.wrap_u), wrap_code(material.wrap_v), material.nearest ? nearest : linear};
    if (key == std::array<int, 3>{wrap_code(TextureWrap::repeat), wrap_code(TextureWrap::repeat), linear}) return -1;
    const auto [entry, is_new] = sampler_of_.try_emplace(key, static_cast<int>(samplers_.Size()));
    if (is_new)
        samplers_.PushBack(json_object(allocator, "wrapS", key[0], "wrapT", key[1], "magFilter", key[2], "minFilter",
                                       material.nearest ? nearest : linear_mipmaps),
                           allocator);
    return entry->second;
}

}  // namespace ostraka::io

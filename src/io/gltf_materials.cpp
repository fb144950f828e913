#include "io/gltf_materials.h"

#include "io/formats.h"
#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"
#include "ostraka/files/json_build.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace ostraka::io {

namespace {

constexpr std::size_t no_element = static_cast<std::size_t>(-1);
constexpr const char* gloss_extension = "KHR_materials_pbrSpecularGlossiness";
constexpr const char* transform_extension = "KHR_texture_transform";

/// The object in a member; null: there is none.
const JsonValue* object_in(const JsonValue& object, const char* name) {
    const JsonValue* value = find_member(object, name);
    return value != nullptr && value->IsObject() ? value : nullptr;
}

const JsonValue* extension_in(const JsonValue& object, const char* name) {
    const JsonValue* extensions = object_in(object, "extensions");
    return extensions == nullptr ? nullptr : object_in(*extensions, name);
}

/// Two numbers of a list, such as an offset.
std::array<double, 2> pair_in(const JsonValue& object, const char* name, std::array<double, 2> fallback) {
    const auto list = list_in(object, name);
    for (rapidjson::SizeType i = 0; i < 2 && list.Size() == 2; ++i)
        if (list[i].IsNumber() && std::abs(list[i].GetDouble()) < 1e30) fallback[i] = list[i].GetDouble();
    return fallback;
}

/// The map of KHR_texture_transform: scales, then turns, then shifts. The sense of the rotation is that of the Khronos sample
/// viewer and its test model (u' = u cos + v sin), since the matrix printed in the text of the extension turns the other way.
TextureMap map_of(const JsonValue& transform) {
    const auto offset = pair_in(transform, "offset", {0, 0}), scale = pair_in(transform, "scale", {1, 1});
    const JsonValue* rotation = find_member(transform, "rotation");
    const double angle = rotation != nullptr && rotation->IsNumber() ? rotation->GetDouble() : 0;
    if (!std::isfinite(angle)) return {};
    const double c = std::cos(angle), s = std::sin(angle);
    return {{c * scale[0], s * scale[1], offset[0], -s * scale[0], c * scale[1], offset[1]}};
}

TextureWrap wrap_of(std::size_t code) {
    constexpr std::size_t clamp_to_edge = 33071, mirrored_repeat = 33648;
    return code == clamp_to_edge ? TextureWrap::clamp : code == mirrored_repeat ? TextureWrap::mirror : TextureWrap::repeat;
}

/// True if the rest of a material does not change what is seen of a diffuse surface: it has at most metallicFactor and
/// roughnessFactor, and black emission.
bool says_nothing_more(const JsonValue& rest) {
    for (const auto& member : rest.GetObject()) {
        const std::string name = text_of(member.name);
        const bool is_pbr = name == "pbrMetallicRoughness" && member.value.IsObject();
        const bool is_emission = name == "emissiveFactor" && member.value.IsArray();
        if (!is_pbr && !is_emission) return false;
        if (is_emission)
            for (const JsonValue& light : member.value.GetArray())
                if (!light.IsNumber() || light.GetDouble() != 0) return false;
        if (!is_pbr) continue;
        for (const auto& factor : member.value.GetObject()) {
            const std::string factor_name = text_of(factor.name);
            if (factor_name != "metallicFactor" && factor_name != "roughnessFactor") return false;
        }
    }
    return true;
}

}  // namespace

TexturePoint TextureMap::operator()(double u, double v) const {
    if (*this == TextureMap{}) return {static_cast<float>(u), static_cast<float>(1 - v)};
    return {static_cast<float>(rows[0] * u + rows[1] * v + rows[2]),
            static_cast<float>(1 - (rows[3] * u + rows[4] * v + rows[5]))};
}

GltfMaterials::GltfMaterials(const glb::Reader& reader, const Path& file, PolygonSoup& soup)
    : reader_(reader), file_(file), soup_(soup) {}

const GltfMaterials::Coordinates& GltfMaterials::coordinates(std::size_t material, const std::string& pointer) {
    const auto known = parsed_.find(material);
    if (known != parsed_.end()) return known->second.coordinates;
    const JsonValue& entry = reader_.element("materials", material, pointer);
    return parsed_.emplace(material, parsed(entry, "/materials/" + std::to_string(material))).first->second.coordinates;
}

GltfMaterials::Parsed GltfMaterials::parsed(const JsonValue& entry, const std::string& pointer) {
    Parsed result;
    Material& material = result.material;
    material.name = text_in(entry, "name");
    material.double_sided = flag_in(entry, "doubleSided");
    read_alpha(entry, material, pointer);
    std::optional<Coordinates> kept;
    read_base(entry, result, kept, pointer);
    JsonValue rest(entry, allocator_);
    for (const char* name : {"name", "doubleSided", "alphaMode", "alphaCutoff"}) rest.RemoveMember(name);
    if (const auto pbr = rest.FindMember("pbrMetallicRoughness"); pbr != rest.MemberEnd() && pbr->value.IsObject())
        for (const char* name : {"baseColorFactor", "baseColorTexture"}) pbr->value.RemoveMember(name);
    if (const auto extensions = rest.FindMember("extensions"); extensions != rest.MemberEnd() && extensions->value.IsObject()) {
        extensions->value.RemoveMember(gloss_extension);
        if (extensions->value.ObjectEmpty()) rest.RemoveMember("extensions");
    }
    read_rest(rest, kept, pointer);
    if (kept) result.coordinates = *kept;
    const bool is_white = material.base_colour == std::array<float, 4>{1, 1, 1, 1};
    result.plain = is_white && material.image == no_index && says_nothing_more(rest);
    material.gltf_rest = to_compact_text(rest);
    return result;
}

void GltfMaterials::read_alpha(const JsonValue& entry, Material& material, const std::string& pointer) {
    const std::string mode = text_in(entry, "alphaMode");
    material.alpha = mode == "MASK" ? Material::Alpha::mask : mode == "BLEND" ? Material::Alpha::blend : Material::Alpha::opaque;
    const JsonValue* cutoff = find_member(entry, "alphaCutoff");
    if (cutoff == nullptr) return;
    if (!cutoff->IsNumber() || !(cutoff->GetDouble() >= 0 && cutoff->GetDouble() < 1e6))
        reader_.fail(pointer + "/alphaCutoff", "is not a number from 0 up");
    material.alpha_cutoff = static_cast<float>(cutoff->GetDouble());
}

std::array<float, 4> GltfMaterials::factor(const JsonValue& object, const char* name, const std::string& pointer) const {
    std::array<float, 4> colour{1, 1, 1, 1};
    const JsonValue* list = find_member(object, name);
    if (list == nullptr) return colour;
    if (!list->IsArray() || list->Size() != 4) reader_.fail(fmt::format("{}/{}", pointer, name), "is not a list of four numbers");
    for (rapidjson::SizeType i = 0; i < 4; ++i) {
        if (!(*list)[i].IsNumber()) reader_.fail(fmt::format("{}/{}/{}", pointer, name, i), "is not a number");
        colour[i] = static_cast<float>(std::clamp((*list)[i].GetDouble(), 0.0, 1.0));
    }
    return colour;
}

/// Reads the base colour; the diffuse colour takes its place in materials with specular colour and glossiness.
void GltfMaterials::read_base(const JsonValue& entry, Parsed& result, std::optional<Coordinates>& base,
                              const std::string& pointer) {
    const JsonValue* pbr = object_in(entry, "pbrMetallicRoughness");
    const JsonValue* gloss = extension_in(entry, gloss_extension);
    const JsonValue* colours = gloss != nullptr ? gloss : pbr;
    if (gloss != nullptr && !dropped_gloss_) {
        soup_.notes.emplace_back("materials have specular colours and glossiness; only their diffuse colours are kept");
        dropped_gloss_ = true;
    }
    if (colours == nullptr) return;
    result.material.base_colour = factor(*colours, gloss != nullptr ? "diffuseFactor" : "baseColorFactor", pointer);
    const JsonValue* texture_info = object_in(*colours, gloss != nullptr ? "diffuseTexture" : "baseColorTexture");
    if (texture_info == nullptr) return;
    base = coordinates_of(*texture_info, pointer);
    result.material.image = image_of_texture(reader_.number(*texture_info, "index", pointer, no_element), pointer);
    read_sampler(*texture_info, result.material, pointer);
}

void GltfMaterials::read_sampler(const JsonValue& texture_info, Material& material, const std::string& pointer) {
    constexpr std::size_t nearest = 9728;
    const std::size_t texture = reader_.number(texture_info, "index", pointer, no_element);
    const JsonValue& entry = reader_.element("textures", texture, pointer);
    const std::size_t index = reader_.number(entry, "sampler", pointer, no_element);
    if (index == no_element) return;
    const JsonValue& sampler = reader_.element("samplers", index, pointer);
    const std::string sampler_pointer = "/samplers/" + std::to_string(index);
    material.wrap_u = wrap_of(reader_.number(sampler, "wrapS", sampler_pointer, 0));
    material.wrap_v = wrap_of(reader_.number(sampler, "wrapT", sampler_pointer, 0));
    material.nearest = reader_.number(sampler, "magFilter", sampler_pointer, 0) == nearest;
}

GltfMaterials::Coordinates GltfMaterials::coordinates_of(const JsonValue& texture_info, const std::string& pointer) const {
    Coordinates result{reader_.number(texture_info, "texCoord", pointer, 0), {}};
    if (const JsonValue* transform = extension_in(texture_info, transform_extension); transform != nullptr) {
        result.map = map_of(*transform);
        result.set = reader_.number(*transform, "texCoord", pointer, result.set);
    }
    return result;
}

/// Replaces the textures in the rest of a material by images, and removes those that use other texture coordinates than `kept`.
void GltfMaterials::read_rest(JsonValue& value, std::optional<Coordinates>& kept, const std::string& pointer) {
    if (value.IsArray())
        for (JsonValue& element : value.GetArray()) read_rest(element, kept, pointer);
    if (!value.IsObject()) return;
    for (auto member = value.MemberBegin(); member != value.MemberEnd();) {
        const std::string name = text_of(member->name);
        const bool is_texture = name.ends_with("Texture") && find_member(member->value, "index") != nullptr;
        if (is_texture && !keeps_texture(member->value, kept, fmt::format("{}/{}", pointer, name))) {
            member = value.EraseMember(member);
            continue;
        }
        if (!is_texture && name != "extras") read_rest(member->value, kept, pointer);
        ++member;
    }
}

bool GltfMaterials::keeps_texture(JsonValue& texture_info, std::optional<Coordinates>& kept, const std::string& pointer) {
    const Coordinates coordinates = coordinates_of(texture_info, pointer);
    // The first texture decides which coordinates are kept. A base colour texture has its map applied to the coordinates; without
    // one, the maps of the others are kept as they are.
    if (!kept) kept = Coordinates{coordinates.set, {}};
    const bool is_mapped = kept->map != TextureMap{};
    if (coordinates.set != kept->set || (is_mapped && coordinates.map != kept->map)) {
        if (!dropped_textures_)
            soup_.notes.push_back(fmt::format(
                "at {}: the texture uses other coordinates than the base colour; such textures are not kept", pointer));
        dropped_textures_ = true;
        return false;
    }
    const Index image = image_of_texture(reader_.number(texture_info, "index", pointer, no_element), pointer);
    if (image == no_index) return false;
    texture_info["index"].SetUint(image);
    texture_info.RemoveMember("texCoord");
    const auto extensions = texture_info.FindMember("extensions");
    if (extensions == texture_info.MemberEnd() || !extensions->value.IsObject()) return true;
    const auto transform = extensions->value.FindMember(transform_extension);
    if (transform == extensions->value.MemberEnd()) return true;
    if (is_mapped || coordinates.map == TextureMap{} || !transform->value.IsObject()) extensions->value.EraseMember(transform);
    else transform->value.RemoveMember("texCoord");
    if (extensions->value.ObjectEmpty()) texture_info.RemoveMember("extensions");
    return true;
}

/// The image of a texture: the WebP image if there is one, or the image that all readers know; KTX2 images are not read.
Index GltfMaterials::image_of_texture(std::size_t texture, const std::string& pointer) {
    const JsonValue& entry = reader_.element("textures", texture, pointer);
    const std::string entry_pointer = "/textures/" + std::to_string(texture);
    const auto source_in = [&](const char* extension) {
        const JsonValue* object = extension_in(entry, extension);
        return object == nullptr ? no_element : reader_.number(*object, "source", entry_pointer, no_element);
    };
    const std::size_t webp = source_in("EXT_texture_webp"), basis = source_in("KHR_texture_basisu"),
                      usual = reader_.number(entry, "source", entry_pointer, no_element);
    Index result = no_index;
    for (const std::size_t source : {webp, usual, usual == no_element && webp == no_element ? basis : no_element}) {
        if (source == no_element) continue;
        const Index candidate = image(source, entry_pointer);
        if (result == no_index || soup_.extras.appearance.images[result] == nullptr) result = candidate;
        if (soup_.extras.appearance.images[result] != nullptr) break;
    }
    if (basis != no_element && usual != no_element && soup_.extras.appearance.images[result] == nullptr)
        soup_.notes.push_back(
            fmt::format("at {}: the texture is there as KTX2 (Basis Universal), which is not read; convert it to "
                        "PNG under the name of the missing image",
                        entry_pointer));
    return result;
}

Index GltfMaterials::image(std::size_t index, const std::string& pointer) {
    const auto known = images_.find(index);
    if (known != images_.end()) return known->second;
    const JsonValue& entry = reader_.element("images", index, pointer);
    const std::string entry_pointer = "/images/" + std::to_string(index), uri = text_in(entry, "uri");
    const bool is_embedded = uri.empty() || lower_case(uri.substr(0, 5)) == "data:";
    const Index added = is_embedded ? embedded_image(entry, text_in(entry, "name"), entry_pointer) : add_image(soup_, file_, uri);
    return images_[index] = added;
}

/// Adds an image whose bytes are in the file; an unreadable one gives a note and a null image.
Index GltfMaterials::embedded_image(const JsonValue& entry, const std::string& name, const std::string& pointer) {
    std::vector<SharedImage>& images = soup_.extras.appearance.images;
    SharedImage image;
    try {
        std::string bytes;
        if (const std::string uri = text_in(entry, "uri"); !uri.empty()) {
            reader_.charge(2.0 * static_cast<double>(uri.size()), pointer);
            auto content = glb::content_of_data_uri(uri);
            if (!content) reader_.fail(pointer + "/uri", "is not valid base64");
            bytes = std::move(*content);
        } else {
            const std::string_view view = reader_.view(reader_.number(entry, "bufferView", pointer, no_element), pointer);
            reader_.charge(static_cast<double>(view.size()), pointer);
            bytes = view;
        }
        image = std::make_shared<const Image>(parse_image(std::move(bytes), name, reader_.where()));
    } catch (const Error& error) {
        soup_.notes.push_back(fmt::format("the image at {} is not kept: it {}", pointer, printable(error.problem(), 300)));
    }
    images.push_back(std::move(image));
    return static_cast<Index>(images.size() - 1);
}

void GltfMaterials::finish() {
    MeshExtras& extras = soup_.extras;
    std::set<Index> used;
    for (Index last = no_index; const Index m : extras.face_materials)
        if (m != last) used.insert(last = m);
    used.erase(no_index);
    const bool all_plain = std::all_of(used.begin(), used.end(), [&](Index m) { return parsed_.at(m).plain; });
    if (all_plain) {
        extras.face_materials.clear();
        extras.appearance = {};
        return;
    }
    std::map<Index, Index> place_of;  // of a material of the file in the appearance
    for (const Index m : used) {
        Parsed& entry = parsed_.at(m);
        // What writers use for faces without a material is none.
        if (entry.plain && entry.material.name.empty()) continue;
        place_of[m] = static_cast<Index>(extras.appearance.materials.size());
        extras.appearance.materials.push_back(std::move(entry.material));
    }
    Index last = no_index, last_place = no_index;
    for (Index& m : extras.face_materials) {
        if (m != last) {
            const auto place = place_of.find(last = m);
            last_place = place == place_of.end() ? no_index : place->second;
        }
        m = last_place;
    }
}

}  // namespace ostraka::io

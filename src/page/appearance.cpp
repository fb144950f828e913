#include "page/appearance.h"

#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"
#include "ostraka/files/json_build.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <set>

namespace ostraka {

namespace {

/// A small image that the viewer shows in its first picture, until the large one is decoded.
constexpr int preview_side = 512;
constexpr std::size_t preview_bytes = 60'000;
constexpr std::size_t min_image_bytes = 20'000;  ///< for the smallest images of an object with many

void add_run_number(std::string& bytes, std::size_t value) {
    for (; value >= 128; value /= 128) bytes += static_cast<char>(value % 128 + 128);
    bytes += static_cast<char>(value);
}

const char* wrap_name(TextureWrap wrap) {
    return wrap == TextureWrap::repeat ? "repeat" : wrap == TextureWrap::clamp ? "clamp" : "mirror";
}

/// Faces of each material that is in use.
std::map<Index, std::vector<Index>> faces_by_material(const MeshExtras& extras) {
    std::map<Index, std::vector<Index>> faces;
    for (std::size_t face = 0; face < extras.face_materials.size(); ++face)
        if (extras.face_materials[face] != no_index) faces[extras.face_materials[face]].push_back(static_cast<Index>(face));
    return faces;
}

/// The images of the page, each written once.
class PageImages {
public:
    PageImages(const Appearance& appearance, const std::set<Index>& used, const std::string& name, const KeepBytes& keep,
               JsonAllocator& allocator, std::vector<std::string>& notes) {
        double all_pixels = 0;
        for (const Index i : used) all_pixels += pixels_of(*appearance.images[i]);
        for (const Index i : used) {
            const Image& image = *appearance.images[i];
            const double share = pixels_of(image) / all_pixels;
            const auto budget =
                std::max(min_image_bytes, static_cast<std::size_t>(share * static_cast<double>(page_image_bytes)));
            const Image shown = within_budget(image, page_image_side, budget, name);
            if (shown.width != image.width || shown.height != image.height)
                notes.push_back(fmt::format("{}: the image {} of {} x {} pixels is shown with {} x {}", printable(name, 200),
                                            printable(image.name, 200), image.width, image.height, shown.width, shown.height));
            else if (shown.bytes.size() != image.bytes.size())
                notes.push_back(fmt::format("{}: the image {} of {} bytes is compressed to {}", printable(name, 200),
                                            printable(image.name, 200), image.bytes.size(), shown.bytes.size()));
            numbers_[i] = list_.Size();
            JsonValue entry = json_object(allocator, "blob", keep(shown.bytes), "type", media_type(shown.format), "width",
                                          shown.width, "height", shown.height);
            if (std::max(shown.width, shown.height) > 2 * preview_side) {
                const Image preview = within_budget(shown, preview_side, preview_bytes, name);
                add_members(entry, allocator, "preview",
                            json_object(allocator, "blob", keep(preview.bytes), "type", media_type(preview.format)));
            }
            list_.PushBack(entry, allocator);
        }
    }
    [[nodiscard]] std::size_t number(Index image) const { return numbers_.at(image); }
    JsonValue& list() { return list_; }

private:
    static double pixels_of(const Image& image) { return static_cast<double>(image.width) * image.height; }

    std::map<Index, std::size_t> numbers_;
    JsonValue list_{rapidjson::kArrayType};
};

JsonValue material_json(const Material& material, JsonAllocator& allocator) {
    JsonValue entry = json_object(allocator, "colour", material.base_colour);
    if (material.alpha == Material::Alpha::mask) add_members(entry, allocator, "cutoff", double{material.alpha_cutoff});
    if (material.alpha == Material::Alpha::blend) add_members(entry, allocator, "cutoff", 0.5);
    if (material.gltf_rest.find("KHR_materials_unlit") != std::string::npos) add_members(entry, allocator, "unlit", true);
    return entry;
}

}  // namespace

std::string runs_of(const std::vector<Index>& faces) {
    std::string bytes;
    std::size_t at = 0;
    for (std::size_t i = 0; i < faces.size();) {
        std::size_t end = i + 1;
        while (end < faces.size() && faces[end] == faces[end - 1] + 1) ++end;
        add_run_number(bytes, faces[i] - at);
        add_run_number(bytes, end - i);
        at = faces[end - 1] + std::size_t{1};
        i = end;
    }
    return bytes;
}

void check_extras(const MeshExtras& extras, const TriangleSoup& soup, const std::string& name) {
    const auto length = [&](const char* list, std::size_t count, std::size_t expected, const char* element) {
        if (count != 0 && count != expected)
            fail_input(name, fmt::format("has {} {} for {} {}", count, list, expected, element),
                       "give one entry for each element");
    };
    length("colours", extras.vertex_colours.size(), soup.points.size(), "vertices");
    length("colours", extras.face_colours.size(), soup.triangles.size(), "faces");
    length("materials", extras.face_materials.size(), soup.triangles.size(), "faces");
    length("texture coordinates", extras.corner_texture.size(), 3 * soup.triangles.size(), "corners");
    for (const Index material : extras.face_materials)
        if (material != no_index && material >= extras.appearance.materials.size())
            fail_input(name, "has a face whose material does not exist", "use materials of the mesh");
}

JsonValue colours_json(const MeshExtras& extras, const KeepBytes& keep, JsonAllocator& allocator) {
    const auto bytes_of = [](const std::vector<Colour>& colours) {
        std::string bytes;
        for (const Colour& colour : colours)
            for (std::size_t k = 0; k < 3; ++k) bytes += static_cast<char>(colour[k]);
        return bytes;
    };
    if (!extras.face_colours.empty()) return json_object(allocator, "faces", keep(bytes_of(extras.face_colours)));
    if (!extras.vertex_colours.empty()) return json_object(allocator, "vertices", keep(bytes_of(extras.vertex_colours)));
    return {};
}

JsonValue materials_json(const MeshExtras& extras, const std::string& name, const KeepBytes& keep, JsonAllocator& allocator,
                         std::vector<std::string>& notes) {
    const Appearance& appearance = extras.appearance;
    const std::map<Index, std::vector<Index>> faces = faces_by_material(extras);
    std::vector<Index> materials;  // those in use
    for (const auto& [material, list] : faces) materials.push_back(material);
    std::set<Index> images;
    const auto has_image = [&](const Material& material) {
        return !extras.corner_texture.empty() && material.image < appearance.images.size() && appearance.images[material.image];
    };
    for (const Index material : materials)
        if (has_image(appearance.materials[material])) images.insert(appearance.materials[material].image);
    PageImages page_images(appearance, images, name, keep, allocator, notes);
    JsonValue list(rapidjson::kArrayType);
    for (const Index i : materials) {
        const Material& material = appearance.materials[i];
        JsonValue entry = material_json(material, allocator);
        if (has_image(material)) {
            const std::array<std::string, 2> wrap{wrap_name(material.wrap_u), wrap_name(material.wrap_v)};
            add_members(entry, allocator, "image", page_images.number(material.image), "wrap", wrap);
            if (material.nearest) add_members(entry, allocator, "nearest", true);
        }
        if (faces.at(i).size() < extras.face_materials.size()) add_members(entry, allocator, "faces", keep(runs_of(faces.at(i))));
        list.PushBack(entry, allocator);
    }
    return json_object(allocator, "materials", std::move(list), "images", std::move(page_images.list()));
}

}  // namespace ostraka

#include "io/materials.h"
#include "io/text_writer.h"
#include "ostraka/core/message_text.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace ostraka::io {

namespace {

bool is_image_extension(const std::string& ending) {
    for (const char* known : {".png", ".jpg", ".jpeg", ".jpe", ".jfif", ".webp", ".gif"})
        if (ending == known) return true;
    return false;
}

/// The name of an image as the name of a file: the part behind the last slash, without control characters and blanks at its ends,
/// with the extension of an image file.
std::string plain_image_name(const Image& image) {
    std::string name = image.name;
    if (const std::size_t slash = name.find_last_of("/\\:"); slash != std::string::npos) name.erase(0, slash + 1);
    name = trimmed(without_controls(name, "_"));
    std::replace_if(
        name.begin(), name.end(), [](char c) { return std::string_view("\"*<>?|").find(c) != std::string_view::npos; }, '_');
    while (!name.empty() && (name.front() == '.' || name.front() == '-')) name.erase(0, 1);
    if (name.size() > 200) name.erase(0, name.size() - 200);
    if (name.empty()) return {};
    return is_image_extension(extension(name)) ? name : name + extension_of(image.format);
}

bool has_other_content(const Path& file, const std::string& bytes) {
    return file_exists(file) && (size_of_file(file) != bytes.size() || read_file(file) != bytes);
}

std::string channel_texts(const Material& material) {
    return unit_srgb_text(material.base_colour[0]) + " " + unit_srgb_text(material.base_colour[1]) + " " +
           unit_srgb_text(material.base_colour[2]);
}

/// What an MTL file cannot say of a material.
void add_losses(const Material& material, std::set<std::string>& losses) {
    const bool both_clamp = material.wrap_u == TextureWrap::clamp && material.wrap_v == TextureWrap::clamp;
    const bool both_repeat = material.wrap_u == TextureWrap::repeat && material.wrap_v == TextureWrap::repeat;
    if (material.image != no_index) {
        if (!both_clamp && !both_repeat) losses.insert("how images are mirrored or repeated in one direction");
        if (material.nearest) losses.insert("that pixels are not interpolated");
        if (material.alpha == Material::Alpha::mask || (material.alpha == Material::Alpha::blend && material.base_colour[3] == 1))
            losses.insert("the opacity of images");
    }
    if (!material.double_sided) losses.insert("that the back of faces is not drawn");
    if (!material.gltf_rest.empty()) losses.insert("further data of glTF materials");
}

}  // namespace

std::string unit_srgb_text(float light) {
    const auto linear = static_cast<double>(light);
    const double value = linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
    for (int significant = 1; significant < 17; ++significant) {
        const std::string text = fmt::format("{:.{}g}", value, significant);
        const auto number = number_of(text);
        if (number && linear_from_unit_srgb(std::clamp(*number, 0.0, 1.0)) == light) return text;
    }
    return digits(value);
}

ImageFiles::ImageFiles(const Appearance& appearance, const Path& mesh_file)
    : appearance_(appearance), mesh_file_(mesh_file), names_(appearance.images.size()) {}

bool ImageFiles::is_taken(const std::string& name) const {
    const std::string wanted = lower_case(name);
    return wanted == lower_case(mesh_file_.filename().string()) ||
           std::any_of(names_.begin(), names_.end(), [&](const std::string& other) { return lower_case(other) == wanted; });
}

std::string ImageFiles::free_name(const Image& image, std::size_t number) const {
    const std::string stem = mesh_file_.stem().string();
    std::string name = plain_image_name(image);
    if (name.empty()) name = fmt::format("{}_{}{}", stem, number, extension_of(image.format));
    else if (has_other_content(mesh_file_.parent_path() / name, image.bytes) && !name.starts_with(stem + "_"))
        name = stem + "_" + name;
    const Path path(name);
    std::string candidate = name;
    for (std::size_t counter = 2; is_taken(candidate); ++counter)
        candidate = fmt::format("{}_{}{}", path.stem().string(), counter, path.extension().string());
    return candidate;
}

const std::string& ImageFiles::use(Index image) {
    std::string& name = names_[image];
    const SharedImage& content = appearance_.images[image];
    if (name.empty() && content != nullptr) name = free_name(*content, image);
    return name;
}

std::string ImageFiles::use(const std::string& image_name) {
    for (std::size_t i = 0; i < names_.size(); ++i)
        if (appearance_.images[i] != nullptr && appearance_.images[i]->name == image_name) return use(static_cast<Index>(i));
    return {};
}

void ImageFiles::write() const {
    for (std::size_t i = 0; i < names_.size(); ++i)
        if (!names_[i].empty()) write_file(mesh_file_.parent_path() / names_[i], appearance_.images[i]->bytes);
}

std::vector<std::string> material_names(const Appearance& appearance) {
    std::vector<std::string> names;
    std::set<std::string> taken{"(null)"};
    for (const Material& material : appearance.materials) {
        const std::string given(name_on_line(without_controls(material.name, " ")));
        std::string name = given.empty() ? fmt::format("material_{}", names.size() + 1) : given;
        for (std::size_t counter = 2; !taken.insert(name).second; ++counter)
            name = fmt::format("{}_{}", given.empty() ? "material" : given, counter);
        names.push_back(name);
    }
    return names;
}

Notes write_mtl(const Path& file, const Appearance& appearance, const std::vector<std::string>& names, ImageFiles& images,
                const std::string& comment) {
    TextWriter writer(file);
    if (!comment.empty()) writer.text(fmt::format("# {}\n", one_line(comment)));
    std::set<std::string> losses;
    for (std::size_t m = 0; m < names.size(); ++m) {
        const Material& material = appearance.materials[m];
        writer.text(fmt::format("newmtl {}\nKd {}\n", names[m], channel_texts(material)));
        if (material.base_colour[3] != 1 && material.alpha != Material::Alpha::opaque)
            writer.text(fmt::format("d {}\n", material.base_colour[3]));
        for (const std::string& line : material.mtl_rest) {
            auto map = parse_map_statement(line);
            if (map) {
                const std::string written_name = images.use(map->reference);
                if (!written_name.empty()) map->reference = written_name;
            }
            writer.text((map ? map->line() : one_line(line)) + "\n");
        }
        if (material.image != no_index && appearance.images[material.image] != nullptr) {
            const bool clamp = material.wrap_u == TextureWrap::clamp && material.wrap_v == TextureWrap::clamp;
            writer.text(fmt::format("map_Kd {}{}\n", clamp ? "-clamp on " : "", images.use(material.image)));
        }
        add_losses(material, losses);
    }
    writer.commit();
    Notes notes;
    if (!losses.empty()) notes.push_back("MTL cannot store " + joined(losses));
    return notes;
}

}  // namespace ostraka::io

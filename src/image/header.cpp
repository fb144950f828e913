#include "image/header.h"

#include "ostraka/core/memory.h"
#include "ostraka/core/message_text.h"

#include <fmt/core.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>

namespace ostraka::images {

namespace {

constexpr std::string_view png_signature = "\x89PNG\r\n\x1a\n";
constexpr const char* convert_image = "convert it to PNG, for example with ImageMagick: convert IMAGE IMAGE.png";

/// A format that is not read, recognised by its first bytes.
struct ForeignFormat {
    std::string_view magic;
    std::size_t at;  ///< position of the magic bytes
    const char* name;
    const char* remedy;
};

constexpr const char* unpack_ktx =
    "convert it to PNG, for example with KTX-Software: ktx extract --transcode rgba8 IMAGE.ktx2 IMAGE.png; or the images within "
    "a GLB "
    "with glTF Transform: gltf-transform ktxdecompress IN.glb OUT.glb";

using namespace std::string_view_literals;
constexpr ForeignFormat foreign_formats[] = {
    {"\xABKTX 20\xBB"sv, 0, "a KTX2 texture", unpack_ktx},
    {"\xABKTX 11\xBB"sv, 0, "a KTX texture", "convert it to PNG, for example with an image editor or PVRTexTool"},
    {"sB\x13\0"sv, 0, "a Basis Universal texture", "convert it to PNG, for example with basisu: basisu -unpack IMAGE.basis"},
    {"DDS "sv, 0, "a DDS texture", convert_image},
    {"II*\0"sv, 0, "a TIFF image", convert_image},
    {"MM\0*"sv, 0, "a TIFF image", convert_image},
    {"II+\0"sv, 0, "a BigTIFF image", convert_image},
    {"MM\0+"sv, 0, "a BigTIFF image", convert_image},
    {"8BPS"sv, 0, "a Photoshop image", convert_image},
    {"ftypavif"sv, 4, "an AVIF image", convert_image},
    {"ftypheic"sv, 4, "a HEIC image", convert_image},
    {"ftypmif1"sv, 4, "a HEIF image", convert_image},
    {"\0\0\0\x0cjP  "sv, 0, "a JPEG 2000 image", convert_image},
    {"\xff\x0a"sv, 0, "a JPEG XL image", "convert it to PNG, for example with djxl IMAGE.jxl IMAGE.png"},
    {"\0\0\0\x0cJXL "sv, 0, "a JPEG XL image", "convert it to PNG, for example with djxl IMAGE.jxl IMAGE.png"},
    {"\x76\x2f\x31\x01"sv, 0, "an OpenEXR image", convert_image},
    {"#?RADIANCE"sv, 0, "a Radiance image", convert_image},
    {"<svg"sv, 0, "an SVG drawing", convert_image},
    {"<?xml"sv, 0, "an XML file", "give a JPEG, PNG, WebP or GIF image"},
    {"<!DOCTYPE html"sv, 0, "a web page", "download the image itself"},
    {"version https://git-lfs"sv, 0, "a pointer of Git LFS to an image", "fetch the image itself: git lfs pull"},
};

std::uint8_t byte_at(std::string_view bytes, std::size_t at) { return static_cast<std::uint8_t>(bytes[at]); }

bool is_bmp(std::string_view bytes) {
    static constexpr std::uint8_t header_sizes[] = {12, 16, 40, 52, 56, 64, 108, 124};
    return bytes.size() >= 18 && bytes.starts_with("BM") && bytes.substr(15, 3) == "\0\0\0"sv &&
           std::find(std::begin(header_sizes), std::end(header_sizes), byte_at(bytes, 14)) != std::end(header_sizes);
}

/// TGA has no magic bytes at its beginning: its header is plausible, or its end has the signature of version 2.
bool is_tga(std::string_view bytes) {
    if (bytes.ends_with("TRUEVISION-XFILE.\0"sv)) return true;
    if (bytes.size() < 18) return false;
    const std::uint8_t palette = byte_at(bytes, 1), kind = byte_at(bytes, 2), depth = byte_at(bytes, 16);
    const bool is_kind = (kind >= 1 && kind <= 3) || (kind >= 9 && kind <= 11);
    const bool has_size = bytes.substr(12, 2) != "\0\0"sv && bytes.substr(14, 2) != "\0\0"sv;
    const bool is_depth = depth == 8 || depth == 15 || depth == 16 || depth == 24 || depth == 32;
    return palette <= 1 && (kind == 1 || kind == 9) == (palette == 1) && is_kind && has_size && is_depth &&
           (byte_at(bytes, 17) & 0xC0U) == 0;
}

[[noreturn]] void refuse_foreign(std::string_view bytes, const Place& place) {
    const auto refuse_format = [&](const char* name, const char* remedy) {
        refuse(place, fmt::format("is {}, which is not read", name), remedy);
    };
    for (const ForeignFormat& format : foreign_formats)
        if (bytes.size() >= format.at && bytes.substr(format.at).starts_with(format.magic))
            refuse_format(format.name, format.remedy);
    if (is_bmp(bytes)) refuse_format("a BMP image", convert_image);
    if (is_tga(bytes)) refuse_format("a TGA image", convert_image);
    refuse(place, "is no JPEG, PNG, WebP or GIF image", "check that the file is an image, and convert it to PNG or JPEG");
}

std::string megabytes(double bytes) { return fmt::format("{:.0f} MB", std::ceil(bytes / 1e6)); }

}  // namespace

Place place_of(const std::string& name, const std::string& where) {
    if (name.empty() || where.ends_with(name)) return {where, "the image"};
    return {where, fmt::format("the image '{}'", printable(name, 200))};
}

void refuse(const Place& place, const std::string& problem, const std::string& remedy) {
    fail_input(place.where, fmt::format("{} {}", place.subject, problem), remedy);
}

void refuse_damaged(const Place& place, const std::string& message) {
    refuse(place, fmt::format("is damaged: {}", printable(message, 200)), save_again);
}

Header png_header(std::string_view bytes, const Place& place) {
    constexpr std::size_t header_end = 8 + 8 + 13 + 4;  // signature, length and name of the chunk, its data, its checksum
    if (bytes.size() < header_end) refuse_damaged(place, "the file ends within the header of a PNG");
    if (bytes.substr(8, 8) != "\0\0\0\x0dIHDR"sv) refuse_damaged(place, "the PNG does not begin with an IHDR chunk");
    const auto* chunk = reinterpret_cast<const Bytef*>(bytes.data() + 12);
    if (::crc32(0, chunk, 17) != big_endian(bytes, 29, 4)) refuse_damaged(place, "the checksum of the PNG's header is wrong");
    constexpr std::uint32_t max_side = 0x7FFFFFFF;
    return {ImageFormat::png, static_cast<int>(std::min(big_endian(bytes, 16, 4), max_side)),
            static_cast<int>(std::min(big_endian(bytes, 20, 4), max_side))};
}

Header gif_header(std::string_view bytes, const Place& place) {
    if (bytes.size() < 13) refuse_damaged(place, "the file ends within the header of a GIF");
    const auto side = [&](std::size_t at) { return byte_at(bytes, at) | byte_at(bytes, at + 1) << 8; };
    return {ImageFormat::gif, side(6), side(8)};
}

Header read_header(std::string_view bytes, const Place& place) {
    if (bytes.empty()) refuse(place, "is empty", "copy the image again from its source");
    Header header;
    if (bytes.starts_with(png_signature)) header = png_header(bytes, place);
    else if (bytes.starts_with("\xff\xd8\xff")) header = jpeg_header(bytes, place);
    else if (bytes.starts_with("RIFF") && bytes.size() >= 12 && bytes.substr(8, 4) == "WEBP") header = webp_header(bytes, place);
    else if (bytes.starts_with("GIF87a") || bytes.starts_with("GIF89a")) header = gif_header(bytes, place);
    else refuse_foreign(bytes, place);
    const std::string size = fmt::format("{} x {} pixels", header.width, header.height);
    if (header.width < 1 || header.height < 1) refuse_damaged(place, fmt::format("its header claims {}", size));
    if (header.width > max_image_side || header.height > max_image_side)
        refuse(place, fmt::format("has {}; the limit is {} in each direction", size, max_image_side), "reduce the image");
    if (static_cast<std::int64_t>(header.width) * header.height > max_image_pixels)
        refuse(place, fmt::format("has {}; the limit is {} million pixels", size, max_image_pixels >> 20), "reduce the image");
    return header;
}

void require_proportion(const Header& header, std::size_t file_bytes, double decoder_bytes, const Place& place) {
    const double pixel_bytes = 4.0 * header.width * header.height, allowed = 16.0 * static_cast<double>(file_bytes);
    constexpr double pixel_allowance = 256.0 * 1024 * 1024, total_allowance = 2 * pixel_allowance;
    const auto refuse_size = [&](double bytes, double limit) {
        refuse(place,
               fmt::format("claims {} x {} pixels, which need {} of memory; a file of {} may use {}", header.width, header.height,
                           megabytes(bytes), megabytes(static_cast<double>(file_bytes)), megabytes(limit)),
               header.format == ImageFormat::jpeg && decoder_bytes > 0 ? "save it as JPEG that is not progressive, or reduce it"
                                                                       : "reduce the image");
    };
    if (pixel_bytes > allowed + pixel_allowance) refuse_size(pixel_bytes, allowed + pixel_allowance);
    if (pixel_bytes + decoder_bytes > allowed + total_allowance)
        refuse_size(pixel_bytes + decoder_bytes, allowed + total_allowance);
    require_memory(pixel_bytes + decoder_bytes, fmt::format("{}: {}", place.where, place.subject), "reduce the image");
}

}  // namespace ostraka::images

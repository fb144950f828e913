// Small images in all formats.
#pragma once

#include "ostraka/image/image.h"

#include <cstdio>

#include <jpeglib.h>  // after cstdio
#include <png.h>

#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

namespace ostraka::test {

/// Pixels from a function of column and row.
inline Pixels painted(int width, int height, const std::function<std::array<std::uint8_t, 4>(int, int)>& pixel) {
    Pixels pixels{width, height, {}};
    for (int row = 0; row < height; ++row)
        for (int column = 0; column < width; ++column) pixels.rgba.push_back(pixel(column, row));
    return pixels;
}

/// A smooth picture, which lossy formats keep well.
inline Pixels gradient(int width, int height) {
    return painted(width, height, [&](int column, int row) {
        const auto along = [](int at, int count) { return static_cast<std::uint8_t>(255 * at / std::max(count - 1, 1)); };
        return std::array<std::uint8_t, 4>{along(column, width), along(row, height), 128, 255};
    });
}

/// Largest difference of two pictures of the same size in red, green, blue and alpha.
inline int largest_difference(const Pixels& p, const Pixels& q) {
    if (p.width != q.width || p.height != q.height || p.rgba.size() != q.rgba.size()) return 1000;
    int largest = 0;
    for (std::size_t i = 0; i < p.rgba.size(); ++i)
        for (std::size_t k = 0; k < 4; ++k) largest = std::max(largest, std::abs(p.rgba[i][k] - q.rgba[i][k]));
    return largest;
}

// ---- PNG ----

struct PngSample {
    int width = 8, height = 8, depth = 8, colour_type = PNG_COLOR_TYPE_RGB;
    bool interlaced = false;
    std::vector<std::string> rows;            ///< packed as in the file
    std::vector<png_color> palette;           ///< for palettes
    std::vector<png_byte> palette_alpha;      ///< tRNS of a palette
    std::optional<png_color_16> transparent;  ///< tRNS of grey and RGB
};

inline std::string png_bytes(PngSample sample) {
    std::string bytes;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    const auto append = [](png_structp writer, png_bytep data, png_size_t length) {
        static_cast<std::string*>(png_get_io_ptr(writer))->append(reinterpret_cast<const char*>(data), length);
    };
    png_set_write_fn(png, &bytes, append, [](png_structp) {});
    png_set_IHDR(png, info, static_cast<png_uint_32>(sample.width), static_cast<png_uint_32>(sample.height), sample.depth,
                 sample.colour_type, sample.interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    if (!sample.palette.empty()) png_set_PLTE(png, info, sample.palette.data(), static_cast<int>(sample.palette.size()));
    if (!sample.palette_alpha.empty())
        png_set_tRNS(png, info, sample.palette_alpha.data(), static_cast<int>(sample.palette_alpha.size()), nullptr);
    if (sample.transparent) png_set_tRNS(png, info, nullptr, 0, &*sample.transparent);
    png_set_gAMA(png, info, 1.0);  // not applied by readers of textures
    std::vector<png_bytep> rows;
    for (std::string& row : sample.rows) rows.push_back(reinterpret_cast<png_bytep>(row.data()));
    png_set_rows(png, info, rows.data());
    png_write_png(png, info, PNG_TRANSFORM_IDENTITY, nullptr);
    png_destroy_write_struct(&png, &info);
    return bytes;
}

// ---- JPEG ----

struct JpegSample {
    int channels = 3;  ///< 1: grey, 3: colours, 4: inks
    bool progressive = false, adobe = true, ycck = false;
    int restart = 0;  ///< blocks between restart markers
    int repeated_scans = 0;
};

/// A JPEG whose samples are `values(column, row)`, as stored in the file; sides are 32 x 24.
inline std::string jpeg_bytes(const JpegSample& sample, const std::function<std::array<std::uint8_t, 4>(int, int)>& values) {
    jpeg_compress_struct codec{};
    jpeg_error_mgr errors{};
    codec.err = jpeg_std_error(&errors);
    jpeg_create_compress(&codec);
    unsigned char* bytes = nullptr;
    unsigned long size = 0;
    jpeg_mem_dest(&codec, &bytes, &size);
    codec.image_width = 32;
    codec.image_height = 24;
    codec.input_components = sample.channels;
    codec.in_color_space = sample.channels == 1 ? JCS_GRAYSCALE : sample.channels == 3 ? JCS_RGB : JCS_CMYK;
    jpeg_set_defaults(&codec);
    if (sample.ycck) jpeg_set_colorspace(&codec, JCS_YCCK);
    jpeg_set_quality(&codec, 95, TRUE);
    codec.write_Adobe_marker = sample.channels == 4 && sample.adobe ? TRUE : FALSE;
    codec.restart_interval = static_cast<unsigned>(sample.restart);
    if (sample.progressive) jpeg_simple_progression(&codec);
    std::vector<jpeg_scan_info> scans;
    if (sample.repeated_scans > 0) {  // a progressive bomb: many scans of coefficients that are all 0
        jpeg_scan_info scan{};
        scan.comps_in_scan = sample.channels;
        for (int k = 0; k < sample.channels; ++k) scan.component_index[k] = k;
        scans.push_back(scan);
        for (int i = 0; i < sample.repeated_scans; ++i) {
            jpeg_scan_info one_component{};
            one_component.comps_in_scan = 1;
            one_component.component_index[0] = (i / 63) % sample.channels;
            one_component.Ss = one_component.Se = 1 + i % 63;
            scans.push_back(one_component);
        }
        codec.scan_info = scans.data();
        codec.num_scans = static_cast<int>(scans.size());
    }
    jpeg_start_compress(&codec, TRUE);
    for (int row = 0; row < 24; ++row) {
        std::vector<JSAMPLE> line;
        for (int column = 0; column < 32; ++column)
            for (int k = 0; k < sample.channels; ++k) line.push_back(values(column, row)[static_cast<std::size_t>(k)]);
        JSAMPROW pointer = line.data();
        jpeg_write_scanlines(&codec, &pointer, 1);
    }
    jpeg_finish_compress(&codec);
    jpeg_destroy_compress(&codec);
    std::string result(reinterpret_cast<const char*>(bytes), size);
    std::free(bytes);
    return result;
}

// ---- GIF ----

struct GifSample {
    int screen_width = 8, screen_height = 8;
    int left = 0, top = 0, width = 8, height = 8;
    bool interlaced = false;
    int transparent = -1;               ///< index of a colour
    std::vector<std::uint8_t> indices;  ///< below 64, in the order of the file
};

/// Colour of an index of the samples.
inline std::array<std::uint8_t, 4> gif_colour(int index) {
    return {static_cast<std::uint8_t>(4 * index), static_cast<std::uint8_t>(255 - index), 77, 255};
}

inline std::string gif_bytes(const GifSample& sample) {
    std::string bytes = "GIF89a";
    const auto put = [&](int value) { bytes += static_cast<char>(value); };
    const auto put_short = [&](int value) {
        put(value & 255);
        put(value >> 8);
    };
    put_short(sample.screen_width);
    put_short(sample.screen_height);
    for (const int value : {0x80 | 5, 0, 0}) put(value);  // a table of 64 colours
    for (int index = 0; index < 64; ++index)
        for (std::size_t k = 0; k < 3; ++k) put(gif_colour(index)[k]);
    if (sample.transparent >= 0)
        for (const int value : {0x21, 0xF9, 4, 1, 0, 0, sample.transparent, 0}) put(value);
    put(0x2C);
    for (const int value : {sample.left, sample.top, sample.width, sample.height}) put_short(value);
    put(sample.interlaced ? 0x40 : 0);
    put(6);  // bits of an index; codes of 7 bits, with a clear code before they grow
    std::string codes;
    unsigned waiting = 0, count = 0;
    const auto put_code = [&](unsigned code) {
        waiting |= code << count;
        for (count += 7; count >= 8; count -= 8, waiting >>= 8U) codes += static_cast<char>(waiting & 255U);
    };
    for (std::size_t i = 0; i < sample.indices.size(); ++i) {
        if (i % 32 == 0) put_code(64);
        put_code(sample.indices[i]);
    }
    put_code(65);
    codes += static_cast<char>(waiting);
    for (std::size_t i = 0; i < codes.size(); i += 200) {
        const std::string block = codes.substr(i, 200);
        put(static_cast<int>(block.size()));
        bytes += block;
    }
    put(0);
    put(0x3B);
    return bytes;
}

}  // namespace ostraka::test

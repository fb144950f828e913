// glTF files built in memory, and what a test compares of them.
#pragma once

#include "../../src/io/formats.h"
#include "ostraka/core/error.h"
#include "ostraka/io/glb.h"

#include <string>
#include <string_view>
#include <vector>

namespace ostraka::test {

/// A GLB file of this JSON and these bytes.
inline std::string glb_of(std::string json, const std::string& binary) {
    while (json.size() % 4 != 0) json += ' ';
    std::string padded = binary;
    padded.resize((binary.size() + 3) / 4 * 4);
    std::string file;
    for (const std::size_t word :
         {std::size_t{0x46546C67}, std::size_t{2}, 28 + json.size() + padded.size(), json.size(), std::size_t{0x4E4F534A}})
        glb::append(file, static_cast<std::uint32_t>(word));
    file += json;
    glb::append(file, static_cast<std::uint32_t>(padded.size()));
    glb::append(file, std::uint32_t{0x004E4942});
    return file + padded;
}

template <class Number>
std::string bytes_of(const std::vector<Number>& numbers) {
    std::string bytes;
    for (const Number number : numbers) glb::append(bytes, number);
    return bytes;
}

inline std::string base64_of(std::string_view bytes) {
    constexpr std::string_view alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        unsigned value = 0;
        for (std::size_t k = 0; k < 3; ++k)
            value = value << 8 | (i + k < bytes.size() ? static_cast<unsigned>(static_cast<unsigned char>(bytes[i + k])) : 0U);
        for (std::size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? alphabet[value >> (18 - 6 * k) & 63U] : '=';
    }
    return text;
}

/// Three corners of a right triangle as floats: 36 bytes.
inline std::string right_triangle() { return bytes_of<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}); }

/// The JSON of a file that shows one primitive; `rest`: further members of the root, each preceded by a comma.
inline std::string one_primitive(const std::string& primitive, const std::string& rest, const std::string& node = "") {
    return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0)" + node +
           R"(}],"meshes":[{"primitives":[)" + primitive + "]}]" + rest + "}";
}

/// Views that follow each other in buffer 0, of these sizes, and the buffer.
inline std::string views(const std::vector<std::size_t>& sizes) {
    std::string text = R"(,"bufferViews":[)";
    std::size_t offset = 0;
    for (const std::size_t size : sizes) {
        text += (offset > 0 ? ",{" : "{") + (R"("buffer":0,"byteOffset":)" + std::to_string(offset)) + R"(,"byteLength":)" +
                std::to_string(size) + "}";
        offset += size;
    }
    return text + R"(],"buffers":[{"byteLength":)" + std::to_string(offset) + "}]";
}

inline PolygonSoup read_memory(const std::string& bytes) { return io::read_gltf(bytes, "memory:file.glb"); }

/// The problem with which a file is refused; empty: it is read.
inline std::string problem_of(const std::string& bytes, const std::string& file = "memory:file.glb") {
    try {
        io::read_gltf(bytes, file);
    } catch (const Error& error) {
        return error.problem();
    }
    return {};
}

inline double area_of(const PolygonSoup& soup) {
    double sum = 0;
    for (std::size_t t = 0; t < soup.polygon_count(); ++t) {
        const auto &a = soup.points[soup.corners[3 * t]], &b = soup.points[soup.corners[3 * t + 1]],
                   &c = soup.points[soup.corners[3 * t + 2]];
        const Vector u(b[0] - a[0], b[1] - a[1], b[2] - a[2]), v(c[0] - a[0], c[1] - a[1], c[2] - a[2]);
        sum += std::sqrt(CGAL::cross_product(u, v).squared_length()) / 2;
    }
    return sum;
}

/// The triangles of a soup, for a writer.
inline TriangleSoup triangles_of(const PolygonSoup& soup) {
    TriangleSoup result;
    result.points = soup.points;
    for (std::size_t t = 0; t < soup.polygon_count(); ++t)
        result.triangles.push_back({soup.corners[3 * t], soup.corners[3 * t + 1], soup.corners[3 * t + 2]});
    return result;
}

}  // namespace ostraka::test

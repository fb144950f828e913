// 3MF files made in memory.
#pragma once

#include <zlib.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace ostraka::test {

/// A zip archive of parts (name, content). `claimed`: size that the archive claims for each part, or 0 for the true one.
inline std::string zip_of(const std::vector<std::pair<std::string, std::string>>& parts, std::uint32_t claimed = 0) {
    std::string bytes, directory;
    const auto number = [](std::uint64_t value, int size) {
        std::string text;
        for (int k = 0; k < size; ++k) text += static_cast<char>(value >> (8 * k) & 255U);
        return text;
    };
    for (const auto& [name, content] : parts) {
        std::string packed(compressBound(content.size()), '\0');
        z_stream stream{};
        deflateInit2(&stream, 9, Z_DEFLATED, -15, 9, Z_DEFAULT_STRATEGY);
        stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(content.data()));
        stream.avail_in = static_cast<uInt>(content.size());
        stream.next_out = reinterpret_cast<Bytef*>(packed.data());
        stream.avail_out = static_cast<uInt>(packed.size());
        deflate(&stream, Z_FINISH);
        packed.resize(stream.total_out);
        deflateEnd(&stream);
        const auto check = crc32(0, reinterpret_cast<const Bytef*>(content.data()), static_cast<uInt>(content.size()));
        const std::string fields = number(20, 2) + number(0, 2) + number(8, 2) + number(0, 4) + number(check, 4) +
                                   number(packed.size(), 4) + number(claimed > 0 ? claimed : content.size(), 4) +
                                   number(name.size(), 2) + number(0, 2);
        directory += "PK\1\2" + number(20, 2) + fields + number(0, 10) + number(bytes.size(), 4) + name;
        bytes += "PK\3\4" + fields + name + packed;
    }
    return bytes + directory + "PK\5\6" + number(0, 4) + number(parts.size(), 2) + number(parts.size(), 2) +
           number(directory.size(), 4) + number(bytes.size(), 4) + number(0, 2);
}

inline const std::string model_start =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"centimeter\" xmlns=\"core\" xmlns:m=\"material\">\n<resources>";
inline const std::string tetrahedron_mesh =
    "<mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/><vertex x=\"1\" y=\"0\" z=\"0\"/><vertex x=\"0\" y=\"1\" z=\"0\"/>"
    "<vertex x=\"0\" y=\"0\" z=\"1\"/></vertices>";

/// A tetrahedron with colours of a colour group and of base materials.
inline const std::string coloured_model =
    model_start +
    "<basematerials id=\"1\"><base name=\"clay\" displaycolor=\"#804020\"/></basematerials>"
    "<m:colorgroup id=\"2\"><m:color color=\"#FF000080\"/><m:color color=\"#00FF00\"/></m:colorgroup>"
    "<object id=\"3\" pid=\"1\" pindex=\"0\">" +
    tetrahedron_mesh +
    "<triangles><triangle v1=\"0\" v2=\"2\" v3=\"1\"/><triangle v1=\"0\" v2=\"1\" v3=\"3\" pid=\"2\" p1=\"0\"/>"
    "<triangle v1=\"1\" v2=\"2\" v3=\"3\" pid=\"2\" p1=\"1\" p2=\"1\" p3=\"1\"/>"
    "<triangle v1=\"2\" v2=\"0\" v3=\"3\" pid=\"2\" p1=\"1\" p2=\"0\" p3=\"1\"/></triangles></mesh></object>"
    "</resources><build><item objectid=\"3\"/></build></model>";

}  // namespace ostraka::test

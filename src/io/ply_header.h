// The header of a PLY file: elements and their properties, in the order of the file.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace ostraka::io {

/// Encoding of the numbers in a PLY file.
enum class PlyFormat { ascii, little_endian, big_endian };
/// Type of the numbers of a property.
enum class PlyType : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

std::size_t size_of(PlyType type);  ///< size of a number in bytes
/// True for floating-point types.
inline bool is_real(PlyType type) { return type >= PlyType::float32; }

/// A property that the header declares.
struct PlyProperty {
    std::string name;                     ///< name of the property
    PlyType type = PlyType::float32;      ///< type of the values
    bool is_list = false;                 ///< true: each element has a list of values
    PlyType count_type = PlyType::uint8;  ///< type of the number of values in a list
};

/// A type of elements that the header declares.
struct PlyElement {
    std::string name;                     ///< "vertex", "face" ...
    std::size_t count = 0;                ///< number of elements given in the header
    std::vector<PlyProperty> properties;  ///< properties of an element, in the order of the file
    /// Minimum size in bytes of one element in a file of this format.
    [[nodiscard]] std::size_t min_bytes(PlyFormat format) const;
};

/// The header of a PLY file.
struct PlyHeader {
    PlyFormat format = PlyFormat::ascii;
    std::vector<PlyElement> elements;        ///< element types in the order of the file
    std::size_t size = 0;                    ///< number of bytes before the first element
    std::vector<std::string> texture_files;  ///< images that comments "TextureFile NAME" name
    /// The element type of this name; null if there is none.
    [[nodiscard]] const PlyElement* find(std::string_view name) const;
};

/// Reads the header of a PLY file, which may follow a byte order mark. Throws Error (input) with the line of the header. Numbers
/// of elements are those given in the file, unchecked.
PlyHeader read_ply_header(std::string_view bytes, const std::string& file);

}  // namespace ostraka::io

// Container format and data tables of glTF 2.0 files: written as GLB, read as GLB or JSON.
#pragma once

#include "ostraka/files/json.h"

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ostraka::glb {

// Constants of glTF 2.0 (Khronos, sections 3.6, 3.7, 5.1, 5.11).
inline constexpr int signed_byte = 5120, byte = 5121, signed_short = 5122, short_word = 5123, word = 5125, single = 5126;
inline constexpr int array_buffer = 34962, element_array_buffer = 34963;  ///< targets of buffer views
/// Name of a member in the extras of a node. The member marks nodes whose only purpose is to display the mesh upright and in
/// metres.
inline constexpr const char* display_only = "ostraka-display";
inline constexpr int points_mode = 0, lines_mode = 1, triangles_mode = 4;  ///< modes of primitives
inline constexpr int strip_mode = 5, fan_mode = 6;                         ///< modes of primitives: triangle strip, triangle fan
/// Name of a member in the extras of a mesh whose triangles were sorted by material. Its value is the index of an accessor that
/// gives the original position of each triangle.
inline constexpr const char* triangle_order = "ostraka-triangles";
inline constexpr const char* meshopt_extension = "EXT_meshopt_compression";

/// Converts an sRGB colour channel (IEC 61966-2-1; 0 to 255) to a linear colour channel, because glTF vertex colours are linear
/// (section 3.7.2.1).
std::uint16_t linear_channel(std::size_t value);

/// Builds a GLB file with one buffer: collects buffer views and accessors. The bytes of a view are either stored in the
/// builder, or only announced; the caller then writes them after `head`, in the order of the views.
class Builder {
public:
    /// Every view and both chunks begin at a multiple of `alignment` bytes; some extensions require 8. `escapes`: true to escape
    /// the JSON chunk so that it can be embedded in an HTML page.
    explicit Builder(std::size_t alignment = 4, bool escapes = false);
    JsonAllocator& allocator() { return document_.GetAllocator(); }
    Json& document() { return document_; }  ///< the JSON chunk, to be completed by the caller

    /// Adds a buffer view with these bytes and returns its index; target or stride 0: omitted.
    int add_view(const std::string& bytes, int target = 0, int stride = 0);
    /// Adds a buffer view with these bytes and an accessor for it; returns the index of the accessor.
    int add_accessor(const std::string& bytes, int target, int stride, int component, std::size_t count, const char* type,
                     JsonValue* min = nullptr, JsonValue* max = nullptr);
    /// Adds an accessor for a new view of `size` bytes (a multiple of the alignment) that the caller writes; returns the index of
    /// the accessor.
    int announce_accessor(std::size_t size, int target, int component, std::size_t count, const char* type,
                          JsonValue* min = nullptr, JsonValue* max = nullptr);
    /// Adds a view of `size` bytes that the caller writes, followed by zeros up to the alignment; returns its index.
    int announce_view(std::size_t size) { return view(size, 0, 0); }
    /// Data of an encoded view (EXT_meshopt_compression).
    struct Compressed {
        const std::string& bytes;   ///< encoded data
        std::size_t count, stride;  ///< number of elements; bytes per decoded element
        const char* mode;           ///< "ATTRIBUTES", "TRIANGLES" or "INDICES"
    };
    /// Adds an encoded view and an accessor for it; returns the index of the accessor.
    int add_compressed_accessor(const Compressed& data, int target, int component, std::size_t count, const char* type,
                                JsonValue* min = nullptr, JsonValue* max = nullptr);
    /// Marks the integers of the accessor as normalised to the range 0 to 1.
    void mark_normalised(int accessor);
    /// Returns the first part of the file, up to the first byte of the buffer. Throws Error (failure), naming `where`, if the
    /// file exceeds four gigabytes.
    std::string head(const std::string& where, const std::string& remedy);
    /// The complete file; all views must have been added with their bytes.
    std::string finish(const std::string& where, const std::string& remedy) { return head(where, remedy) + binary_; }

private:
    int view(std::size_t size, int target, int stride);
    int accessor(int view, int component, std::size_t count, const char* type, JsonValue* min, JsonValue* max);

    Json document_;
    JsonValue views_{rapidjson::kArrayType}, accessors_{rapidjson::kArrayType};
    std::string binary_;
    std::size_t alignment_, size_ = 0;
    /// Size of the virtual buffer that decoded views refer to, which is not written.
    std::size_t decoded_size_ = 0;
    bool escapes_;
};

/// Throws Error (failure) if a file of `bytes` bytes exceeds the limit of the GLB format.
void check_size(std::size_t bytes, const std::string& where, const std::string& remedy);

/// Appends the bytes of a value (little-endian).
template <class T>
void append(std::string& bytes, T value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// Content of a data URI (RFC 2397), in base64 or percent-encoded; nullopt if the text is not a data URI or cannot be decoded.
std::optional<std::string> content_of_data_uri(std::string_view uri);

/// A parsed glTF file; every access is checked against the sizes in the file. Throws Error (input) with the file and the JSON
/// pointer.
class Reader {
public:
    /// A GLB file with all its data inside.
    Reader(const std::string& bytes, const std::string& where);
    /// Returns the content of a file beside the glTF file, named by the URI of a buffer. Throws Error (input) if there is none.
    using FileReader = std::function<std::string(const std::string& uri)>;
    /// Reads a GLB file, or a glTF file in JSON whose buffers may be separate files. The limit of memory per byte of the file
    /// is higher than with the other constructor. `bytes` must live as long as the reader.
    Reader(const std::string& bytes, const std::string& where, FileReader file_reader);

    [[nodiscard]] const Json& document() const { return document_; }   ///< the JSON chunk
    [[nodiscard]] const std::string& where() const { return where_; }  ///< name of the file in messages
    /// Throws Error (input) with the file and the JSON pointer.
    [[noreturn]] void fail(const std::string& pointer, const std::string& problem) const;

    /// A non-negative integer member of an object, or `fallback` if it is missing.
    [[nodiscard]] std::size_t number(const JsonValue& object, const char* name, const std::string& pointer,
                                     std::size_t fallback) const;
    /// Element `index` of the list of this name in the root object of the JSON chunk.
    [[nodiscard]] const JsonValue& element(const char* list, std::size_t index, const std::string& pointer) const;

    /// Bytes of a buffer view, decoded if it is compressed (EXT_meshopt_compression).
    [[nodiscard]] std::string_view view(std::size_t index, const std::string& pointer) const;

    /// Number and type of the elements of an accessor.
    struct Shape {
        std::size_t count = 0;    ///< number of elements
        std::size_t width = 0;    ///< numbers per element
        int component = 0;        ///< component type
        bool normalised = false;  ///< true: integers represent fractions of their largest value
    };
    [[nodiscard]] Shape shape(std::size_t index, const std::string& pointer) const;
    /// The numbers of an accessor: `width` numbers per element, consecutively; normalised integers as fractions (section 3.11).
    using Values = std::shared_ptr<const std::vector<double>>;
    /// Reads an accessor with `width` numbers per element. The accessor may be sparse or have no data (all numbers are then
    /// zero). Each accessor is read only once, even if it is referenced several times.
    [[nodiscard]] Values accessor(std::size_t index, std::size_t width, const std::string& pointer) const;
    /// Numbers of single precision where they lie in the file; `bytes` lives as long as the reader.
    struct Floats {
        const char* bytes = nullptr;  ///< first number of the first element
        std::size_t stride = 0;       ///< bytes from one element to the next
        std::size_t count = 0;        ///< number of elements
    };
    /// The numbers of an accessor with `width` numbers per element, without copying them; nothing if they are stored otherwise
    /// than as single precision, or sparse.
    [[nodiscard]] std::optional<Floats> floats(std::size_t index, std::size_t width, const std::string& pointer) const;
    /// Reads an accessor with one unsigned integer per element.
    [[nodiscard]] std::vector<std::uint32_t> integers(std::size_t index, const std::string& pointer) const;

    /// Adds `bytes` to the memory used so far; to be called before an allocation. Throws Error (input), with the JSON pointer,
    /// if the file would exhaust the memory because it references the same data very often or is compressed extremely.
    void charge(double bytes, const std::string& pointer) const;

private:
    struct Stored;
    void parse_container(std::string_view contents);
    void check_version() const;
    [[nodiscard]] std::string_view buffer(std::size_t index, const std::string& pointer) const;
    [[nodiscard]] std::string_view part(const JsonValue& entry, const std::string& pointer) const;
    [[nodiscard]] std::string decoded(const JsonValue& compressed, const std::string& pointer) const;
    [[nodiscard]] Stored stored(const JsonValue& accessor, const Shape& shape, const std::string& pointer) const;
    template <class Number>
    void read(std::size_t index, const Shape& shape, std::vector<Number>& values) const;
    template <class Number>
    void read_sparse(const JsonValue& sparse, const Shape& shape, const std::string& pointer, std::vector<Number>& values) const;

    std::string where_;
    std::string_view binary_;
    FileReader file_reader_;
    Json document_;
    mutable double allowed_ = 0;
    mutable double charged_ = 0;
    mutable std::map<std::size_t, std::string> buffers_;  ///< contents of buffers that are not the binary chunk
    mutable std::map<std::size_t, std::string> decoded_;  ///< decoded bytes of compressed views
    mutable std::map<std::pair<std::size_t, std::size_t>, Values> read_;
};

}  // namespace ostraka::glb

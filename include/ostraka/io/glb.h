// Container format and data tables of binary glTF 2.0 files.
#pragma once

#include "ostraka/files/json.h"

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace ostraka::glb {

// Constants of glTF 2.0 (Khronos, sections 3.6, 3.7, 5.1, 5.11).
inline constexpr int signed_byte = 5120, byte = 5121, signed_short = 5122, short_word = 5123, word = 5125, single = 5126;
inline constexpr int array_buffer = 34962, element_array_buffer = 34963;
/// Marks a node, in its extras, whose only purpose is to display the mesh upright and in metres.
inline constexpr const char* display_only = "ostraka-display";
inline constexpr int points_mode = 0, lines_mode = 1, triangles_mode = 4;

/// Converts an sRGB channel (IEC 61966-2-1; 0 to 255) to a linear one: glTF vertex colours are linear (section 3.7.2.1).
std::uint16_t linear_channel(std::size_t value);

/// Collects buffer views and accessors of one buffer. Their bytes are either stored and become part of a complete file, or only
/// announced and written by the caller after the header, in the order of the views.
class Builder {
public:
    /// Every view and both chunks begin at a multiple of `alignment`; some extensions require 8. With `escapes`, the JSON chunk
    /// can be embedded in an HTML page.
    explicit Builder(std::size_t alignment = 4, bool escapes = false);
    JsonAllocator& allocator() { return document_.GetAllocator(); }
    Json& document() { return document_; }

    /// Index of a new view; target or stride 0: omitted.
    int add_view(const std::string& bytes, int target = 0, int stride = 0);
    /// Index of a new accessor over a new view.
    int add_accessor(const std::string& bytes, int target, int stride, int component, std::size_t count, const char* type,
                     JsonValue* min = nullptr, JsonValue* max = nullptr);
    /// As above, for a view of `size` bytes (a multiple of the alignment) that the caller writes.
    int announce_accessor(std::size_t size, int target, int component, std::size_t count, const char* type,
                          JsonValue* min = nullptr, JsonValue* max = nullptr);
    /// An encoded view (EXT_meshopt_compression) that decodes to `count` elements of `stride` bytes.
    struct Compressed {
        const std::string& bytes;
        std::size_t count, stride;
        const char* mode;  ///< "ATTRIBUTES", "TRIANGLES" or "INDICES"
    };
    int add_compressed_accessor(const Compressed& data, int target, int component, std::size_t count, const char* type,
                                JsonValue* min = nullptr, JsonValue* max = nullptr);
    /// Marks the integers of the accessor as normalised to the range 0 to 1.
    void mark_normalised(int accessor);
    /// The file up to the first byte of the buffer. Throws Error (failure), naming `where`, if the file exceeds four gigabytes.
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
    std::size_t decoded_size_ = 0;  ///< size of the virtual buffer that decoded views refer to; it is not written
    bool escapes_;
};

/// Throws Error (failure) if a file of this size exceeds the limit of the format.
void check_size(std::size_t bytes, const std::string& where, const std::string& remedy);

template <class T>
void append(std::string& bytes, T value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// A parsed file; every access is checked against the sizes in the file. Throws Error (input) with the file and the JSON
/// pointer.
class Reader {
public:
    Reader(const std::string& bytes, const std::string& where);

    [[nodiscard]] const Json& document() const { return document_; }
    [[nodiscard]] const std::string& where() const { return where_; }
    [[noreturn]] void fail(const std::string& pointer, const std::string& problem) const;

    /// A non-negative integer member of an object, or `fallback` if it is missing.
    [[nodiscard]] std::size_t number(const JsonValue& object, const char* name, const std::string& pointer,
                                     std::size_t fallback) const;
    /// Element `index` of a list in the root object.
    [[nodiscard]] const JsonValue& element(const char* list, std::size_t index, const std::string& pointer) const;

    [[nodiscard]] std::string_view view(std::size_t index, const std::string& pointer) const;
    /// `width` numbers per element, consecutively. Each accessor is read only once, however often it is referenced.
    using Values = std::shared_ptr<const std::vector<double>>;
    [[nodiscard]] Values accessor(std::size_t index, std::size_t width, const std::string& pointer) const;

    /// To be called before memory is allocated. Refuses files that reference the same data so often that memory would be
    /// exhausted; the error has the JSON pointer.
    void charge(double bytes, const std::string& pointer) const;

private:
    [[nodiscard]] std::vector<double> read_accessor(std::size_t index, std::size_t width, const std::string& pointer) const;

    std::string where_;
    std::string_view binary_;
    Json document_;
    double allowed_ = 0;
    mutable double charged_ = 0;
    mutable std::map<std::pair<std::size_t, std::size_t>, Values> read_;
};

}  // namespace ostraka::glb

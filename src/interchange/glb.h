// The container and the tables of glTF 2.0 binary files.
#pragma once

#include "ostraka/core/json.h"

#include <cstdint>
#include <string>
#include <vector>

namespace ostraka::exchange::glb {

// Constants of glTF 2.0 (Khronos, sections 3.6, 3.7, 5.1, 5.11).
inline constexpr int signed_byte = 5120, byte = 5121, signed_short = 5122, short_word = 5123, word = 5125, single = 5126;
inline constexpr int array_buffer = 34962, element_array_buffer = 34963;
/// In the extras of a node that only shows the mesh upright and in metres.
inline constexpr const char* display_only = "ostraka-display";
inline constexpr int points_mode = 0, lines_mode = 1, triangles_mode = 4;

/// Collects buffer views and accessors over one buffer. Every view begins at a multiple of eight bytes.
class Builder {
public:
    Builder();
    JsonAllocator& allocator() { return document_.GetAllocator(); }
    Json& document() { return document_; }

    /// Index of a new view; target 0: none, stride 0: none.
    int add_view(const std::string& bytes, int target = 0, int stride = 0);
    /// Index of a new accessor over a new view.
    int add_accessor(const std::string& bytes, int target, int stride, int component, std::size_t count, const char* type,
                     JsonValue* min = nullptr, JsonValue* max = nullptr);
    /// Whole numbers of the accessor stand for 0 to 1.
    void mark_normalised(int accessor);
    /// The whole file; the binary chunk begins at a multiple of eight. `where` stands in errors.
    std::string finish(const std::string& where);

private:
    Json document_;
    JsonValue views_{rapidjson::kArrayType}, accessors_{rapidjson::kArrayType};
    std::string binary_;
};

template <class T>
void append(std::string& bytes, T value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// A file taken apart; every access is checked against the sizes of the file. Errors (input) name the file and the JSON pointer.
class Reader {
public:
    Reader(const std::string& bytes, const std::string& where);

    [[nodiscard]] const Json& document() const { return document_; }
    [[nodiscard]] const std::string& where() const { return where_; }
    [[noreturn]] void fail(const std::string& pointer, const std::string& what) const;

    /// The member of an object that is a whole number from 0, or `fallback`.
    [[nodiscard]] std::size_t number(const JsonValue& object, const char* name, const std::string& pointer,
                                     std::size_t fallback) const;
    /// Element `index` of a list in the root.
    [[nodiscard]] const JsonValue& element(const char* list, std::size_t index, const std::string& pointer) const;

    [[nodiscard]] std::string_view view(std::size_t index, const std::string& pointer) const;
    /// `width` numbers for each element, one after the other.
    [[nodiscard]] std::vector<double> accessor(std::size_t index, std::size_t width, const std::string& pointer) const;

private:
    std::string where_;
    std::string_view binary_;
    Json document_;
};

}  // namespace ostraka::exchange::glb

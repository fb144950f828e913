#include "ostraka/io/glb.h"

#include "ostraka/core/error.h"
#include "ostraka/files/json_build.h"
#include "ostraka/files/markup.h"
#include "ostraka/files/provenance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace ostraka::glb {

namespace {

constexpr std::uint32_t magic = 0x46546C67, json_chunk = 0x4E4F534A, binary_chunk = 0x004E4942;

}  // namespace

std::uint16_t linear_channel(std::size_t value) {
    static const auto table = [] {
        std::array<std::uint16_t, 256> values{};
        for (std::size_t i = 0; i < values.size(); ++i) {
            const double s = static_cast<double>(i) / 255;
            const double linear = s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
            values[i] = static_cast<std::uint16_t>(std::lround(65535 * linear));
        }
        return values;
    }();
    return table.at(value);
}

void check_size(std::size_t bytes, const std::string& where, const std::string& remedy) {
    if (bytes > std::numeric_limits<std::uint32_t>::max())
        fail_work(where, "would exceed the four gigabytes of a GLB file", remedy);
}

Builder::Builder(std::size_t alignment, bool escapes) : alignment_(alignment), escapes_(escapes) {
    document_.SetObject();
    add_members(document_, allocator(), "asset", json_object(allocator(), "version", "2.0", "generator", "ostraka " + version()));
}

int Builder::view(std::size_t size, int target, int stride) {
    size_ = (size_ + alignment_ - 1) / alignment_ * alignment_;
    JsonValue entry = json_object(allocator(), "buffer", 0, "byteOffset", size_, "byteLength", size);
    add_nonempty_members(entry, allocator(), "byteStride", stride, "target", target);
    size_ += size;
    views_.PushBack(entry, allocator());
    return static_cast<int>(views_.Size()) - 1;
}

int Builder::accessor(int view, int component, std::size_t count, const char* type, JsonValue* min, JsonValue* max) {
    JsonValue entry = json_object(allocator(), "bufferView", view, "componentType", component, "count", count, "type", type);
    if (min != nullptr) add_member(entry, "min", std::move(*min), allocator());
    if (max != nullptr) add_member(entry, "max", std::move(*max), allocator());
    accessors_.PushBack(entry, allocator());
    return static_cast<int>(accessors_.Size()) - 1;
}

int Builder::add_view(const std::string& bytes, int target, int stride) {
    const int added = view(std::max<std::size_t>(bytes.size(), 1), target, stride);  // a view must have at least one byte
    binary_.resize((binary_.size() + alignment_ - 1) / alignment_ * alignment_, '\0');
    binary_ += bytes.empty() ? std::string(1, '\0') : bytes;
    return added;
}

int Builder::add_accessor(const std::string& bytes, int target, int stride, int component, std::size_t count, const char* type,
                          JsonValue* min, JsonValue* max) {
    return accessor(add_view(bytes, target, stride), component, count, type, min, max);
}

int Builder::add_compressed_accessor(const Compressed& data, int target, int component, std::size_t count, const char* type,
                                     JsonValue* min, JsonValue* max) {
    const int stored = add_view(data.bytes);
    JsonValue& entry = views_[static_cast<rapidjson::SizeType>(stored)];
    JsonValue packed(entry, allocator());
    const bool attributes = std::string_view(data.mode) == "ATTRIBUTES";
    add_members(packed, allocator(), "byteStride", data.stride, "count", data.count, "mode", data.mode);
    entry = json_object(allocator(), "buffer", 1, "byteOffset", decoded_size_, "byteLength", data.count * data.stride,
                        "extensions", json_object(allocator(), meshopt_extension, std::move(packed)));
    add_nonempty_members(entry, allocator(), "byteStride", attributes ? static_cast<int>(data.stride) : 0, "target", target);
    decoded_size_ += (data.count * data.stride + 7) / 8 * 8;
    return accessor(stored, component, count, type, min, max);
}

int Builder::announce_accessor(std::size_t size, int target, int component, std::size_t count, const char* type, JsonValue* min,
                               JsonValue* max) {
    return accessor(view(size, target, 0), component, count, type, min, max);
}

void Builder::mark_normalised(int accessor) {
    add_members(accessors_[static_cast<rapidjson::SizeType>(accessor)], allocator(), "normalized", true);
}

std::string Builder::head(const std::string& where, const std::string& remedy) {
    size_ = (size_ + alignment_ - 1) / alignment_ * alignment_;
    binary_.resize((binary_.size() + alignment_ - 1) / alignment_ * alignment_, '\0');  // views that were only announced follow
    JsonValue buffers = json_list_of(json_object(allocator(), "byteLength", size_), allocator());
    if (decoded_size_ > 0) {
        JsonValue none = json_object(allocator(), meshopt_extension, json_object(allocator(), "fallback", true));
        buffers.PushBack(json_object(allocator(), "byteLength", decoded_size_, "extensions", std::move(none)), allocator());
    }
    add_members(document_, allocator(), "accessors", std::move(accessors_), "bufferViews", std::move(views_), "buffers",
                std::move(buffers));
    std::string json = to_compact_text(document_);
    if (escapes_) json = with_markup_escaped(json);
    while ((12 + 8 + json.size() + 8) % alignment_ != 0) json += ' ';
    const std::size_t total = 12 + 8 + json.size() + 8 + size_;
    check_size(total, where, remedy);
    std::string file;
    for (const std::uint32_t w :
         {magic, 2U, static_cast<std::uint32_t>(total), static_cast<std::uint32_t>(json.size()), json_chunk})
        append(file, w);
    file += json;
    append(file, static_cast<std::uint32_t>(size_));
    append(file, binary_chunk);
    return file;
}

}  // namespace ostraka::glb

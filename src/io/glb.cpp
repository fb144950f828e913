#include "ostraka/io/glb.h"

#include "ostraka/core/error.h"
#include "ostraka/core/text.h"
#include "ostraka/files/json_build.h"
#include "ostraka/files/markup.h"
#include "ostraka/files/provenance.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

namespace ostraka::glb {

namespace {

constexpr std::uint32_t magic = 0x46546C67, json_chunk = 0x4E4F534A, binary_chunk = 0x004E4942;

template <class T>
T value_at(std::string_view bytes, std::size_t offset) {
    T value;
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
}

/// A component type of accessors.
struct Component {
    std::size_t kind, size;
    double (*number_at)(std::string_view bytes, std::size_t offset);
};
template <class T>
constexpr Component component(int kind) {
    return {static_cast<std::size_t>(kind), sizeof(T),
            [](std::string_view bytes, std::size_t offset) { return static_cast<double>(value_at<T>(bytes, offset)); }};
}
constexpr std::array components{component<std::int8_t>(signed_byte),   component<std::uint8_t>(byte),
                                component<std::int16_t>(signed_short), component<std::uint16_t>(short_word),
                                component<std::uint32_t>(word),        component<float>(single)};

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
                        "extensions", json_object(allocator(), "EXT_meshopt_compression", std::move(packed)));
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
    if (!binary_.empty()) binary_.resize(size_, '\0');
    JsonValue buffers = json_list_of(json_object(allocator(), "byteLength", size_), allocator());
    if (decoded_size_ > 0) {
        JsonValue none = json_object(allocator(), "EXT_meshopt_compression", json_object(allocator(), "fallback", true));
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

Reader::Reader(const std::string& bytes, const std::string& where)
    : where_(where), allowed_(6.0 * static_cast<double>(bytes.size()) + 128e6) {
    const std::string_view contents(bytes);
    const auto damaged = [&](const std::string& problem) { fail_input(where_, problem, "give a binary glTF 2.0 file (.glb)"); };
    if (contents.size() < 20 || value_at<std::uint32_t>(contents, 0) != magic) damaged("is not a GLB file");
    if (value_at<std::uint32_t>(contents, 4) != 2)
        damaged("has glTF version " + std::to_string(value_at<std::uint32_t>(contents, 4)));
    if (value_at<std::uint32_t>(contents, 8) > contents.size())
        damaged("is truncated: its header states more bytes than the file has");
    const std::size_t end = value_at<std::uint32_t>(contents, 8);
    bool has_json = false;
    for (std::size_t at = 12; at + 8 <= end;) {
        const std::size_t length = value_at<std::uint32_t>(contents, at);
        const std::uint32_t kind = value_at<std::uint32_t>(contents, at + 4);
        if (length > end - at - 8) damaged("a chunk is longer than the file");
        const std::string_view chunk = contents.substr(at + 8, length);
        if (!has_json && kind != json_chunk) damaged("the first chunk is not JSON");
        if (!has_json) document_ = parse_json(chunk, where_ + ", JSON chunk");
        else if (kind == binary_chunk && binary_.empty()) binary_ = chunk;
        has_json = true;
        at += 8 + (length + 3) / 4 * 4;
    }
    if (!has_json || !document_.IsObject()) damaged("has no JSON chunk with an object");
}

void Reader::fail(const std::string& pointer, const std::string& problem) const {
    fail_input(where_, fmt::format("at {}: {}", pointer, problem), "correct or regenerate the file");
}

std::size_t Reader::number(const JsonValue& object, const char* name, const std::string& pointer, std::size_t fallback) const {
    const JsonValue* value = find_member(object, name);
    if (value == nullptr) return fallback;
    if (!value->IsUint()) fail(pointer + "/" + name, "is not a non-negative integer");
    return value->GetUint();
}

const JsonValue& Reader::element(const char* list_name, std::size_t index, const std::string& pointer) const {
    const JsonValue* list = find_member(document_, list_name);
    if (list == nullptr || !list->IsArray() || index >= list->Size() ||
        !(*list)[static_cast<rapidjson::SizeType>(index)].IsObject())
        fail(pointer, fmt::format("refers to element {} of {}, which does not exist", index, list_name));
    return (*list)[static_cast<rapidjson::SizeType>(index)];
}

std::string_view Reader::view(std::size_t index, const std::string& pointer) const {
    const JsonValue& entry = element("bufferViews", index, pointer);
    const std::string entry_pointer = "/bufferViews/" + std::to_string(index);
    if (number(entry, "buffer", entry_pointer, 1) != 0) fail(entry_pointer + "/buffer", "is not the file's own buffer");
    const JsonValue& buffer = element("buffers", 0, entry_pointer);
    if (find_member(buffer, "uri") != nullptr) fail("/buffers/0/uri", "external data is not supported");
    const std::size_t offset = number(entry, "byteOffset", entry_pointer, 0),
                      length = number(entry, "byteLength", entry_pointer, 0);
    if (offset > binary_.size() || length > binary_.size() - offset) fail(entry_pointer, "exceeds the buffer");
    return binary_.substr(offset, length);
}

void Reader::charge(double bytes, const std::string& pointer) const {
    charged_ += bytes;
    if (charged_ > allowed_)
        fail_input(where_,
                   fmt::format("at {}: the file would take more than {} MB, many times its size, because its parts refer to the "
                               "same data repeatedly",
                               pointer, digits(allowed_ / 1e6, 3)),
                   "export each surface once, without copies of it");
}

Reader::Values Reader::accessor(std::size_t index, std::size_t width, const std::string& pointer) const {
    Values& values = read_[{index, width}];
    if (!values) values = std::make_shared<const std::vector<double>>(read_accessor(index, width, pointer));
    return values;
}

std::vector<double> Reader::read_accessor(std::size_t index, std::size_t width, const std::string& pointer) const {
    const JsonValue& entry = element("accessors", index, pointer);
    const std::string entry_pointer = "/accessors/" + std::to_string(index);
    if (find_member(entry, "sparse") != nullptr) fail(entry_pointer + "/sparse", "sparse accessors are not supported");
    const std::string type = text_in(entry, "type");
    const std::size_t type_width = type == "SCALAR" ? 1 : type == "VEC2" ? 2 : type == "VEC3" ? 3 : type == "VEC4" ? 4 : 0;
    if (type_width != width)
        fail(entry_pointer + "/type", fmt::format("'{}' is not the expected type", without_controls(type, " ").substr(0, 20)));
    const std::size_t kind = number(entry, "componentType", entry_pointer, 0);
    const auto* const stored_type =
        std::find_if(components.begin(), components.end(), [&](const Component& candidate) { return candidate.kind == kind; });
    if (stored_type == components.end()) fail(entry_pointer + "/componentType", "is not a known component type");
    const std::size_t view_index = number(entry, "bufferView", entry_pointer, static_cast<std::size_t>(-1));
    if (view_index == static_cast<std::size_t>(-1)) fail(entry_pointer, "has no bufferView");
    const std::string_view bytes = view(view_index, entry_pointer);
    const std::size_t element_size = stored_type->size * width;
    const std::size_t stride = number(element("bufferViews", view_index, entry_pointer), "byteStride",
                                      "/bufferViews/" + std::to_string(view_index), element_size);
    const std::size_t offset = number(entry, "byteOffset", entry_pointer, 0), count = number(entry, "count", entry_pointer, 0);
    if (stride < element_size || stride > 252) fail(entry_pointer, "has a stride that does not fit");
    if (count == 0) return {};
    if (offset > bytes.size() || element_size > bytes.size() - offset ||
        (count - 1) > (bytes.size() - offset - element_size) / stride)
        fail(entry_pointer, "exceeds its bufferView");
    charge(8.0 * static_cast<double>(count * width), entry_pointer);
    std::vector<double> values;
    values.reserve(count * width);
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t k = 0; k < width; ++k)
            values.push_back(stored_type->number_at(bytes, offset + i * stride + k * stored_type->size));
    return values;
}

}  // namespace ostraka::glb

// The container of a glTF file: chunks, buffers and buffer views.
#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"
#include "ostraka/io/glb.h"

#include <fmt/core.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace ostraka::glb {

namespace {

constexpr std::uint32_t glb_magic = 0x46546C67, json_kind = 0x4E4F534A, binary_kind = 0x004E4942;

std::uint32_t word_at(std::string_view bytes, std::size_t offset) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
}

/// The six bits that a character of base64 stands for (RFC 4648, also its alphabet for URLs); -1 for other characters.
int bits_of_base64(char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    if (c == '+' || c == '-') return 62;
    return c == '/' || c == '_' ? 63 : -1;
}

std::optional<std::string> decoded_base64(std::string_view text) {
    while (text.ends_with('=')) text.remove_suffix(1);
    std::string bytes;
    bytes.reserve(text.size() / 4 * 3 + 3);
    std::uint32_t collected = 0;
    int count = 0;
    for (const char c : text) {
        if (c == ' ' || c == '\t' || c == '\r' || c == '\n') continue;
        const int bits = bits_of_base64(c);
        if (bits < 0) return std::nullopt;
        collected = collected << 6 | static_cast<std::uint32_t>(bits);
        count += 6;
        if (count < 8) continue;
        count -= 8;
        bytes.push_back(static_cast<char>(collected >> count & 255));
    }
    return bytes;
}

std::optional<std::string> decoded_percent(std::string_view text) {
    const auto digit = [](char c) {
        return c >= '0' && c <= '9' ? c - '0' : c >= 'A' && c <= 'F' ? c - 'A' + 10 : c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
    };
    std::string bytes;
    bytes.reserve(text.size());
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '%') {
            bytes.push_back(text[i]);
            continue;
        }
        if (text.size() - i < 3 || digit(text[i + 1]) < 0 || digit(text[i + 2]) < 0) return std::nullopt;
        bytes.push_back(static_cast<char>(16 * digit(text[i + 1]) + digit(text[i + 2])));
        i += 2;
    }
    return bytes;
}

/// The JSON text of a glTF file, from its first brace; empty if the file is something else.
std::string_view json_text(std::string_view contents) {
    if (contents.starts_with("\xEF\xBB\xBF")) contents.remove_prefix(3);
    const std::size_t first = contents.find_first_not_of(" \t\r\n");
    if (first == std::string_view::npos || contents[first] != '{') return {};
    return contents.substr(first);
}

[[noreturn]] void refuse_first_version(const std::string& where) {
    fail_input(where, "is a glTF 1.0 file; only glTF 2.0 is read, which replaced it in 2017",
               "convert it to glTF 2.0, for example with the program gltf-pipeline");
}

/// The extension of this name in the extensions of a JSON object; null: none.
const JsonValue* extension_of(const JsonValue& object, const char* name) {
    const JsonValue* extensions = find_member(object, "extensions");
    const JsonValue* extension = extensions == nullptr ? nullptr : find_member(*extensions, name);
    return extension != nullptr && extension->IsObject() ? extension : nullptr;
}

}  // namespace

std::optional<std::string> content_of_data_uri(std::string_view uri) {
    const std::size_t comma = uri.find(',');
    if (comma == std::string_view::npos || lower_case(uri.substr(0, 5)) != "data:") return std::nullopt;
    const std::string_view kind = uri.substr(0, comma), data = uri.substr(comma + 1);
    return lower_case(kind).ends_with(";base64") ? decoded_base64(data) : decoded_percent(data);
}

Reader::Reader(const std::string& bytes, const std::string& where)
    : where_(where), allowed_(6.0 * static_cast<double>(bytes.size()) + 128e6) {
    parse_container(bytes);
}

Reader::Reader(const std::string& bytes, const std::string& where, FileReader file_reader)
    : where_(where), file_reader_(std::move(file_reader)), allowed_(13.0 * static_cast<double>(bytes.size()) + 200e6) {
    if (const std::string_view text = json_text(bytes); !text.empty()) document_ = parse_json(text, where_);
    else parse_container(bytes);
    check_version();
}

void Reader::parse_container(std::string_view contents) {
    const auto damaged = [&](const std::string& problem) { fail_input(where_, problem, "give a binary glTF 2.0 file (.glb)"); };
    if (contents.size() < 20 || word_at(contents, 0) != glb_magic)
        damaged(file_reader_ ? "is neither a GLB file nor a glTF file in JSON" : "is not a GLB file");
    if (word_at(contents, 4) == 1) refuse_first_version(where_);
    if (word_at(contents, 4) != 2) damaged("has glTF version " + std::to_string(word_at(contents, 4)));
    if (word_at(contents, 8) > contents.size()) damaged("is truncated: its header states more bytes than the file has");
    const std::size_t end = word_at(contents, 8);
    bool has_json = false;
    for (std::size_t at = 12; at + 8 <= end;) {
        const std::size_t length = word_at(contents, at);
        const std::uint32_t kind = word_at(contents, at + 4);
        if (length > end - at - 8) damaged("a chunk is longer than the file");
        const std::string_view chunk = contents.substr(at + 8, length);
        if (!has_json && kind != json_kind) damaged("the first chunk is not JSON");
        if (!has_json) document_ = parse_json(chunk, where_ + ", JSON chunk");
        else if (kind == binary_kind && binary_.empty()) binary_ = chunk;
        has_json = true;
        at += 8 + (length + 3) / 4 * 4;
    }
    if (!has_json || !document_.IsObject()) damaged("has no JSON chunk with an object");
}

void Reader::check_version() const {
    const JsonValue* asset = find_member(document_, "asset");
    const std::string version = asset == nullptr ? std::string() : text_in(*asset, "version"),
                      needed = asset == nullptr ? std::string() : text_in(*asset, "minVersion");
    const JsonValue* meshes = find_member(document_, "meshes");
    if (version.starts_with("1") || (meshes != nullptr && meshes->IsObject())) refuse_first_version(where_);
    for (const std::string& stated : {version, needed})
        if (!stated.empty() && stated != "2" && !stated.starts_with("2."))
            fail_input(where_, fmt::format("has glTF version {}", printable(stated, 20)), "export glTF 2.0");
    if (needed > "2.0") fail_input(where_, fmt::format("needs a reader of glTF {}", printable(needed, 20)), "export glTF 2.0");
}

void Reader::fail(const std::string& pointer, const std::string& problem) const {
    fail_input(where_, fmt::format("at {}: {}", pointer, problem), "correct or regenerate the file");
}

std::size_t Reader::number(const JsonValue& object, const char* name, const std::string& pointer, std::size_t fallback) const {
    const JsonValue* value = find_member(object, name);
    if (value == nullptr) return fallback;
    // JSON does not distinguish 3 from 3.0.
    if (value->IsDouble() && value->GetDouble() >= 0 && value->GetDouble() < 4294967296.0 &&
        value->GetDouble() == std::floor(value->GetDouble()))
        return static_cast<std::size_t>(value->GetDouble());
    if (!value->IsUint()) fail(pointer + "/" + name, "is not a non-negative integer");
    return value->GetUint();
}

const JsonValue& Reader::element(const char* list_name, std::size_t index, const std::string& pointer) const {
    const JsonValue* list = find_member(document_, list_name);
    if (list == nullptr || !list->IsArray() || index >= list->Size() ||
        !(*list)[static_cast<rapidjson::SizeType>(index)].IsObject())
        fail(pointer, fmt::format("refers to element {} of {}, which does not exist", index, list_name));
    const JsonValue& entry = (*list)[static_cast<rapidjson::SizeType>(index)];
    // Members are found by a search through all of them: bounds the work on objects with absurdly many.
    if (entry.MemberCount() + document_.MemberCount() > 200)
        charge(16.0 * (entry.MemberCount() + document_.MemberCount()), pointer);
    return entry;
}

void Reader::charge(double bytes, const std::string& pointer) const {
    charged_ += bytes;
    if (charged_ > allowed_)
        fail_input(where_,
                   fmt::format("at {}: the file would take more than {} MB, many times its size, because its parts refer to the "
                               "same data repeatedly or are compressed very strongly",
                               pointer, digits(allowed_ / 1e6, 3)),
                   "export each surface once, without copies of it, and without compression");
}

std::string_view Reader::buffer(std::size_t index, const std::string& pointer) const {
    const JsonValue& entry = element("buffers", index, pointer);
    const JsonValue* uri = find_member(entry, "uri");
    const std::string entry_pointer = "/buffers/" + std::to_string(index);
    if (uri == nullptr) {
        if (index == 0 && !binary_.empty()) return binary_;
        if (extension_of(entry, meshopt_extension) != nullptr)
            fail(entry_pointer, "is a fallback for readers without EXT_meshopt_compression, and its data are not in the file");
        fail(entry_pointer, "has no data: the file has no binary chunk for it");
    }
    if (!uri->IsString()) fail(entry_pointer + "/uri", "is not a text");
    if (const auto known = buffers_.find(index); known != buffers_.end()) return known->second;
    const std::string_view text(uri->GetString(), uri->GetStringLength());
    if (lower_case(text.substr(0, 5)) == "data:") {
        charge(0.75 * static_cast<double>(text.size()), entry_pointer);
        auto content = content_of_data_uri(text);
        if (!content) fail(entry_pointer + "/uri", "is not valid base64");
        return buffers_[index] = std::move(*content);
    }
    if (!file_reader_) fail(entry_pointer + "/uri", "external data is not supported");
    std::string content = file_reader_(std::string(text));
    allowed_ += 12.0 * static_cast<double>(content.size());
    return buffers_[index] = std::move(content);
}

/// The bytes to which an object with buffer, byteOffset and byteLength refers.
std::string_view Reader::part(const JsonValue& entry, const std::string& pointer) const {
    const std::size_t index = number(entry, "buffer", pointer, static_cast<std::size_t>(-1));
    if (index == static_cast<std::size_t>(-1)) fail(pointer + "/buffer", "is missing");
    const std::string_view bytes = buffer(index, pointer);
    const std::size_t offset = number(entry, "byteOffset", pointer, 0), length = number(entry, "byteLength", pointer, 0);
    if (offset > bytes.size() || length > bytes.size() - offset) fail(pointer, "exceeds the buffer");
    return bytes.substr(offset, length);
}

std::string_view Reader::view(std::size_t index, const std::string& pointer) const {
    const JsonValue& entry = element("bufferViews", index, pointer);
    const std::string entry_pointer = "/bufferViews/" + std::to_string(index);
    const JsonValue* compressed = extension_of(entry, meshopt_extension);
    if (compressed == nullptr) return part(entry, entry_pointer);
    const auto known = decoded_.find(index);
    if (known != decoded_.end()) return known->second;
    return decoded_[index] = decoded(*compressed, entry_pointer + "/extensions/EXT_meshopt_compression");
}

/// Decodes a view of EXT_meshopt_compression (Khronos, vendor extension; modes and filters of its sections of these names).
std::string Reader::decoded(const JsonValue& compressed, const std::string& pointer) const {
    const std::string_view bytes = part(compressed, pointer);
    const std::size_t stride = number(compressed, "byteStride", pointer, 0), count = number(compressed, "count", pointer, 0);
    const std::string mode = text_in(compressed, "mode"), filter = text_in(compressed, "filter");
    const auto* const source = reinterpret_cast<const unsigned char*>(bytes.data());
    const bool attributes = mode == "ATTRIBUTES", triangles = mode == "TRIANGLES";
    if (!attributes && !triangles && mode != "INDICES") fail(pointer + "/mode", "is not ATTRIBUTES, TRIANGLES or INDICES");
    if (attributes ? stride == 0 || stride % 4 != 0 || stride > 256 : stride != 2 && stride != 4)
        fail(pointer + "/byteStride", "does not fit the mode");
    if (triangles && count % 3 != 0) fail(pointer + "/count", "is not a multiple of three");
    charge(static_cast<double>(count) * static_cast<double>(stride), pointer);
    std::string result(count * stride, '\0');
    if (count == 0) return result;
    const int code = attributes  ? meshopt_decodeVertexBuffer(result.data(), count, stride, source, bytes.size())
                     : triangles ? meshopt_decodeIndexBuffer(result.data(), count, stride, source, bytes.size())
                                 : meshopt_decodeIndexSequence(result.data(), count, stride, source, bytes.size());
    if (code != 0) fail(pointer, "the compressed data are damaged, or of a newer version than EXT_meshopt_compression");
    if (filter.empty() || filter == "NONE") return result;
    if (!attributes) fail(pointer + "/filter", "fits attributes only");
    if (filter == "OCTAHEDRAL" && (stride == 4 || stride == 8)) meshopt_decodeFilterOct(result.data(), count, stride);
    else if (filter == "QUATERNION" && stride == 8) meshopt_decodeFilterQuat(result.data(), count, stride);
    else if (filter == "EXPONENTIAL") meshopt_decodeFilterExp(result.data(), count, stride);
    else fail(pointer + "/filter", "is unknown, or does not fit the stride");
    return result;
}

}  // namespace ostraka::glb

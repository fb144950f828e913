#include "findings.h"

#include "ostraka/core/error.h"
#include "ostraka/files/json_build.h"

#include <algorithm>
#include <array>

namespace ostraka::fuzz {

namespace {

constexpr std::array<const char*, 5> kinds_of_change{"bytes", "link", "pipe", "folder", "gone"};

/// Text that a JSON string keeps as it is.
bool is_plain(const std::string& bytes) {
    for (std::size_t at = 0; at < bytes.size();) {
        const std::size_t length = utf8_length(bytes, at);
        if (length == 0 || bytes[at] == '\0') return false;
        at += length;
    }
    return true;
}

std::string hexadecimal(const std::string& bytes) {
    static constexpr const char* digits = "0123456789abcdef";
    std::string text;
    for (const char c : bytes) {
        text += digits[static_cast<unsigned char>(c) >> 4U];
        text += digits[static_cast<unsigned char>(c) & 15U];
    }
    return text;
}

std::string from_hexadecimal(const std::string& text, const std::string& where) {
    const auto digit = [&](char c) {
        if (c >= '0' && c <= '9') return c - '0';
        if (c >= 'a' && c <= 'f') return c - 'a' + 10;
        fail_input(where, "holds bytes that are not in hexadecimal digits", "keep the finding once more");
    };
    std::string bytes;
    for (std::size_t i = 0; i + 1 < text.size(); i += 2) bytes += static_cast<char>(digit(text[i]) * 16 + digit(text[i + 1]));
    return bytes;
}

}  // namespace

void write_finding(const Path& file, const Finding& finding) {
    Json document(rapidjson::kObjectType);
    auto& a = document.GetAllocator();
    add_members(document, a, "subject", finding.subject, "kind", finding.kind, "note", finding.note, "changes",
                json_list(finding.changes, a, [&](const Change& change) {
                    JsonValue entry =
                        json_object(a, "file", change.file, "what", kinds_of_change.at(static_cast<std::size_t>(change.what)));
                    if (is_plain(change.bytes)) add_members(entry, a, "text", change.bytes);
                    else add_members(entry, a, "hexadecimal", hexadecimal(change.bytes));
                    return entry;
                }));
    write_json(file, document);
}

Finding read_finding(const Path& file) {
    const Json document = read_json(file);
    Finding finding{text_in(document, "subject"), text_in(document, "kind"), text_in(document, "note"), {}};
    for (const JsonValue& entry : list_in(document, "changes")) {
        Change change;
        change.file = text_in(entry, "file");
        const auto kind = std::find(kinds_of_change.begin(), kinds_of_change.end(), text_in(entry, "what"));
        if (change.file.empty() || kind == kinds_of_change.end())
            fail_input(file.string(), "holds a change without a file or of an unknown kind", "keep the finding once more");
        change.what = static_cast<Change::What>(kind - kinds_of_change.begin());
        const JsonValue* bytes = find_member(entry, "hexadecimal");
        change.bytes = bytes != nullptr ? from_hexadecimal(text_of(*bytes), file.string()) : text_in(entry, "text");
        finding.changes.push_back(std::move(change));
    }
    if (finding.changes.empty()) fail_input(file.string(), "holds no change", "name what ostraka_fuzz --keep has kept");
    return finding;
}

}  // namespace ostraka::fuzz

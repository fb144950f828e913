#include "io/formats.h"
#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"
#include "ostraka/files/safe_path.h"

#include <fmt/core.h>

#include <algorithm>

namespace ostraka::io {

namespace {

/// The text with %XX replaced by the byte XX.
std::string without_percent_escapes(const std::string& text) {
    const auto digit = [](char c) {
        if (c >= '0' && c <= '9') return c - '0';
        if (c >= 'a' && c <= 'f') return c - 'a' + 10;
        return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
    };
    std::string result;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool is_escape = text[i] == '%' && i + 2 < text.size() && digit(text[i + 1]) >= 0 && digit(text[i + 2]) >= 0;
        result += is_escape ? static_cast<char>(16 * digit(text[i + 1]) + digit(text[i + 2])) : text[i];
        if (is_escape) i += 2;
    }
    return result;
}

/// The folders and the file name of a reference. A reference that is absolute or leads out of the folder keeps its file name
/// only.
std::vector<std::string> components_of(std::string reference) {
    std::replace(reference.begin(), reference.end(), '\\', '/');
    const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
    bool leads_out = reference.starts_with('/') || lower_case(reference).starts_with("file:");
    if (reference.size() > 1 && reference[1] == ':' && is_letter(reference[0])) {
        leads_out = true;
        reference.erase(0, 2);
    }
    std::vector<std::string> components;
    for (const std::string_view part : split_words(reference, "/")) {
        if (part == ".") continue;
        if (part != "..") components.emplace_back(part);
        else if (components.empty()) leads_out = true;
        else components.pop_back();
    }
    if (leads_out && components.size() > 1) components.erase(components.begin(), components.end() - 1);
    return components;
}

/// The entry of a folder whose name is `name` but for the case of its letters: the first one in the order of names.
std::optional<std::string> entry_ignoring_case(const Path& folder, const std::string& name) {
    std::vector<std::string> entries;
    if (is_memory(folder)) {
        entries = files_in(folder);
    } else {
        std::error_code code;
        std::filesystem::directory_iterator iterator(folder, code);
        for (; !code && iterator != std::filesystem::directory_iterator(); iterator.increment(code))
            entries.push_back(iterator->path().filename().string());
    }
    std::optional<std::string> result;
    const std::string wanted = lower_case(name);
    for (const std::string& entry : entries)
        if (lower_case(entry) == wanted && (!result || entry < *result)) result = entry;
    return result;
}

std::optional<Path> file_in_folder(const Path& folder, const std::vector<std::string>& components, bool ignore_case) {
    Path path = folder;
    const Path here(".");
    for (const std::string& component : components) {
        const Path next = path / component;
        std::error_code code;
        const bool exists = is_memory(next) ? file_exists(next) || is_folder(next) : std::filesystem::exists(next, code);
        if (exists) {
            path = next;
            continue;
        }
        const auto entry = ignore_case ? entry_ignoring_case(path.empty() ? here : path, component) : std::nullopt;
        if (!entry) return std::nullopt;
        path /= *entry;
    }
    if (!file_exists(path) || (!is_memory(path) && !is_inside(path, folder))) return std::nullopt;
    return path;
}

/// A name that no image of the appearance has: the name itself, or with a number before its extension.
std::string distinct_image_name(const std::vector<SharedImage>& images, const std::string& name) {
    const auto is_taken = [&](const std::string& candidate) {
        return std::any_of(images.begin(), images.end(), [&](const SharedImage& image) {
            return image != nullptr && lower_case(image->name) == lower_case(candidate);
        });
    };
    const Path path(name);
    std::string candidate = name;
    for (std::size_t number = 2; is_taken(candidate); ++number)
        candidate = fmt::format("{}_{}{}", path.stem().string(), number, path.extension().string());
    return candidate;
}

}  // namespace

std::optional<Path> file_beside(const Path& file, const std::string& reference) {
    if (reference.find('\0') != std::string::npos || reference.size() > 4096) return std::nullopt;
    const Path folder = file.parent_path();
    if (is_memory(file) && folder.empty()) {  // a file in memory without a folder
        const Path path = "memory:" + reference;
        return file_exists(path) ? std::optional(path) : std::nullopt;
    }
    for (const bool decoded : {false, true}) {
        const std::string text = decoded ? without_percent_escapes(reference) : reference;
        if ((decoded && text == reference) || text.find('\0') != std::string::npos) continue;
        const std::vector<std::string> components = components_of(text);
        if (components.empty()) continue;
        for (const auto& candidate : {components, std::vector<std::string>{components.back()}})
            for (const bool ignore_case : {false, true})
                if (auto path = file_in_folder(folder, candidate, ignore_case)) return path;
    }
    return std::nullopt;
}

Index add_image(PolygonSoup& soup, const Path& file, const std::string& reference) {
    std::vector<SharedImage>& images = soup.extras.appearance.images;
    const auto add = [&images](SharedImage image) {
        images.push_back(std::move(image));
        return static_cast<Index>(images.size() - 1);
    };
    const auto path = file_beside(file, reference);
    if (!path) {
        soup.notes.push_back(fmt::format("the image '{}' that {} names is not in its folder", printable(reference, 200),
                                         printable(file.filename().string(), 200)));
        return add(nullptr);
    }
    const std::string name = path->filename().string();
    try {
        std::string bytes = read_file(*path);
        for (std::size_t i = 0; i < images.size(); ++i)
            if (images[i] != nullptr && images[i]->bytes == bytes && (images[i]->name == name || images[i]->name.empty()))
                return static_cast<Index>(i);
        const std::string image_name = distinct_image_name(images, name);
        return add(std::make_shared<const Image>(parse_image(std::move(bytes), image_name, path->string())));
    } catch (const Error& error) {
        if (error.kind() == ErrorKind::cancelled) throw;
        soup.notes.push_back(fmt::format("the image '{}' is not kept: {}", printable(reference, 200), error.what()));
        return add(nullptr);
    }
}

}  // namespace ostraka::io

#include "ostraka/io/obj_parts.h"

#include "ostraka/core/message_text.h"

#include <algorithm>
#include <map>
#include <utility>

namespace ostraka {

ObjParts read_obj_parts(const Path& file, ObjStatement statement) {
    const std::string text = read_file(file);
    const std::string_view keyword = statement == ObjStatement::group ? "g" : statement == ObjStatement::object ? "o" : "usemtl";
    ObjParts parts;
    std::map<std::string, std::int32_t> number;
    std::string name;
    bool named = false;
    std::string logical;  // lines that end with a backslash are joined with the next
    for (std::size_t at = 0; at < text.size();) {
        const std::string_view part = trimmed(line_at(text, at));
        if (part.ends_with('\\')) {
            logical += std::string(part.substr(0, part.size() - 1)) + ' ';
            continue;
        }
        const std::string joined_line = std::exchange(logical, std::string()) + std::string(part);
        const std::string_view line = trimmed(joined_line);
        if (line.empty() || line.front() == '#') continue;
        const std::size_t end = std::min(line.find_first_of(" \t"), line.size());
        const std::string_view word = line.substr(0, end);
        if (word == keyword) {
            name = joined(split_words(line.substr(end)), " ");
            named = true;
        } else if (word == "f" || word == "fo") {
            if (!named) {
                parts.of_polygon.push_back(-1);
                continue;
            }
            const auto [entry, added] = number.try_emplace(name, static_cast<std::int32_t>(parts.names.size()));
            if (added) parts.names.push_back(name.empty() ? "default" : name);
            parts.of_polygon.push_back(entry->second);
        }
    }
    return parts;
}

}  // namespace ostraka

#include "ostraka/files/provenance.h"
#include "ostraka/files/json_build.h"

#include <fmt/core.h>

#include <algorithm>

namespace ostraka {

void Provenance::add_input(const Path& file) { inputs.emplace_back(file.filename().string(), sha256_of_file(file)); }

JsonValue Provenance::to_json(JsonAllocator& allocator) const {
    // An option that was given several times becomes one member, so that the names in the object are unique.
    std::vector<std::pair<std::string, std::string>> members;
    for (const auto& [name, value] : options) {
        const auto existing =
            std::find_if(members.begin(), members.end(), [&](const auto& member) { return member.first == name; });
        if (existing == members.end()) members.emplace_back(name, value);
        else existing->second += "; " + value;
    }
    JsonValue option_values(rapidjson::kObjectType);
    for (const auto& [name, value] : members) add_member(option_values, name, value, allocator);
    const auto json_of = [&](const auto& input) { return json_object(allocator, "file", input.first, "sha256", input.second); };
    return json_object(allocator, "tool", "ostraka " + version(), "command", command, "options", std::move(option_values),
                       "inputs", json_list(inputs, allocator, json_of));
}

std::string Provenance::to_line() const {
    std::string line = fmt::format("ostraka {} {}", version(), command);
    for (const auto& [name, value] : options) line += fmt::format(" --{}={}", name, value);
    for (const auto& [name, hash] : inputs) line += fmt::format("; {} sha256:{}", name, hash);
    for (char& c : line)
        if (static_cast<unsigned char>(c) < 32) c = ' ';
    return line;
}

}  // namespace ostraka

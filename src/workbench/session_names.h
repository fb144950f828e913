// Names of objects, parts and files of a session.
#pragma once

#include "workbench/request.h"

#include "ostraka/core/message_text.h"
#include "ostraka/workbench/session.h"

#include <fmt/core.h>

#include <algorithm>

namespace ostraka::workbench {

/// The part of an object that an output of this kind becomes; empty: the output becomes no part.
inline std::string part_of(Kind kind) {
    switch (kind) {
        case Kind::mesh:
            return "mesh";
        case Kind::annotations:
            return "annotations";
        case Kind::graph:
            return "graph";
        case Kind::cage:
            return "cage";
        case Kind::coordinates:
            return "coordinates";
        case Kind::recipe:
            return "recipe";
        case Kind::edit:
            return "edit";
        default:
            return {};
    }
}

/// Whether the name is a valid name of a file without folder.
inline bool is_plain_name(const std::string& name) {
    return !name.empty() && name.size() <= 100 && name.front() != '.' && printable(name) == name &&
           name.find_first_of("/\\:$") == std::string::npos;
}

/// A name for a new object: `name`, with a number appended if an object already has this name.
inline std::string free_name(const SessionState& state, const std::string& name) {
    const auto is_taken = [&](const std::string& candidate) {
        return std::any_of(state.objects.begin(), state.objects.end(),
                           [&](const SessionObject& o) { return o.name == candidate; });
    };
    std::string free = name;
    for (int i = 2; is_taken(free); ++i) free = fmt::format("{}-{}", name, i);
    return free;
}

/// File name without folder and without the extension of its kind of file.
inline std::string stem_of(const std::string& file) {
    const std::string name = Path(file).filename().string();
    for (const std::string_view end : {".ant.json", ".graph.json", ".recipe.json", ".edit.json", ".template.json", ".cage.ply"})
        if (name.ends_with(end)) return name.substr(0, name.size() - end.size());
    return Path(name).stem().string();
}

}  // namespace ostraka::workbench

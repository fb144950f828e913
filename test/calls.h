// Calls operations with settings whose file names are relative to a folder.
#pragma once

#include "ostraka/files/json.h"
#include "ostraka/operations/table.h"

#include <string>

namespace ostraka::test {

/// `settings`: JSON as for Call::set; file names are relative to the folder.
inline Call call_in(const Path& folder, const std::string& operation, const std::string& settings) {
    const Json values = parse_json(settings, operation);
    Call call(find_operation(operation));
    Json options(rapidjson::kObjectType);
    for (const auto& member : values.GetObject()) {
        const std::string name = text_of(member.name);
        if (call.parameters().slot(name) == nullptr)
            add_member(options, name, JsonValue(member.value, options.GetAllocator()), options.GetAllocator());
        else if (member.value.IsArray())
            for (const auto& file_name : member.value.GetArray()) call.set_file(name, folder / text_of(file_name));
        else call.set_file(name, folder / text_of(member.value));
    }
    call.set(options);
    return call;
}

}  // namespace ostraka::test

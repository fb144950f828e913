#include "operations/command_words.h"

#include "ostraka/core/text.h"

#include <fmt/core.h>

#include <algorithm>

namespace ostraka {

std::vector<std::string> command_words(const std::string& operation, const JsonValue& settings) {
    const Call call(find_operation(operation));
    const auto given = [&](const std::string& name) { return find_member(settings, name) != nullptr; };
    const auto& orders = call.parameters().orders;
    // The longest order whose arguments are all given; otherwise the first order, without the missing arguments.
    const std::vector<std::string>* order = &orders.front();
    std::size_t length = 0;
    for (const auto& candidate : orders)
        if (candidate.size() > length && std::all_of(candidate.begin(), candidate.end(), given))
            order = &candidate, length = candidate.size();
    std::vector<std::string> words;
    for (const auto word : split_words(operation)) words.emplace_back(word);
    const auto text = [](const JsonValue& value) {
        if (value.IsString()) return text_of(value);
        if (value.IsBool()) return std::string(value.GetBool() ? "true" : "false");
        return value.IsInt64()    ? std::to_string(value.GetInt64())
               : value.IsNumber() ? digits(value.GetDouble())
                                  : to_compact_text(value);
    };
    for (const std::string& name : *order)
        if (const JsonValue* value = find_member(settings, name); value != nullptr && value->IsArray())
            for (const auto& element : value->GetArray()) words.push_back(text(element));
        else if (value != nullptr) words.push_back(text(*value));
    for (const auto& member : settings.GetObject()) {
        const std::string name = text_of(member.name);
        if (std::find(order->begin(), order->end(), name) != order->end()) continue;
        const auto add = [&](const JsonValue& value) {
            const std::string word = text(value);
            if (word.empty() || (word[0] == '-' && !number_of(word))) {
                words.push_back(fmt::format("--{}={}", name, word));
            } else {
                words.push_back("--" + name);
                words.push_back(word);
            }
        };
        if (member.value.IsBool()) {
            const Option* option = call.parameters().options.find(name);
            if (member.value.GetBool()) words.push_back("--" + name);
            else if (option != nullptr && option->initial == "true") words.push_back("--no-" + name);
        } else if (member.value.IsArray()) {
            for (const auto& element : member.value.GetArray()) add(element);
        } else {
            add(member.value);
        }
    }
    words.emplace_back("--json");
    return words;
}

}  // namespace ostraka

#include "ostraka/operations/pages.h"

#include <algorithm>
#include <sstream>

namespace ostraka {

namespace {

/// Adds files and folders whose names begin with `prefix`.
void add_files(std::vector<std::string>& candidates, const std::string& prefix, const std::vector<std::string>& endings) {
    const std::size_t slash = prefix.rfind('/');
    const std::string folder = slash == std::string::npos ? "" : prefix.substr(0, slash + 1);
    std::error_code code;
    for (std::filesystem::directory_iterator entry(folder.empty() ? "." : folder, code), end; !code && entry != end;
         entry.increment(code)) {
        const std::string name = folder + entry->path().filename().string();
        std::error_code entry_error;
        if (!name.starts_with(prefix)) continue;
        if (entry->is_directory(entry_error)) candidates.push_back(name + "/");
        else if (endings.empty() ||
                 std::any_of(endings.begin(), endings.end(), [&](const auto& ending) { return name.ends_with(ending); }))
            candidates.push_back(name);
    }
}

/// Adds the tags of the annotation files among the words.
void add_tags(std::vector<std::string>& candidates, const std::vector<std::string>& words) {
    for (const std::string& word : words) {
        if (!word.ends_with(".ant.json")) continue;
        try {
            const Json document = read_json(word);
            const JsonValue* annotations = document.IsObject() ? find_member(document, "annotations") : nullptr;
            if (annotations == nullptr || !annotations->IsArray()) continue;
            for (const auto& annotation : annotations->GetArray())
                if (const JsonValue* tag = annotation.IsObject() ? find_member(annotation, "tag") : nullptr;
                    tag != nullptr && tag->IsString())
                    candidates.emplace_back(tag->GetString());
        } catch (const Error&) {  // unreadable files give no tags
            continue;
        }
    }
}

void add_flags(std::vector<std::string>& candidates, const Call& call) {
    for (const Slot* slot : call.parameters().slots())
        if (!slot->is_positional) candidates.push_back("--" + slot->name);
    for (const Option& option : call.parameters().options)
        if (!option.is_positional)
            candidates.push_back((option.type() == OptionType::boolean && option.initial == "true" ? "--no-" : "--") +
                                 option.name);
    for (const CommonFlag& common : common_flags) candidates.push_back(std::string("--") + common.name);
}

}  // namespace

std::vector<std::string> completions(const std::vector<std::string>& words) {
    if (words.empty()) return {};
    std::vector<std::string> candidates;
    const std::string& prefix = words.back();
    if (words.size() == 1 && std::string("workbench").starts_with(prefix)) candidates.emplace_back("workbench");
    const OperationEntry* operation = nullptr;
    std::size_t length = 0;
    for (const OperationEntry& entry : operations()) {
        std::istringstream stream(entry.name);
        std::size_t matched = 0;
        std::string word;
        bool matches = true;
        while (stream >> word) {
            if (matched + 1 < words.size() && words[matched] == word) {
                ++matched;
                continue;
            }
            matches = false;
            if (matched + 1 == words.size() && word.starts_with(prefix)) candidates.push_back(word);
            break;
        }
        if (matches && matched > length) operation = &entry, length = matched;
    }
    if (operation != nullptr) {
        const Call call(*operation);
        candidates.clear();
        const std::string& before = words[words.size() - 2];
        const auto flag_of = [](const std::string& word) { return word.starts_with("--") ? word.substr(2) : std::string(); };
        const std::string flag = flag_of(before);
        const Option* option = flag.empty() ? nullptr : call.parameters().options.find(flag);
        const Slot* slot = flag.empty() ? nullptr : call.parameters().slot(flag);
        const std::vector<std::string> named_values = option == nullptr ? std::vector<std::string>() : option->names();
        const bool takes_dash = std::any_of(named_values.begin(), named_values.end(),
                                            [&](const std::string& value) { return value.starts_with(prefix); });
        if (prefix.starts_with("-") && !takes_dash) {
            add_flags(candidates, call);
        } else if (flag == "show") {
            candidates = {"table", "json", "csv", "markdown"};
        } else if (flag == "threads") {
            candidates.clear();
        } else if (slot != nullptr) {
            add_files(candidates, prefix, extensions_of(slot->kind));
        } else if (option != nullptr && option->type() != OptionType::boolean) {
            if (!named_values.empty()) candidates = named_values;
            else if (option->type() == OptionType::text || option->type() == OptionType::texts) add_tags(candidates, words);
        } else {
            // The next positional argument.
            std::size_t place = 0;
            for (std::size_t i = length; i + 1 < words.size(); ++i) {
                if (!words[i].starts_with("-")) ++place;
                else if (const Option* other = call.parameters().options.find(flag_of(words[i]));
                         (other != nullptr && other->type() != OptionType::boolean) ||
                         call.parameters().slot(flag_of(words[i])) != nullptr)
                    ++i;
            }
            const auto& order = call.parameters().orders.front();
            const Slot* next = order.empty() ? nullptr : call.parameters().slot(order[std::min(place, order.size() - 1)]);
            if (next != nullptr) add_files(candidates, prefix, extensions_of(next->kind));
        }
    }
    // Words with control characters cannot be typed.
    std::erase_if(candidates, [&](const std::string& candidate) {
        return !candidate.starts_with(prefix) || printable(candidate) != candidate;
    });
    std::sort(candidates.begin(), candidates.end());
    candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
    return candidates;
}

std::string completion_script(Shell shell) {
    switch (shell) {
        case Shell::bash:
            return "# bash completion for ostraka\n"
                   "_ostraka() {\n"
                   "    local IFS=$'\\n'\n"
                   "    mapfile -t COMPREPLY < <(ostraka --complete \"${COMP_WORDS[@]:1:COMP_CWORD}\" 2>/dev/null)\n"
                   "    [[ ${#COMPREPLY[@]} == 1 && ${COMPREPLY[0]} == */ ]] && compopt -o nospace\n"
                   "    [[ ${#COMPREPLY[@]} -gt 0 ]] && mapfile -t COMPREPLY < <(printf '%q\\n' \"${COMPREPLY[@]}\")\n"
                   "}\n"
                   "complete -o default -F _ostraka ostraka\n";
        case Shell::zsh:
            return "#compdef ostraka\n"
                   "_ostraka() {\n"
                   "    local -a found\n"
                   "    found=(\"${(@f)$(ostraka --complete \"${(@)words[2,CURRENT]}\" 2>/dev/null)}\")\n"
                   "    if [[ -n ${found[1]} ]]; then compadd -Q -- \"${(@q)found}\"; else _files; fi\n"
                   "}\n"
                   "compdef _ostraka ostraka\n";
        case Shell::fish:
            return "# fish completion for ostraka\n"
                   "complete -c ostraka -a '(ostraka --complete (commandline -opc)[2..-1] (commandline -ct) 2>/dev/null)'\n";
    }
    return {};
}

}  // namespace ostraka

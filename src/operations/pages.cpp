#include "ostraka/operations/pages.h"

#include "ostraka/core/message_text.h"
#include "ostraka/core/text.h"

#include <fmt/core.h>

#include <algorithm>

namespace ostraka {

namespace {

std::string first_word_of(const std::string& name) { return name.substr(0, name.find(' ')); }

/// Allowed values as text: "0.05 to 1", "one of a, b", "a whole number".
std::string allowed_for_page(const Option& option) {
    if (const auto* range = std::get_if<Range>(&option.rule))
        return fmt::format("{} to {}", ostraka::digits(range->min, 6), ostraka::digits(range->max, 6));
    if (const auto* choices = std::get_if<Choices>(&option.rule)) return joined(choices->names);
    if (std::holds_alternative<Words>(option.rule)) return option.allowed();
    if (option.type() == OptionType::boolean)
        return option.initial == "true" ? fmt::format("on, `--no-{}`", option.name) : "switch";
    static constexpr const char* types[]{"", "whole number", "number", "text", "text", "texts", "numbers", "whole numbers"};
    return types[static_cast<std::size_t>(option.type())];
}

std::string initial_for_page(const Option& option) {
    if (option.type() == OptionType::boolean || option.initial.empty()) return {};
    const auto value = number_of(option.initial);
    return value ? digits(*value) : option.initial;
}

/// Wraps text to lines of at most 120 characters.
std::string wrapped(const std::string& text, const std::string& indent = {}) {
    std::string result, line;
    std::size_t position = 0;
    while (position <= text.size()) {
        const std::size_t end = std::min(text.find(' ', position), text.size());
        const std::string word = text.substr(position, end - position);
        if (!line.empty() && line.size() + 1 + word.size() > 120) result += line + "\n", line = indent + word;
        else line += (line.empty() ? "" : " ") + word;
        position = end + 1;
    }
    return result + line + "\n";
}

std::string sentence(std::string help) {
    help[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(help[0])));
    return wrapped(help + ".");
}

void add_fields(std::string& page, const std::vector<Field>& fields, const std::string& indent) {
    static constexpr const char* types[]{"boolean", "whole number", "number", "text", "numbers", "texts", "structure"};
    for (const Field& field : fields) {
        if (field.key.empty()) continue;
        std::string type_text = types[static_cast<std::size_t>(field.type)];
        if (!field.unit.empty()) type_text += ", " + field.unit;
        page += wrapped(fmt::format("{}- `{}`: {}", indent, field.key, type_text), indent + "  ");
    }
}

std::string operation_section(const OperationEntry& entry) {
    const Call call(entry);
    std::string page = fmt::format("## {}\n\n", entry.name);
    page += sentence(entry.help) + "\n```sh\n";
    for (const auto& order : call.parameters().orders) page += usage_of(call, order) + "\n";
    page += "```\n\n";
    for (const Slot* slot : call.parameters().slots()) {
        const bool by_flag = !call.parameters().in_some_order(slot->name);
        page += wrapped(fmt::format("- `{}{}` ({}, {}{}{}): {}", by_flag ? "--" : "", slot->name,
                                    slot->role == Role::input ? "input" : "output", to_string(slot->kind),
                                    slot->needed ? "" : ", optional", slot->repeated ? ", repeatable" : "", slot->help),
                        "  ");
    }
    std::string group = "-";
    for (const Option& option : call.parameters().options) {
        if (option.group != group) {
            group = option.group;
            page += "\n" + (group.empty() ? std::string("Options:") : group + ":") + "\n\n";
        }
        std::string line = fmt::format("- `{}{}` ({}{}", option.is_positional ? "" : "--", option.name, allowed_for_page(option),
                                       option.unit.empty() ? "" : "; " + option.unit);
        if (const std::string initial = initial_for_page(option); !initial.empty()) line += "; " + initial;
        page += wrapped(fmt::format("{}{}): {}", line, option.needed ? "; required" : "", option.help), "  ");
    }
    const ReportLayout& report = call.parameters().report;
    page += "\nReport (`--json`, member `result`):";
    if (!report.schema.empty()) page += fmt::format(" as specified by `doc/schema/{}.schema.json`.", report.schema);
    page += "\n\n";
    add_fields(page, report.value_fields, "");
    if (report.checks) page += "- `sound`, `defects`, `findings`: the result of the check\n";
    for (const auto& table : report.tables) {
        if (table.key.empty()) continue;
        page += fmt::format("- `{}`: a list of objects{}\n", table.key, table.title.empty() ? "" : ", " + table.title);
        add_fields(page, table.columns, "  ");
    }
    return page + "- `notes`: texts\n";
}

/// Escapes text for troff.
std::string troff(const std::string& text) {
    std::string result;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '\\') result += "\\e";
        else if (text[i] == '-') result += "\\-";
        else if ((text[i] == '.' || text[i] == '\'') && (i == 0 || text[i - 1] == '\n'))
            result += "\\&" + std::string(1, text[i]);
        else result += text[i];
    }
    return result;
}

}  // namespace

std::string usage_of(const Call& call, const std::vector<std::string>& order) {
    std::string text = "ostraka " + std::string(call.entry().name);
    for (const std::string& name : order) {
        const Slot* slot = call.parameters().slot(name);
        const bool repeated = slot != nullptr && slot->repeated;
        std::string upper = name;
        std::transform(upper.begin(), upper.end(), upper.begin(),
                       [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
        upper += repeated ? " ..." : "";
        text += slot != nullptr && !slot->needed && call.parameters().orders.size() == 1 ? " [" + upper + "]" : " " + upper;
    }
    for (const Slot* slot : call.parameters().slots())
        if (slot->needed && !slot->is_positional) text += fmt::format(" --{} FILE", slot->name);
    for (const Option& option : call.parameters().options)
        if (option.needed && !option.is_positional) text += fmt::format(" --{} VALUE", option.name);
    return text + " [options]";
}

std::vector<std::string> command_page_names() {
    std::vector<std::string> words;
    for (const OperationEntry& entry : operations())
        if (const std::string word = first_word_of(entry.name); std::find(words.begin(), words.end(), word) == words.end())
            words.push_back(word);
    return words;
}

std::string command_page(const std::string& first_word) {
    std::string page = fmt::format("# ostraka {}\n\n", first_word);
    for (const OperationGroup& group : operation_groups())
        if (group.name == first_word) page += sentence(group.help) + "\n";
    page += wrapped(
        "Generated from the table of operations. Every operation also accepts `--json`, `--show`, `--quiet`, `--threads` and "
        "`--help`. Exit codes: 0 done, 1 failed, 2 wrong usage, 3 done but the answer is \"no\", 130 cancelled.");
    for (const OperationEntry& entry : operations())
        if (first_word_of(entry.name) == first_word) page += "\n" + operation_section(entry);
    return page;
}

std::string manual_name(const OperationEntry& entry) {
    std::string name = "ostraka-" + std::string(entry.name);
    std::replace(name.begin(), name.end(), ' ', '-');
    return name;
}

std::string manual_page(const OperationEntry& entry) {
    const Call call(entry);
    const std::string name = manual_name(entry);
    std::string page = fmt::format(".TH {} 1 \"\" \"ostraka {}\" \"Ostraka\"\n.SH NAME\n{} \\- {}\n.SH SYNOPSIS\n", name,
                                   version(), troff(name), troff(entry.help));
    for (const auto& order : call.parameters().orders) page += fmt::format(".B {}\n.br\n", troff(usage_of(call, order)));
    page += ".SH FILES AND OBJECTS\n";
    for (const Slot* slot : call.parameters().slots())
        page += fmt::format(
            ".TP\n.B {}\n{}\n", troff((call.parameters().in_some_order(slot->name) ? "" : "--") + slot->name),
            troff(fmt::format("{}, {}: {}", slot->role == Role::input ? "Input" : "Output", to_string(slot->kind), slot->help)));
    page += ".SH OPTIONS\n";
    for (const Option& option : call.parameters().options) {
        std::string rule = allowed_for_page(option) + (option.unit.empty() ? "" : "; " + option.unit);
        if (const std::string initial = initial_for_page(option); !initial.empty()) rule += "; default " + initial;
        page += fmt::format(".TP\n.B {}\n{}\n", troff((option.is_positional ? "" : "--") + option.name),
                            troff(fmt::format("{} ({})", option.help, rule)));
    }
    return page + ".SH EXIT STATUS\n0 done, 1 failed, 2 wrong usage, 3 done but the answer is no, 130 cancelled.\n";
}

}  // namespace ostraka

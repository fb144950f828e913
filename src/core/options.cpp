#include "ostraka/core/options.h"

#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"
#include "ostraka/core/nearest_name.h"
#include "ostraka/core/overloaded.h"
#include "ostraka/core/text.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <concepts>
#include <stdexcept>

namespace ostraka {

namespace {

std::string value_text(bool value) { return value ? "true" : "false"; }
std::string value_text(const std::string& value) { return value; }
template <class Number>
std::string value_text(Number value) {
    if constexpr (std::floating_point<Number>) return digits(value, 17);
    else return std::to_string(value);
}

[[noreturn]] void refuse(const Option& option, const std::string& value, const std::string& where = {}) {
    const std::string suggestion = value.size() > 64 ? std::string() : nearest_name(value, option.names());
    throw Error(ErrorKind::usage, where, fmt::format("option {} is '{}'", option.name, printable(value, 60)),
                (suggestion.empty() ? "use " : fmt::format("did you mean '{}'? use ", suggestion)) + option.allowed());
}

/// Reports common misspellings of numbers: "2cm", "50%", "0,5". `given`: the word that contains `word`.
[[noreturn]] void refuse_number(const Option& option, const std::string& word, const std::string& given) {
    const OptionType type = option.type();
    std::string amount = word.substr(0, word.find_last_of("0123456789.") + 1);
    const std::string suffix(trimmed(std::string_view(word).substr(amount.size())));
    const std::size_t comma = amount.find(',');
    const bool decimal = comma != std::string::npos && comma == amount.rfind(',');
    if (decimal) amount[comma] = '.';
    const auto value = number_of(amount);
    if (!value || type == OptionType::integer || type == OptionType::integers || (suffix.empty() && !decimal))
        refuse(option, given);
    const std::string unit = option.unit.empty()
                                 ? "a length is in the unit of the mesh's coordinates, which --unit names where there is one"
                                 : option.unit;
    throw Error(ErrorKind::usage, "", fmt::format("option {} is '{}'", option.name, printable(given, 60)),
                suffix.empty()  ? fmt::format("write {}, with a decimal point", amount)
                : suffix == "%" ? fmt::format("write {}, a share, for {} %", digits(*value / 100, 6), amount)
                                : fmt::format("write the number alone: {} ({})", amount, unit));
}

/// `given`: the word that contains `word`, shown in errors.
template <class Number>
Number parse(const Option& option, const std::string& word, const std::string& given) {
    Number value{};
    const char *begin = word.data(), *const end = begin + word.size();
    if (word.size() > 1 && word[0] == '+' && word[1] != '-') ++begin;
    const auto [stop, code] = std::from_chars(begin, end, value);
    if (word.empty() || code != std::errc() || stop != end) refuse_number(option, word, given);
    return value;
}
template <>
bool parse<bool>(const Option& option, const std::string& word, const std::string&) {
    if (word == "true" || word == "1" || word == "yes" || word == "on") return true;
    if (word == "false" || word == "0" || word == "no" || word == "off") return false;
    refuse(option, word);
}
template <>
std::string parse<std::string>(const Option&, const std::string& word, const std::string&) {
    return word;
}

std::vector<std::string> split(const std::string& text) {
    std::vector<std::string> words(1);
    for (const char c : text)
        if (c == ',') words.emplace_back();
        else words.back() += c;
    return words;
}

const std::vector<std::string>& choices_of(const Option& option) {
    const auto* choices = std::get_if<Choices>(&option.rule);
    if (choices == nullptr) throw std::logic_error(fmt::format("option {} has no choices", option.name));
    return choices->names;
}

template <class T>
OptionType type_of() {
    return std::same_as<T, bool>          ? OptionType::boolean
           : std::same_as<T, std::string> ? OptionType::text
           : std::floating_point<T>       ? OptionType::number
                                          : OptionType::integer;
}

}  // namespace

OptionType Option::type() const {
    if (std::holds_alternative<Choices>(rule) && !is_list()) return OptionType::choice;
    return std::visit(
        Overloaded{
            [](const EnumValue&) { return OptionType::choice; }, [](std::vector<std::string>*) { return OptionType::texts; },
            [](std::vector<double>*) { return OptionType::numbers; }, [](std::vector<int>*) { return OptionType::integers; },
            []<class T>(std::optional<T>*) { return type_of<T>(); }, []<class T>(T*) { return type_of<T>(); }},
        value.place);
}

bool Option::is_list() const {
    return std::holds_alternative<std::vector<std::string>*>(value.place) ||
           std::holds_alternative<std::vector<double>*>(value.place) || std::holds_alternative<std::vector<int>*>(value.place);
}

bool Option::empty() const {
    return std::visit(Overloaded{[](std::string* text) { return text->empty(); },
                                 []<class T>(std::vector<T>* values) { return values->empty(); },
                                 []<class T>(std::optional<T>* optional_value) { return !optional_value->has_value(); },
                                 [](const auto&) { return false; }},
                      value.place);
}

std::vector<std::string> Option::texts() const {
    return std::visit(
        Overloaded{
            [&](const EnumValue& enum_value) { return std::vector{choices_of(*this).at(enum_value.get(enum_value.value))}; },
            []<class T>(std::vector<T>* values) {
                std::vector<std::string> words;
                for (const T& element : *values) words.push_back(value_text(element));
                return words;
            },
            []<class T>(std::optional<T>* optional_value) {
                return optional_value->has_value() ? std::vector{value_text(**optional_value)} : std::vector<std::string>();
            },
            [](auto* element) { return std::vector{value_text(*element)}; }},
        value.place);
}

std::string Option::text() const {
    return joined(texts(), std::holds_alternative<std::vector<std::string>*>(value.place) ? "; " : ",");
}

void Option::set(const std::vector<std::string>& words) {
    if (!is_list() && words.size() != 1)
        throw Error(ErrorKind::usage, "", fmt::format("option {} is given {} times", name, words.size()), "give it once");
    const auto numbers = [&]<class T>(std::vector<T>* values) {
        values->clear();
        for (const std::string& word : words)
            for (const std::string& part : split(word)) values->push_back(parse<T>(*this, part, word));
    };
    const auto texts_of = [&](std::vector<std::string>* values) {
        values->clear();
        for (const std::string& word : words)
            for (std::string& part : std::holds_alternative<Choices>(rule) ? split(word) : std::vector{word})
                values->push_back(std::move(part));
    };
    std::visit(
        Overloaded{
            [&](std::vector<std::string>* values) { texts_of(values); }, [&](std::vector<double>* values) { numbers(values); },
            [&](std::vector<int>* values) { numbers(values); },
            [&]<class T>(std::optional<T>* optional_value) { *optional_value = parse<T>(*this, words.front(), words.front()); },
            [&](const EnumValue& enum_value) {
                const auto& names = choices_of(*this);
                const auto match = std::find(names.begin(), names.end(), words.front());
                if (match == names.end()) refuse(*this, words.front());
                enum_value.set(enum_value.value, static_cast<std::size_t>(match - names.begin()));
            },
            [&]<class T>(T* scalar) { *scalar = parse<T>(*this, words.front(), words.front()); }},
        value.place);
    given = true;
    check();
}

void Option::set(bool new_value) {
    if (auto* flag = std::get_if<bool*>(&value.place)) **flag = new_value;
    else if (auto* optional_flag = std::get_if<std::optional<bool>*>(&value.place)) **optional_flag = new_value;
    else refuse(*this, value_text(new_value));
    given = true;
}

void Option::set(std::int64_t new_value) {
    if (type() == OptionType::boolean || type() == OptionType::text || type() == OptionType::choice)
        refuse(*this, value_text(new_value));
    set(std::vector{value_text(new_value)});
}

void Option::set(double new_value) {
    if (type() != OptionType::number && type() != OptionType::numbers) refuse(*this, value_text(new_value));
    set(std::vector{value_text(new_value)});
}

void Option::set(const std::vector<double>& values) {
    std::vector<std::string> words;
    for (const double number : values) words.push_back(value_text(number));
    if (type() != OptionType::numbers && type() != OptionType::integers) {
        const std::string joined_text = joined(words, ",");
        // Options such as directions: three numbers, or a word.
        if (type() != OptionType::text) refuse(*this, joined_text);
        set(std::vector{joined_text});
        return;
    }
    set(words);
}

std::vector<std::string> Option::names() const {
    if (const auto* choices = std::get_if<Choices>(&rule)) return choices->names;
    if (const auto* words = std::get_if<Words>(&rule)) return words->names;
    return {};
}

std::string Option::allowed() const {
    if (const auto* choices = std::get_if<Choices>(&rule)) return "one of: " + joined(choices->names);
    if (const auto* words = std::get_if<Words>(&rule))
        return joined(words->names) + (words->others.empty() ? "" : " or ") + words->others;
    const OptionType kind = type();
    const bool integral = kind == OptionType::integer || kind == OptionType::integers;
    std::string description = kind == OptionType::boolean                                 ? "true or false"
                              : integral                                                  ? "a whole number"
                              : kind == OptionType::number || kind == OptionType::numbers ? "a number"
                                                                                          : "a text";
    if (const auto* range = std::get_if<Range>(&rule))
        description = fmt::format("a value from {} to {}", digits(range->min, 6), digits(range->max, 6));
    if (is_list() && kind != OptionType::texts) description += ", with commas between several";
    return description + (unit.empty() ? "" : fmt::format(" ({})", unit));
}

void Option::check(const std::string& where) const {
    if (const auto* range = std::get_if<Range>(&rule)) {
        const auto check_range = [&]<class T>(T element) {
            if constexpr (std::is_arithmetic_v<T> && !std::same_as<T, bool>) {
                const auto number = static_cast<double>(element);
                if (number >= range->min && number <= range->max) return;
                const std::string word = std::floating_point<T> ? digits(number) : value_text(element);
                throw Error(ErrorKind::usage, where, fmt::format("option {} is {}", name, word), "use " + allowed());
            }
        };
        std::visit(Overloaded{[](const EnumValue&) {},
                              [&]<class T>(std::vector<T>* values) {
                                  for (const T& element : *values) check_range(element);
                              },
                              [&]<class T>(std::optional<T>* optional_value) {
                                  if (*optional_value) check_range(**optional_value);
                              },
                              [&](auto* element) { check_range(*element); }},
                   value.place);
    }
    if (std::holds_alternative<Choices>(rule) && !std::holds_alternative<EnumValue>(value.place))
        for (const std::string& word : texts())
            if (const auto& names = choices_of(*this); std::find(names.begin(), names.end(), word) == names.end())
                refuse(*this, word, where);
    if (const auto* words = std::get_if<Words>(&rule); words != nullptr && words->check)
        for (const std::string& word : texts())
            if (!word.empty()) words->check(word);
}

OptionList::OptionList() = default;
OptionList::~OptionList() = default;
OptionList::OptionList(OptionList&&) noexcept = default;
OptionList& OptionList::operator=(OptionList&&) noexcept = default;

Option& OptionList::operator()(std::string name, OptionValue value, std::string help, OptionRule rule, std::string unit) {
    if (find(name) != nullptr) throw std::logic_error(fmt::format("option {} is declared twice", name));
    Option option{std::move(name), value, std::move(help), std::move(rule), std::move(unit), group_};
    option.initial = option.text();
    return options_.emplace_back(std::move(option));
}

Option* OptionList::find(const std::string& name) {
    const auto match = std::find_if(options_.begin(), options_.end(), [&](const Option& option) { return option.name == name; });
    return match == options_.end() ? nullptr : &*match;
}

void OptionList::check(const std::string& where) const {
    for (const Option& option : options_) option.check(where);
}

std::vector<std::pair<std::string, std::string>> OptionList::values() const {
    std::vector<std::pair<std::string, std::string>> result;
    for (const Option& option : options_)
        if (option.affects_result) result.emplace_back(option.name, option.text());
    return result;
}

}  // namespace ostraka

#include "ostraka/core/options.h"

#include "ostraka/core/error.h"
#include "ostraka/core/nearest_name.h"
#include "ostraka/core/text.h"
#include "ostraka/core/words.h"

#include <algorithm>
#include <charconv>
#include <concepts>
#include <stdexcept>

namespace ostraka {

namespace {

template <class... Cases>
struct Overloaded : Cases... {
    using Cases::operator()...;
};

std::string word_of(bool value) { return value ? "true" : "false"; }
std::string word_of(const std::string& value) { return value; }
template <class Number>
std::string word_of(Number value) {
    if constexpr (std::floating_point<Number>) return digits(value, 17);
    else return std::to_string(value);
}

[[noreturn]] void refuse(const Option& option, const std::string& value, const std::string& where = {}) {
    const std::string near = value.size() > 64 ? std::string() : nearest_name(value, option.names());
    throw Error(ErrorKind::usage, where, "option " + option.name + " is '" + printable(value, 60) + "'",
                (near.empty() ? "use " : "did you mean '" + near + "'? use ") + option.allowed());
}

/// Reports common misspellings of numbers: "2cm", "50%", "0,5". `given`: the word that contains `word`.
[[noreturn]] void refuse_number(const Option& option, const std::string& word, const std::string& given) {
    const OptionType type = option.type();
    std::string amount = word.substr(0, word.find_last_of("0123456789.") + 1);
    const std::string behind(trimmed(std::string_view(word).substr(amount.size())));
    const std::size_t comma = amount.find(',');
    const bool decimal = comma != std::string::npos && comma == amount.rfind(',');
    if (decimal) amount[comma] = '.';
    const auto value = number_of(amount);
    if (!value || type == OptionType::integer || type == OptionType::integers || (behind.empty() && !decimal))
        refuse(option, given);
    const std::string unit = option.unit.empty()
                                 ? "a length is in the unit of the mesh's coordinates, which --unit names where there is one"
                                 : option.unit;
    throw Error(ErrorKind::usage, "", "option " + option.name + " is '" + printable(given, 60) + "'",
                behind.empty()  ? "write " + amount + ", with a decimal point"
                : behind == "%" ? "write " + digits(*value / 100, 6) + ", a share, for " + amount + " %"
                                : "write the number alone: " + amount + " (" + unit + ")");
}

/// `given`: the word that contains `word`, shown in errors.
template <class Number>
Number parse(const Option& option, const std::string& word, const std::string& given) {
    Number value{};
    const char *begin = word.data(), *const end = begin + word.size();
    if (word.size() > 1 && word[0] == '+' && word[1] != '-') ++begin;
    const auto [rest, code] = std::from_chars(begin, end, value);
    if (word.empty() || code != std::errc() || rest != end) refuse_number(option, word, given);
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

std::vector<std::string> split(const std::string& list) {
    std::vector<std::string> words(1);
    for (const char c : list)
        if (c == ',') words.emplace_back();
        else words.back() += c;
    return words;
}

const std::vector<std::string>& choices_of(const Option& option) {
    const auto* choices = std::get_if<Choices>(&option.rule);
    if (choices == nullptr) throw std::logic_error("option " + option.name + " has no choices");
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
    return std::visit(
        Overloaded{[](std::string* text) { return text->empty(); }, []<class T>(std::vector<T>* list) { return list->empty(); },
                   []<class T>(std::optional<T>* maybe) { return !maybe->has_value(); }, [](const auto&) { return false; }},
        value.place);
}

std::vector<std::string> Option::texts() const {
    return std::visit(
        Overloaded{[&](const EnumValue& named) { return std::vector{choices_of(*this).at(named.get(named.value))}; },
                   []<class T>(std::vector<T>* list) {
                       std::vector<std::string> words;
                       for (const T& one : *list) words.push_back(word_of(one));
                       return words;
                   },
                   []<class T>(std::optional<T>* maybe) {
                       return maybe->has_value() ? std::vector{word_of(**maybe)} : std::vector<std::string>();
                   },
                   [](auto* one) { return std::vector{word_of(*one)}; }},
        value.place);
}

std::string Option::text() const {
    return joined(texts(), std::holds_alternative<std::vector<std::string>*>(value.place) ? "; " : ",");
}

void Option::set(const std::vector<std::string>& words) {
    if (!is_list() && words.size() != 1)
        throw Error(ErrorKind::usage, "", "option " + name + " is given " + std::to_string(words.size()) + " times",
                    "give it once");
    const auto numbers = [&]<class T>(std::vector<T>* list) {
        list->clear();
        for (const std::string& word : words)
            for (const std::string& one : split(word)) list->push_back(parse<T>(*this, one, word));
    };
    const auto texts_of = [&](std::vector<std::string>* list) {
        list->clear();
        for (const std::string& word : words)
            for (std::string& part : std::holds_alternative<Choices>(rule) ? split(word) : std::vector{word})
                list->push_back(std::move(part));
    };
    std::visit(Overloaded{[&](std::vector<std::string>* list) { texts_of(list); },
                          [&](std::vector<double>* list) { numbers(list); }, [&](std::vector<int>* list) { numbers(list); },
                          [&]<class T>(std::optional<T>* maybe) { *maybe = parse<T>(*this, words.front(), words.front()); },
                          [&](const EnumValue& named) {
                              const auto& names = choices_of(*this);
                              const auto found = std::find(names.begin(), names.end(), words.front());
                              if (found == names.end()) refuse(*this, words.front());
                              named.set(named.value, static_cast<std::size_t>(found - names.begin()));
                          },
                          [&]<class T>(T* one) { *one = parse<T>(*this, words.front(), words.front()); }},
               value.place);
    given = true;
    check();
}

void Option::set(bool fresh) {
    if (auto* place = std::get_if<bool*>(&value.place)) **place = fresh;
    else if (auto* maybe = std::get_if<std::optional<bool>*>(&value.place)) **maybe = fresh;
    else refuse(*this, word_of(fresh));
    given = true;
}

void Option::set(std::int64_t fresh) {
    if (type() == OptionType::boolean || type() == OptionType::text || type() == OptionType::choice)
        refuse(*this, word_of(fresh));
    set(std::vector{word_of(fresh)});
}

void Option::set(double fresh) {
    if (type() != OptionType::number && type() != OptionType::numbers) refuse(*this, word_of(fresh));
    set(std::vector{word_of(fresh)});
}

void Option::set(const std::vector<double>& values) {
    std::vector<std::string> words;
    for (const double one : values) words.push_back(word_of(one));
    if (type() != OptionType::numbers && type() != OptionType::integers) {
        const std::string list = joined(words, ",");
        // Options such as directions: three numbers, or a word.
        if (type() != OptionType::text) refuse(*this, list);
        set(std::vector{list});
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
    const bool whole = kind == OptionType::integer || kind == OptionType::integers;
    std::string what = kind == OptionType::boolean                                 ? "true or false"
                       : whole                                                     ? "a whole number"
                       : kind == OptionType::number || kind == OptionType::numbers ? "a number"
                                                                                   : "a text";
    if (const auto* range = std::get_if<Range>(&rule))
        what = "a value from " + digits(range->min, 6) + " to " + digits(range->max, 6);
    if (is_list() && kind != OptionType::texts) what += ", with commas between several";
    return what + (unit.empty() ? "" : " (" + unit + ")");
}

void Option::check(const std::string& where) const {
    if (const auto* range = std::get_if<Range>(&rule)) {
        const auto look = [&]<class T>(T one) {
            if constexpr (std::is_arithmetic_v<T> && !std::same_as<T, bool>) {
                const auto number = static_cast<double>(one);
                if (number >= range->min && number <= range->max) return;
                const std::string word = std::floating_point<T> ? digits(number) : word_of(one);
                throw Error(ErrorKind::usage, where, "option " + name + " is " + word, "use " + allowed());
            }
        };
        std::visit(Overloaded{[](const EnumValue&) {},
                              [&]<class T>(std::vector<T>* list) {
                                  for (const T& one : *list) look(one);
                              },
                              [&]<class T>(std::optional<T>* maybe) {
                                  if (*maybe) look(**maybe);
                              },
                              [&](auto* one) { look(*one); }},
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
    if (find(name) != nullptr) throw std::logic_error("option " + name + " is declared twice");
    Option option{std::move(name), value, std::move(help), std::move(rule), std::move(unit), group_};
    option.initial = option.text();
    return options_.emplace_back(std::move(option));
}

Option* OptionList::find(const std::string& name) {
    const auto found = std::find_if(options_.begin(), options_.end(), [&](const Option& option) { return option.name == name; });
    return found == options_.end() ? nullptr : &*found;
}

void OptionList::check(const std::string& where) const {
    for (const Option& option : options_) option.check(where);
}

std::vector<std::pair<std::string, std::string>> OptionList::values() const {
    std::vector<std::pair<std::string, std::string>> list;
    for (const Option& option : options_)
        if (option.affects_result) list.emplace_back(option.name, option.text());
    return list;
}

}  // namespace ostraka

// Option lists. Each operation and each options struct has one list; flags, JSON keys, help, checks, provenance and schemas are
// derived from this list.
//
// An options struct has a member
//     void declare_options(OptionList& list);
// which lists its fields:
//     list("max-distance", max_distance, "maximum distance of a correspondence", Range{0, 1}, "share of the box diagonal");
//     list("metric", metric, "distance that paths minimise", Choices{"euclidean", "segment", "combined"});
#pragma once

#include "ostraka/core/error.h"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace ostraka {

/// Rule of an option: any value is allowed.
struct Anything {};
/// Rule of an option: numbers from min to max are allowed.
struct Range {
    double min, max;  ///< smallest and largest allowed number
};
/// Rule of an option: only these names are allowed.
struct Choices {
    std::vector<std::string> names;
    Choices(std::initializer_list<const char*> choices) : names(choices.begin(), choices.end()) {}
    explicit Choices(std::vector<std::string> choices) : names(std::move(choices)) {}
};
/// Rule of an option: these words are allowed, and also other values. Help and completion offer the words.
struct Words {
    std::vector<std::string> names;
    std::string others;  ///< description of the other values: "three numbers"
    /// Throws Error (usage) for a text that is neither one of `names` nor another allowed value; empty: the operation checks the
    /// text.
    std::function<void(const std::string&)> check = {};
};
using OptionRule = std::variant<Anything, Range, Choices, Words>;  ///< which values an option allows

/// An enumeration with the values 0, 1, ..., named in this order by the option's Choices.
struct EnumValue {
    void* value;                      ///< address of the variable
    std::size_t (*get)(const void*);  ///< reads the index of the enumerator
    void (*set)(void*, std::size_t);  ///< writes the index of the enumerator
};

/// Reference to the variable that holds the value of an option.
class OptionValue {
public:
    using Place = std::variant<bool*, int*, std::uint64_t*, double*, std::string*, std::vector<std::string>*,
                               std::vector<double>*, std::vector<int>*, std::optional<bool>*, std::optional<int>*,
                               std::optional<std::uint32_t>*, std::optional<double>*, std::optional<std::string>*, EnumValue>;
    // NOLINTBEGIN(google-explicit-constructor): any of these is meant to be handed over as it is
    OptionValue(bool& value) : place(&value) {}
    OptionValue(int& value) : place(&value) {}
    OptionValue(std::uint64_t& value) : place(&value) {}
    OptionValue(double& value) : place(&value) {}
    OptionValue(std::string& value) : place(&value) {}
    OptionValue(std::vector<std::string>& value) : place(&value) {}
    OptionValue(std::vector<double>& value) : place(&value) {}
    OptionValue(std::vector<int>& value) : place(&value) {}
    OptionValue(std::optional<bool>& value) : place(&value) {}
    OptionValue(std::optional<int>& value) : place(&value) {}
    OptionValue(std::optional<std::uint32_t>& value) : place(&value) {}
    OptionValue(std::optional<double>& value) : place(&value) {}
    OptionValue(std::optional<std::string>& value) : place(&value) {}
    template <class Enum>
    requires std::is_enum_v<Enum> OptionValue(Enum& value)
        : place(EnumValue{&value,
                          [](const void* address) { return static_cast<std::size_t>(*static_cast<const Enum*>(address)); },
                          [](void* address, std::size_t index) { *static_cast<Enum*>(address) = static_cast<Enum>(index); }}) {}
    // NOLINTEND(google-explicit-constructor)
    Place place;
};

/// Type of the value of an option; "texts", "numbers" and "integers" are lists.
enum class OptionType { boolean, integer, number, text, choice, texts, numbers, integers };

/// One option: a named reference to a variable, with help, rule and state.
struct Option {
    std::string name;            ///< the flag (--name) and the JSON key
    OptionValue value;           ///< the variable that holds the value
    std::string help;            ///< help text
    OptionRule rule;             ///< allowed values
    std::string unit = {};       ///< unit of the value; empty: none, or stated in the help
    std::string group = {};      ///< heading in the help; empty: none
    std::string initial = {};    ///< default value as text; empty: none
    bool needed = false;         ///< true: the caller must give a value
    bool given = false;          ///< true: the caller has set the value
    bool is_positional = false;  ///< true: given on the command line without the flag
    /// False: the option does not affect the result and is not recorded in the provenance.
    bool affects_result = true;
    bool takes_words = false;  ///< true: a list option whose flag may be followed by several words
    /// False: the option is ignored in studies, conformance kits and sessions; only the calling user may set it
    /// (doc/security.md).
    bool from_files = true;

    /// Marks an option that must be given.
    Option& required() { return needed = true, initial.clear(), *this; }
    /// Marks an option that is given without the flag.
    Option& positional() { return is_positional = true, *this; }
    /// Marks a list option whose flag may be followed by several words.
    Option& words() { return takes_words = true, *this; }
    /// Marks an option that affects only how and where results are shown or stored.
    Option& unrecorded() { return affects_result = false, *this; }
    /// Marks an option that only the caller may set, not a study, a kit or a session.
    Option& only_by_caller() { return from_files = false, affects_result = false, *this; }

    [[nodiscard]] OptionType type() const;  ///< type of the value
    [[nodiscard]] bool is_list() const;     ///< true if the value is a list
    /// True if there is no value: an empty text or list, or an empty optional.
    [[nodiscard]] bool empty() const;
    /// The value as text: numbers with 17 digits, true or false, lists of numbers joined by commas, lists of texts joined by ";
    /// ".
    [[nodiscard]] std::string text() const;
    [[nodiscard]] std::vector<std::string> texts() const;  ///< entries of a list as texts

    /// Sets the value from words of a command line; several words for lists only (numbers and choices also as "1,2,3"). Throws
    /// Error (usage) with the option, the word and the allowed values if a word cannot be converted or violates the rule.
    void set(const std::vector<std::string>& words);
    void set(bool value);
    void set(double value);
    void set(std::int64_t value);
    void set(const std::vector<double>& values);
    /// Checks the value against the rule. Throws Error (usage) with the option, its value and the allowed values.
    void check(const std::string& where = {}) const;
    /// Description of the allowed values: "a number from 0 to 1", "one of: a, b".
    [[nodiscard]] std::string allowed() const;
    /// The names of the option's Choices or Words; empty for other rules.
    [[nodiscard]] std::vector<std::string> names() const;
};

/// The options of an operation or of an options struct, in order.
class OptionList {
public:
    OptionList();
    ~OptionList();
    OptionList(OptionList&&) noexcept;
    OptionList& operator=(OptionList&&) noexcept;

    /// Appends an option that refers to the variable `value`.
    Option& operator()(std::string name, OptionValue value, std::string help, OptionRule rule = Anything{},
                       std::string unit = {});

    /// Sets the heading in the help for the options added after this call.
    void group(std::string title) { group_ = std::move(title); }

    [[nodiscard]] Option* find(const std::string& name);  ///< the option of this name; null if there is none
    [[nodiscard]] const Option* find(const std::string& name) const { return const_cast<OptionList*>(this)->find(name); }
    void check(const std::string& where) const;  ///< checks all values; throws Error (usage)
    /// Names and values as text, for provenance; the text is empty for an option without a value.
    [[nodiscard]] std::vector<std::pair<std::string, std::string>> values() const;

    [[nodiscard]] auto begin() { return options_.begin(); }
    [[nodiscard]] auto end() { return options_.end(); }
    [[nodiscard]] auto begin() const { return options_.begin(); }
    [[nodiscard]] auto end() const { return options_.end(); }

private:
    std::deque<Option> options_;
    std::string group_;
};

/// The option list of an options struct, filled by its member `declare_options`.
template <class Options>
OptionList options_of(const Options& options) {
    OptionList result;
    const_cast<Options&>(options).declare_options(result);
    return result;
}

/// Checks all members of an options struct. Throws Error (usage) with the option, its value and the allowed values.
template <class Options>
void check_options(const Options& options, const std::string& where) {
    options_of(options).check(where);
}

/// Names and values as text, for provenance.
template <class Options>
std::vector<std::pair<std::string, std::string>> declare_options(const Options& options) {
    return options_of(options).values();
}

/// The value of one option as text; for a choice, its name.
template <class Options>
std::string option_text(const Options& options, const std::string& name) {
    return options_of(options).find(name)->text();
}

/// Sets one option from a word. Throws Error (usage) as Option::set does.
template <class Options>
void set_option(Options& options, const std::string& name, const std::string& word) {
    options_of(options).find(name)->set(std::vector{word});
}

/// All options as one text; equal options give equal texts.
template <class Options>
std::string options_text(const Options& options) {
    std::string text;
    for (const auto& [name, value] : declare_options(options)) text += name + "=" + value + "\n";
    return text;
}

}  // namespace ostraka

// Arguments that are texts: lists of numbers, directions, names of annotations.
#pragma once

#include "ostraka/operation/operation.h"

#include <array>
#include <string>
#include <vector>

namespace ostraka {

/// The numbers of "12,88"; Error (usage) names the option.
template <class Number>
std::vector<Number> numbers_of(const std::string& text, const std::string& option);
extern template std::vector<double> numbers_of<double>(const std::string&, const std::string&);
extern template std::vector<std::uint32_t> numbers_of<std::uint32_t>(const std::string&, const std::string&);

/// The direction "0,0,1", or the axis "z" or "-z"; Error (usage) names the option.
std::array<double, 3> direction_of(const std::string& text, const std::string& option);

/// --up: a direction as `direction_of` takes it, checked before any work.
class DirectionOption {
public:
    void describe(Parameters& p, const std::string& help);
    explicit operator bool() const { return !text_.empty(); }
    /// Empty where none was given.
    [[nodiscard]] std::optional<std::array<double, 3>> value() const;

private:
    std::string text_;
};

/// The annotation of this id, or of this tag if exactly one has it. Throws Error (input) that names the file.
const Annotation& find_annotation(const AnnotationSet& set, const std::string& name, const std::string& file);

}  // namespace ostraka

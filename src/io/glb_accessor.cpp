// The accessors of a glTF file as lists of numbers.
#include "ostraka/core/text.h"
#include "ostraka/io/glb.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

namespace ostraka::glb {

namespace {

constexpr std::size_t no_view = static_cast<std::size_t>(-1);

/// Size in bytes of a component type of accessors; 0: unknown type.
std::size_t component_size(int component) {
    switch (component) {
        case signed_byte:
        case byte:
            return 1;
        case signed_short:
        case short_word:
            return 2;
        case word:
        case single:
            return 4;
        default:
            return 0;
    }
}

/// A stored number as the number it stands for (glTF 2.0, section 3.11).
template <class Component, class Number>
Number value_of(Component component, bool normalised) {
    if constexpr (std::is_floating_point_v<Number> && std::is_integral_v<Component>) {
        if (!normalised) return static_cast<Number>(component);
        const Number fraction = static_cast<Number>(component) / static_cast<Number>(std::numeric_limits<Component>::max());
        return std::max(fraction, Number{-1});
    } else {
        return static_cast<Number>(component);
    }
}

/// Calls `function` with a zero of the C++ type of a component type that has a size.
template <class Function>
void with_component(int component, const Function& function) {
    if (component == signed_byte) function(std::int8_t{0});
    else if (component == byte) function(std::uint8_t{0});
    else if (component == signed_short) function(std::int16_t{0});
    else if (component == short_word) function(std::uint16_t{0});
    else if (component == word) function(std::uint32_t{0});
    else function(0.0F);
}

}  // namespace

/// Elements in a buffer view, checked against its size.
struct Reader::Stored {
    std::string_view bytes;  ///< from the first element on
    std::size_t stride = 0;  ///< bytes from one element to the next
};

Reader::Shape Reader::shape(std::size_t index, const std::string& pointer) const {
    const JsonValue& entry = element("accessors", index, pointer);
    const std::string entry_pointer = "/accessors/" + std::to_string(index);
    const std::string type = text_in(entry, "type");
    Shape shape;
    shape.width = type == "SCALAR" ? 1 : type == "VEC2" ? 2 : type == "VEC3" ? 3 : type == "VEC4" ? 4 : 0;
    if (shape.width == 0)
        fail(entry_pointer + "/type", fmt::format("'{}' is not the expected type", without_controls(type, " ").substr(0, 20)));
    shape.component = static_cast<int>(std::min<std::size_t>(number(entry, "componentType", entry_pointer, 0), 1 << 20));
    if (component_size(shape.component) == 0) fail(entry_pointer + "/componentType", "is not a known component type");
    shape.count = number(entry, "count", entry_pointer, 0);
    shape.normalised = flag_in(entry, "normalized");
    return shape;
}

/// Finds the elements that an accessor, or the values of a sparse accessor, has in a view.
Reader::Stored Reader::stored(const JsonValue& accessor, const Shape& shape, const std::string& pointer) const {
    const std::size_t index = number(accessor, "bufferView", pointer, no_view);
    if (index == no_view) fail(pointer, "has no bufferView");
    const std::string_view bytes = view(index, pointer);
    const std::size_t element_size = component_size(shape.component) * shape.width;
    std::size_t stride =
        number(element("bufferViews", index, pointer), "byteStride", "/bufferViews/" + std::to_string(index), element_size);
    if (stride == 0) stride = element_size;
    const std::size_t offset = number(accessor, "byteOffset", pointer, 0);
    if (stride < element_size || stride > 256) fail(pointer, "has a stride that does not fit");
    if (shape.count == 0) return {{}, stride};
    if (offset > bytes.size() || element_size > bytes.size() - offset ||
        shape.count - 1 > (bytes.size() - offset - element_size) / stride)
        fail(pointer, "exceeds its bufferView");
    return {bytes.substr(offset), stride};
}

template <class Number>
void Reader::read(std::size_t index, const Shape& shape, std::vector<Number>& values) const {
    const JsonValue& entry = element("accessors", index, "/accessors");
    const std::string pointer = "/accessors/" + std::to_string(index);
    const bool has_data = find_member(entry, "bufferView") != nullptr;
    const Stored source = has_data ? stored(entry, shape, pointer) : Stored{};
    charge(static_cast<double>(sizeof(Number)) * static_cast<double>(shape.count) * static_cast<double>(shape.width), pointer);
    values.resize(shape.count * shape.width);
    if (has_data)
        with_component(shape.component, [&](auto component) {
            using Component = decltype(component);
            Number* value = values.data();
            if constexpr (std::is_same_v<Component, Number>) {
                if (source.stride == shape.width * sizeof component && !values.empty()) {
                    std::memcpy(value, source.bytes.data(), values.size() * sizeof component);
                    return;
                }
            }
            for (std::size_t i = 0; i < shape.count; ++i)
                for (std::size_t k = 0; k < shape.width; ++k) {
                    std::memcpy(&component, source.bytes.data() + i * source.stride + k * sizeof component, sizeof component);
                    *value++ = value_of<decltype(component), Number>(component, shape.normalised);
                }
        });
    if (const JsonValue* sparse = find_member(entry, "sparse"); sparse != nullptr)
        read_sparse(*sparse, shape, pointer + "/sparse", values);
}

/// Replaces the elements that a sparse accessor lists (section 3.6.2.3).
template <class Number>
void Reader::read_sparse(const JsonValue& sparse, const Shape& shape, const std::string& pointer,
                         std::vector<Number>& values) const {
    const JsonValue* indices = find_member(sparse, "indices");
    const JsonValue* replacements = find_member(sparse, "values");
    if (indices == nullptr || replacements == nullptr) fail(pointer, "has no indices or no values");
    Shape places{number(sparse, "count", pointer, 0), 1,
                 static_cast<int>(std::min<std::size_t>(number(*indices, "componentType", pointer, 0), 1 << 20)), false};
    if (places.component != byte && places.component != short_word && places.component != word)
        fail(pointer + "/indices/componentType", "is not an unsigned integer");
    Shape replaced = shape;
    replaced.count = places.count;
    const Stored place_data = stored(*indices, places, pointer + "/indices"),
                 value_data = stored(*replacements, replaced, pointer + "/values");
    with_component(shape.component, [&](auto component) {
        for (std::size_t i = 0; i < places.count; ++i) {
            std::uint32_t place = 0;  // the machine is little-endian
            std::memcpy(&place, place_data.bytes.data() + i * place_data.stride, component_size(places.component));
            if (place >= shape.count) fail(pointer + "/indices", "an index is out of range");
            for (std::size_t k = 0; k < shape.width; ++k) {
                std::memcpy(&component, value_data.bytes.data() + i * value_data.stride + k * sizeof component, sizeof component);
                values[place * shape.width + k] = value_of<decltype(component), Number>(component, shape.normalised);
            }
        }
    });
}

Reader::Values Reader::accessor(std::size_t index, std::size_t width, const std::string& pointer) const {
    Values& values = read_[{index, width}];
    if (values) return values;
    const Shape described = shape(index, pointer);
    if (described.width != width) {
        const std::string type = text_in(element("accessors", index, pointer), "type");
        fail(fmt::format("/accessors/{}/type", index), fmt::format("'{}' is not the expected type", type));
    }
    std::vector<double> numbers;
    read(index, described, numbers);
    return values = std::make_shared<const std::vector<double>>(std::move(numbers));
}

std::optional<Reader::Floats> Reader::floats(std::size_t index, std::size_t width, const std::string& pointer) const {
    const Shape described = shape(index, pointer);
    const JsonValue& entry = element("accessors", index, pointer);
    if (described.component != single || described.width != width || find_member(entry, "bufferView") == nullptr ||
        find_member(entry, "sparse") != nullptr)
        return std::nullopt;
    const Stored source = stored(entry, described, "/accessors/" + std::to_string(index));
    return Floats{source.bytes.data(), source.stride, described.count};
}

std::vector<std::uint32_t> Reader::integers(std::size_t index, const std::string& pointer) const {
    const Shape described = shape(index, pointer);
    if (described.width != 1 || (described.component != byte && described.component != short_word && described.component != word))
        fail(pointer, fmt::format("accessor {} does not contain unsigned integers", index));
    std::vector<std::uint32_t> numbers;
    read(index, described, numbers);
    return numbers;
}

}  // namespace ostraka::glb

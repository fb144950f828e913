// Serialisation of values, field by field, for pickles of objects. Reading checks every length against the remaining bytes.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/core/error.h"
#include "ostraka/image/appearance.h"

#include <bit>
#include <concepts>
#include <cstring>
#include <memory>
#include <type_traits>
#include <utility>
#include <variant>

namespace ostraka::python {

static_assert(std::endian::native == std::endian::little, "archives are little-endian");

/// Throws if the bytes are not a valid archive.
[[noreturn]] inline void fail_archive(const std::string& problem) {
    fail_input("pickle", problem, "pickle the object again with this version, or save it as a file");
}

/// Whether a type is stored as in memory, without padding: numbers and arrays of numbers.
template <class T>
constexpr bool is_plain = std::is_arithmetic_v<T> && !std::same_as<T, bool>;
template <class T, std::size_t Count>
constexpr bool is_plain<std::array<T, Count>> = is_plain<T>;

/// The last value of an enumeration.
constexpr AnnotationType last_of(AnnotationType /*any*/) { return AnnotationType::region; }
constexpr Information::Kind last_of(Information::Kind /*any*/) { return Information::Kind::file; }
constexpr ImageFormat last_of(ImageFormat /*any*/) { return ImageFormat::gif; }
constexpr TextureWrap last_of(TextureWrap /*any*/) { return TextureWrap::mirror; }
constexpr Material::Alpha last_of(Material::Alpha /*any*/) { return Material::Alpha::blend; }
constexpr SurfacePoint::Kind last_of(SurfacePoint::Kind /*any*/) { return SurfacePoint::Kind::face; }

/// Appends fields to bytes.
class Writer {
public:
    template <class... T>
    void operator()(const T&... values) {
        (put(values), ...);
    }
    std::string bytes;

private:
    void put_size(std::size_t size) { put(static_cast<std::uint64_t>(size)); }
    template <class T>
    void put(const T& value) {
        if constexpr (is_plain<T>) bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
        else if constexpr (std::same_as<T, bool> || std::is_enum_v<T>) put(static_cast<std::uint8_t>(value));
        else fields(*this, value);
    }
    void put(const std::string& text) {
        put_size(text.size());
        bytes += text;
    }
    void put(const Json& document) { put(document.IsNull() ? std::string() : to_text(document)); }
    template <class T>
    void put(const std::optional<T>& value) {
        put(value.has_value());
        if (value) put(*value);
    }
    template <class T>
    void put(const std::shared_ptr<const T>& value) {
        put(value != nullptr);
        if (value) put(*value);
    }
    template <class... T>
    void put(const std::variant<T...>& value) {
        put(static_cast<std::uint8_t>(value.index()));
        std::visit([this](const auto& alternative) { put(alternative); }, value);
    }
    template <class First, class Second>
    void put(const std::pair<First, Second>& both) {
        put(both.first);
        put(both.second);
    }
    template <class T>
    void put(const std::vector<T>& list) {
        put_size(list.size());
        if constexpr (is_plain<T>) bytes.append(reinterpret_cast<const char*>(list.data()), list.size() * sizeof(T));
        else
            for (const T& element : list) put(element);
    }
};

/// Reads fields from bytes. Throws Error (input) if the bytes do not hold them.
class Reader {
public:
    explicit Reader(std::string_view bytes) : rest_(bytes) {}
    template <class... T>
    void operator()(T&... values) {
        (get(values), ...);
    }
    /// Throws Error (input) if bytes are left over.
    void end() const {
        if (!rest_.empty()) fail_archive("holds more than an object");
    }

private:
    std::string_view take(std::size_t count) {
        if (count > rest_.size()) fail_archive("is shorter than its content");
        const std::string_view part = rest_.substr(0, count);
        rest_.remove_prefix(count);
        return part;
    }
    /// Reads the length of a list whose elements take at least `bytes_each` bytes.
    std::size_t get_size(std::size_t bytes_each) {
        std::uint64_t size = 0;
        get(size);
        if (size > rest_.size() / bytes_each) fail_archive("is shorter than its content");
        return static_cast<std::size_t>(size);
    }
    template <class T>
    void get(T& value) {
        if constexpr (is_plain<T>) {
            std::memcpy(&value, take(sizeof(T)).data(), sizeof(T));
        } else if constexpr (std::same_as<T, bool> || std::is_enum_v<T>) {
            std::uint8_t number = 0;
            get(number);
            std::uint8_t last = 1;
            if constexpr (std::is_enum_v<T>) last = static_cast<std::uint8_t>(last_of(T{}));
            if (number > last) fail_archive("holds a value that is not allowed");
            value = static_cast<T>(number);
        } else {
            fields(*this, value);
        }
    }
    void get(std::string& text) { text = take(get_size(1)); }
    void get(Json& document) {
        std::string text;
        get(text);
        document = text.empty() ? Json() : parse_json(text, "pickle");
    }
    template <class T>
    void get(std::optional<T>& value) {
        bool has_value = false;
        get(has_value);
        if (has_value) get(value.emplace());
        else value.reset();
    }
    template <class T>
    void get(std::shared_ptr<const T>& value) {
        bool has_value = false;
        get(has_value);
        T content;
        if (has_value) get(content);
        value = has_value ? std::make_shared<const T>(std::move(content)) : nullptr;
    }
    template <class... T>
    void get(std::variant<T...>& value) {
        std::uint8_t index = 0;
        get(index);
        if (index >= sizeof...(T)) fail_archive("holds a value that is not allowed");
        get_alternative(value, index, std::index_sequence_for<T...>());
    }
    template <class... T, std::size_t... Alternative>
    void get_alternative(std::variant<T...>& value, std::size_t index, std::index_sequence<Alternative...> /*all*/) {
        ((index == Alternative ? get(value.template emplace<Alternative>()) : void()), ...);
    }
    template <class First, class Second>
    void get(std::pair<First, Second>& both) {
        get(both.first);
        get(both.second);
    }
    template <class T>
    void get(std::vector<T>& list) {
        list.clear();
        if constexpr (is_plain<T>) {
            list.resize(get_size(sizeof(T)));
            const std::string_view part = take(list.size() * sizeof(T));
            if (!part.empty()) std::memcpy(list.data(), part.data(), part.size());
        } else {
            for (std::size_t count = get_size(1); count > 0; --count) get(list.emplace_back());
        }
    }
    std::string_view rest_;
};

/// Matches a type both for writing (const) and for reading.
template <class T, class Of>
concept Is = std::same_as<std::remove_const_t<T>, Of>;

template <class Archive, Is<SurfacePoint> T>
void fields(Archive& archive, T& x) {
    archive(x.kind, x.element, x.weights);
}
template <class Archive, Is<Measure> T>
void fields(Archive& archive, T& x) {
    archive(x.tool, x.points, x.locations, x.direction, x.value, x.unit, x.stale, x.exact, x.repeats, x.uncertainty);
}
template <class Archive, Is<Note> T>
void fields(Archive& archive, T& x) {
    archive(x.text, x.origin);
}
template <class Archive, Is<Descriptor> T>
void fields(Archive& archive, T& x) {
    archive(x.values, x.is_list, x.file, x.unit, x.stale, x.sha256);
}
template <class Archive, Is<Attribute> T>
void fields(Archive& archive, T& x) {
    archive(x.id, x.name, x.value);
}
template <class Archive, Is<Information> T>
void fields(Archive& archive, T& x) {
    archive(x.kind, x.value, x.title, x.sha256);
}
template <class Archive, Is<Annotation> T>
void fields(Archive& archive, T& x) {
    archive(x.id, x.tag, x.colour, x.type, x.points, x.polylines, x.faces, x.curves, x.all, x.attributes, x.information, x.note);
}
template <class Archive, Is<AnnotationSet> T>
void fields(Archive& archive, T& x) {
    archive(x.object_class, x.unit, x.up, x.annotations, x.provenance, x.notes);
}

}  // namespace ostraka::python

#include "ostraka/files/npy.h"

#include "ostraka/core/error.h"

#include <fmt/core.h>

#include <array>
#include <bit>
#include <charconv>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <utility>

namespace ostraka {

static_assert(std::endian::native == std::endian::little);

namespace {

constexpr const char* remedy = "write it with numpy.save, as an array of float64 or int64 of one or two dimensions";
constexpr std::string_view magic = "\x93NUMPY";

/// Parses the header's dictionary, in Python syntax.
class HeaderReader {
public:
    HeaderReader(std::string_view text, std::string where) : text_(text), where_(std::move(where)) {}

    void read(NpyView& view) {
        std::optional<std::string> type;
        std::optional<bool> columns_first;
        std::optional<std::vector<std::size_t>> shape;
        expect('{');
        while (!next_is('}')) {
            const std::string key = quoted();
            expect(':');
            if (key == "descr" && !type) type = quoted();
            else if (key == "fortran_order" && !columns_first) columns_first = boolean();
            else if (key == "shape" && !shape) shape = sizes();
            else damaged();
            if (!next_is(',')) {
                expect('}');
                break;
            }
        }
        skip_blanks();
        if (!text_.empty() || !type || !columns_first || !shape) damaged();
        view.type = *type;
        view.columns_first = *columns_first;
        view.shape = std::move(*shape);
    }

private:
    [[noreturn]] void damaged() const { fail_input(where_, "the header of the NumPy array cannot be read", remedy); }

    void skip_blanks() { text_.remove_prefix(std::min(text_.find_first_not_of(" \n\t"), text_.size())); }
    bool next_is(char c) {
        skip_blanks();
        if (text_.empty() || text_.front() != c) return false;
        text_.remove_prefix(1);
        return true;
    }
    void expect(char c) {
        if (!next_is(c)) damaged();
    }
    std::string quoted() {
        skip_blanks();
        if (text_.empty() || (text_.front() != '\'' && text_.front() != '"')) damaged();
        const std::size_t end = text_.find(text_.front(), 1);
        if (end == std::string_view::npos || end > 40) damaged();
        std::string word(text_.substr(1, end - 1));
        text_.remove_prefix(end + 1);
        return word;
    }
    bool boolean() {
        skip_blanks();
        const bool value = text_.starts_with("True");
        if (!value && !text_.starts_with("False")) damaged();
        text_.remove_prefix(value ? 4 : 5);
        return value;
    }
    std::vector<std::size_t> sizes() {
        std::vector<std::size_t> result;
        expect('(');
        while (!next_is(')')) {
            skip_blanks();
            std::uint64_t size = 0;
            const auto [end, code] = std::from_chars(text_.data(), text_.data() + text_.size(), size);
            if (code == std::errc::result_out_of_range)
                fail_input(where_, "the shape of the array does not match the size of its data", remedy);
            if (code != std::errc() || result.size() == 40) damaged();
            text_.remove_prefix(static_cast<std::size_t>(end - text_.data()));
            result.push_back(size);
            if (!next_is(',')) {
                expect(')');
                break;
            }
        }
        return result;
    }

    std::string_view text_;
    std::string where_;
};

/// A number type: its size and its conversion.
struct Kind {
    std::string_view name;
    std::size_t size;
    double (*real)(const char*);
    std::int64_t (*integer)(const char*, const std::string&);
};

template <class Number>
Number number_at(const char* element) {
    Number number;
    std::memcpy(&number, element, sizeof number);
    return number;
}
template <class Number>
double real_of(const char* element) {
    return static_cast<double>(number_at<Number>(element));
}
template <class Number>
std::int64_t integer_of(const char* element, const std::string& where) {
    if constexpr (std::is_floating_point_v<Number>) {
        fail_input(where, "the array contains fractions, not integers", "write it with numpy.save, as int64");
    } else {
        const Number number = number_at<Number>(element);
        if (!std::in_range<std::int64_t>(number)) fail_input(where, "an integer of the array is above 2^63", remedy);
        return static_cast<std::int64_t>(number);
    }
}
template <class Number>
constexpr Kind kind(std::string_view name) {
    return {name, sizeof(Number), &real_of<Number>, &integer_of<Number>};
}

const Kind& kind_of(const std::string& type, const std::string& where) {
    static constexpr std::array kinds{kind<double>("<f8"),        kind<float>("<f4"),         kind<std::int64_t>("<i8"),
                                      kind<std::int32_t>("<i4"),  kind<std::int16_t>("<i2"),  kind<std::int8_t>("|i1"),
                                      kind<std::uint64_t>("<u8"), kind<std::uint32_t>("<u4"), kind<std::uint16_t>("<u2"),
                                      kind<std::uint8_t>("|u1"),  kind<std::uint8_t>("|b1")};
    for (const Kind& candidate : kinds)
        if (candidate.name == type) return candidate;
    fail_input(where, fmt::format("contains numbers of the unsupported type '{}'", type), remedy);
}

/// Copies the elements to row-major order, from either order in the file.
template <class Number, class Convert>
void copy(const NpyView& view, Number* values, std::size_t size, Convert&& convert) {
    const std::size_t rows = view.rows(), columns = view.columns();
    if (!view.columns_first || columns == 1) {
        for (std::size_t i = 0; i < rows * columns; ++i) values[i] = convert(view.data.data() + i * size);
        return;
    }
    for (std::size_t r = 0; r < rows; ++r)
        for (std::size_t c = 0; c < columns; ++c) values[r * columns + c] = convert(view.data.data() + (c * rows + r) * size);
}

template <class Number>
NpyArray<Number> read_array(const Path& file) {
    const std::string bytes = read_file(file);
    const NpyView view = view_npy(bytes, file.string());
    NpyArray<Number> array{view.shape, std::vector<Number>(view.count())};
    view.copy_to(array.values.data());
    return array;
}

std::string write_array(const Path& file, std::string_view type, std::string_view data, std::size_t count,
                        const std::vector<std::size_t>& shape) {
    std::size_t product = 1;
    std::string text = "(";
    for (const std::size_t size : shape) {
        product *= size;
        text += (text.size() > 1 ? ", " : "") + std::to_string(size);
    }
    if (shape.empty() || shape.size() > 2 || product != count) throw std::logic_error("write_npy: the shape does not fit");
    text += shape.size() == 1 ? ",)" : ")";
    std::string head = fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': {}, }}", type, text);
    head.resize((head.size() + 11 + 63) / 64 * 64 - 11, ' ');  // the data start at a multiple of 64
    head += '\n';
    const std::string start = std::string(magic) + std::string("\x01\x00", 2) + static_cast<char>(head.size() & 255) +
                              static_cast<char>(head.size() >> 8) + head;
    Sha256 hash;
    AtomicFile output(file);
    for (const std::string_view block : {std::string_view(start), data}) {
        hash.update(block.data(), block.size());
        output.write(block);
    }
    output.commit();
    return hash.hexadecimal();
}

template <class Number>
std::string_view bytes_of(std::span<const Number> values) {
    return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
}

}  // namespace

std::size_t NpyView::count() const { return rows() * columns(); }

void NpyView::copy_to(double* values) const {
    if (type == "<f8" && (!columns_first || columns() == 1)) {
        if (!data.empty()) std::memcpy(values, data.data(), data.size());
        return;
    }
    const Kind& number_kind = kind_of(type, where);
    copy(*this, values, number_kind.size, number_kind.real);
}

void NpyView::copy_to(std::int64_t* values) const {
    const Kind& number_kind = kind_of(type, where);
    copy(*this, values, number_kind.size, [&](const char* element) { return number_kind.integer(element, where); });
}

NpyView view_npy(std::string_view bytes, const std::string& where) {
    const auto byte = [&](std::size_t i) { return static_cast<std::size_t>(static_cast<unsigned char>(bytes[i])); };
    if (bytes.size() < 12 || bytes.substr(0, magic.size()) != magic) fail_input(where, "is not a NumPy array", remedy);
    if (byte(6) < 1 || byte(6) > 3) fail_input(where, "is a NumPy array of unknown version " + std::to_string(byte(6)), remedy);
    const bool long_header = byte(6) > 1;
    const std::size_t begin = long_header ? 12 : 10;
    const std::size_t length = byte(8) | byte(9) << 8 | (long_header ? byte(10) << 16 | byte(11) << 24 : 0);
    if (length > bytes.size() - begin) fail_input(where, "ends within the header of its NumPy array", remedy);
    NpyView view;
    view.where = where;
    HeaderReader(bytes.substr(begin, length), where).read(view);
    view.data = bytes.substr(begin + length);
    if (view.shape.empty() || view.shape.size() > 2)
        fail_input(where, fmt::format("contains an array of {} dimensions", view.shape.size()), remedy);
    const std::size_t size = kind_of(view.type, where).size;
    const std::size_t maximum = view.data.size() / size;
    const bool overflows = view.rows() != 0 && view.columns() > maximum / view.rows();
    if (overflows || view.rows() > std::max<std::size_t>(maximum, 1) || view.count() * size != view.data.size()) {
        std::string text;
        for (const std::size_t extent : view.shape) text += (text.empty() ? "" : " x ") + std::to_string(extent);
        fail_input(where,
                   fmt::format("the shape of the array ({} numbers) does not match the size of its data ({} bytes)", text,
                               view.data.size()),
                   remedy);
    }
    return view;
}

NpyArray<double> read_npy(const Path& file) { return read_array<double>(file); }
NpyArray<std::int64_t> read_npy_integers(const Path& file) { return read_array<std::int64_t>(file); }

std::string write_npy(const Path& file, std::span<const double> values, const std::vector<std::size_t>& shape) {
    return write_array(file, "<f8", bytes_of(values), values.size(), shape);
}
std::string write_npy(const Path& file, std::span<const std::int64_t> values, const std::vector<std::size_t>& shape) {
    return write_array(file, "<i8", bytes_of(values), values.size(), shape);
}

}  // namespace ostraka

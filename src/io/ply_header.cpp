#include "io/ply_header.h"

#include "io/text_reader.h"
#include "ostraka/core/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <optional>

namespace ostraka::io {

namespace {

std::optional<PlyType> parse_type(std::string_view word) {
    static const std::map<std::string_view, PlyType> types{
        {"char", PlyType::int8},     {"int8", PlyType::int8},       {"uchar", PlyType::uint8},    {"uint8", PlyType::uint8},
        {"short", PlyType::int16},   {"int16", PlyType::int16},     {"ushort", PlyType::uint16},  {"uint16", PlyType::uint16},
        {"int", PlyType::int32},     {"int32", PlyType::int32},     {"uint", PlyType::uint32},    {"uint32", PlyType::uint32},
        {"float", PlyType::float32}, {"float32", PlyType::float32}, {"double", PlyType::float64}, {"float64", PlyType::float64}};
    const auto type = types.find(word);
    return type == types.end() ? std::nullopt : std::optional(type->second);
}

PlyType type_word(TextReader& reader) {
    const std::string_view word = reader.word();
    const auto type = parse_type(word);
    if (!type)
        reader.fail("unknown property type " + in_quotes(word), "use char, uchar, short, ushort, int, uint, float or double");
    return *type;
}

PlyProperty property_line(TextReader& reader) {
    PlyProperty property;
    const char* start = reader.position();
    std::string_view word = reader.word();
    if (word == "list") {
        property.is_list = true;
        property.count_type = type_word(reader);
        if (is_real(property.count_type)) reader.fail("a list's length cannot be a real number", {}, start);
    } else {
        reader.set_position(start);
    }
    property.type = type_word(reader);
    word = reader.word();
    if (word.empty()) reader.fail("a property has no name");
    property.name = word;
    return property;
}

PlyElement element_line(TextReader& reader, const PlyHeader& header) {
    PlyElement element;
    element.name = reader.word();
    if (element.name.empty()) reader.fail("an element has no name");
    if (header.find(element.name) != nullptr) reader.fail(fmt::format("element {} is declared twice", in_quotes(element.name)));
    const std::int64_t count = reader.integer("the number of elements");
    if (count < 0) reader.fail("the number of elements is negative");
    element.count = static_cast<std::size_t>(count);
    return element;
}

}  // namespace

std::size_t size_of(PlyType type) {
    constexpr std::size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
    return sizes[static_cast<std::size_t>(type)];
}

std::size_t PlyElement::min_bytes(PlyFormat format) const {
    if (format == PlyFormat::ascii) return 2 * properties.size();  // a digit and a blank or line end per property
    std::size_t sum = 0;
    for (const PlyProperty& property : properties) sum += size_of(property.is_list ? property.count_type : property.type);
    return sum;
}

const PlyElement* PlyHeader::find(std::string_view name) const {
    const auto element = std::find_if(elements.begin(), elements.end(), [name](const PlyElement& e) { return e.name == name; });
    return element == elements.end() ? nullptr : &*element;
}

PlyHeader read_ply_header(std::string_view bytes, const std::string& file) {
    TextReader reader(bytes, file, 0);
    PlyHeader header;
    reader.set_position(without_byte_order_mark(bytes).data());
    if (!reader.next_line() || reader.word() != "ply")
        fail_input(file, "does not start with the line ply", "check that this is a PLY file");
    bool has_format = false;
    while (reader.next_line()) {
        const char* line = reader.position();
        const std::string_view keyword = reader.word();
        if (keyword == "format") {
            const std::string_view word = reader.word();
            if (word == "ascii") header.format = PlyFormat::ascii;
            else if (word == "binary_little_endian") header.format = PlyFormat::little_endian;
            else if (word == "binary_big_endian") header.format = PlyFormat::big_endian;
            else reader.fail("unknown format " + in_quotes(word), "use ascii, binary_little_endian or binary_big_endian", line);
            has_format = true;
            reader.word();  // the version is always 1.0
        } else if (keyword == "comment" || keyword == "obj_info") {
            if (reader.word() != "TextureFile") continue;
            if (header.texture_files.size() >= 1000) reader.fail("more than 1000 texture files are named");
            header.texture_files.emplace_back(reader.rest_of_line());
            continue;
        } else if (keyword == "element") {
            if (header.elements.size() >= 1000) reader.fail("more than 1000 elements are declared");
            header.elements.push_back(element_line(reader, header));
        } else if (keyword == "property") {
            if (header.elements.empty()) reader.fail("a property stands before the first element", {}, line);
            auto& properties = header.elements.back().properties;
            if (properties.size() >= 10000) reader.fail("more than 10000 properties are declared");
            properties.push_back(property_line(reader));
        } else if (keyword == "end_header") {
            if (!has_format) reader.fail("the header has no format line", {}, line);
            // Binary data begin directly after the line feed; blanks at the end of the line belong to the header.
            while (!reader.take('\n')) {
                if (reader.remaining() == 0) break;
                if (!reader.at_word_end()) reader.fail("end_header is followed by further text on its line", {}, line);
                reader.set_position(reader.position() + 1);
            }
            header.size = static_cast<std::size_t>(reader.position() - bytes.data());
            return header;
        } else {
            reader.fail("unknown header line " + in_quotes(keyword),
                        "a header has format, comment, element, property and end_header", line);
        }
        if (!reader.line_done()) reader.fail("a header line has too many words", {}, line);
    }
    reader.fail("the header has no end_header line", "the file is cut off");
}

}  // namespace ostraka::io

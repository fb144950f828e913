// PCD of the Point Cloud Library: text, binary, and binary packed by LZF column by column.
#include "point_cloud/cloud_columns.h"
#include "point_cloud/cloud_formats.h"
#include "point_cloud/little_endian.h"

#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"
#include "ostraka/core/progress.h"

#include <fmt/core.h>

#include <algorithm>

namespace ostraka::clouds {

namespace {

/// A field of the points: `count` numbers of `size` bytes.
struct PcdField {
    std::string name;
    std::size_t size = 4, count = 1;
    char type = 'F';         ///< F: real, I: whole, U: whole and not negative
    std::size_t column = 0;  ///< numbers of a point before this field
    std::size_t offset = 0;  ///< bytes of a point before this field
};

struct PcdHeader {
    std::vector<PcdField> fields;
    std::size_t points = 0, columns = 0, record = 0;
    std::string encoding;
    std::size_t size = 0;  ///< bytes before the data
    bool has_pose = false;
};

class PcdHeaderReader {
public:
    PcdHeaderReader(std::string_view bytes, const std::string& file) : bytes_(bytes), file_(file) {}

    PcdHeader read() {
        std::size_t position = 0, line_number = 0;
        while (position < bytes_.size()) {
            const std::string_view line = line_at(bytes_, position);
            if (++line_number > 1000) break;
            place_ = fmt::format("{}, line {}", file_, line_number);
            const std::string_view text = trimmed(line);
            if (text.empty() || text.starts_with('#')) continue;
            take(split_words(text));
            if (header_.encoding.empty()) continue;
            header_.size = std::min(position, bytes_.size());
            complete();
            return header_;
        }
        fail_input(file_, "has no line DATA: the header of PCD is incomplete", "the file is cut off or no PCD file");
    }

private:
    void take(const std::vector<std::string_view>& words) {
        const std::string_view key = words[0];
        const std::size_t count = words.size() - 1;
        if (count > 10000) fail_input(place_, "names more than 10000 fields", "export it again");
        if (key == "FIELDS" || key == "COLUMNS") {
            header_.fields.resize(count);
            for (std::size_t k = 0; k < count; ++k) header_.fields[k].name = words[k + 1];
        } else if (key == "SIZE" || key == "COUNT" || key == "TYPE") {
            if (count != header_.fields.size())
                fail_input(place_, fmt::format("has {} entries for {} fields", count, header_.fields.size()), "export it again");
            for (std::size_t k = 0; k < count; ++k) {
                if (key == "TYPE") header_.fields[k].type = words[k + 1] == "I" || words[k + 1] == "U" ? words[k + 1][0] : 'F';
                else (key == "SIZE" ? header_.fields[k].size : header_.fields[k].count) = whole(words[k + 1]);
            }
        } else if (key == "WIDTH" || key == "HEIGHT" || key == "POINTS") {
            if (count != 1) fail_input(place_, fmt::format("{} needs one number", key), "export it again");
            (key == "WIDTH" ? width_ : key == "HEIGHT" ? height_ : points_) = whole(words[1]);
        } else if (key == "VIEWPOINT") {
            constexpr std::array<double, 7> identity{0, 0, 0, 1, 0, 0, 0};
            for (std::size_t k = 0; k < std::min<std::size_t>(count, 7); ++k)
                header_.has_pose = header_.has_pose || number_of(words[k + 1]) != identity[k];
        } else if (key == "DATA") {
            header_.encoding = count == 1 ? std::string(words[1]) : "?";
        } else if (key != "VERSION") {
            fail_input(place_, fmt::format("'{}' is no line of a PCD header", printable(std::string(key), 40)),
                       "export it again");
        }
    }

    std::size_t whole(std::string_view word) {
        const auto value = number_of(word);
        if (!value || !(*value >= 0 && *value <= 4294967295.0) || *value != static_cast<double>(static_cast<std::size_t>(*value)))
            fail_input(place_, fmt::format("'{}' is no whole number", printable(std::string(word), 40)), "export it again");
        return static_cast<std::size_t>(*value);
    }

    void complete() {
        header_.points = points_ != none ? points_ : width_ != none ? width_ * (height_ == none ? 1 : height_) : 0;
        for (PcdField& field : header_.fields) {
            const bool fits = field.type == 'F' ? field.size == 4 || field.size == 8
                                                : field.size == 1 || field.size == 2 || field.size == 4 || field.size == 8;
            if (!fits || field.count > 100000)
                fail_input(file_,
                           fmt::format("field {} has {} numbers of type {} and {} bytes", printable(field.name, 40), field.count,
                                       field.type, field.size),
                           "export it again");
            field.column = header_.columns;
            field.offset = header_.record;
            header_.columns += field.count;
            header_.record += field.count * field.size;
        }
        if (header_.record == 0) fail_input(file_, "names no fields", "export it again");
        if (header_.columns > 1000000) fail_input(file_, "has more than a million numbers per point", "export it again");
    }

    static constexpr std::size_t none = static_cast<std::size_t>(-1);
    std::string_view bytes_;
    const std::string& file_;
    std::string place_;
    PcdHeader header_;
    std::size_t width_ = none, height_ = none, points_ = none;
};

double pcd_number(const char* bytes, char type, std::size_t size) {
    if (type == 'F') return size == 8 ? little_endian<double>(bytes) : static_cast<double>(little_endian<float>(bytes));
    if (type == 'I')
        return size == 1   ? little_endian<std::int8_t>(bytes)
               : size == 2 ? little_endian<std::int16_t>(bytes)
               : size == 4 ? little_endian<std::int32_t>(bytes)
                           : static_cast<double>(little_endian<std::int64_t>(bytes));
    return size == 1   ? little_endian<std::uint8_t>(bytes)
           : size == 2 ? little_endian<std::uint16_t>(bytes)
           : size == 4 ? little_endian<std::uint32_t>(bytes)
                       : static_cast<double>(little_endian<std::uint64_t>(bytes));
}

/// The whole number that a colour is packed into; a real number holds it in its bits.
double packed_number(const char* bytes, const PcdField& field) {
    return field.size == 4 ? little_endian<std::uint32_t>(bytes) : pcd_number(bytes, field.type, field.size);
}

std::vector<double> text_numbers(std::string_view text, const PcdHeader& header, const std::string& file) {
    // A number takes at least two bytes of the file.
    if (header.points > text.size() / std::max<std::size_t>(2 * header.columns - 1, 1) + 1)
        fail_input(file, fmt::format("promises {} points, but only {} bytes follow", header.points, text.size()),
                   "the file is cut off or its header is wrong");
    std::vector<double> values, numbers;
    values.reserve(header.points * header.columns);
    std::size_t position = 0;
    CancelCheck check;
    for (std::size_t i = 0; i < header.points; ++i) {
        check();
        std::string_view line;
        while (position < text.size() && line.empty()) line = trimmed(line_at(text, position));
        if (line.empty()) fail_input(file, fmt::format("ends after {} of {} points", i, header.points), "the file is cut off");
        CloudLines words(line, file);
        if (!words.next() || !words.numbers(numbers) || numbers.size() != header.columns)
            fail_input(file, fmt::format("point {} does not have {} numbers", i, header.columns), "correct or remove the point");
        values.insert(values.end(), numbers.begin(), numbers.end());
    }
    return values;
}

/// Unpacks the data of a file of encoding binary_compressed.
std::string unpacked_columns(std::string_view data, const PcdHeader& header, std::size_t file_size, const std::string& file) {
    if (data.size() < 8) fail_input(file, "ends inside its packed data", "the file is cut off");
    const std::size_t packed = little_endian<std::uint32_t>(data.data()), size = little_endian<std::uint32_t>(data.data() + 4);
    if (packed > data.size() - 8)
        fail_input(file, fmt::format("promises {} bytes of packed data, but holds {}", packed, data.size() - 8),
                   "the file is cut off");
    if (size / header.record < header.points)
        fail_input(file, fmt::format("promises {} points of {} bytes in {} unpacked bytes", header.points, header.record, size),
                   "its header is damaged; export it again");
    if (static_cast<double>(size) > 4 * static_cast<double>(file_size) + 64e6)
        fail_input(file, fmt::format("claims to unpack to {} bytes, far more than a file of {} bytes should", size, file_size),
                   "save it unpacked: pcl_convert_pcd_ascii_binary IN.pcd OUT.pcd 1");
    std::string columns;
    if (!unpack_lzf(data.substr(8, packed), size, columns)) fail_input(file, "its packed data are damaged", "export it again");
    return columns;
}

CloudTable pcd_columns(const PcdHeader& header) {
    CloudTable table;
    table.columns.assign(header.columns, Column::other);
    table.rows = header.points;
    for (const PcdField& field : header.fields) {
        if (field.count != 1) continue;
        Column& column = table.columns[field.column] = column_named(field.name);
        if (column == Column::red && field.type != 'F')
            table.colour_range = field.size == 1 ? ColourRange::bytes : table.colour_range;
    }
    return table;
}

}  // namespace

PointCloud read_pcd(std::string_view bytes, const std::string& file) {
    const PcdHeader header = PcdHeaderReader(bytes, file).read();
    const std::string_view data = bytes.substr(header.size);
    CloudBuilder builder(file, bytes.size());
    if (header.has_pose) builder.note("the viewpoint of the sensor is not kept, and the points are not moved by it");
    CloudTable table = pcd_columns(header);
    std::vector<const PcdField*> field_of_column(header.columns, nullptr);
    for (const PcdField& field : header.fields)
        if (field.count > 0) field_of_column[field.column] = &field;
    std::vector<double> values;
    std::string columns;
    if (header.encoding == "ascii") {
        values = text_numbers(data, header, file);
        table.at = [&](std::size_t row, std::size_t column) {
            const double value = values[row * header.columns + column];
            if (table.columns[column] != Column::packed_colour || field_of_column[column]->type != 'F') return value;
            return static_cast<double>(std::bit_cast<std::uint32_t>(static_cast<float>(value)));
        };
    } else if (header.encoding == "binary" || header.encoding == "binary_compressed") {
        const bool is_packed = header.encoding != "binary";
        if (is_packed) columns = unpacked_columns(data, header, bytes.size(), file);
        else if (data.size() / header.record < header.points)
            fail_input(file, fmt::format("promises {} points, but holds only {}", header.points, data.size() / header.record),
                       "the file is cut off");
        const char* first = is_packed ? columns.data() : data.data();
        table.at = [&header, &table, &field_of_column, first, is_packed](std::size_t row, std::size_t column) {
            const PcdField& field = *field_of_column[column];
            const char* number =
                is_packed ? first + header.points * field.offset + row * field.size : first + row * header.record + field.offset;
            return table.columns[column] == Column::packed_colour ? packed_number(number, field)
                                                                  : pcd_number(number, field.type, field.size);
        };
    } else {
        fail_input(file, fmt::format("has data of kind '{}'", printable(header.encoding, 40)),
                   "save it as ascii, binary or binary_compressed");
    }
    std::vector<std::string> unused;
    for (const PcdField& field : header.fields)
        if (field.name != "_" && (field.count != 1 || table.columns[field.column] == Column::other))
            unused.push_back(printable(field.name, 40));
    if (!unused.empty() && unused.size() <= 100) builder.note("fields not kept: " + joined(unused));
    add_table(builder, table);
    return builder.finish();
}

bool unpack_lzf(std::string_view packed, std::size_t size, std::string& unpacked) {
    unpacked.clear();
    unpacked.reserve(size);
    const auto byte = [&](std::size_t i) { return static_cast<std::size_t>(static_cast<unsigned char>(packed[i])); };
    for (std::size_t i = 0; i < packed.size();) {
        const std::size_t control = byte(i++);
        if (control < 32) {  // a run of bytes as they are
            const std::size_t length = control + 1;
            if (length > packed.size() - i || length > size - unpacked.size()) return false;
            unpacked.append(packed, i, length);
            i += length;
            continue;
        }
        std::size_t length = control >> 5U;
        if (length == 7) {
            if (i == packed.size()) return false;
            length += byte(i++);
        }
        length += 2;
        if (i == packed.size()) return false;
        const std::size_t distance = ((control & 31U) << 8U) + byte(i++) + 1;
        if (distance > unpacked.size() || length > size - unpacked.size()) return false;
        for (; length > 0; --length) unpacked.push_back(unpacked[unpacked.size() - distance]);
    }
    return unpacked.size() == size;
}

}  // namespace ostraka::clouds

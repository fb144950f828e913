// Scans of E57 files (ASTM E2807-11): coordinates, colours, intensities and normals, with the poses of the scans.
#include "point_cloud/cloud_columns.h"
#include "point_cloud/cloud_formats.h"
#include "point_cloud/e57_file.h"

#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"
#include "ostraka/core/progress.h"

#include <fmt/core.h>
#include <Eigen/Geometry>
#include <pugixml.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>

namespace ostraka::clouds {

namespace {

/// The columns of the standard that are read.
enum class Field : std::uint8_t {
    x,
    y,
    z,
    range,
    azimuth,
    elevation,
    invalid,
    invalid_spherical,
    intensity,
    invalid_intensity,
    red,
    green,
    blue,
    invalid_colour,
    nx,
    ny,
    nz,
    count
};
constexpr std::size_t field_count = static_cast<std::size_t>(Field::count);
constexpr std::array<const char*, field_count> field_names{"cartesianX",
                                                           "cartesianY",
                                                           "cartesianZ",
                                                           "sphericalRange",
                                                           "sphericalAzimuth",
                                                           "sphericalElevation",
                                                           "cartesianInvalidState",
                                                           "sphericalInvalidState",
                                                           "intensity",
                                                           "isIntensityInvalid",
                                                           "colorRed",
                                                           "colorGreen",
                                                           "colorBlue",
                                                           "isColorInvalid",
                                                           "normalX",
                                                           "normalY",
                                                           "normalZ"};

/// The name of an element without the prefix of an extension.
const char* plain_name(pugi::xml_node node) {
    const char* colon = std::strchr(node.name(), ':');
    return colon == nullptr ? node.name() : colon + 1;
}

/// A number of an attribute or element; `missing` if it is empty.
double number_or(const char* text, double missing, const std::string& place, const char* name) {
    if (trimmed(text).empty()) return missing;
    const auto value = number_of(text);
    if (!value)
        fail_input(place, fmt::format("'{}' of {} is no number", printable(text, 40), printable(name, 40)), "export it again");
    return *value;
}

double child_number(pugi::xml_node parent, const char* name, double missing, const std::string& place) {
    const pugi::xml_node node = parent.child(name);
    return node ? number_or(node.child_value(), 0, place, name) : missing;
}

std::int64_t whole_attribute(pugi::xml_node node, const char* name, std::int64_t missing, const std::string& place) {
    const std::string_view text = trimmed(node.attribute(name).value());
    if (text.empty()) return missing;
    std::int64_t value = 0;
    const auto [stop, code] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (code != std::errc() || stop != text.data() + text.size())
        fail_input(place,
                   fmt::format("'{}' of {} is no whole number", printable(std::string(text), 40), printable(node.name(), 40)),
                   "export it again");
    return value;
}

/// The column that an element of the prototype declares.
E57Column column_of(pugi::xml_node node, const std::string& place) {
    using Limits = std::numeric_limits<std::int64_t>;
    E57Column column;
    column.name = plain_name(node);
    const std::string_view type = node.attribute("type").value();
    const auto real = [&](const char* name, double missing) {
        return number_or(node.attribute(name).value(), missing, place, name);
    };
    if (type == "Float") {
        const bool single = std::string_view(node.attribute("precision").value()) == "single";
        column.type = single ? E57Column::Type::single_real : E57Column::Type::double_real;
        column.real_minimum = real("minimum", 0);
        column.real_maximum = real("maximum", 0);
    } else if (type == "Integer" || type == "ScaledInteger") {
        column.type = E57Column::Type::integer;
        column.minimum = whole_attribute(node, "minimum", Limits::min(), place);
        column.maximum = whole_attribute(node, "maximum", Limits::max(), place);
        if (column.maximum < column.minimum)
            fail_input(place, fmt::format("{} has a maximum below its minimum", printable(column.name, 40)), "export it again");
        if (type == "ScaledInteger") {
            column.scale = real("scale", 1);
            column.offset = real("offset", 0);
        }
    } else if (type == "String") {
        column.type = E57Column::Type::text;
    } else {
        fail_input(place, fmt::format("{} has the type '{}'", printable(column.name, 40), printable(std::string(type), 40)),
                   "export it again");
    }
    return column;
}

/// The columns of the prototype, nested ones too, in the order of their bytestreams.
void collect_columns(pugi::xml_node prototype, std::vector<E57Column>& columns, std::size_t depth, const std::string& place) {
    for (const pugi::xml_node node : prototype.children()) {
        if (node.type() != pugi::node_element) continue;
        const std::string_view type = node.attribute("type").value();
        if (type == "Structure" || type == "Vector") {
            if (depth > 20) fail_input(place, "the columns of the points are nested too deeply", "export it again");
            const std::size_t first = columns.size();
            collect_columns(node, columns, depth + 1, place);
            for (std::size_t k = first; k < columns.size(); ++k) columns[k].name = "/" + columns[k].name.substr(0, 100);
        } else {
            columns.push_back(column_of(node, place));
        }
        if (columns.size() > 10000) fail_input(place, "has more than 10000 columns", "export it again");
    }
}

/// Maps a column of colours to 0 to 255.
struct ColourLimits {
    double minimum = 0, maximum = 255;
    [[nodiscard]] std::uint8_t channel(double value) const {
        return cloud_channel(255 * (value - minimum) / (maximum - minimum));
    }
};

ColourLimits colour_limits(const E57Column& column, pugi::xml_node limits, const char* colour, const std::string& place) {
    // The range of a byte or of 16 bits is the range of the colours, whatever the brightest point of the scan is.
    if (column.type == E57Column::Type::integer && column.scale == 1 && column.minimum == 0 &&
        (column.maximum == 255 || column.maximum == 65535))
        return {0, static_cast<double>(column.maximum)};
    ColourLimits result;
    result.minimum = child_number(limits, fmt::format("color{}Minimum", colour).c_str(), 0, place);
    result.maximum = child_number(limits, fmt::format("color{}Maximum", colour).c_str(), 0, place);
    if (result.maximum > result.minimum) return result;
    if (column.type == E57Column::Type::integer) {
        const double low = column.value(0), high = static_cast<double>(column.maximum) * column.scale + column.offset;
        return high > low && high <= 65535 ? ColourLimits{low, high} : ColourLimits();
    }
    return column.real_maximum > column.real_minimum ? ColourLimits{column.real_minimum, column.real_maximum}
                                                     : ColourLimits{0, 1};
}

/// The pose that places a scan in the common frame.
Eigen::Isometry3d pose_of(pugi::xml_node scan, const std::string& place) {
    Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
    const pugi::xml_node pose = scan.child("pose");
    if (!pose) return result;
    if (const pugi::xml_node rotation = pose.child("rotation")) {
        const auto part = [&](const char* name) { return child_number(rotation, name, 0, place); };
        const Eigen::Quaterniond quaternion(part("w"), part("x"), part("y"), part("z"));
        const double length = quaternion.norm();
        if (!(length > 1e-100 && length < 1e100)) fail_input(place, "its rotation has no length", "export it again with poses");
        result.linear() = Eigen::Quaterniond(quaternion.coeffs() / length).toRotationMatrix();
    }
    if (const pugi::xml_node translation = pose.child("translation"))
        for (const auto& [k, name] : {std::pair{0, "x"}, {1, "y"}, {2, "z"}})
            result.translation()[k] = child_number(translation, name, 0, place);
    return result;
}

/// One scan of the file.
class E57Scan {
public:
    E57Scan(pugi::xml_node scan, std::string place) : scan_(scan), points_(scan.child("points")), place_(std::move(place)) {
        if (std::string_view(points_.attribute("type").value()) != "CompressedVector")
            fail_input(place_, "has no points of type CompressedVector", "export it again");
        const pugi::xml_node codecs = points_.child("codecs");
        for (const pugi::xml_node codec : codecs.children())
            if (codec.type() == pugi::node_element && !codec.child("bitPackCodec") &&
                std::strcmp(plain_name(codec), "bitPackCodec") != 0)
                fail_input(place_, "its points are packed by a codec that is not in the standard", "export it again without it");
        section_ = count_attribute("fileOffset");
        records_ = count_attribute("recordCount");
        collect_columns(points_.child("prototype"), columns_, 0, place_);
        for (std::size_t k = 0; k < columns_.size(); ++k) {
            if (columns_[k].type == E57Column::Type::text) continue;
            const auto name = std::find(field_names.begin(), field_names.end(), columns_[k].name);
            if (name == field_names.end()) continue;
            auto& column = column_of_field_[static_cast<std::size_t>(name - field_names.begin())];
            if (!column) column = k;
        }
        cartesian_ = has(Field::x) && has(Field::y) && has(Field::z);
        if (!cartesian_ && !(has(Field::range) && has(Field::azimuth) && has(Field::elevation)))
            fail_input(place_, "has neither cartesian nor spherical coordinates", "export it again");
        coloured_ = has(Field::red) && has(Field::green) && has(Field::blue);
        with_normals_ = has(Field::nx) && has(Field::ny) && has(Field::nz);
    }

    void add_to(CloudBuilder& builder, const E57Pages& pages, std::vector<std::string>& unused) {
        std::vector<bool> wanted(columns_.size(), false);
        for (const auto& column : column_of_field_)
            if (column) wanted[*column] = true;
        for (std::size_t k = 0; k < columns_.size(); ++k)
            if (!wanted[k] && std::find(unused.begin(), unused.end(), columns_[k].name) == unused.end() && unused.size() < 100)
                unused.push_back(columns_[k].name);
        std::vector<E57Stream> streams = e57_streams(pages, section_, records_, columns_, wanted, place_);
        builder.begin_scan(static_cast<std::size_t>(std::min<std::uint64_t>(records_, no_index)),
                           {with_normals_, coloured_, has(Field::intensity)});
        prepare();
        std::vector<std::size_t> field_of_stream;
        std::vector<unsigned> bits;
        for (std::size_t k = 0; k < columns_.size(); ++k) {
            if (!wanted[k]) continue;
            field_of_stream.push_back(static_cast<std::size_t>(
                std::find(column_of_field_.begin(), column_of_field_.end(), std::optional(k)) - column_of_field_.begin()));
            bits.push_back(columns_[k].bits());
        }
        CancelCheck check;
        std::array<double, field_count> values{};
        for (std::uint64_t record = 0; record < records_; ++record) {
            check();
            for (std::size_t s = 0; s < streams.size(); ++s)
                values[field_of_stream[s]] = column(field_of_stream[s]).value(streams[s].next(bits[s]));
            add_point(builder, values);
        }
    }

private:
    [[nodiscard]] bool has(Field field) const { return column_of_field_[static_cast<std::size_t>(field)].has_value(); }
    [[nodiscard]] const E57Column& column(std::size_t field) const { return columns_[*column_of_field_[field]]; }

    std::uint64_t count_attribute(const char* name) {
        const std::int64_t value = whole_attribute(points_, name, -1, place_);
        if (value < 0) fail_input(place_, fmt::format("its points have no {}", name), "export it again");
        return static_cast<std::uint64_t>(value);
    }

    void prepare() {
        pose_ = pose_of(scan_, place_);
        if (!coloured_) return;
        constexpr std::array<const char*, 3> colours{"Red", "Green", "Blue"};
        for (std::size_t k = 0; k < 3; ++k)
            limits_[k] =
                colour_limits(column(static_cast<std::size_t>(Field::red) + k), scan_.child("colorLimits"), colours[k], place_);
    }

    void add_point(CloudBuilder& builder, const std::array<double, field_count>& values) const {
        const auto value = [&](Field field) { return values[static_cast<std::size_t>(field)]; };
        const auto is_set = [&](Field field) { return has(field) && value(field) != 0; };
        if (is_set(cartesian_ ? Field::invalid : Field::invalid_spherical)) return builder.drop_empty();
        Vector3d place(value(Field::x), value(Field::y), value(Field::z));
        if (!cartesian_) {
            const double range = value(Field::range), azimuth = value(Field::azimuth), elevation = value(Field::elevation);
            place = range * Vector3d(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                                     std::sin(elevation));
        }
        CloudPoint point;
        place = pose_ * place;
        point.place = Point(place.x(), place.y(), place.z());
        if (with_normals_) {
            const Vector3d normal = pose_.linear() * Vector3d(value(Field::nx), value(Field::ny), value(Field::nz));
            point.normal = Vector(normal.x(), normal.y(), normal.z());
        }
        if (coloured_ && !is_set(Field::invalid_colour)) {
            for (std::size_t k = 0; k < 3; ++k)
                point.colour[k] = limits_[k].channel(values[static_cast<std::size_t>(Field::red) + k]);
            point.colour[3] = 255;
        }
        if (has(Field::intensity) && !is_set(Field::invalid_intensity)) point.intensity = value(Field::intensity);
        builder.add(point);
    }

    pugi::xml_node scan_, points_;
    std::string place_;
    std::uint64_t section_ = 0, records_ = 0;
    std::vector<E57Column> columns_;
    std::array<std::optional<std::size_t>, field_count> column_of_field_{};
    std::array<ColourLimits, 3> limits_{};
    Eigen::Isometry3d pose_ = Eigen::Isometry3d::Identity();
    bool cartesian_ = false, coloured_ = false, with_normals_ = false;
};

std::size_t element_count(pugi::xml_node parent) {
    std::size_t count = 0;
    for (const pugi::xml_node node : parent.children()) count += node.type() == pugi::node_element ? 1 : 0;
    return count;
}

}  // namespace

PointCloud read_e57(std::string& bytes, const std::string& file) {
    const std::size_t file_size = bytes.size();
    const E57Pages pages(bytes, file);
    pugi::xml_document document;
    const pugi::xml_parse_result parsed = document.load_buffer(pages.xml().data(), pages.xml().size());
    if (!parsed) fail_input(file, fmt::format("its XML section is damaged ({})", parsed.description()), "export it again");
    const pugi::xml_node root = document.child("e57Root"), scans = root.child("data3D");
    const std::size_t scan_count = element_count(scans);
    if (scan_count == 0) fail_input(file, "holds no scan", "export it again with points");
    CloudBuilder builder(file, file_size);
    std::vector<std::string> unused;
    std::size_t number = 0;
    for (const pugi::xml_node scan : scans.children()) {
        if (scan.type() != pugi::node_element) continue;
        E57Scan(scan, fmt::format("{}, scan {}", file, ++number)).add_to(builder, pages, unused);
    }
    if (scan_count > 1) builder.note(fmt::format("{} scans were merged by their poses", scan_count));
    for (std::string& name : unused) name = printable(name, 40);
    if (!unused.empty()) builder.note("columns not kept: " + joined(unused));
    if (const std::size_t images = element_count(root.child("images2D")); images > 0)
        builder.note(counted(images, "image") + " of the file " + (images == 1 ? "is" : "are") + " not kept");
    return builder.finish();
}

}  // namespace ostraka::clouds

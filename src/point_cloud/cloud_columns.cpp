#include "point_cloud/cloud_columns.h"

#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"
#include "ostraka/core/text.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

namespace ostraka::clouds {

namespace {

/// Indices of three columns that belong together.
using Triple = std::array<std::size_t, 3>;

std::optional<Triple> triple_of(const std::vector<Column>& columns, Column first) {
    Triple triple{};
    for (std::size_t k = 0; k < 3; ++k) {
        triple[k] = column_index(columns, static_cast<Column>(static_cast<std::size_t>(first) + k));
        if (triple[k] == columns.size()) return std::nullopt;
    }
    return triple;
}

/// Factor from the numbers of the colour columns to 0 to 255.
double colour_factor(const CloudTable& table, const Triple& colours) {
    if (table.colour_range == ColourRange::unit) return 255;
    if (table.colour_range == ColourRange::bytes) return 1;
    double largest = 0;
    for (std::size_t row = 0; row < table.rows; ++row)
        for (const std::size_t column : colours)
            if (const double value = table.at(row, column); std::isfinite(value)) largest = std::max(largest, value);
    constexpr double sixteen_bits = 257;
    return largest <= 1 ? 255 : largest <= 255 ? 1 : 1 / sixteen_bits;
}

Colour unpacked(double packed) {
    if (!(packed >= 0 && packed <= 0xFFFFFFFFU)) return {0, 0, 0, 0};
    const auto bits = static_cast<std::uint32_t>(packed);
    return {static_cast<std::uint8_t>(bits >> 16U & 255U), static_cast<std::uint8_t>(bits >> 8U & 255U),
            static_cast<std::uint8_t>(bits & 255U), 255};
}

}  // namespace

std::size_t column_index(const std::vector<Column>& columns, Column role) {
    return static_cast<std::size_t>(std::find(columns.begin(), columns.end(), role) - columns.begin());
}

Column column_named(std::string_view name) {
    static const std::map<std::string, Column, std::less<>> names{{"x", Column::x},
                                                                  {"easting", Column::x},
                                                                  {"y", Column::y},
                                                                  {"northing", Column::y},
                                                                  {"z", Column::z},
                                                                  {"elevation", Column::z},
                                                                  {"height", Column::z},
                                                                  {"altitude", Column::z},
                                                                  {"nx", Column::nx},
                                                                  {"ny", Column::ny},
                                                                  {"nz", Column::nz},
                                                                  {"normalx", Column::nx},
                                                                  {"normaly", Column::ny},
                                                                  {"normalz", Column::nz},
                                                                  {"r", Column::red},
                                                                  {"g", Column::green},
                                                                  {"b", Column::blue},
                                                                  {"red", Column::red},
                                                                  {"green", Column::green},
                                                                  {"blue", Column::blue},
                                                                  {"rf", Column::red},
                                                                  {"gf", Column::green},
                                                                  {"bf", Column::blue},
                                                                  {"diffusered", Column::red},
                                                                  {"diffusegreen", Column::green},
                                                                  {"diffuseblue", Column::blue},
                                                                  {"colorred", Column::red},
                                                                  {"colorgreen", Column::green},
                                                                  {"colorblue", Column::blue},
                                                                  {"rgb", Column::packed_colour},
                                                                  {"rgba", Column::packed_colour},
                                                                  {"i", Column::intensity},
                                                                  {"intensity", Column::intensity},
                                                                  {"scalarintensity", Column::intensity},
                                                                  {"reflectance", Column::intensity},
                                                                  {"scalarreflectance", Column::intensity},
                                                                  {"amplitude", Column::intensity}};
    std::string plain;
    for (const char c : name) {
        if (c == '[' || c == '(') break;  // a unit
        if (c != '"' && c != '\'' && c != '_' && c != ' ' && c != '\r') plain += c;
    }
    const auto entry = names.find(lower_case(plain));
    return entry == names.end() ? Column::other : entry->second;
}

void add_table(CloudBuilder& builder, const CloudTable& table) {
    const auto place = triple_of(table.columns, Column::x);
    if (!place) fail_input(builder.file(), "the points lack one of the columns x, y and z", "export it again with coordinates");
    const auto normal = triple_of(table.columns, Column::nx), colours = triple_of(table.columns, Column::red);
    const std::size_t packed = column_index(table.columns, Column::packed_colour),
                      intensity = column_index(table.columns, Column::intensity), none = table.columns.size();
    builder.begin_scan(table.rows, {normal.has_value(), colours || packed != none, intensity != none});
    const double factor = colours ? colour_factor(table, *colours) : 1;
    CancelCheck check;
    for (std::size_t row = 0; row < table.rows; ++row) {
        check();
        const auto vector_at = [&](const Triple& columns) {
            return Vector(table.at(row, columns[0]), table.at(row, columns[1]), table.at(row, columns[2]));
        };
        CloudPoint point;
        point.place = CGAL::ORIGIN + vector_at(*place);
        if (normal) point.normal = vector_at(*normal);
        if (colours) {
            for (std::size_t k = 0; k < 3; ++k) point.colour[k] = cloud_channel(factor * table.at(row, (*colours)[k]));
            point.colour[3] = 255;
        } else if (packed != none) {
            point.colour = unpacked(table.at(row, packed));
        }
        if (intensity != none) point.intensity = table.at(row, intensity);
        builder.add(point);
    }
}

}  // namespace ostraka::clouds

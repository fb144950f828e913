// Tables of numbers with named columns (text, PLY, PCD), and which column holds what.
#pragma once

#include "point_cloud/cloud_builder.h"

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace ostraka::clouds {

/// What a column of a table holds. `packed_colour`: red, green and blue as the bytes of one whole number (0xRRGGBB).
enum class Column : std::uint8_t { other, x, y, z, nx, ny, nz, red, green, blue, packed_colour, intensity, count };

/// The column with this name in the headers of scanning programs (Red, Rf, diffuse_red; nx, NormalX, normal_x; Easting ...).
Column column_named(std::string_view name);

/// Range of the numbers of the colour columns.
enum class ColourRange { from_values, unit, bytes };

/// A table with one row per point.
struct CloudTable {
    std::vector<Column> columns;                                    ///< what each column holds
    std::size_t rows = 0;                                           ///< number of points
    std::function<double(std::size_t row, std::size_t column)> at;  ///< a number of the table
    ColourRange colour_range = ColourRange::from_values;
};

/// Adds the points of a table as one scan. Colours whose range is `from_values` are taken for 0 to 1 if no value exceeds 1, for
/// bytes if none exceeds 255, else for 16 bits. Throws Error (input) if x, y or z is missing.
void add_table(CloudBuilder& builder, const CloudTable& table);

/// The index of the first column that holds `role`; the number of columns if there is none.
std::size_t column_index(const std::vector<Column>& columns, Column role);

}  // namespace ostraka::clouds

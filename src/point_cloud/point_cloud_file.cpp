// Reads points without faces from files.
#include "ostraka/core/error.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/io/ply.h"
#include "ostraka/mesh/limits.h"
#include "ostraka/point_cloud/point_cloud.h"

#include <fmt/core.h>

#include <charconv>
#include <cmath>

namespace ostraka {

namespace {

/// Parses the numbers of a line, separated by spaces, commas, semicolons and tabs; false for any other content.
bool numbers_of_line(std::string_view line, std::vector<double>& numbers) {
    numbers.clear();
    const char *position = line.data(), *end = position + line.size();
    while (true) {
        while (position < end &&
               (*position == ' ' || *position == '\t' || *position == ',' || *position == ';' || *position == '\r'))
            ++position;
        if (position == end) return true;
        if (*position == '+') ++position;
        double value = 0;
        const auto [next, error] = std::from_chars(position, end, value);
        if (error != std::errc()) return false;
        numbers.push_back(value);
        position = next;
    }
}

PointCloud read_text(const Path& file) {
    PointCloud cloud;
    const std::string bytes = read_file(file);
    const std::string name = file.string();
    std::vector<double> numbers;
    std::size_t line = 0, columns = 0;
    std::vector<Vector> normals;
    for (std::size_t begin = 0; begin < bytes.size();) {
        std::size_t end = bytes.find('\n', begin);
        if (end == std::string::npos) end = bytes.size();
        const std::string_view text(bytes.data() + begin, end - begin);
        begin = end + 1;
        ++line;
        if (text.starts_with('#') || text.find_first_not_of(" \t\r") == std::string_view::npos) continue;
        const std::string where = name + ", line " + std::to_string(line);
        if (!numbers_of_line(text, numbers))
            fail_input(where, "is not a list of numbers", "give x y z, or x y z nx ny nz, a line");
        if (numbers.size() == 1 && cloud.points.empty() && columns == 0) continue;  // a count of points, as in .pts files
        if (numbers.size() < 3) fail_input(where, "has fewer than three numbers", "give x y z, or x y z nx ny nz, a line");
        if (columns == 0) columns = numbers.size();
        if (numbers.size() != columns)
            fail_input(where, fmt::format("has {} numbers, the first line {}", numbers.size(), columns),
                       "give every line the same columns");
        for (const double x : numbers)
            if (!std::isfinite(x)) fail_input(where, "has a number that is not finite", "correct or remove the point");
        cloud.points.emplace_back(numbers[0], numbers[1], numbers[2]);
        if (columns == 6) normals.emplace_back(numbers[3], numbers[4], numbers[5]);
    }
    // Six columns may be a colour instead.
    bool unit = true;
    for (const Vector& n : normals) unit = unit && std::abs(n.squared_length() - 1) < 0.1;
    if (unit) cloud.normals = std::move(normals);
    else cloud.notes.emplace_back("columns 4 to 6 are not vectors of length 1 and are not kept");
    if (columns != 3 && columns != 6) cloud.notes.emplace_back("columns after the third are not kept");
    return cloud;
}

}  // namespace

std::optional<PointCloud> read_point_cloud(const Path& file) {
    const std::string file_extension = extension(file);
    PointCloud cloud;
    if (file_extension == ".xyz" || file_extension == ".pts" || file_extension == ".asc" || file_extension == ".txt") {
        cloud = read_text(file);
    } else {
        PolygonSoup soup = read_polygons(file);
        if (soup.polygon_count() > 0) return std::nullopt;
        for (const auto& p : soup.points) cloud.points.emplace_back(p[0], p[1], p[2]);
        cloud.notes = std::move(soup.notes);
        if (file_extension == ".ply")
            for (const auto& n : read_ply_vectors(file, {"nx", "ny", "nz"})) cloud.normals.emplace_back(n[0], n[1], n[2]);
    }
    if (cloud.points.empty()) fail_input(file.string(), "has neither faces nor points", "export it again");
    for (std::size_t i = 0; i < cloud.points.size(); ++i)
        if (!is_place(cloud.points[i]))
            fail_input(file.string(), fmt::format("point {} exceeds the supported range of coordinates", i), "remove it");
    for (Vector& n : cloud.normals) {
        n = unit_vector(n);
        if (n == CGAL::NULL_VECTOR) {
            cloud.notes.emplace_back("some normals have no length, so that none is kept");
            cloud.normals.clear();
            break;
        }
    }
    return cloud;
}

}  // namespace ostraka

// Points without faces, from files.
#include "ostraka/core/error.h"
#include "ostraka/core/limits.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/point_cloud/point_cloud.h"

#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <sstream>

namespace ostraka {

namespace {

/// Numbers of a line apart from spaces, commas, semicolons and tabs; false where something else stands.
bool numbers_of_line(std::string_view line, std::vector<double>& numbers) {
    numbers.clear();
    const char *at = line.data(), *end = at + line.size();
    while (true) {
        while (at < end && (*at == ' ' || *at == '\t' || *at == ',' || *at == ';' || *at == '\r')) ++at;
        if (at == end) return true;
        if (*at == '+') ++at;
        double value = 0;
        const auto [next, error] = std::from_chars(at, end, value);
        if (error != std::errc()) return false;
        numbers.push_back(value);
        at = next;
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
        if (numbers.size() == 1 && cloud.points.empty() && columns == 0) continue;  // a count of points, as .pts has
        if (numbers.size() < 3) fail_input(where, "has fewer than three numbers", "give x y z, or x y z nx ny nz, a line");
        if (columns == 0) columns = numbers.size();
        if (numbers.size() != columns)
            fail_input(where, "has " + std::to_string(numbers.size()) + " numbers, the first line " + std::to_string(columns),
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

std::size_t bytes_of(const std::string& type) {
    if (type == "char" || type == "uchar" || type == "int8" || type == "uint8") return 1;
    if (type == "short" || type == "ushort" || type == "int16" || type == "uint16") return 2;
    if (type == "int" || type == "uint" || type == "float" || type == "int32" || type == "uint32" || type == "float32") return 4;
    if (type == "double" || type == "float64") return 8;
    return 0;
}

/// The properties nx, ny, nz of the vertices of a PLY file whose points are read already, so that its syntax is known to be
/// sound; empty where it has none, or they are not plain numbers of the first element.
std::vector<Vector> ply_normals(const std::string& bytes, std::size_t count) {
    const std::size_t mark = bytes.find("end_header");
    if (mark == std::string::npos) return {};
    std::istringstream header(bytes.substr(0, mark));
    std::string word, format, element, line;
    std::vector<std::pair<std::string, std::string>> properties;  // type, name
    int elements = 0;
    while (std::getline(header, line)) {
        std::istringstream words(line);
        if (!(words >> word)) continue;
        if (word == "format") words >> format;
        if (word == "element" && ++elements == 1 && words >> element && element != "vertex") return {};
        if (word == "property" && elements == 1) {
            std::string type, name;
            words >> type >> name;
            properties.emplace_back(type, name);
        }
    }
    std::array<std::size_t, 3> column{}, offset{};
    std::array<bool, 3> real8{};
    std::size_t stride = 0;
    int found = 0;
    for (std::size_t i = 0; i < properties.size(); ++i) {
        const std::size_t size = bytes_of(properties[i].first);
        if (size == 0) return {};  // a list
        for (std::size_t k = 0; k < 3; ++k)
            if (properties[i].second == std::array{"nx", "ny", "nz"}.at(k)) {
                const bool real = properties[i].first.starts_with("float") || properties[i].first == "double";
                if (!real) return {};
                column[k] = i, offset[k] = stride, real8[k] = size == 8, ++found;
            }
        stride += size;
    }
    if (found != 3) return {};
    std::size_t at = bytes.find('\n', mark);
    if (at == std::string::npos) return {};
    ++at;
    std::vector<Vector> normals;
    normals.reserve(count);
    if (format == "ascii") {
        const char *here = bytes.data() + at, *end = bytes.data() + bytes.size();
        std::vector<double> row(properties.size());
        for (std::size_t i = 0; i < count; ++i) {
            for (double& value : row) {
                while (here < end && std::isspace(static_cast<unsigned char>(*here)) != 0) ++here;
                const auto [next, error] = std::from_chars(here, end, value);
                if (error != std::errc()) return {};
                here = next;
            }
            normals.emplace_back(row[column[0]], row[column[1]], row[column[2]]);
        }
        return normals;
    }
    if (bytes.size() - at < count * stride) return {};
    const bool swap = (format == "binary_big_endian") != (std::endian::native == std::endian::big);
    for (std::size_t i = 0; i < count; ++i, at += stride) {
        std::array<double, 3> n{};
        for (std::size_t k = 0; k < 3; ++k) {
            std::array<char, 8> raw{};
            const std::size_t size = real8[k] ? 8 : 4;
            for (std::size_t b = 0; b < size; ++b) raw[b] = bytes[at + offset[k] + (swap ? size - 1 - b : b)];
            if (real8[k]) {
                std::memcpy(&n[k], raw.data(), 8);
            } else {
                float value = 0;
                std::memcpy(&value, raw.data(), 4);
                n[k] = value;
            }
        }
        normals.emplace_back(n[0], n[1], n[2]);
    }
    return normals;
}

}  // namespace

std::optional<PointCloud> read_point_cloud(const Path& file) {
    const std::string kind = extension(file);
    PointCloud cloud;
    if (kind == ".xyz" || kind == ".pts" || kind == ".asc" || kind == ".txt") {
        cloud = read_text(file);
    } else {
        PolygonSoup soup = read_polygons(file);
        if (soup.polygon_count() > 0) return std::nullopt;
        for (const auto& p : soup.points) cloud.points.emplace_back(p[0], p[1], p[2]);
        cloud.notes = std::move(soup.notes);
        if (kind == ".ply") cloud.normals = ply_normals(read_file(file), cloud.points.size());
    }
    if (cloud.points.empty()) fail_input(file.string(), "has neither faces nor points", "export it again");
    for (std::size_t i = 0; i < cloud.points.size(); ++i)
        if (!is_place(cloud.points[i]))
            fail_input(file.string(), "point " + std::to_string(i) + " is too far away to compute with", "remove it");
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

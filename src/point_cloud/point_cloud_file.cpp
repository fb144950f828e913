// Reads points without faces from files.
#include "point_cloud/cloud_columns.h"
#include "point_cloud/cloud_formats.h"

#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/io/ply_columns.h"
#include "ostraka/point_cloud/point_cloud.h"

#include <fmt/core.h>

#include <algorithm>

namespace ostraka {

namespace clouds {

namespace {

std::optional<PointCloud> read_ply_points(const std::string& bytes, const std::string& file) {
    const PlyVertexProperties vertices = read_ply_vertex_properties(bytes, file);
    if (vertices.has_faces) return std::nullopt;
    CloudBuilder builder(file, bytes.size());
    for (const std::string& text : vertices.notes) builder.note(text);
    if (vertices.vertices == 0) return builder.finish();
    CloudTable table;
    std::vector<std::string> unused;
    for (const PlyVertexColumn& column : vertices.columns) {
        const Column role = column_named(column.name);
        table.columns.push_back(role);
        if (role == Column::red && !column.is_real && column.bytes == 1) table.colour_range = ColourRange::bytes;
        if (role == Column::other) unused.push_back(printable(column.name, 40));
    }
    if (!unused.empty()) builder.note("vertex properties not kept: " + joined(unused));
    table.rows = vertices.vertices;
    table.at = [&](std::size_t row, std::size_t column) { return vertices.columns[column].values[row]; };
    add_table(builder, table);
    return builder.finish();
}

/// Points of the mesh formats, which are read by the readers of meshes.
std::optional<PointCloud> read_mesh_points(const Path& file) {
    PolygonSoup soup = read_polygons(file);
    if (soup.polygon_count() > 0) return std::nullopt;
    CloudBuilder builder(file.string(), size_of_file(file));
    const NamedValues* intensity = nullptr;
    for (const NamedValues& values : soup.extras.vertex_values)
        if (intensity == nullptr && column_named(values.name) == Column::intensity) intensity = &values;
    const bool coloured = !soup.extras.vertex_colours.empty();
    builder.begin_scan(soup.points.size(), {false, coloured, intensity != nullptr});
    for (std::string& text : soup.notes) builder.note(std::move(text));
    for (std::size_t i = 0; i < soup.points.size(); ++i) {
        CloudPoint point;
        point.place = Point(soup.points[i][0], soup.points[i][1], soup.points[i][2]);
        if (coloured) point.colour = soup.extras.vertex_colours[i];
        if (coloured) point.colour[3] = 255;
        if (intensity != nullptr) point.intensity = intensity->values[i];
        builder.add(point);
    }
    return builder.finish();
}

bool looks_like_pcd(std::string_view bytes) {
    std::size_t position = 0;
    const std::string_view first = line_at(bytes.substr(0, 200), position);
    return first.starts_with("# .PCD") || first.starts_with("VERSION ") || first.starts_with("VERSION\t");
}

}  // namespace

}  // namespace clouds

const std::vector<std::string>& point_cloud_endings() {
    static const std::vector<std::string> endings{".e57", ".las", ".laz", ".pts", ".ptx",  ".pcd",
                                                  ".xyz", ".asc", ".csv", ".txt", ".xyzn", ".xyzrgb"};
    return endings;
}

std::optional<PointCloud> read_point_cloud(const Path& file) {
    using namespace clouds;
    const std::string ending = extension(file), name = file.string();
    const auto& endings = point_cloud_endings();
    const bool is_cloud = std::find(endings.begin(), endings.end(), ending) != endings.end();
    if (!is_cloud && ending != ".ply") return read_mesh_points(file);
    std::string bytes = read_file(file);
    if (bytes.empty()) fail_input(name, "is empty", "export it again");
    if (bytes.starts_with("ply\n") || bytes.starts_with("ply\r")) return read_ply_points(bytes, name);
    if (ending == ".ply") {
        bytes = {};
        return read_mesh_points(file);
    }
    if (bytes.starts_with("ASTM-E57")) return read_e57(bytes, name);
    if (bytes.starts_with("LASF")) return read_las(bytes, name);
    if (looks_like_pcd(bytes) || ending == ".pcd") return read_pcd(bytes, name);
    for (const auto& [binary, start] : {std::pair{".e57", "ASTM-E57"}, {".las", "LASF"}, {".laz", "LASF"}})
        if (ending == binary)
            fail_input(name, fmt::format("does not begin with {}", start),
                       fmt::format("check that this is a {} file", ending.substr(1)));
    if (ending == ".ptx") return read_ptx(bytes, name);
    return read_text_points(bytes, name, ending == ".pts");
}

}  // namespace ostraka

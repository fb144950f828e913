#include "io/polygon_cutter.h"
#include "ostraka/io/carry_extras.h"

namespace ostraka {

namespace {

bool all_are_triangles(const PolygonSoup& polygons) {
    if (polygons.corners.size() != 3 * polygons.polygon_count()) return false;
    for (std::size_t i = 0; i < polygons.polygon_count(); ++i) {
        if (polygons.polygon_begin[i] != 3 * i) return false;
        const Index* c = &polygons.corners[3 * i];
        if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0]) return false;
    }
    return true;
}

}  // namespace

TriangulatedSoup triangulate(PolygonSoup&& input) {
    PolygonSoup polygons = std::move(input);  // moved, so that the corners are freed on return
    TriangulatedSoup result;
    result.notes = std::move(polygons.notes);
    result.soup.points = std::move(polygons.points);
    auto& triangles = result.soup.triangles;
    const auto& corners = polygons.corners;
    if (all_are_triangles(polygons)) {
        triangles.resize(polygons.polygon_count());
        for (std::size_t t = 0; t < triangles.size(); ++t)
            triangles[t] = {corners[3 * t], corners[3 * t + 1], corners[3 * t + 2]};
        result.extras = std::move(polygons.extras);
        return result;
    }
    std::vector<Index> triangle_corner;
    std::vector<io::PolygonCutter::Triple> cut_triangles;
    io::PolygonCutter cutter;
    std::size_t empty = 0, crossing = 0, gave_up = 0;
    for (std::size_t i = 0; i < polygons.polygon_count(); ++i) {
        const Index begin = polygons.polygon_begin[i], count = polygons.polygon_begin[i + 1] - begin;
        cut_triangles.clear();
        const auto cut =
            count == 0 ? io::CutResult::clean : cutter.cut(result.soup.points, &corners[begin], count, cut_triangles);
        empty += cut_triangles.empty();
        crossing += cut == io::CutResult::crossing;
        gave_up += cut == io::CutResult::gave_up;
        for (const auto& piece : cut_triangles) {
            triangles.push_back({corners[begin + piece[0]], corners[begin + piece[1]], corners[begin + piece[2]]});
            result.polygon_of_triangle.push_back(static_cast<Index>(i));
            if (!polygons.extras.corner_texture.empty())
                for (const auto k : piece) triangle_corner.push_back(begin + k);
        }
    }
    if (empty > 0)
        result.notes.push_back(std::to_string(empty) + " faces have fewer than three distinct corners and give no triangle");
    if (crossing > 0)
        result.notes.push_back(std::to_string(crossing) + " faces cross or touch themselves; their triangles may overlap");
    if (gave_up > 0)
        result.notes.push_back(std::to_string(gave_up) +
                               " faces are too large and intricate to be cut cleanly; their triangles may overlap");
    result.extras = carried(polygons.extras, {nullptr, &result.polygon_of_triangle, &triangle_corner});
    result.extras.tetrahedra = std::move(polygons.extras.tetrahedra);
    return result;
}

}  // namespace ostraka

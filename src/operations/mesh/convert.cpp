// mesh convert
#include "operations/operations.h"

#include <fmt/core.h>

#include <algorithm>

namespace ostraka {

namespace {

struct MeshConvert final : Operation {
    void declare(Parameters& p) override {
        p.input("input", Kind::mesh, input, "mesh to read: .ply, .obj, .glb, .gltf, .stl, .off, .3mf; tetrahedra: .mesh, .vtu");
        p.output("output", Kind::mesh, output.with_ascii_option(),
                 "mesh to write: .ply, .obj, .off, .stl, .glb; .mesh and .vtu keep tetrahedra");
        p.output_option("map", Kind::index_map, map, "JSON file to write: for each triangle, the index of its source polygon");
        p.input_option("polygons-of", Kind::mesh, polygons_of,
                       "polygon file from which the triangles of the input were made, possibly with other vertex positions; the "
                       "polygons of this file are written instead of triangles (.obj, .off, .ply)");
        p.options("binary", binary, "write PLY and STL in binary encoding (the default)");
        for (const char* count : {"vertices", "polygons", "triangles"}) p.report.values(integer(count, count));
    }

    void check() const override {
        if (binary && output.ascii()) fail_usage("--ascii and --binary", "give one of them");
    }

    void run(Context& context, Report& report) override {
        PolygonSoup polygons = input.take_polygons();
        const std::size_t polygon_count = polygons.polygon_count();
        TriangulatedSoup triangles = triangulate(std::move(polygons));
        context.notes("", triangles.notes);
        const std::size_t count = triangles.soup.triangles.size();
        if (map) {
            std::vector<Index> origin = triangles.polygon_of_triangle;
            if (origin.empty())
                for (Index t = 0; t < count; ++t) origin.push_back(t);
            map.write(
                {"face", std::move(origin), polygon_count, "for each triangle written the polygon of the input it was cut from"});
        }
        report("vertices", triangles.soup.points.size())("polygons", polygon_count)("triangles", count);
        WriteOptions writing;
        if (polygons_of) keep_polygons(triangles.soup, writing, report);
        output.write(std::move(triangles.soup), std::move(triangles.extras), std::move(writing));
    }

    /// Writes the polygons of a file whose triangulation gives exactly these triangles in this order, with the shape of the
    /// mesh.
    void keep_polygons(const TriangleSoup& soup, WriteOptions& writing, Report& report) {
        PolygonSoup polygon_soup = polygons_of.take_polygons();
        const std::vector<Index> polygon_corners = polygon_soup.corners, polygon_begin = polygon_soup.polygon_begin;
        const std::size_t vertices = polygon_soup.points.size();
        const TriangulatedSoup triangulated = triangulate(std::move(polygon_soup));
        const auto fail = [&](const std::string& problem) {
            fail_input(polygons_of.file(), problem, "give the file that the mesh was originally read from");
        };
        if (vertices != soup.points.size()) fail(fmt::format("has {} vertices, and the mesh {}", vertices, soup.points.size()));
        if (triangulated.soup.triangles.size() != soup.triangles.size())
            fail(fmt::format("gives {} triangles, and the mesh has {}", triangulated.soup.triangles.size(),
                             soup.triangles.size()));
        Index last = no_index;
        for (Index t = 0; t < soup.triangles.size(); ++t) {
            const Index polygon = triangulated.polygon_of_triangle.empty() ? t : triangulated.polygon_of_triangle[t];
            const std::vector<Index> corners(polygon_corners.begin() + polygon_begin[polygon],
                                             polygon_corners.begin() + polygon_begin[polygon + 1]);
            for (const Index v : soup.triangles[t])
                if (std::find(corners.begin(), corners.end(), v) == corners.end())
                    fail(fmt::format("has a polygon {} that triangle {} of the mesh was not cut from", polygon, t));
            if (polygon == last) continue;
            last = polygon;
            writing.polygons.push_back(corners);
            writing.triangle_of_polygon.push_back(t);
        }
        report.note(counted(writing.polygons.size(), "polygon") + " in place of the triangles");
    }

    MeshInput input, polygons_of;
    MeshOutput output;
    IndexMapOutput map;
    bool binary = false;
};

}  // namespace

std::unique_ptr<Operation> make_mesh_convert() { return std::make_unique<MeshConvert>(); }

}  // namespace ostraka

// mesh convert
#include "operations.h"

namespace ostraka {

namespace {

struct MeshConvert final : Operation {
    void describe(Parameters& p) override {
        p.input("input", Kind::mesh, input, "mesh to read: .ply, .obj, .off, .stl; of tetrahedra .mesh, .vtu");
        p.output("output", Kind::mesh, output.with_encoding(),
                 "mesh to write: .ply, .obj, .off, .stl, .glb; .mesh and .vtu keep tetrahedra");
        p.output_option("map", Kind::index_map, map, "JSON file to write: for each triangle the polygon it was cut from");
        p.options("binary", binary, "write PLY and STL as bytes (the default)");
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
            std::vector<Index> origin = triangles.triangle_polygon;
            if (origin.empty())
                for (Index t = 0; t < count; ++t) origin.push_back(t);
            map.write(
                {"face", std::move(origin), polygon_count, "for each triangle written the polygon of the input it was cut from"});
        }
        report("vertices", triangles.soup.points.size())("polygons", polygon_count)("triangles", count);
        output.write(std::move(triangles.soup), std::move(triangles.extras));
    }

    MeshInput input;
    MeshOutput output;
    IndexMapOutput map;
    bool binary = false;
};

}  // namespace

std::unique_ptr<Operation> make_mesh_convert() { return std::make_unique<MeshConvert>(); }

}  // namespace ostraka

// mesh info: the content and the defects of a mesh file.
#include "operations/diagnosis.h"
#include "operations/operations.h"

#include <fmt/core.h>

#include <algorithm>

namespace ostraka {

namespace {

/// Number of polygons with fewer than three distinct corners, which give no triangle.
std::size_t count_degenerate(const PolygonSoup& soup) {
    std::size_t count = 0;
    std::vector<Index> corners;
    for (std::size_t p = 0; p < soup.polygon_count(); ++p) {
        corners.assign(soup.corners.begin() + soup.polygon_begin[p], soup.corners.begin() + soup.polygon_begin[p + 1]);
        std::sort(corners.begin(), corners.end());
        count += std::unique(corners.begin(), corners.end()) - corners.begin() < 3;
    }
    return count;
}

struct MeshInfo final : Operation {
    void declare(Parameters& p) override {
        p.input("input", Kind::mesh, input, "mesh to read: .ply, .obj, .glb, .gltf, .stl, .off, .3mf");
        options.declare_options(p.options);
        declare_diagnosis(p.report);
        p.report.values(integer("polygons"), integer("degenerate_polygons"), texts("holds"), number("crack_width"));
    }

    void run(Context& context, Report& report) override {
        std::vector<std::pair<std::string, double>> seconds;
        Stopwatch stopwatch;
        const auto lap = [&](const char* part) {
            seconds.emplace_back(part, stopwatch.seconds());
            stopwatch = {};
        };
        PolygonSoup polygons = input.take_polygons();
        lap("read");
        const std::size_t polygon_count = polygons.polygon_count(), degenerate = count_degenerate(polygons);
        const std::vector<std::string> extras = attributes_in_words(polygons.extras);
        const TriangulatedSoup triangles = triangulate(std::move(polygons));
        lap("triangulate");
        const MeshDiagnosis diagnosis = in_file(input.file(), [&] { return diagnose(triangles.soup, options); });
        seconds.insert(seconds.end(), diagnosis.seconds.begin(), diagnosis.seconds.end());
        context.notes("", triangles.notes);
        report.values(to_json(diagnosis, report.allocator()));
        const bool sound = diagnosis.defects().empty() && degenerate == 0;
        report("sound", sound)("polygons", polygon_count)("degenerate_polygons", degenerate)("holds", extras);
        for (const auto& [part, time] : seconds) report.run("seconds." + part, time);

        auto rows = rows_of(diagnosis);
        rows.insert(rows.begin() + 2, {{"polygons", std::to_string(polygon_count)},
                                       {"polygons with fewer than three corners", std::to_string(degenerate)}});
        rows.insert(rows.end() - 1, {"holds", extras.empty() ? "nothing but the geometry" : joined(extras)});
        for (const auto& [quantity, value] : rows) report.text_only(quantity, value);
        if (diagnosis.border_edges > 0) note_cracks(triangles.soup, diagnosis, report);
        if (!sound) report.answer_no();
    }

    /// Notes the width of cracks and the distance that joins them. The distance is larger than the crack width because
    /// duplicates of a point may be farther from each other than from their nearest duplicate.
    void note_cracks(const TriangleSoup& soup, const MeshDiagnosis& diagnosis, Report& report) const {
        const double width = crack_width(soup);
        if (!(width > 0)) return;
        const double joining = std::max(width, std::min(2 * width, 0.3 * diagnosis.mean_edge));
        report("crack_width", width);
        report.note(
            fmt::format("the surface has cracks along its edges: most points of its border have another border point within {} "
                        "(join them: ostraka mesh repair {} OUTPUT --merge-distance {})",
                        number(width, 2), input.file(), digits(joining / diagnosis.diagonal, 2)));
    }

    MeshInput input;
    DiagnoseOptions options;
};

}  // namespace

std::unique_ptr<Operation> make_mesh_info() { return make<MeshInfo>(); }

}  // namespace ostraka

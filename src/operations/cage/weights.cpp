// cage weights
#include "operations/cage/triangles.h"
#include "operations/operations.h"

#include "ostraka/cage/cage.h"

#include <fmt/core.h>

namespace ostraka {

namespace {

struct CageCoordinates final : Operation {
    void declare(Parameters& p) override {
        p.input("mesh", Kind::mesh, mesh, "mesh file");
        p.input("cage", Kind::cage, cage, "cage: a closed mesh around the mesh (polygons are triangulated)");
        p.output("output", Kind::coordinates, output,
                 "weights to write (.npy), with their description in a file .coordinates.json beside it");
        p.options("kind", kind,
                  "kind of coordinates: mean-value; local, harmonic or positive-mean-value (inside the cage; never negative); "
                  "green (strictly inside; not for constraints)",
                  Choices(coordinate_kinds()));
        options.declare_options(p.options);
        p.report.values(text("kind", "coordinates"), integer("points", "points"), integer("cageVertices", "cage vertices"),
                        integer("cageFaces", "cage faces"), any("certificate"),
                        number("storedShare", "", "fraction of all weights"),
                        number("amplification", "", "multiples of the motion of the cage"), integer("outside"),
                        integer("crossed"), integer("cageIntersections"), texts("objections"), boolean("holds", "verdict"));
        p.report.text_table("", {"property", "value", "meaning"});
    }

    void run(Context&, Report& report) override {
        const Mesh &subject = mesh->mesh, &around = triangles_of_cage(cage, report);
        Coordinates coordinates = in_file(cage.file(), [&] { return compute_coordinates(kind, around, subject, options); });
        const CoordinateCertificate certificate =
            in_file(cage.file(), [&] { return certify(coordinates, around, points_of(subject), options); });
        if (coordinates.has_normals())
            report.note(kind +
                        " coordinates can only be used for deformation without constraints, because the solve over the cage "
                        "vertices ignores their normal term");
        report_result(report, certificate, check_cage(around, subject), coordinates);
        output.write(std::move(coordinates), subject, around, certificate);
    }

    static void report_result(Report& report, const CoordinateCertificate& c, const CageCheck& cage,
                              const Coordinates& coordinates) {
        report("kind", c.kind)("points", c.points)("cageVertices", c.vertices)("cageFaces", c.faces)(
            "certificate", to_json(c, report.allocator()));
        const auto row = [&](const char* property, const std::string& value, const char* meaning) {
            report.row("", {property, value, meaning});
        };
        const auto percent = [](double part) { return number(100 * part, 4) + " %"; };
        const auto on_cage = [&](const char* property, const std::optional<double>& value, const char* meaning) {
            row(property, value ? number(*value, 3) : "-", value ? meaning : "not defined on the cage");
        };
        row("partition of unity", number(c.partition, 3), "largest |sum of a point's weights - 1|");
        row("linear precision", number(c.linear, 3),
            "largest distance between a point and its reconstruction from the undeformed cage, as a fraction of the cage's "
            "diagonal");
        on_cage("Lagrange property", c.lagrange, "largest deviation at the cage's vertices");
        on_cage("linear on edges", c.edges, "largest deviation at three points per edge");
        on_cage("linear on faces", c.on_faces, "largest deviation at three points per face");
        row("negative weights", percent(c.negative), "of all");
        row("points with one", percent(c.negative_rows), "of all");
        row("min, max", fmt::format("{}, {}", number(c.minimum), number(c.maximum)), "weight");
        row("negative sum", number(c.negative_sum), "largest of a point");
        row("locality", fmt::format("{} mean, {} max", number(c.dominant_weights_mean, 4), c.dominant_weights_max),
            "weights that carry 95 % at a point");
        if (coordinates.is_sparse()) row("stored", percent(coordinates.stored_share()), "of the weights; the others are zero");
        std::vector<std::string> phases;
        for (const auto& [phase, seconds] : coordinates.seconds) {
            report.run("seconds." + phase, seconds);
            phases.push_back(fmt::format("{} {} s", phase, number(seconds, 3)));
        }
        if (!phases.empty()) row("time", joined(phases), "of each phase");
        report("storedShare", coordinates.stored_share());
        const double factor = amplification(coordinates);
        row("amplification", number(factor, 3),
            "upper bound of the displacement of a point, relative to the largest displacement of a cage vertex");
        report("amplification", factor)("outside", cage.outside.size())("crossed", cage.crossing.size())(
            "cageIntersections", cage.intersections.size());
        std::vector<std::string> objections = reasons_against_deformation(cage, coordinates);
        if (!c.holds()) objections.emplace_back("partition of unity or linear precision fails");
        report("objections", objections);
        report("holds", objections.empty(),
               objections.empty() ? "fit for deformation" : "not fit for deformation: " + joined(objections, "; "));
        if (!objections.empty()) report.answer_no();
    }

    MeshInput mesh, cage;
    CoordinatesOutput output;
    std::string kind = "mean-value";
    CoordinateOptions options;
};

}  // namespace

std::unique_ptr<Operation> make_cage_weights() { return make<CageCoordinates>(); }

}  // namespace ostraka

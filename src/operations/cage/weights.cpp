// cage weights, cage influence
#include "operations/operations.h"

#include "ostraka/cage/cage.h"
#include "ostraka/coords/influence.h"
#include "ostraka/render/colour_scale.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ostraka {

namespace {

/// The triangles of a cage; a note reports if its polygons were triangulated.
const Mesh& triangles_of_cage(const MeshInput& cage, Report& report) {
    if (!cage->triangle_polygon.empty())
        report.note(fmt::format("the cage's polygons were cut into {} triangles", cage->mesh.number_of_faces()));
    return cage->mesh;
}

struct CageCoordinates final : Operation {
    void describe(Parameters& p) override {
        p.input("mesh", Kind::mesh, mesh, "mesh file");
        p.input("cage", Kind::cage, cage, "closed mesh around it (polygons are cut into triangles)");
        p.output("output", Kind::coordinates, output, "weights to write (.npy; a .coordinates.json goes beside it)");
        p.options("kind", kind,
                  "mean-value; local, harmonic or positive-mean-value (inside, none negative); green (strictly inside; without "
                  "constraints "
                  "only)",
                  Choices(coordinate_kinds()));
        options.describe(p.options);
        p.report.values(text("kind", "coordinates"), integer("points", "points"), integer("cageVertices", "cage vertices"),
                        integer("cageFaces", "cage faces"), any("certificate"), number("storedShare"), number("amplification"),
                        integer("outside"), integer("crossed"), integer("cageIntersections"), texts("objections"),
                        boolean("holds", "verdict"));
        p.report.people_table("", {"property", "value", "meaning"});
    }

    void run(Context&, Report& report) override {
        const Mesh &subject = mesh->mesh, &around = triangles_of_cage(cage, report);
        Coordinates coordinates = in_file(cage.file(), [&] { return compute_coordinates(kind, around, subject, options); });
        const CoordinateCertificate certificate =
            in_file(cage.file(), [&] { return certify(coordinates, around, points_of(subject), options); });
        if (coordinates.has_normals())
            report.note(kind +
                        " coordinates serve deformation without constraints only: the constrained solve through the cage "
                        "leaves out their normal term");
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
        row("linear precision", number(c.linear, 3), "largest error of a point at rest, in diagonals of the cage");
        on_cage("Lagrange property", c.lagrange, "largest deviation at the cage's vertices");
        on_cage("linear on edges", c.edges, "largest deviation at three points per edge");
        on_cage("linear on faces", c.on_faces, "largest deviation at three points per face");
        row("negative weights", percent(c.negative), "of all");
        row("points with one", percent(c.negative_rows), "of all");
        row("min, max", fmt::format("{}, {}", number(c.minimum), number(c.maximum)), "weight");
        row("negative sum", number(c.negative_sum), "largest of a point");
        row("locality", fmt::format("{} mean, {} max", number(c.carriers_mean, 4), c.carriers_max),
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
        row("amplification", number(factor, 3), "upper bound on how far a point moves, relative to the cage");
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

struct CageInfluence final : Operation {
    void describe(Parameters& p) override {
        p.input("mesh", Kind::mesh, mesh, "mesh file");
        p.input("cage", Kind::cage, cage, "its cage");
        p.input("weights", Kind::coordinates, weights, "weights of 'cage weights' (.npy)");
        p.output("output", Kind::mesh, output,
                 "coloured mesh to write (PLY, with the numbers as the property quality): the cage for --annotation, otherwise "
                 "the mesh; by default coloured by the number of cage vertices that carry 95 % of the weight");
        p.input_option("annotations", Kind::annotations, annotations, "annotations of the mesh (.ant.json)");
        p.options("cage-vertex", cage_vertex, "the weights of this cage vertex on the mesh");
        p.options("annotation", annotation, "id or tag: the influence of each cage vertex on its vertices");
        p.options("by", by, "influence on an annotation: the maximum or the sum of the weights on its vertices",
                  Choices{"max", "sum"});
        p.options("threshold", threshold, "list the cage vertices with an influence above this");
        p.report.values(text("what", "what"), text("on", "on the"), number("min", "min"), number("max", "max"), any("above"),
                        any("strongest"));
    }

    void check() const override {
        if (static_cast<bool>(annotations) == annotation.empty())
            fail_usage(annotations ? "--annotations without an annotation" : "--annotation without a file",
                       "give both --annotations FILE and --annotation ID");
        if (!annotation.empty() && cage_vertex)
            fail_usage("--cage-vertex with --annotation",
                       "give one of them: influence of a cage vertex, or influence on an annotation");
        if (annotation.empty() && threshold)
            fail_usage("--threshold without --annotation", "add --annotation, for which it selects cage vertices");
        if (threshold && !std::isfinite(*threshold)) fail_usage("--threshold is not finite", "give a number");
    }

    void run(Context&, Report& report) override {
        const Mesh &subject = mesh->mesh, &around = triangles_of_cage(cage, report);
        const Coordinates& coordinates = weights.of(subject, around);
        const bool on_cage = static_cast<bool>(annotations);
        std::string quantity;
        std::vector<double> values;
        if (cage_vertex) {
            values = influence_of(coordinates, *cage_vertex);
            quantity = "weight of cage vertex " + std::to_string(*cage_vertex);
        } else if (on_cage) {
            const Annotation& chosen = find_annotation(annotations.on(subject), annotation, annotations.file());
            values = influence_on(coordinates, touched_vertices(subject, chosen), by);
            quantity =
                fmt::format("{} on '{}'", by == InfluenceMeasure::max ? "largest weight" : "sum of the weights", chosen.tag);
        } else {
            for (const Index count : carriers(coordinates.vertex)) values.push_back(count);
            quantity = "cage vertices that carry 95 %";
        }
        const auto [low, high] = std::minmax_element(values.begin(), values.end());
        report("what", quantity)("on", on_cage ? "cage" : "mesh")("min", *low)("max", *high);
        if (on_cage) report_strongest(report, values);
        const ColourScale scale = scale_of({&values}, "the weights");
        MeshExtras extras;
        for (const double value : values) {
            const Rgb c = colour_of(scale, value);
            extras.vertex_colours.push_back({c.red, c.green, c.blue, 255});
        }
        WriteOptions writing;
        writing.vertex_quality = std::move(values);
        output.write(on_cage ? around : subject, std::move(extras), std::move(writing));
    }

    /// Cage vertices above the threshold, or the ten strongest.
    void report_strongest(Report& report, const std::vector<double>& values) const {
        std::vector<Index> order(values.size());
        std::iota(order.begin(), order.end(), Index{0});
        std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return values[a] > values[b]; });
        std::vector<Index> chosen;
        std::vector<std::string> texts;
        for (const Index v : order) {
            if (threshold ? !(values[v] > *threshold) : chosen.size() == 10) break;
            chosen.push_back(v);
            texts.push_back(std::to_string(v));
        }
        report(threshold ? "above" : "strongest", chosen);
        report.people(threshold ? "cage vertices above" : "strongest cage vertices", texts.empty() ? "none" : joined(texts));
    }

    MeshInput mesh, cage;
    CoordinatesInput weights;
    AnnotationsInput annotations;
    MeshOutput output;
    std::optional<Index> cage_vertex;
    std::string annotation;
    InfluenceMeasure by = InfluenceMeasure::max;
    std::optional<double> threshold;
};

}  // namespace

std::unique_ptr<Operation> make_cage_weights() { return make<CageCoordinates>(); }
std::unique_ptr<Operation> make_cage_influence() { return make<CageInfluence>(); }

}  // namespace ostraka

// cage influence
#include "operations/cage/triangles.h"
#include "operations/operations.h"

#include "ostraka/coords/influence.h"
#include "ostraka/render/colour_scale.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ostraka {

namespace {

struct CageInfluence final : Operation {
    void declare(Parameters& p) override {
        p.input("mesh", Kind::mesh, mesh, "mesh file");
        p.input("cage", Kind::cage, cage, "cage of the mesh");
        p.input("weights", Kind::coordinates, weights, "weights written by 'cage weights' (.npy)");
        p.output(
            "output", Kind::mesh, output,
            "coloured mesh to write (PLY, with the values as the property quality): with --annotation the cage, otherwise the "
            "mesh; by default each mesh vertex is coloured by the number of cage vertices that carry 95 % of its weight");
        p.input_option("annotations", Kind::annotations, annotations, "annotations of the mesh (.ant.json)");
        p.options("cage-vertex", cage_vertex, "index of a cage vertex: colour the mesh by the weights of this cage vertex");
        p.options("annotation", annotation, "id or tag of an annotation: colour the cage by the influence on this annotation");
        p.options("by", by, "influence of a cage vertex: maximum or sum of its weights over the annotation",
                  Choices{"max", "sum"});
        p.options("threshold", threshold, "list the cage vertices whose influence exceeds this value");
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
            for (const Index count : dominant_weight_counts(coordinates.vertex)) values.push_back(count);
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
        extras.vertex_values.push_back({"quality", std::move(values)});
        output.write(on_cage ? around : subject, std::move(extras));
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
        report.text_only(threshold ? "cage vertices above" : "strongest cage vertices", texts.empty() ? "none" : joined(texts));
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

std::unique_ptr<Operation> make_cage_influence() { return make<CageInfluence>(); }

}  // namespace ostraka

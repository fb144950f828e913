// measure take: a ruler, a tape, or two parallel planes.
#include "operations/measure/measured_object.h"

#include "ostraka/geom/surface_search.h"
#include "ostraka/measure/measure.h"
#include "ostraka/mesh/limits.h"
#include "ostraka/select/selections.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

struct MeasureTake final : Operation {
    void declare(Parameters& p) override {
        object.declare(p);
        p.options("tool", tool,
                  "measuring tool: ruler (straight distance), tape (over the surface) or bounding (between two parallel planes)",
                  Choices{"ruler", "tape", "bounding"})
            .required();
        p.options("points", points, "pins (the points between which the tool measures) as vertex indices, like 12,88",
                  Range{0, largest_index});
        p.options("at", pin_positions, "pin as a point x,y,z, of which the nearest vertex is used; given once per pin");
        p.options("direction", direction,
                  "direction of the extent that --tool bounding measures: of the points of --points or --at, without them of the "
                  "whole annotation",
                  direction_words("--direction"));
        p.options("geodesic", geodesic, "course of a tape: along edges, or the exact shortest curve over the faces (exact)",
                  Choices{"edges", "exact"});
        p.options("repeat", repeats,
                  "pins of a repeated picking, as vertex indices like 12,88; given once per picking, and the value is the mean "
                  "of all pickings");
        p.options("annotation", annotation,
                  "id or tag of the annotation that gets the new attribute; the whole object if left out");
        p.options("name", name, "name of the new attribute; the name of the tool if left out");
        p.report.values(text("name"), integer("annotation"), text("tool"), any("points"), number("value"), text("unit"));
        for (const char* figure : {"uncertainty", "resolution", "spread"}) p.report.values(number(figure));
        p.report.values(integer("pickings"));
    }

    void check() const override {
        const bool bounding = tool == "bounding";
        if (geodesic == Geodesic::exact && tool != "tape")
            fail_usage("--geodesic exact with a " + tool, "use it with --tool tape");
        if (bounding && direction.empty()) fail_usage("a bounding measure without a direction", "add --direction x,y,z");
        if (!bounding && !direction.empty()) fail_usage("--direction with a " + tool, "use it with --tool bounding");
        if (!points.empty() && !pin_positions.empty()) fail_usage("--points and --at", "give the pins in one way");
        for (const auto& text : pin_positions) static_cast<void>(place_of(text));
        for (const auto& text : repeats) static_cast<void>(numbers_of<Index>(text, "--repeat"));
        const std::size_t pins = points.size() + pin_positions.size();
        if (bounding ? pins == 1 : pins < 2)
            fail_usage(fmt::format("a {} with {} {}", tool, pins, pins == 1 ? "pin" : "pins"),
                       bounding ? "give two or more, or none and the whole annotation is measured" : "give two or more");
    }

    void run(Context&, Report& report) override {
        const Mesh& mesh = object.mesh->mesh;
        AnnotationSet set = object.read(report);
        Annotation& holder = annotation.empty() ? ensure_root(set, mesh) : object.require_annotation(set, annotation);
        Measure measure = pinned(mesh, holder, report);
        measure.unit = set.unit;
        const Evaluated evaluated = in_file(object.mesh.file(), [&] { return evaluate_with_uncertainty(mesh, holder, measure); });
        measure.value = evaluated.value;
        measure.uncertainty = evaluated.uncertainty;
        add_to(holder, measure, report);
        report_result(report, holder, measure, evaluated);
        object.write(std::move(set));
    }

    enum class Geodesic { edges, exact };
    static constexpr int largest_index = std::numeric_limits<int>::max();

    [[nodiscard]] const std::string& attribute_name() const { return name.empty() ? tool : name; }

    static Point place_of(const std::string& text) {
        const auto numbers = numbers_of<double>(text, "--at");
        const std::string problem = fmt::format("--at is '{}'", printable(text, 60));
        if (numbers.size() != 3) fail_usage(problem, "give three numbers, like 0,0,1");
        if (std::any_of(numbers.begin(), numbers.end(), [](double x) { return !std::isfinite(x); }))
            fail_usage(problem, "give finite numbers");
        if (!is_place(numbers[0], numbers[1], numbers[2]))
            fail_usage(problem + ", which is too large (coordinates up to 1e60)",
                       "give a place on the surface, in the unit of the mesh");
        return {numbers[0], numbers[1], numbers[2]};
    }

    /// The requested measure, with its pins at vertices.
    [[nodiscard]] Measure pinned(const Mesh& mesh, const Annotation& holder, Report& report) const {
        Measure measure;
        measure.tool = tool;
        measure.exact = geodesic == Geodesic::exact;
        if (!direction.empty()) measure.direction = direction_of(direction, "--direction");
        measure.points.assign(points.begin(), points.end());
        for (const auto& text : pin_positions) measure.points.push_back(pin(mesh, place_of(text), report));
        for (const auto& text : repeats) measure.repeats.push_back(numbers_of<Index>(text, "--repeat"));
        if (measure.points.empty()) {
            const auto ends = extremes(mesh, holder, *measure.direction);
            measure.points.assign(ends.begin(), ends.end());
        }
        return measure;
    }

    /// The nearest vertex. A position far from the surface is an error, probably of the unit or the coordinates.
    [[nodiscard]] Index pin(const Mesh& mesh, const Point& place, Report& report) const {
        const Index vertex = in_file(object.mesh.file(), [&] { return nearest_vertex(mesh, place); });
        const double pin_distance = std::sqrt(CGAL::squared_distance(place, mesh.point(Vertex(vertex)))),
                     diagonal = box_diagonal(mesh);
        const std::string position = fmt::format("{},{},{}", number(place.x(), 6), number(place.y(), 6), number(place.z(), 6));
        if (pin_distance > 0.02 * diagonal) {
            const double surface_distance = SurfaceSearch(mesh).closest(place).distance;
            if (surface_distance > 0.02 * diagonal)
                fail_input("--at " + position,
                           fmt::format("the surface is {} away, farther than 2 % of the diagonal ({})",
                                       number(surface_distance, 4), number(0.02 * diagonal, 4)),
                           "give a place on the surface, in the unit of the mesh, or vertices with --points");
        }
        if (pin_distance > 0.001 * diagonal)
            report.note(fmt::format("the pin at {} is vertex {}, {} away", position, vertex, number(pin_distance, 3)));
        return vertex;
    }

    void add_to(Annotation& holder, const Measure& measure, Report& report) const {
        const auto existing = std::find_if(holder.attributes.begin(), holder.attributes.end(),
                                           [&](const Attribute& attribute) { return attribute.name == attribute_name(); });
        if (existing != holder.attributes.end())
            report.note(fmt::format(
                "annotation {} already has an attribute '{}' (id {}), and both are kept: give another --name, remove one "
                "with 'annotation edit --remove-attribute ID', or join pickings with 'measure refresh --merge-pickings'",
                holder.id, attribute_name(), existing->id));
        add_measure(holder, attribute_name(), measure);
    }

    void report_result(Report& report, const Annotation& holder, const Measure& measure, const Evaluated& evaluated) const {
        report("name", attribute_name())("annotation", holder.id)("tool", tool)("points", measure.points)(
            "value", evaluated.value)("unit", measure.unit)("uncertainty", evaluated.uncertainty)(
            "resolution", evaluated.resolution)("spread", evaluated.spread)("pickings", evaluated.pickings);
        std::string line =
            fmt::format("{} {} {}{}+- {}", printable(attribute_name(), 60), number(evaluated.value, 9),
                        printable(measure.unit, 20), measure.unit.empty() ? "" : " ", number(evaluated.uncertainty, 3));
        if (evaluated.pickings > 1)
            line += fmt::format(" ({} pickings, spread {}, resolution {})", evaluated.pickings, number(evaluated.spread, 3),
                                number(evaluated.resolution, 3));
        report.line(line);
    }

    MeasuredObject object;
    std::string tool, direction, annotation, name;
    std::vector<int> points;
    std::vector<std::string> pin_positions, repeats;
    Geodesic geodesic = Geodesic::edges;
};

}  // namespace

std::unique_ptr<Operation> make_measure_take() { return make<MeasureTake>(); }

}  // namespace ostraka

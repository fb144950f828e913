// measure clay: the clay volume of an object, with estimates for unseen inner surfaces.
#include "operations/operations.h"

#include "ostraka/measure/solid.h"
#include "ostraka/slicing/clay.h"

#include <fmt/core.h>

#include <cmath>

namespace ostraka {

namespace {

struct MeasureClay final : Operation {
    void declare(Parameters& p) override {
        p.input("mesh", Kind::mesh, mesh, "mesh file; the mesh may be closed or open");
        p.input("annotations", Kind::annotations, annotations, "annotations of the mesh (.ant.json): unit and upward direction")
            .optional();
        up.declare(p, "direction perpendicular to the slices; by default the upward direction of the annotations, or 0,0,1");
        p.options("unit", unit, "unit of the mesh's coordinates, such as mm; by default the unit of the annotations");
        options.declare_options(p.options);
        for (const Figure& figure : attribute_values({})) p.report.values(any(figure.name, "", figure.unit));
        p.report.values(text("unit"), number("volume of the mesh", "", "length^3"));
    }

    void run(Context&, Report& report) override {
        std::array<double, 3> direction{0, 0, 1};
        if (up) direction = *up.value();
        length_unit = unit;
        if (annotations) {
            const AnnotationSet& set = annotations.on(mesh->mesh);
            if (unit.empty()) length_unit = set.unit;
            if (!up && set.up) direction = *set.up;
        }
        const SliceFrame frame = slice_frame(Point(0, 0, 0), Vector(direction[0], direction[1], direction[2]));
        const ClayVolume clay = in_file(mesh.file(), [&] { return clay_volume(mesh->mesh, frame, options); });
        const double mesh_volume = closed_volume(mesh->mesh);
        for (const Figure& figure : attribute_values(clay)) {
            const bool is_known = !std::isnan(figure.value);
            report(figure.name, is_known ? JsonValue(figure.value) : JsonValue());
            report.text_only(figure.name, is_known ? number(figure.value) + unit_text(figure.unit) : "unknown");
        }
        report("unit", length_unit)("volume of the mesh", mesh_volume);
        report.line(sentence(clay, mesh_volume));
        if (const double cavity = clay.envelope - clay.maximum; cavity > 1e-3 * clay.envelope)
            report.line(
                fmt::format("the space within the outer surface that is not clay, the difference of the two, is {}: the "
                            "cavities as far as they were scanned ('ostraka measure capacity': up to the overflow or a level)",
                            volume(cavity)));
        add_notes(report, clay);
        if (std::isnan(clay.maximum)) report.answer_no();
    }

    struct Figure {
        std::string name;
        double value;
        std::string unit;
    };
    static std::vector<Figure> attribute_values(const ClayVolume& clay) {
        return {{"most clay", clay.maximum, "length^3"},
                {"least clay", clay.minimum, "length^3"},
                {"within the outer surface", clay.envelope, "length^3"},
                {"cavity seen", clay.envelope - clay.maximum, "length^3"},
                {"wall taken for least", clay.wall, "length"},
                {"wall seen, mean", clay.wall_mean, "length"},
                {"wall seen, least (5 % quantile)", clay.wall_min, "length"},
                {"wall seen, most (95 % quantile)", clay.wall_max, "length"},
                {"slices", double(clay.slices), ""},
                {"slices with a cavity seen", double(clay.with_cavity), ""},
                {"slices without an outline", double(clay.without_outline), ""},
                {"slices whose contours cross", double(clay.crossing), ""},
                {"slices read against their orientation", double(clay.reversed ? clay.slices : clay.reversed_slices), ""}};
    }

    [[nodiscard]] std::string unit_text(const std::string& measured_unit) const {
        return measured_unit.empty() || length_unit.empty()
                   ? ""
                   : " " + length_unit + measured_unit.substr(std::string("length").size());
    }

    /// "12345 mm^3 (12.3 cm^3)": large volumes also in a larger unit.
    [[nodiscard]] std::string volume(double value) const {
        std::string text = number(value) + unit_text("length^3");
        const double cubic_cm = length_unit == "mm" ? value / 1000 : length_unit == "cm" ? value : 0;
        if (cubic_cm >= 1000) text += fmt::format(" ({} litres)", number(cubic_cm / 1000, 3));
        else if (length_unit == "mm" && cubic_cm >= 1) text += fmt::format(" ({} cm^3)", number(cubic_cm, 3));
        return text;
    }

    [[nodiscard]] std::string sentence(const ClayVolume& clay, double mesh_volume) const {
        std::string text = std::isnan(clay.maximum) ? "the amount of clay is unknown"
                           : std::isnan(clay.minimum)
                               ? "clay: at most " + volume(clay.maximum)
                               : fmt::format("clay: between {} and {}", volume(clay.minimum), volume(clay.maximum));
        if (std::isnan(mesh_volume)) return text + "; the mesh is open, so that it has no volume of its own";
        return fmt::format("{}; the mesh is closed, and its own volume is {}", text, volume(mesh_volume));
    }

    static void add_notes(Report& report, const ClayVolume& clay) {
        const auto note_slices = [&](int count, const std::string& problem) {
            if (count > 0) report.note(fmt::format("{} slices have {}", count, problem));
        };
        if (std::isnan(clay.minimum) && !std::isnan(clay.maximum))
            report.note("no wall is visible, so there is no minimum: give a wall thickness with --wall");
        note_slices(clay.without_outline, "no closed outline: interpolated between their neighbours");
        note_slices(clay.crossing,
                    "contours that cross, since parts of the mesh pass through each other: the maximum may count them twice, the "
                    "minimum does not count them (ostraka mesh repair --wrap makes one surface of them)");
        note_slices(clay.reversed_slices,
                    "contours whose orientation contradicts their nesting, such as a cavity that is oriented outwards: their "
                    "nesting is used");
        if (clay.reversed) report.note("the mesh is inside out: its orientation is reversed (ostraka mesh repair corrects it)");
        if (clay.slices == 0) report.note("no slice meets the mesh: it has no height along this direction; give another --up");
        else if (std::isnan(clay.maximum))
            report.note(
                "no slice has a closed outline, so there is no volume: is the mesh open along its height, or inside out?");
    }

    MeshInput mesh;
    AnnotationsInput annotations;
    DirectionOption up;
    std::string unit, length_unit;  ///< requested unit, or that of the annotations
    ClayOptions options;
};

}  // namespace

std::unique_ptr<Operation> make_measure_clay() { return make<MeasureClay>(); }

}  // namespace ostraka

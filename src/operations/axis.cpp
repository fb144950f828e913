// axis
#include "ostraka/axis/axis.h"
#include "ostraka/axis/revolution_axis.h"

#include "operations/file_attribute.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ostraka {

namespace {

struct FindAxis final : Operation {
    void declare(Parameters& p) override {
        p.input("mesh", Kind::mesh, mesh, "mesh file");
        p.input("annotations", Kind::annotations, annotations, "annotations of the mesh (.ant.json)").optional();
        p.output_option("output", Kind::report, output, "file to write: the axis as poly-lines (.json, .obj)");
        p.options("annotation", names,
                  "id or tag of the part; several for the union of the parts; a line, or points, give the axis of the circle "
                  "fitted to it")
            .words();
        attribute.declare(p, "axis");
        options.declare_options(p.options);
        intervals.declare_options(p.options);

        p.report.values(boolean("found", "axis"), text("verdict"), text("reason"), numbers("point", "through"),
                        numbers("direction", "direction"), any("polylines"), number("quality", "quality"), any("figures"));
    }

    void check() const override {
        if (static_cast<bool>(annotations) == names.empty())
            fail_usage(names.empty() ? "no annotation is named" : "there are no annotations",
                       "give an annotation file and --annotation ID or TAG, or neither for the whole mesh");
        const std::string kind = extension(output.file());
        if (!output.file().empty() && kind != ".json" && kind != ".obj")
            fail_usage(fmt::format("'{}' is not an axis file", output.file()), "end its name in .json or .obj");
        attribute.check(output, ".json");
        if (attribute && names.size() > 1)
            fail_usage("--annotations-out with several parts", "name the one part whose attribute the axis is");
    }

    void run(Context& context, Report& report) override {
        std::string unit;
        const RevolutionAxis result = find(mesh->mesh, unit);
        const Axis& axis = result.axis;
        report_result(report, result, unit);
        if (!output) return;
        if (extension(output.file()) == ".obj") return output.write(to_obj(axis));
        Json document = json_document("axis");
        auto& allocator = document.GetAllocator();
        add_members(document, allocator, "axis", report.result(), "provenance", context.provenance().to_json(allocator));
        const std::string bytes = to_text(document);
        if (attribute) write_attribute(axis, sha256(bytes), report);
        output.write(bytes);
    }

    void write_attribute(const Axis& axis, const std::string& checksum, Report& report) const {
        if (!axis.found) return report.note(fmt::format("there is no axis, so {} is not written", attribute.file()));
        AnnotationSet set;
        if (annotations) set = annotations.on(mesh->mesh);
        const int holder =
            names.empty() ? ensure_root(set, mesh->mesh).id : find_annotation(set, names.front(), annotations.file()).id;
        attribute.write(std::move(set), holder, output, {"axis", "", checksum}, mesh, report);
    }

    [[nodiscard]] RevolutionAxis find(const Mesh& surface, std::string& unit) const {
        std::vector<Index> faces;
        if (!annotations) {
            faces.resize(surface.number_of_faces());
            std::iota(faces.begin(), faces.end(), Index{0});
            return in_file(mesh.file(), [&] { return axis_of(surface, faces); });
        }
        const AnnotationSet& set = annotations.on(surface);
        unit = set.unit;
        std::vector<Point> rim;
        for (const auto& name : names) {
            const Annotation& annotation = find_annotation(set, name, annotations.file());
            if (annotation.type == AnnotationType::region)
                faces.insert(faces.end(), annotation.faces.begin(), annotation.faces.end());
            else
                for (const Index v : touched_vertices(surface, annotation)) rim.push_back(surface.point(Vertex(v)));
        }
        if (!rim.empty() && !faces.empty())
            fail_usage("regions and curves have no axis together", "name regions only, or lines and points only");
        if (!rim.empty()) return {circle_axis(rim), {}, false};
        std::sort(faces.begin(), faces.end());
        faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
        return in_file(annotations.file(), [&] { return axis_of(surface, faces); });
    }

    [[nodiscard]] RevolutionAxis axis_of(const Mesh& surface, const std::vector<Index>& faces) const {
        if (options.method == AxisMethod::rotation) return revolution_axis(surface, faces, options, intervals);
        return {find_axis(surface, faces, options), {}, false};
    }

    /// "between 190 and 310 mm", or "at least 190 mm".
    static std::string interval_text(const DiameterEstimate& diameter, const std::string& unit, int places) {
        const std::string length = unit.empty() ? "" : " " + unit;
        if (!std::isfinite(diameter.high)) return fmt::format("at least {}{}", number(diameter.low, places), length);
        return fmt::format("between {} and {}{}", number(diameter.low, places), number(diameter.high, places), length);
    }

    static std::string verdict_text(const RevolutionAxis& result, const std::string& unit) {
        if (result.undetermined) {
            const DiameterEstimate& diameter = result.diameters.front();
            return fmt::format("cannot be told: {} ({}, 95 % interval)", interval_text(diameter, unit, 3), diameter.name);
        }
        if (!result.axis.found) return "has no axis: " + result.axis.reason;
        if (result.diameters.empty()) return {};
        const DiameterEstimate& diameter = result.diameters.front();
        return fmt::format("{} {}{}, 95 % interval {}", diameter.name, number(diameter.value, 4), unit.empty() ? "" : " " + unit,
                           interval_text(diameter, unit, 4));
    }

    static void report_result(Report& report, const RevolutionAxis& result, const std::string& unit) {
        const Axis& axis = result.axis;
        auto& allocator = report.allocator();
        const auto coordinates = [](const auto& p) { return std::vector<double>{p.x(), p.y(), p.z()}; };
        report("found", axis.found, axis.found ? "found" : "none");
        if (axis.found) {
            report("point", coordinates(axis.point))("direction", coordinates(axis.direction));
            const auto point = [&](const Point& p) { return json_value(coordinates(p), allocator); };
            report("polylines",
                   json_list(axis.lines, allocator, [&](const auto& line) { return json_list(line, allocator, point); }));
        } else {
            report("reason", axis.reason);
            report.answer_no();
        }
        report("verdict", std::string(axis.found ? "found" : result.undetermined ? "cannot be told" : "none"));
        report("quality", axis.quality, number(axis.quality, 4));
        JsonValue figures(rapidjson::kArrayType);
        for (const auto& figure : axis.figures) {
            const std::string shown_unit = figure.unit == "length" ? unit : figure.unit;
            JsonValue entry = json_object(allocator, "name", figure.name, "value", figure.value);
            if (!shown_unit.empty()) add_members(entry, allocator, "unit", shown_unit);
            std::string shown = number(figure.value) + (shown_unit.empty() ? "" : " " + shown_unit);
            for (const DiameterEstimate& diameter : result.diameters) {
                if (diameter.name != figure.name) continue;
                add_members(entry, allocator, "low", diameter.low);
                if (std::isfinite(diameter.high)) add_members(entry, allocator, "high", diameter.high);
                shown += fmt::format(" ({})", interval_text(diameter, {}, 5));
            }
            figures.PushBack(entry, allocator);
            report.text_only(figure.name, shown);
        }
        report("figures", std::move(figures));
        if (const std::string line = verdict_text(result, unit); !line.empty()) report.line(line);
        report.notes(axis.notes);
    }

    MeshInput mesh;
    AnnotationsInput annotations;
    FileOutput output{".json"};
    FileAttribute attribute;
    std::vector<std::string> names;
    AxisOptions options;
    RevolutionAxisOptions intervals;
};

}  // namespace

std::unique_ptr<Operation> make_axis() { return make<FindAxis>(); }

}  // namespace ostraka

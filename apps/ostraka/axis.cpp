// ostraka axis
#include "ostraka/axis/axis.h"

#include "annotation_names.h"
#include "command.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/io/mesh_file.h"

#include <iostream>
#include <memory>
#include <numeric>

namespace ostraka::app {

namespace {

JsonValue numbers(const double x, const double y, const double z, JsonAllocator& allocator) {
    JsonValue list(rapidjson::kArrayType);
    list.PushBack(x, allocator).PushBack(y, allocator).PushBack(z, allocator);
    return list;
}

/// The poly-lines as Wavefront OBJ.
std::string obj_of(const Axis& axis) {
    std::string text = "# axis\n";
    char buffer[128];
    std::size_t first = 1;
    for (const auto& line : axis.lines) {
        for (const auto& p : line) {
            std::snprintf(buffer, sizeof buffer, "v %.17g %.17g %.17g\n", p.x(), p.y(), p.z());
            text += buffer;
        }
        text += "l";
        for (std::size_t i = 0; i < line.size(); ++i) text += " " + std::to_string(first + i);
        text += "\n";
        first += line.size();
    }
    return text;
}

struct AxisCommand {
    std::string mesh, annotations, output;
    std::vector<std::string> names;
    AxisOptions options;
    ReadAnnotationsOptions reading;

    int run(const Session& session) const {
        if (annotations.empty() != names.empty())
            fail_usage(names.empty() ? "no annotation is named" : "there are no annotations",
                       "give an annotation file and --annotation ID or TAG, or neither for the whole mesh");
        if (!output.empty() && extension(output) != ".json" && extension(output) != ".obj")
            fail_usage("'" + output + "' is not a file of axes", "end its name in .json or .obj");
        std::vector<Path> inputs{mesh};
        if (!annotations.empty()) inputs.emplace_back(annotations);
        check_outputs(inputs, output.empty() ? std::vector<Path>() : std::vector<Path>{output});
        Provenance provenance{"axis", list_options(options), {}};
        for (const Path& file : inputs) provenance.add_input(file);
        for (const auto& name : names) provenance.options.emplace_back("annotation", name);
        const MeshFile file = read_mesh(mesh);
        for (const auto& note : file.notes) session.note("note: " + note);
        std::string unit;
        const Axis axis = find(file.mesh, unit);

        Json document(rapidjson::kObjectType);
        auto& allocator = document.GetAllocator();
        JsonValue result = json_of(axis, unit, allocator);
        if (!output.empty()) write(axis, result, provenance);
        if (session.json) session.print_report(provenance, document, result);
        else print(axis, unit);
        return axis.found ? done : answer_is_no;
    }

private:
    [[nodiscard]] Axis find(const Mesh& whole, std::string& unit) const {
        std::vector<Index> faces;
        if (annotations.empty()) {
            faces.resize(whole.number_of_faces());
            std::iota(faces.begin(), faces.end(), Index{0});
            return in_file(mesh, [&] { return find_axis(whole, faces, options); });
        }
        const AnnotationSet set = read_annotations(annotations, whole, reading);
        unit = set.unit;
        std::vector<Point> rim;
        for (const auto& name : names) {
            const Annotation* annotation = &find_annotation(set, name, annotations);
            if (annotation->type == AnnotationType::region)
                faces.insert(faces.end(), annotation->faces.begin(), annotation->faces.end());
            else
                for (const Index v : touched_vertices(whole, *annotation)) rim.push_back(whole.point(Vertex(v)));
        }
        if (!rim.empty() && !faces.empty())
            fail_usage("regions and curves have no axis together", "name regions only, or lines and points only");
        if (!rim.empty()) return circle_axis(rim);
        std::sort(faces.begin(), faces.end());
        faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
        return in_file(annotations, [&] { return find_axis(whole, faces, options); });
    }

    static std::string unit_of(const AxisFigure& figure, const std::string& unit) {
        return figure.unit == "length" ? unit : figure.unit;
    }

    static JsonValue json_of(const Axis& axis, const std::string& unit, JsonAllocator& allocator) {
        JsonValue object(rapidjson::kObjectType), figures(rapidjson::kArrayType);
        add_member(object, "found", JsonValue(axis.found), allocator);
        if (!axis.found) add_member(object, "reason", axis.reason, allocator);
        if (axis.found) {
            add_member(object, "point", numbers(axis.point.x(), axis.point.y(), axis.point.z(), allocator), allocator);
            add_member(object, "direction", numbers(axis.direction.x(), axis.direction.y(), axis.direction.z(), allocator),
                       allocator);
            JsonValue lines(rapidjson::kArrayType);
            for (const auto& line : axis.lines) {
                JsonValue list(rapidjson::kArrayType);
                for (const auto& p : line) list.PushBack(numbers(p.x(), p.y(), p.z(), allocator), allocator);
                lines.PushBack(list, allocator);
            }
            add_member(object, "polylines", std::move(lines), allocator);
        }
        add_member(object, "quality", JsonValue(axis.quality), allocator);
        for (const auto& figure : axis.figures) {
            JsonValue entry(rapidjson::kObjectType);
            add_member(entry, "name", figure.name, allocator);
            add_member(entry, "value", JsonValue(figure.value), allocator);
            if (const std::string text = unit_of(figure, unit); !text.empty()) add_member(entry, "unit", text, allocator);
            figures.PushBack(entry, allocator);
        }
        add_member(object, "figures", std::move(figures), allocator);
        return object;
    }

    void write(const Axis& axis, const JsonValue& result, const Provenance& provenance) const {
        if (extension(output) == ".obj") {
            AtomicFile file(output);
            file.write(obj_of(axis));
            file.commit();
            return;
        }
        Json document(rapidjson::kObjectType);
        auto& allocator = document.GetAllocator();
        JsonValue copy(result, allocator);
        add_member(document, "format", "ostraka-axis", allocator);
        add_member(document, "version", JsonValue(1), allocator);
        add_member(document, "axis", std::move(copy), allocator);
        add_member(document, "provenance", provenance.to_json(allocator), allocator);
        write_json(output, document);
    }

    static void print(const Axis& axis, const std::string& unit) {
        const auto three = [](double x, double y, double z) { return number(x) + " " + number(y) + " " + number(z); };
        std::vector<std::vector<std::string>> rows;
        if (axis.found) {
            rows.push_back({"through", three(axis.point.x(), axis.point.y(), axis.point.z())});
            rows.push_back({"direction", three(axis.direction.x(), axis.direction.y(), axis.direction.z())});
        }
        rows.push_back({"quality", number(axis.quality, 4)});
        for (const auto& figure : axis.figures) {
            const std::string text = unit_of(figure, unit);
            rows.push_back({figure.name, number(figure.value) + (text.empty() ? "" : " " + text)});
        }
        std::cout << table({"axis", axis.found ? "found" : "none"}, rows);
        if (!axis.found) std::cout << "has no axis: " << axis.reason << '\n';
    }
};

}  // namespace

void add_axis(CLI::App& tool, Session& session) {
    const auto axis = std::make_shared<AxisCommand>();
    CLI::App* command = session.add(tool, "axis", "the axis of an object or of an annotated part; exit code 3 if it has none",
                                    [&session, axis] { return axis->run(session); });
    command->add_option("mesh", axis->mesh, "mesh file")->required();
    command->add_option("annotations", axis->annotations, "its annotations (.ant.json)");
    command->add_option("--annotation", axis->names,
                        "id or tag of the part; more than one: all together; a line or points: its circle");
    command->add_option("--output", axis->output, "write the axis as poly-lines (.json, .obj)");
    add_flags(command, axis->options);
    add_flags(command, axis->reading);
}

}  // namespace ostraka::app

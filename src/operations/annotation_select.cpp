// annotation select: one step of a recipe, given by options.
#include "operations.h"

#include "ostraka/annotation/label_file.h"
#include "ostraka/measure/examine.h"
#include "ostraka/select/recipe.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

/// All that the options say of a step.
struct SelectStep {
    // tools, of which exactly one is given
    std::string expression;  ///< as recipes have it
    bool all = false;
    std::vector<double> rectangle, polygon, box, sphere, halfspace, nearest;
    std::string threshold, component;
    std::optional<int> segment;
    std::vector<std::string> path, lasso, brush, vertices;
    std::vector<int> faces, labels;
    // how
    bool through = false, closed = false, stroke = false, invert = false, quantiles = false;
    std::string seed, metric = "euclidean", frame = "mesh";
    std::optional<double> radius, above, below;
    double scale = 0, smoothing = 0.26;
    int grow = 0, shrink = 0;
    // the camera
    std::string camera_text, view = "30,20", up, projection = "orthographic", size = "1200x900";
    double zoom = 1;
    // what for
    std::string tag, action = "make";
    std::optional<std::string> type;
    std::vector<int> colour;
    std::optional<int> id;

    void describe(OptionList& visit) {
        visit("expression", expression, "what to select, as recipes say it (JSON)").positional();
        visit.group("Tools (picks are an index, a point x,y,z or a pixel @x,y of the camera)");
        visit("all", all, "the whole mesh");
        visit("rectangle", rectangle, "x0,y0,x1,y1 in pixels of the camera's picture");
        visit("polygon", polygon, "x,y,x,y,... drawn around a part in the camera's picture");
        visit("box", box, "six numbers: least and greatest corner");
        visit("sphere", sphere, "x,y,z,radius");
        visit("halfspace", halfspace, "six numbers: a point of the plane, and the normal to the side wanted");
        visit("nearest", nearest, "x,y,z: the nearest vertex");
        visit("threshold", threshold,
              "x, y, z, mean-curvature, gaussian-curvature, thickness, distance (from --seed) or a file of values (.npy or "
              "text)");
        visit("segment", segment, "levels of thickness to tell apart; the segment of --seed", Range{2, 100});
        visit("path", path, "picks joined by shortest paths along edges").words();
        visit("lasso", lasso, "picks around a part; --seed lies within it").words();
        visit("brush", brush, "picks; the discs of --radius around them").words();
        visit("vertices", vertices, "picks").words();
        visit("component", component, "the connected part of this pick");
        visit("faces", faces, "indices of faces").words();
        visit("labels", labels, "labels of the mesh file's faces").words();

        visit.group("How");
        visit("through", through, "rectangle and polygon: hidden parts too");
        visit("closed", closed, "path: back to the first pick");
        visit("metric", metric, "path and lasso: what is short", Choices{"euclidean", "segment", "combined"});
        visit("seed", seed, "lasso, segment, distance: a pick");
        visit("radius", radius, "brush: geodesic radius, in lengths as --frame says");
        visit("stroke", stroke, "brush: drawn from pick to pick");
        visit("above", above, "threshold: least value, in lengths as --frame says (curvature: one over them), of a file its own");
        visit("below", below, "threshold: greatest value, likewise");
        visit("quantiles", quantiles, "threshold: values are shares of the area, 0 to 1");
        visit("scale", scale, "curvature: radius as a share of the diagonal; 0: as the mesh is fine", Range{0, 1});
        visit("smoothing", smoothing, "segment: how much short borders in hollows are preferred", Range{0, 1});
        visit("grow", grow, "so many rings larger", Range{0, 1000000});
        visit("shrink", shrink, "so many rings smaller", Range{0, 1000000});
        visit("invert", invert, "all but this");
        visit(
            "frame", frame,
            "mesh: coordinates and lengths in the unit of the mesh's coordinates; box: as shares, 0 to 1, of its box and of the "
            "box's diagonal",
            Choices{"mesh", "box"});

        visit.group("Camera (that of 'ostraka render' without legend and title)");
        visit("camera", camera_text,
              "one of the recipe's by its name, or as JSON ('render --json' reports it), instead of the following");
        visit("view", view, "front, back, left, right, top, bottom, iso or azimuth,elevation in degrees");
        visit("up", up,
              "x, y, z, -x, -y, -z or three numbers: upward direction, kept where a new file is made; else as the annotations "
              "say, else 0,0,1");
        visit("projection", projection, "of the camera", Choices{"orthographic", "perspective"});
        visit("zoom", zoom, "magnification about the middle", Range{0.01, 1000});
        visit("size", size, "width and height of the picture in pixels");

        visit.group("Annotation");
        visit("tag", tag, "what it is");
        visit("id", id, "its id; a free one if it is new and none is given");
        visit("type", type, "of a new one; else what the tool selects", Choices{"point", "line", "region"});
        visit("colour", colour, "red,green,blue", Range{0, 255});
        visit("action", action, "what to do with the annotation of this id",
              Choices{"make", "add to", "remove from", "replace", "delete", "retag"});
    }

    /// The step, taken on this set. Throws Error (usage) for options that make no step.
    [[nodiscard]] Json step(const AnnotationSet& set) const {
        Json document(rapidjson::kObjectType);
        auto& a = document.GetAllocator();
        const bool makes = action == "make";
        if (!makes) add_member(document, "action", action, a);
        if (!makes && !id) fail_usage("the action '" + action + "' needs the annotation's --id", "see 'ostraka annotation list'");
        add_member(document, "id", JsonValue(id ? *id : free_id(set)), a);
        if (makes && tag.empty()) fail_usage("a new annotation needs a tag", "add --tag TEXT");
        if (action != "delete" && !tag.empty()) add_member(document, "tag", tag, a);
        if (!colour.empty() && colour.size() != 3)
            fail_usage("--colour has " + std::to_string(colour.size()) + " numbers", "give red,green,blue, each 0 to 255");
        const auto fresh = distinct_colour(set.annotations.size());
        if (makes || !colour.empty())
            add_member(document, "colour", list(colour.empty() ? std::vector<int>(fresh.begin(), fresh.end()) : colour, a), a);
        if (makes) add_member(document, "type", type.value_or(type_of_tool()), a);
        if (action != "delete" && action != "retag") {
            add_member(document, "frame", frame, a);
            add_member(document, "select", selected(a), a);
        }
        return document;
    }

private:
    using Alloc = JsonAllocator&;

    template <class... Rest>
    static void add(JsonValue& object, Alloc a, const char* name, JsonValue value, Rest&&... rest) {
        add_member(object, name, std::move(value), a);
        if constexpr (sizeof...(rest) > 0) add(object, a, std::forward<Rest>(rest)...);
    }
    /// {name: value, ...}
    template <class... Members>
    static JsonValue object(Alloc a, Members&&... members) {
        JsonValue value(rapidjson::kObjectType);
        add(value, a, std::forward<Members>(members)...);
        return value;
    }

    static JsonValue finite(double x) {
        if (!std::isfinite(x)) fail_usage("a number of the step is not finite", "give finite numbers");
        return JsonValue(x);
    }
    static JsonValue list(const std::vector<double>& values, Alloc a) {
        JsonValue value(rapidjson::kArrayType);
        for (const double x : values) value.PushBack(finite(x), a);
        return value;
    }
    static JsonValue list(const std::vector<int>& values, Alloc a) {
        JsonValue value(rapidjson::kArrayType);
        for (const int x : values) value.PushBack(x, a);
        return value;
    }
    static JsonValue part(const std::vector<double>& values, std::size_t begin, std::size_t count, Alloc a) {
        const auto first = values.begin() + static_cast<std::ptrdiff_t>(begin);
        return list(std::vector<double>(first, first + static_cast<std::ptrdiff_t>(count)), a);
    }
    static void check_count(const std::vector<double>& values, const char* option, std::size_t count) {
        if (values.size() == count) return;
        fail_usage(
            "--" + std::string(option) + " takes " + std::to_string(count) + " numbers, not " + std::to_string(values.size()),
            "separate them by commas, without blanks");
    }

    [[nodiscard]] JsonValue camera(Alloc a) const {
        if (camera_text.starts_with('{')) return JsonValue(parse_json(camera_text, "camera"), a);
        if (!camera_text.empty()) return json_string(camera_text, a);
        JsonValue value = object(a, "view", json_string(view, a));
        if (!up.empty()) {
            const auto direction = direction_of(up, "--up");
            add(value, a, "up", list(std::vector<double>(direction.begin(), direction.end()), a));
        }
        add_member(value, "projection", projection, a);
        if (zoom != 1) add(value, a, "zoom", JsonValue(zoom));
        int width = 0, height = 0;
        char cross = 0, rest = 0;
        if (std::sscanf(size.c_str(), "%d%c%d%c", &width, &cross, &height, &rest) != 3 || cross != 'x' || width < 16 ||
            height < 16)
            fail_usage("size '" + printable(size, 60) + "' is not possible", "use WIDTHxHEIGHT such as 1200x900");
        add(value, a, "picture", list(std::vector{width, height}, a));
        return value;
    }

    [[nodiscard]] JsonValue pick(const std::string& text, const char* option, Alloc a) const {
        const std::string name = "--" + std::string(option);
        if (text.starts_with('@')) {
            const auto pixel = numbers_of<double>(text.substr(1), name);
            check_count(pixel, option, 2);
            return object(a, "camera", camera(a), "pixel", list(pixel, a));
        }
        const auto values = numbers_of<double>(text, name);
        if (values.size() == 3) return list(values, a);
        if (values.size() == 1 && values[0] >= 0 && values[0] < no_index && values[0] == std::floor(values[0]))
            return JsonValue(static_cast<std::uint32_t>(values[0]));
        fail_usage(name + " '" + printable(text, 60) + "' is not a pick", "give an index, a point x,y,z or a pixel @x,y");
    }
    [[nodiscard]] JsonValue picks(const std::vector<std::string>& texts, const char* option, Alloc a) const {
        JsonValue value(rapidjson::kArrayType);
        for (const auto& text : texts) value.PushBack(pick(text, option, a), a);
        return value;
    }

    void need_seed(const char* what) const {
        if (seed.empty()) fail_usage(std::string(what) + " needs a seed", "add --seed PICK, a place within it");
    }

    [[nodiscard]] JsonValue of_threshold(Alloc a) const {
        JsonValue value(rapidjson::kObjectType);
        if (threshold == "mean-curvature" || threshold == "gaussian-curvature") {
            add_member(value, "curvature", threshold.substr(0, threshold.find('-')), a);
            if (scale != 0) add(value, a, "scale", JsonValue(scale));
        } else if (threshold == "thickness") {
            add(value, a, "thickness", JsonValue(true));
        } else if (threshold == "x" || threshold == "y" || threshold == "z") {
            const auto axis = direction_of(threshold, "--threshold");
            add(value, a, "coordinate", list(std::vector<double>(axis.begin(), axis.end()), a));
        } else if (threshold == "distance") {
            if (seed.empty()) fail_usage("a threshold on the distance needs a place to start from", "add --seed PICK");
            add(value, a, "distance", picks({seed}, "seed", a));
        } else {
            if (extension(threshold).empty() && !file_exists(threshold))
                fail_usage("--threshold '" + printable(threshold, 60) + "' is no known quantity and no file",
                           "use x, y, z, mean-curvature, gaussian-curvature, thickness, distance or a file of values (.npy or "
                           "text)");
            add_member(value, "map", threshold, a);
        }
        if (above) add(value, a, "above", finite(*above));
        if (below) add(value, a, "below", finite(*below));
        if (quantiles) add(value, a, "quantiles", JsonValue(true));
        return value;
    }

    /// The expression that one tool stands for.
    [[nodiscard]] JsonValue tool(Alloc a) const {
        std::vector<std::string> given;
        JsonValue result(rapidjson::kObjectType);
        const auto when = [&](bool present, const char* kind, auto&& make) {
            if (!present) return;
            given.emplace_back(kind);
            if (given.size() == 1) add_member(result, kind, make(), a);
        };
        const auto seen = [&](JsonValue value) {
            if (through) add(value, a, "visible", JsonValue(false));
            return value;
        };
        when(all, "all", [&] { return JsonValue(true); });
        when(!rectangle.empty(), "rectangle", [&] {
            check_count(rectangle, "rectangle", 4);
            return seen(object(a, "camera", camera(a), "from", part(rectangle, 0, 2, a), "to", part(rectangle, 2, 2, a)));
        });
        when(!polygon.empty(), "polygon", [&] {
            if (polygon.size() < 6 || polygon.size() % 2 != 0)
                fail_usage("--polygon has " + std::to_string(polygon.size()) + " numbers", "give x,y of three pixels or more");
            JsonValue points(rapidjson::kArrayType);
            for (std::size_t i = 0; i < polygon.size(); i += 2) points.PushBack(part(polygon, i, 2, a), a);
            return seen(object(a, "camera", camera(a), "points", std::move(points)));
        });
        when(!box.empty(), "box", [&] {
            check_count(box, "box", 6);
            return object(a, "min", part(box, 0, 3, a), "max", part(box, 3, 3, a));
        });
        when(!sphere.empty(), "sphere", [&] {
            check_count(sphere, "sphere", 4);
            return object(a, "centre", part(sphere, 0, 3, a), "radius", finite(sphere[3]));
        });
        when(!halfspace.empty(), "halfspace", [&] {
            check_count(halfspace, "halfspace", 6);
            return object(a, "point", part(halfspace, 0, 3, a), "normal", part(halfspace, 3, 3, a));
        });
        when(!nearest.empty(), "nearest", [&] {
            check_count(nearest, "nearest", 3);
            return list(nearest, a);
        });
        when(!vertices.empty(), "vertices", [&] { return picks(vertices, "vertices", a); });
        when(!faces.empty(), "faces", [&] { return list(faces, a); });
        when(!labels.empty(), "labels", [&] { return list(labels, a); });
        when(!component.empty(), "component", [&] { return object(a, "seed", pick(component, "component", a)); });
        when(!path.empty(), "path", [&] {
            JsonValue value = object(a, "points", picks(path, "path", a));
            if (closed) add(value, a, "closed", JsonValue(true));
            add_member(value, "metric", metric, a);
            return value;
        });
        when(!lasso.empty(), "lasso", [&] {
            need_seed("a lasso");
            return object(a, "points", picks(lasso, "lasso", a), "seed", pick(seed, "seed", a), "metric", json_string(metric, a));
        });
        when(!brush.empty(), "brush", [&] {
            if (!radius || !(*radius >= 0)) fail_usage("a brush needs a radius of zero or more", "add --radius LENGTH");
            JsonValue value = object(a, "points", picks(brush, "brush", a), "radius", finite(*radius));
            if (stroke) add(value, a, "stroke", JsonValue(true));
            return value;
        });
        when(!threshold.empty(), "threshold", [&] { return of_threshold(a); });
        when(segment.has_value(), "segments", [&] {
            need_seed("a segment");
            return object(a, "clusters", JsonValue(*segment), "smoothing", JsonValue(smoothing), "seeds",
                          picks({seed}, "seed", a));
        });
        if (!expression.empty()) {
            given.emplace_back("expression");
            const Json parsed = parse_json(expression, "expression");
            if (given.size() == 1) result.CopyFrom(parsed, a);
        }
        if (given.empty())
            fail_usage("nothing says what to select", "give an expression or a tool, such as --rectangle x0,y0,x1,y1");
        if (given.size() > 1)
            fail_usage("two tools at once: " + given[0] + " and " + given[1],
                       "give one; join them by an expression, or by two commands");
        return result;
    }

    [[nodiscard]] JsonValue selected(Alloc a) const {
        JsonValue result = tool(a);
        if (grow > 0 && shrink > 0) fail_usage("both --grow and --shrink", "give one of them");
        if (grow > 0 || shrink > 0)
            result = object(a, grow > 0 ? "grow" : "shrink",
                            object(a, "of", std::move(result), "rings", JsonValue(std::max(grow, shrink))));
        return invert ? object(a, "invert", std::move(result)) : std::move(result);
    }

    [[nodiscard]] std::string type_of_tool() const {
        if (!path.empty()) return "line";
        return nearest.empty() && vertices.empty() ? "region" : "point";
    }
};

class AnnotationSelect final : public Operation {
public:
    void describe(Parameters& p) override {
        p.input("mesh", Kind::mesh, mesh, "mesh file");
        p.input("annotations", Kind::annotations, annotations, "annotation file (.ant.json): brought up to date, or made");
        p.output_option("output", Kind::annotations, output, "write the annotations here and leave the file as it is")
            .updates(annotations);
        p.input_option("record", Kind::recipe, record, "recipe to which the step is added, or which is begun");
        p.output_option("recipe", Kind::recipe, recipe, "write the recipe here and leave that of --record as it is")
            .updates(record);
        step.describe(p.options);
        p.options.group("New file");
        p.options("class", object_class, "what the object is (any text)");
        p.options("unit", unit, "unit of the coordinates (any text, such as mm)");

        p.report.values(integer("id"), text("action"), text("tag"), text("type"), integer("elements"), integer("patches"),
                        number("area", "", "length^2"), number("length", "", "length"));
        p.report.table("", people("id"), people("tag"), people("type"), people("elements"), people("patches"),
                       people("area", FieldType::number, "length^2"), people("perimeter / length", FieldType::number, "length"));
    }

    void check() const override {
        static_cast<void>(step.step({}));
        if (!step.up.empty()) static_cast<void>(direction_of(step.up, "--up"));
    }

    void run(Context& context, Report& report) override {
        const MeshFile& file = *mesh;
        const bool makes = !annotations.exists(), begins = !record.exists();
        RecipeStart start;
        start.face_labels = file.extras.face_labels;
        if (start.face_labels.empty() && !file.extras.vertex_labels.empty())
            start.face_labels = face_labels_from_vertices(file.mesh, file.extras.vertex_labels);
        start.folder = Path(record.file()).parent_path();
        if (!makes) start.annotations = annotations.on(file.mesh);
        const std::string before =
            begins ? std::string() : record.load<std::string>([](const Path& path) { return read_file(path); });
        Json steps = begins ? begun(makes) : parse_json(before, record.file());
        if (!begins) validate(steps, "recipe", record.file());
        // The recipe alone makes these annotations.
        const bool replayable = recipe && (begins ? makes : !makes && stems_from(start.annotations, steps, before, start.folder));

        // This step alone, with the head of the recipe, on what there is.
        Json now;
        now.CopyFrom(steps, now.GetAllocator());
        now["annotations"].Clear();
        if (makes) add_head(now, true);
        const auto append = [&](const JsonValue& made) {
            for (Json* to : {&steps, &now})
                (*to)["annotations"].PushBack(JsonValue(made, to->GetAllocator()), to->GetAllocator());
        };
        AnnotationSet there;  // ids and colours follow what is there when the step is taken
        there.annotations = start.annotations.annotations;
        if (makes && !object_class.empty() && !(step.all && step.action == "make")) {
            // The whole object comes first, as a step of its own: later steps then find the same ids.
            Json whole = parse_json(R"({"id": 0, "colour": [128, 128, 128], "type": "region", "select": {"all": true}})", "root");
            add_member(whole, "tag", object_class, whole.GetAllocator());
            append(whole);
            there.annotations.emplace_back();
        }
        const Json made = step.step(there);
        append(made);
        const Path folder = start.folder;
        AnnotationSet set;
        context.record([&] { set = follow_recipe(now, file.mesh, std::move(start), "selection"); });
        tell(report, file.mesh, set, made["id"].GetInt());

        const std::string text = to_text(steps);
        std::optional<Provenance> replay;
        if (replayable) {
            replay = {"annotation apply", {}, {context.provenance().inputs.front()}};
            for (const OperationEntry& entry : operations())
                if (entry.name == replay->command) replay->options = Call(entry).parameters().options.values();
            replay->inputs.emplace_back(recipe.path().filename().string(), sha256(text));
            for (const Path& named : files_named_by(steps, folder)) replay->add_input(named);
        }
        output.write(std::move(set), file.mesh, mesh.file(), replay);
        if (!recipe) return;
        recipe.write(text);
        if (!replayable)
            report.note(recipe.file() + " alone does not give " + output.file() +
                        ": replay it with 'annotation apply --edit' on the annotations as they were before it was begun");
    }

private:
    /// What the options say of the object, where the recipe does not. With an older file --up turns the camera only.
    void add_head(Json& document, bool makes) const {
        auto& a = document.GetAllocator();
        const auto missing = [&](const char* name) { return find_member(document, name) == nullptr; };
        if (!object_class.empty() && missing("class")) add_member(document, "class", object_class, a);
        if (!unit.empty() && missing("unit")) add_member(document, "unit", unit, a);
        if (!makes || step.up.empty() || !missing("up")) return;
        JsonValue list(rapidjson::kArrayType);
        for (const double x : direction_of(step.up, "--up")) list.PushBack(x, a);
        add_member(document, "up", std::move(list), a);
    }

    [[nodiscard]] Json begun(bool makes) const {
        Json document(rapidjson::kObjectType);
        auto& a = document.GetAllocator();
        add_member(document, "format", "ostraka-recipe", a);
        add_member(document, "version", JsonValue(1), a);
        add_head(document, makes);
        add_member(document, "annotations", JsonValue(rapidjson::kArrayType), a);
        return document;
    }

    /// True if the set is what 'annotation apply' makes of the recipe with these bytes.
    static bool stems_from(const AnnotationSet& set, const Json& recipe, const std::string& bytes, const Path& folder) {
        if (!set.provenance.IsObject()) return false;
        const JsonValue *command = find_member(set.provenance, "command"), *inputs = find_member(set.provenance, "inputs");
        if (command == nullptr || !command->IsString() || std::string(command->GetString()) != "annotation apply" ||
            inputs == nullptr || !inputs->IsArray() || inputs->Size() != 2 + files_named_by(recipe, folder).size())
            return false;
        const JsonValue& second = (*inputs)[1];
        const JsonValue* hash = second.IsObject() ? find_member(second, "sha256") : nullptr;
        return hash != nullptr && hash->IsString() && sha256(bytes) == hash->GetString();
    }

    void tell(Report& report, const Mesh& on, const AnnotationSet& set, int id) const {
        report.set_unit(set.unit);
        report("id", id)("action", step.action);
        const Annotation* chosen = set.find(id);
        if (chosen == nullptr) return report.line("annotation " + std::to_string(id) + " deleted");
        const AnnotationSummary summary = summarise(on, *chosen);
        const bool region = chosen->type == AnnotationType::region, point = chosen->type == AnnotationType::point;
        report("tag", chosen->tag)("type", to_string(chosen->type))("elements", summary.elements)("patches", summary.patches);
        if (region) report("area", summary.area);
        if (!point) report("length", summary.length);
        Report::Row row = report.row("");
        row.shown("id", std::to_string(id)).shown("tag", chosen->tag).shown("type", to_string(chosen->type));
        row.shown("elements", std::to_string(summary.elements)).shown("patches", std::to_string(summary.patches));
        if (region) row.shown("area", number(summary.area));
        if (!point) row.shown("perimeter / length", number(summary.length));
    }

    MeshInput mesh;
    AnnotationsInput annotations;
    AnnotationsOutput output;
    FileInput record;
    FileOutput recipe{".json"};
    SelectStep step;
    std::string object_class, unit;
};

}  // namespace

std::unique_ptr<Operation> make_annotation_select() { return make<AnnotationSelect>(); }

}  // namespace ostraka

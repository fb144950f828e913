#include "step_flags.h"

#include "ostraka/annotation/label_file.h"

#include <algorithm>
#include <cmath>

namespace ostraka::app {

namespace {

/// Numbers separated by commas, each finite.
std::vector<double> numbers(const std::string& text, const std::string& flag) {
    std::vector<double> list;
    const char* place = text.c_str();
    for (;;) {
        char* end = nullptr;
        const double value = std::strtod(place, &end);
        if (end == place || !std::isfinite(value) || (*end != ',' && *end != '\0'))
            fail_usage("--" + flag + " '" + text + "' is not a list of numbers", "separate numbers by commas, without blanks");
        list.push_back(value);
        if (*end == '\0') return list;
        place = end + 1;
    }
}

JsonValue list_of(const std::vector<double>& values, JsonAllocator& a) {
    JsonValue list(rapidjson::kArrayType);
    for (const double x : values) list.PushBack(x, a);
    return list;
}
JsonValue vector(const std::string& text, const std::string& flag, std::size_t count, JsonAllocator& a) {
    const auto values = numbers(text, flag);
    if (values.size() != count)
        fail_usage("--" + flag + " takes " + std::to_string(count) + " numbers, not " + std::to_string(values.size()),
                   "separate them by commas, without blanks");
    return list_of(values, a);
}
JsonValue part(const std::string& text, const std::string& flag, std::size_t begin, std::size_t count, std::size_t all,
               JsonAllocator& a) {
    const auto values = numbers(text, flag);
    if (values.size() != all)
        fail_usage("--" + flag + " takes " + std::to_string(all) + " numbers, not " + std::to_string(values.size()),
                   "separate them by commas, without blanks");
    const auto first = values.begin() + static_cast<std::ptrdiff_t>(begin);
    return list_of({first, first + static_cast<std::ptrdiff_t>(count)}, a);
}
}  // namespace

JsonValue StepFlags::camera(Alloc a) const {
    JsonValue value(rapidjson::kObjectType);
    if (camera_text.starts_with('{')) {
        value.CopyFrom(parse_json(camera_text, "camera"), a);
        return value;
    }
    if (!camera_text.empty()) return json_string(camera_text, a);
    add_member(value, "view", view, a);
    if (!up.empty()) add_member(value, "up", vector(up, "up", 3, a), a);
    add_member(value, "projection", projection, a);
    if (zoom != 1) add_member(value, "zoom", JsonValue(zoom), a);
    int width = 0, height = 0;
    char cross = 0, rest = 0;
    if (std::sscanf(size.c_str(), "%d%c%d%c", &width, &cross, &height, &rest) != 3 || cross != 'x' || width < 16 || height < 16)
        fail_usage("size '" + size + "' is not possible", "use WIDTHxHEIGHT such as 1200x900");
    JsonValue picture(rapidjson::kArrayType);
    picture.PushBack(width, a).PushBack(height, a);
    add_member(value, "picture", std::move(picture), a);
    return value;
}

JsonValue StepFlags::pick(const std::string& text, const std::string& flag, Alloc a) const {
    if (text.starts_with('@')) {
        JsonValue value(rapidjson::kObjectType);
        add_member(value, "camera", camera(a), a);
        add_member(value, "pixel", vector(text.substr(1), flag, 2, a), a);
        return value;
    }
    const auto values = numbers(text, flag);
    if (values.size() == 3) return list_of(values, a);
    if (values.size() == 1 && values[0] >= 0 && values[0] < 4294967295.0 && values[0] == std::floor(values[0]))
        return JsonValue(static_cast<std::uint32_t>(values[0]));
    fail_usage("--" + flag + " '" + text + "' is not a pick", "give an index, a point x,y,z or a pixel @x,y");
}

JsonValue StepFlags::picks(const std::vector<std::string>& list, const std::string& flag, Alloc a) const {
    JsonValue value(rapidjson::kArrayType);
    for (const auto& text : list) value.PushBack(pick(text, flag, a), a);
    return value;
}

JsonValue StepFlags::threshold(Alloc a) const {
    JsonValue value(rapidjson::kObjectType);
    const std::string& of = tools.threshold;
    if (of == "mean-curvature" || of == "gaussian-curvature") {
        add_member(value, "curvature", of.substr(0, of.find('-')), a);
        if (scale != 0) add_member(value, "scale", JsonValue(scale), a);
    } else if (of == "thickness") {
        add_member(value, "thickness", JsonValue(true), a);
    } else if (of == "x" || of == "y" || of == "z") {
        add_member(value, "coordinate", list_of({of == "x" ? 1.0 : 0.0, of == "y" ? 1.0 : 0.0, of == "z" ? 1.0 : 0.0}, a), a);
    } else if (of == "distance") {
        if (seed.empty()) fail_usage("a threshold on the distance needs a place to start from", "add --seed PICK");
        add_member(value, "distance", picks({seed}, "seed", a), a);
    } else {
        if (extension(of).empty() && !std::filesystem::exists(of))
            fail_usage("--threshold '" + of + "' is no known quantity and no file",
                       "use x, y, z, mean-curvature, gaussian-curvature, thickness, distance or a file of values (.npy or text)");
        add_member(value, "map", of, a);
    }
    if (above) add_member(value, "above", JsonValue(*above), a);
    if (below) add_member(value, "below", JsonValue(*below), a);
    if (quantiles) add_member(value, "quantiles", JsonValue(true), a);
    return value;
}

/// The expression that the flags of one tool stand for.
JsonValue StepFlags::tool(Alloc a) const {
    std::vector<std::string> given;
    JsonValue result(rapidjson::kObjectType);
    const auto add = [&](const char* flag, const char* kind, bool present, auto&& make) {
        if (!present) return;
        given.emplace_back(flag);
        if (given.size() == 1) add_member(result, kind, make(), a);
    };
    const auto object = [] { return JsonValue(rapidjson::kObjectType); };
    const Tools& t = tools;
    add("all", "all", t.all, [&] { return JsonValue(true); });
    add("rectangle", "rectangle", !t.rectangle.empty(), [&] {
        JsonValue value = object();
        add_member(value, "camera", camera(a), a);
        add_member(value, "from", part(t.rectangle, "rectangle", 0, 2, 4, a), a);
        add_member(value, "to", part(t.rectangle, "rectangle", 2, 2, 4, a), a);
        if (through) add_member(value, "visible", JsonValue(false), a);
        return value;
    });
    add("polygon", "polygon", !t.polygon.empty(), [&] {
        const auto values = numbers(t.polygon, "polygon");
        if (values.size() < 6 || values.size() % 2 != 0)
            fail_usage("--polygon has " + std::to_string(values.size()) + " numbers", "give x,y of three pixels or more");
        JsonValue value = object(), points(rapidjson::kArrayType);
        for (std::size_t i = 0; i < values.size(); i += 2) points.PushBack(list_of({values[i], values[i + 1]}, a), a);
        add_member(value, "camera", camera(a), a);
        add_member(value, "points", std::move(points), a);
        if (through) add_member(value, "visible", JsonValue(false), a);
        return value;
    });
    add("box", "box", !t.box.empty(), [&] {
        JsonValue value = object();
        add_member(value, "min", part(t.box, "box", 0, 3, 6, a), a);
        add_member(value, "max", part(t.box, "box", 3, 3, 6, a), a);
        return value;
    });
    add("sphere", "sphere", !t.sphere.empty(), [&] {
        JsonValue value = object();
        add_member(value, "centre", part(t.sphere, "sphere", 0, 3, 4, a), a);
        add_member(value, "radius", JsonValue(numbers(t.sphere, "sphere").back()), a);
        return value;
    });
    add("halfspace", "halfspace", !t.halfspace.empty(), [&] {
        JsonValue value = object();
        add_member(value, "point", part(t.halfspace, "halfspace", 0, 3, 6, a), a);
        add_member(value, "normal", part(t.halfspace, "halfspace", 3, 3, 6, a), a);
        return value;
    });
    add("nearest", "nearest", !t.nearest.empty(), [&] { return vector(t.nearest, "nearest", 3, a); });
    add("vertices", "vertices", !t.vertices.empty(), [&] { return picks(t.vertices, "vertices", a); });
    const auto integers = [&](const std::vector<int>& list) {
        JsonValue value(rapidjson::kArrayType);
        for (const int i : list) value.PushBack(i, a);
        return value;
    };
    add("faces", "faces", !t.faces.empty(), [&] { return integers(t.faces); });
    add("labels", "labels", !t.labels.empty(), [&] { return integers(t.labels); });
    add("component", "component", !t.component.empty(), [&] {
        JsonValue value = object();
        add_member(value, "seed", pick(t.component.front(), "component", a), a);
        return value;
    });
    add("path", "path", !t.path.empty(), [&] {
        JsonValue value = object();
        add_member(value, "points", picks(t.path, "path", a), a);
        if (closed) add_member(value, "closed", JsonValue(true), a);
        add_member(value, "metric", metric, a);
        return value;
    });
    add("lasso", "lasso", !t.lasso.empty(), [&] {
        if (seed.empty()) fail_usage("a lasso needs a seed", "add --seed PICK, a place within it");
        JsonValue value = object();
        add_member(value, "points", picks(t.lasso, "lasso", a), a);
        add_member(value, "seed", pick(seed, "seed", a), a);
        add_member(value, "metric", metric, a);
        return value;
    });
    add("brush", "brush", !t.brush.empty(), [&] {
        if (!(radius >= 0)) fail_usage("a brush needs a radius of zero or more", "add --radius LENGTH");
        JsonValue value = object();
        add_member(value, "points", picks(t.brush, "brush", a), a);
        add_member(value, "radius", JsonValue(radius), a);
        if (stroke) add_member(value, "stroke", JsonValue(true), a);
        return value;
    });
    add("threshold", "threshold", !t.threshold.empty(), [&] { return threshold(a); });
    add("segment", "segments", !t.segments.empty(), [&] {
        JsonValue value = object();
        const auto clusters = numbers(t.segments, "segment").front();
        add_member(value, "clusters", JsonValue(static_cast<int>(clusters)), a);
        add_member(value, "smoothing", JsonValue(smoothing), a);
        if (seed.empty()) fail_usage("a segment needs a seed", "add --seed PICK, a place within it");
        add_member(value, "seeds", picks({seed}, "seed", a), a);
        return value;
    });
    if (!t.expression.empty()) {
        given.emplace_back("expression");
        Json parsed = parse_json(t.expression, "expression");
        if (given.size() == 1) result.CopyFrom(parsed, a);
    }
    if (given.empty()) fail_usage("nothing says what to select", "give an expression or a tool, such as --rectangle x0,y0,x1,y1");
    if (given.size() > 1)
        fail_usage("two tools at once: " + given[0] + " and " + given[1],
                   "give one; join them by an expression, or by two commands");
    return result;
}

JsonValue StepFlags::expression(Alloc a) const {
    JsonValue result = tool(a);
    if (grow > 0 && shrink > 0) fail_usage("both --grow and --shrink", "give one of them");
    if (grow > 0 || shrink > 0) {
        JsonValue value(rapidjson::kObjectType), outer(rapidjson::kObjectType);
        add_member(value, "of", std::move(result), a);
        add_member(value, "rings", JsonValue(std::max(grow, shrink)), a);
        add_member(outer, grow > 0 ? "grow" : "shrink", std::move(value), a);
        result = std::move(outer);
    }
    if (invert) {
        JsonValue outer(rapidjson::kObjectType);
        add_member(outer, "invert", std::move(result), a);
        result = std::move(outer);
    }
    return result;
}

std::string StepFlags::type_of_tool() const {
    if (!tools.path.empty()) return "line";
    return tools.nearest.empty() && tools.vertices.empty() ? "region" : "point";
}

int StepFlags::id_for(const AnnotationSet& set) const {
    if (id) return *id;
    if (action != "make") fail_usage("the action '" + action + "' needs the annotation's --id", "see 'ostraka annotation list'");
    return free_id(set);
}

JsonValue StepFlags::colour_for(const AnnotationSet& set, Alloc a) const {
    std::array<int, 3> rgb = distinct_colour(set.annotations.size());
    if (!colour.empty()) {
        const auto given = numbers(colour, "colour");
        const auto possible = [](double x) { return x >= 0 && x <= 255 && x == std::floor(x); };
        if (given.size() != 3 || !std::all_of(given.begin(), given.end(), possible))
            fail_usage("--colour '" + colour + "' is not possible", "give red,green,blue, each 0 to 255");
        for (std::size_t k = 0; k < 3; ++k) rgb[k] = static_cast<int>(given[k]);
    }
    JsonValue list(rapidjson::kArrayType);
    for (const int x : rgb) list.PushBack(x, a);
    return list;
}

Json StepFlags::step(const AnnotationSet& set) const {
    Json document(rapidjson::kObjectType);
    auto& a = document.GetAllocator();
    const bool selects = action != "delete" && action != "retag";
    if (action != "make") add_member(document, "action", action, a);
    add_member(document, "id", JsonValue(id_for(set)), a);
    if (action == "make" && tag.empty()) fail_usage("a new annotation needs a tag", "add --tag TEXT");
    if (action != "delete" && !tag.empty()) add_member(document, "tag", tag, a);
    if (action == "make" || !colour.empty()) {
        add_member(document, "colour", colour_for(set, a), a);
    }
    if (action == "make") add_member(document, "type", type.empty() ? type_of_tool() : type, a);
    if (selects) {
        add_member(document, "frame", frame, a);
        add_member(document, "select", expression(a), a);
    }
    return document;
}

void StepFlags::add_to(CLI::App& command) {
    command.add_option("expression", tools.expression, "what to select, as recipes say it (JSON)");
    const auto many = [&](const char* flag, std::vector<std::string>& list, const char* help) {
        command.add_option(flag, list, help)->expected(1, 1000000);
    };
    const std::string tool_group = "Tools (picks are an index, a point x,y,z or a pixel @x,y of the camera)";
    command.add_flag("--all", tools.all, "the whole mesh")->group(tool_group);
    for (auto& [flag, text, help] : std::initializer_list<std::tuple<const char*, std::string&, const char*>>{
             {"--rectangle", tools.rectangle, "x0,y0,x1,y1 in pixels of the camera's picture"},
             {"--polygon", tools.polygon, "x,y,x,y,... drawn around a part in the camera's picture"},
             {"--box", tools.box, "six numbers: least and greatest corner"},
             {"--sphere", tools.sphere, "x,y,z,radius"},
             {"--halfspace", tools.halfspace, "six numbers: a point of the plane, and the normal to the side wanted"},
             {"--nearest", tools.nearest, "x, y, z, -x, -y, -z or three numbers: the nearest vertex"},
             {"--threshold", tools.threshold,
              "x, y, z, mean-curvature, gaussian-curvature, thickness, distance (from --seed) or a file of values (.npy or "
              "text)"},
             {"--segment", tools.segments, "levels of thickness to tell apart; the segment of --seed"}})
        command.add_option(flag, text, help)->group(tool_group);
    many("--path", tools.path, "picks joined by shortest paths along edges");
    many("--lasso", tools.lasso, "picks around a part; --seed lies within it");
    many("--brush", tools.brush, "picks; the discs of --radius around them");
    many("--vertices", tools.vertices, "picks");
    command.add_option("--component", tools.component, "the connected part of this pick")->expected(1);
    command.add_option("--faces", tools.faces, "indices of faces");
    command.add_option("--labels", tools.labels, "labels of the mesh file's faces");
    for (const char* flag : {"--path", "--lasso", "--brush", "--vertices", "--component", "--faces", "--labels"})
        command.get_option(flag)->group(tool_group);

    const std::string how = "How";
    command.add_flag("--through", through, "rectangle and polygon: hidden parts too")->group(how);
    command.add_flag("--closed", closed, "path: back to the first pick")->group(how);
    command.add_option("--metric", metric, "path and lasso: what is short")
        ->check(CLI::IsMember({"euclidean", "segment", "combined"}))
        ->capture_default_str()
        ->group(how);
    command.add_option("--seed", seed, "lasso, segment, distance: a pick")->group(how);
    command.add_option("--radius", radius, "brush: geodesic radius, in lengths as --frame says")->group(how);
    command.add_flag("--stroke", stroke, "brush: drawn from pick to pick")->group(how);
    command
        .add_option("--above", above,
                    "threshold: least value, in lengths as --frame says (curvature: one over them), of a file its own")
        ->group(how);
    command.add_option("--below", below, "threshold: greatest value, likewise")->group(how);
    command.add_flag("--quantiles", quantiles, "threshold: values are shares of the area, 0 to 1")->group(how);
    command.add_option("--scale", scale, "curvature: radius as a share of the diagonal; 0: as the mesh is fine")
        ->check(CLI::Range(0.0, 1.0))
        ->group(how);
    command.add_option("--smoothing", smoothing, "segment: 0 to 1")
        ->check(CLI::Range(0.0, 1.0))
        ->capture_default_str()
        ->group(how);
    command.add_option("--grow", grow, "so many rings larger")->check(CLI::Range(0, 1000000))->group(how);
    command.add_option("--shrink", shrink, "so many rings smaller")->check(CLI::Range(0, 1000000))->group(how);
    command.add_flag("--invert", invert, "all but this")->group(how);
    command
        .add_option("--frame", frame,
                    "mesh: coordinates and lengths in the unit of the mesh's coordinates; box: as shares, 0 to 1, of its box and "
                    "of the box's diagonal")
        ->check(CLI::IsMember({"mesh", "box"}))
        ->capture_default_str()
        ->group(how);

    const std::string camera = "Camera (that of 'ostraka render' without legend and title)";
    command
        .add_option("--camera", camera_text,
                    "one of the recipe's by its name, or as JSON ('render --json' reports it), instead of the following")
        ->group(camera);
    command.add_option("--view", view, "front, back, left, right, top, bottom, iso or azimuth,elevation in degrees")
        ->capture_default_str()
        ->group(camera);
    command
        .add_option("--up", up,
                    "x, y, z, -x, -y, -z or three numbers: upward direction, kept where a new file is made; else as the "
                    "annotations say, else 0,0,1")
        ->group(camera);
    command.add_option("--projection", projection, "orthographic or perspective")
        ->check(CLI::IsMember({"orthographic", "perspective"}))
        ->capture_default_str()
        ->group(camera);
    command.add_option("--zoom", zoom, "magnification about the middle")
        ->check(CLI::Range(0.01, 1000.0))
        ->capture_default_str()
        ->group(camera);
    command.add_option("--size", size, "width and height of the picture in pixels")->capture_default_str()->group(camera);

    const std::string what = "Annotation";
    command.add_option("--tag", tag, "what it is")->group(what);
    command.add_option("--id", id, "its id; a free one if it is new and none is given")->group(what);
    command.add_option("--type", type, "of a new one; else what the tool selects")
        ->check(CLI::IsMember({"point", "line", "region"}))
        ->group(what);
    command.add_option("--colour", colour, "red,green,blue, each 0 to 255")->group(what);
    command.add_option("--action", action, "what to do with the annotation of this id")
        ->check(CLI::IsMember({"make", "add to", "remove from", "replace", "delete", "retag"}))
        ->capture_default_str()
        ->group(what);
}

}  // namespace ostraka::app

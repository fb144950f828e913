#include "operations/annotation/select_step.h"

#include "ostraka/render/view.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

const std::vector<std::string>& threshold_names() {
    static const std::vector<std::string> names{"x",         "y",        "z",     "mean-curvature", "gaussian-curvature",
                                                "thickness", "distance", "colour"};
    return names;
}

/// Begins the name of values that the mesh file holds.
constexpr std::string_view file_values_prefix = "values:";

/// Throws unless `of` is the name of a quantity, or a file.
void check_threshold(const std::string& of) {
    const auto& names = threshold_names();
    if (std::find(names.begin(), names.end(), of) != names.end() || of.starts_with(file_values_prefix) ||
        !extension(of).empty() || file_exists(of))
        return;
    fail_usage(
        "--threshold '" + printable(of, 60) + "' is no known quantity and no file",
        "use " + joined(names) + ", values:NAME for the property NAME of the mesh file, or a file of values (.npy or text)");
}

}  // namespace

void SelectStep::declare_options(OptionList& list) {
    list("expression", expression, "selection as a JSON expression, in the syntax of recipes").positional();
    list.group("Tools (picks are an index, a point x,y,z or a pixel @x,y of the camera)");
    list("all", all, "the whole mesh");
    list("rectangle", rectangle, "selects elements inside the rectangle x0,y0,x1,y1, in pixels of the camera's picture");
    list("polygon", polygon, "selects elements inside the polygon x,y,x,y,..., in pixels of the camera's picture");
    list("box", box, "selects elements inside a box, given by its minimum and maximum corner as six numbers");
    list("sphere", sphere, "selects elements inside the sphere x,y,z,radius");
    list("halfspace", halfspace, "selects one side of a plane, given by a point and the normal towards this side as six numbers");
    list("nearest", nearest, "selects the vertex nearest to x,y,z");
    list("threshold", threshold,
         "selects elements where this quantity lies between --above and --below; distance: distance from --seed; colour: "
         "difference (CIEDE2000) from the colour at --seed or from --like",
         Words{threshold_names(), "values:NAME for the property NAME of the mesh file, a file of values (.npy or text)",
               check_threshold});
    list("painted", painted,
         "selects a painted figure at the resolution of the image: by its colour (--like, or that at --seed), within bounds "
         "(--lightness, --chroma, --hue), or by its edge (the outline around --seed with the sharpest contrast); with --seed "
         "only the connected figure there",
         Choices{"colour", "bounds", "edge"});
    list("segment", segment,
         "number of thickness levels: segments the mesh by thickness and selects the segment that contains --seed",
         Range{2, 100});
    list("path", path, "selects the shortest paths along edges that join these picks").words();
    list("lasso", lasso, "selects the part enclosed by a path through these picks; --seed is a pick within the part").words();
    list("brush", brush, "selects the geodesic discs of --radius around these picks").words();
    list("vertices", vertices, "selects the vertices at these picks").words();
    list("component", component, "selects the connected component of this pick");
    list("faces", faces, "selects the faces with these indices").words();
    list("labels", labels, "selects the faces with these labels in the mesh file").words();

    list.group("How");
    list("through", through, "with --rectangle or --polygon: select hidden parts as well");
    list("closed", closed, "with --path: close the path from the last pick to the first");
    list("metric", metric, "with --path or --lasso: length that is minimised between picks",
         Choices{"euclidean", "segment", "combined"});
    list("seed", seed, "with --lasso, --segment, --painted or --threshold distance: a pick within the part");
    list("radius", radius, "with --brush: geodesic radius, in the unit of --frame");
    list("stroke", stroke, "with --brush: paint along the path through the picks");
    list("above", above,
         "with --threshold: minimum value; lengths are in the unit of --frame, curvatures in the inverse of this unit, values of "
         "a file in their own unit");
    list("below", below, "with --threshold: maximum value, in the unit of --above");
    list("like", like, "with --threshold colour or --painted: the colour, as #rrggbb");
    list("tolerance", tolerance,
         "with --painted: largest difference (CIEDE2000) from the colour; default 16, or, if only --seed is given, the one with "
         "the "
         "sharpest outline; with 'edge' the largest tried, 60",
         Range{0, 200});
    list("lightness", lightness, "with --painted: lowest and highest CIELAB lightness, 0 to 100", Range{-1000, 1000});
    list("chroma", chroma, "with --painted: lowest and highest CIELAB chroma, 0 is grey", Range{-1000, 1000});
    list("hue", hue, "with --painted: first and last CIELAB hue angle, counter-clockwise: 0 red, 90 yellow, 180 green, 270 blue",
         Range{-360, 720}, "degrees");
    list(
        "smallest", smallest,
        "with --painted: patches and holes smaller than the square of this length are left out, in the unit of --frame; default: "
        "six texels",
        Range{0, 1e60});
    list("blur", blur, "with --painted: rounds of smoothing over neighbouring texels; default 2", Range{0, 100});
    list("quantiles", quantiles, "with --threshold: --above and --below are quantiles by area, from 0 to 1");
    list("scale", scale, "with --threshold of a curvature: radius over which the curvature is averaged; 0: automatic",
         Range{0, 1}, "share of the diagonal");
    list("smoothing", smoothing, "with --segment: weight of short borders along concave edges", Range{0, 1});
    list("grow", grow, "number of rings of neighbours by which the selection is dilated", Range{0, 1000000});
    list("shrink", shrink, "number of rings of neighbours by which the selection is eroded", Range{0, 1000000});
    list("invert", invert, "select the complement");
    list("frame", frame,
         "unit of coordinates and lengths: the unit of the mesh (mesh), or relative to its bounding box (box): coordinates from "
         "0 to 1, lengths as shares of the diagonal",
         Choices{"mesh", "box"});

    list.group("Camera (as in 'ostraka render' without legend and title)");
    list("camera", camera_text,
         "camera: its name in the recipe, or JSON (from 'render --json'); replaces the options --view to --size");
    list("view", view, "view direction", view_words());
    list("up", up, "upward direction, stored in new files; default: that of the annotations, or 0,0,1", direction_words("--up"));
    list("projection", projection, "projection of the camera", Choices{"orthographic", "perspective"});
    list("zoom", zoom, "magnification about the centre of the picture; 1 shows the whole object", Range{0.01, 1000});
    list("size", size, "width and height of the picture in pixels, such as 1200x900");

    list.group("Annotation");
    list("tag", tag, "tag of the annotation");
    list("id", id, "id of the annotation; if left out, a new annotation gets an unused id");
    list("type", type, "type of a new annotation; by default the type of the selection", Choices{"point", "line", "region"});
    list("outline", outline,
         "representation of outlines: curves through the faces (free) or paths of edges (edges); by default an edited outline "
         "keeps its representation, and a new outline is free if the selection has a border between vertices (volume, polygon, "
         "threshold on vertices, brush, lasso or distance)",
         Choices{"edges", "free"});
    list("colour", colour, "colour of the annotation, as red,green,blue", Range{0, 255});
    list("action", action, "effect of the selection on the annotation with --id",
         Choices{"make", "add to", "remove from", "replace", "delete", "retag"});
}

namespace {

using Numbers = std::vector<double>;

/// Writes the JSON of a step from its options.
class StepWriter {
public:
    StepWriter(const SelectStep& step, JsonAllocator& allocator) : step_(step), a_(allocator) {}

    /// The selection: that of the tool, grown, shrunk or inverted.
    [[nodiscard]] JsonValue selected() const {
        JsonValue result = tool();
        if (step_.grow > 0 && step_.shrink > 0) fail_usage("both --grow and --shrink", "give one of them");
        if (step_.grow > 0 || step_.shrink > 0)
            result = object(step_.grow > 0 ? "grow" : "shrink",
                            object("of", std::move(result), "rings", std::max(step_.grow, step_.shrink)));
        return step_.invert ? object("invert", std::move(result)) : std::move(result);
    }

private:
    template <class... Members>
    JsonValue object(Members&&... members) const {
        return json_object(a_, std::forward<Members>(members)...);
    }
    [[nodiscard]] JsonValue list(const Numbers& values) const {
        for (const double x : values)
            if (!std::isfinite(x)) fail_usage("a number of the step is not finite", "give finite numbers");
        return json_value(values, a_);
    }
    [[nodiscard]] JsonValue part(const Numbers& values, std::size_t begin, std::size_t count) const {
        const auto first = values.begin() + static_cast<std::ptrdiff_t>(begin);
        return list(Numbers(first, first + static_cast<std::ptrdiff_t>(count)));
    }
    [[nodiscard]] double finite(double x) const { return list({x})[0].GetDouble(); }
    static void check_count(const Numbers& values, const std::string& option, std::size_t count) {
        if (values.size() != count)
            fail_usage("--" + option + " takes " + std::to_string(count) + " numbers, not " + std::to_string(values.size()),
                       "separate them by commas, without blanks");
    }
    /// Splits a list of numbers into two points or vectors.
    [[nodiscard]] JsonValue halves(const Numbers& values, const char* option, std::size_t count, const char* first,
                                   const char* second) const {
        check_count(values, option, 2 * count);
        return object(first, part(values, 0, count), second, part(values, count, count));
    }

    [[nodiscard]] JsonValue camera() const {
        if (step_.camera_text.starts_with('{')) return JsonValue(parse_json(step_.camera_text, "camera"), a_);
        if (!step_.camera_text.empty()) return json_value(step_.camera_text, a_);
        JsonValue value = object("view", step_.view);
        if (!step_.up.empty()) add_members(value, a_, "up", direction_of(step_.up, "--up"));
        add_members(value, a_, "projection", step_.projection);
        if (step_.zoom != 1) add_members(value, a_, "zoom", step_.zoom);
        int width = 0, height = 0;
        char cross = 0, rest = 0;
        if (std::sscanf(step_.size.c_str(), "%d%c%d%c", &width, &cross, &height, &rest) != 3 || cross != 'x' || width < 16 ||
            height < 16)
            fail_usage("size '" + printable(step_.size, 60) + "' is not possible", "use WIDTHxHEIGHT such as 1200x900");
        add_members(value, a_, "picture", std::array{width, height});
        return value;
    }
    /// A shape drawn in the picture of the camera.
    [[nodiscard]] JsonValue drawn(JsonValue shape) const {
        JsonValue value = object("camera", camera());
        for (auto& member : shape.GetObject()) add_members(value, a_, member.name.GetString(), std::move(member.value));
        if (step_.through) add_members(value, a_, "visible", false);
        return value;
    }

    [[nodiscard]] JsonValue pick(const std::string& text, const std::string& option) const {
        const std::string name = "--" + option;
        if (text.starts_with('@')) {
            const auto pixel = numbers_of<double>(text.substr(1), name);
            check_count(pixel, option, 2);
            return object("camera", camera(), "pixel", list(pixel));
        }
        const auto values = numbers_of<double>(text, name);
        if (values.size() == 3) return list(values);
        if (values.size() == 1 && values[0] >= 0 && values[0] < no_index && values[0] == std::floor(values[0]))
            return JsonValue(static_cast<std::uint32_t>(values[0]));
        fail_usage(name + " '" + printable(text, 60) + "' is not a pick", "give an index, a point x,y,z or a pixel @x,y");
    }
    [[nodiscard]] JsonValue picks(const std::vector<std::string>& texts, const char* option) const {
        return json_list(texts, a_, [&](const auto& text) { return pick(text, option); });
    }
    void need_seed(const std::string& what) const {
        if (step_.seed.empty()) fail_usage(what + " needs a seed", "add --seed PICK, a place within it");
    }

    [[nodiscard]] JsonValue threshold() const {
        const std::string& of = step_.threshold;
        JsonValue value(rapidjson::kObjectType);
        if (of == "mean-curvature" || of == "gaussian-curvature") {
            add_members(value, a_, "curvature", of.substr(0, of.find('-')));
            if (step_.scale != 0) add_members(value, a_, "scale", step_.scale);
        } else if (of == "thickness") {
            add_members(value, a_, "thickness", true);
        } else if (of == "x" || of == "y" || of == "z") {
            add_members(value, a_, "coordinate", direction_of(of, "--threshold"));
        } else if (of == "distance") {
            if (step_.seed.empty()) fail_usage("a threshold on the distance needs a starting point", "add --seed PICK");
            add_members(value, a_, "distance", picks({step_.seed}, "seed"));
        } else if (of == "colour") {
            if (step_.seed.empty() == step_.like.empty())
                fail_usage("a threshold on the colour needs a reference point or a reference colour",
                           "add --seed PICK, or --like '#rrggbb'");
            if (step_.like.empty()) {
                JsonValue seeds = picks({step_.seed}, "seed");
                add_members(value, a_, "colour", json_object(a_, "at", JsonValue(seeds[0], a_)));
            } else {
                add_members(value, a_, "colour", step_.like);
            }
        } else if (of.starts_with(file_values_prefix)) {
            add_members(value, a_, "values", of.substr(file_values_prefix.size()));
        } else {
            add_members(value, a_, "map", of);
        }
        if (step_.above) add_members(value, a_, "above", finite(*step_.above));
        if (step_.below) add_members(value, a_, "below", finite(*step_.below));
        if (step_.quantiles) add_members(value, a_, "quantiles", true);
        return value;
    }

    [[nodiscard]] JsonValue painted() const {
        const bool by_edge = step_.painted == "edge", by_colour = step_.painted == "colour";
        const bool bounded = !step_.lightness.empty() || !step_.chroma.empty() || !step_.hue.empty();
        if (by_edge && step_.seed.empty()) fail_usage("a painted figure by its edge needs a place in it", "add --seed PICK");
        if (by_colour && step_.seed.empty() && step_.like.empty())
            fail_usage("a painted figure by its colour needs a colour or a place", "add --like '#rrggbb', or --seed PICK");
        if (step_.painted == "bounds" && !bounded)
            fail_usage("a painted figure within bounds has none", "add --lightness LOW,HIGH, --chroma LOW,HIGH or --hue FROM,TO");
        JsonValue value(rapidjson::kObjectType);
        if (!step_.like.empty()) add_members(value, a_, "like", step_.like);
        if (!step_.seed.empty()) add_members(value, a_, "at", picks({step_.seed}, "seed"));
        if (by_edge) add_members(value, a_, "edge", true);
        if (step_.tolerance) add_members(value, a_, "tolerance", finite(*step_.tolerance));
        const auto add_bounds = [&](const char* name, const Numbers& bounds) {
            if (bounds.empty()) return;
            check_count(bounds, name, 2);
            add_members(value, a_, name, list(bounds));
        };
        add_bounds("lightness", step_.lightness);
        add_bounds("chroma", step_.chroma);
        add_bounds("hue", step_.hue);
        if (step_.smallest) add_members(value, a_, "smallest", finite(*step_.smallest));
        if (step_.blur) add_members(value, a_, "blur", *step_.blur);
        return value;
    }

    /// The selection expression of the given tool.
    [[nodiscard]] JsonValue tool() const {
        std::vector<std::string> given;
        JsonValue result(rapidjson::kObjectType);
        const auto when = [&](bool present, const char* kind, auto&& make) {
            if (!present) return;
            given.emplace_back(kind);
            if (given.size() == 1) add_members(result, a_, kind, make());
        };
        when(step_.all, "all", [&] { return true; });
        when(!step_.rectangle.empty(), "rectangle", [&] { return drawn(halves(step_.rectangle, "rectangle", 2, "from", "to")); });
        when(!step_.polygon.empty(), "polygon", [&] {
            const Numbers& polygon = step_.polygon;
            if (polygon.size() < 6 || polygon.size() % 2 != 0)
                fail_usage("--polygon has " + std::to_string(polygon.size()) + " numbers", "give x,y of three pixels or more");
            JsonValue points(rapidjson::kArrayType);
            for (std::size_t i = 0; i < polygon.size(); i += 2) points.PushBack(part(polygon, i, 2), a_);
            return drawn(object("points", std::move(points)));
        });
        when(!step_.box.empty(), "box", [&] { return halves(step_.box, "box", 3, "min", "max"); });
        when(!step_.sphere.empty(), "sphere", [&] {
            check_count(step_.sphere, "sphere", 4);
            return object("centre", part(step_.sphere, 0, 3), "radius", finite(step_.sphere[3]));
        });
        when(!step_.halfspace.empty(), "halfspace", [&] { return halves(step_.halfspace, "halfspace", 3, "point", "normal"); });
        when(!step_.nearest.empty(), "nearest", [&] {
            check_count(step_.nearest, "nearest", 3);
            return list(step_.nearest);
        });
        when(!step_.vertices.empty(), "vertices", [&] { return picks(step_.vertices, "vertices"); });
        when(!step_.faces.empty(), "faces", [&] { return step_.faces; });
        when(!step_.labels.empty(), "labels", [&] { return step_.labels; });
        when(!step_.component.empty(), "component", [&] { return object("seed", pick(step_.component, "component")); });
        when(!step_.path.empty(), "path", [&] {
            JsonValue value = object("points", picks(step_.path, "path"));
            if (step_.closed) add_members(value, a_, "closed", true);
            add_members(value, a_, "metric", step_.metric);
            return value;
        });
        when(!step_.lasso.empty(), "lasso", [&] {
            need_seed("a lasso");
            return object("points", picks(step_.lasso, "lasso"), "seed", pick(step_.seed, "seed"), "metric", step_.metric);
        });
        when(!step_.brush.empty(), "brush", [&] {
            if (!step_.radius || !(*step_.radius >= 0))
                fail_usage("a brush needs a radius of zero or more", "add --radius LENGTH");
            JsonValue value = object("points", picks(step_.brush, "brush"), "radius", finite(*step_.radius));
            if (step_.stroke) add_members(value, a_, "stroke", true);
            return value;
        });
        when(!step_.threshold.empty(), "threshold", [&] { return threshold(); });
        when(step_.painted.has_value(), "painted", [&] { return painted(); });
        when(step_.segment.has_value(), "segments", [&] {
            need_seed("a segment");
            return object("clusters", *step_.segment, "smoothing", step_.smoothing, "seeds", picks({step_.seed}, "seed"));
        });
        if (!step_.expression.empty()) {
            given.emplace_back("expression");
            const Json parsed = parse_json(step_.expression, "expression");
            if (given.size() == 1) result.CopyFrom(parsed, a_);
        }
        if (given.empty()) fail_usage("no selection is given", "give an expression or a tool, such as --rectangle x0,y0,x1,y1");
        if (given.size() > 1)
            fail_usage("two tools at once: " + given[0] + " and " + given[1],
                       "give one; join them by an expression, or by two commands");
        return result;
    }

    const SelectStep& step_;
    JsonAllocator& a_;
};

}  // namespace

Json SelectStep::step(const AnnotationSet& set) const {
    Json document(rapidjson::kObjectType);
    auto& a = document.GetAllocator();
    const bool makes = action == "make";
    if (!makes) add_members(document, a, "action", action);
    if (!makes && !id) fail_usage("the action '" + action + "' needs the annotation's --id", "see 'ostraka annotation list'");
    add_members(document, a, "id", id ? *id : free_id(set));
    if (makes && tag.empty()) fail_usage("a new annotation needs a tag", "add --tag TEXT");
    if (action != "delete" && !tag.empty()) add_members(document, a, "tag", tag);
    if (!colour.empty() && colour.size() != 3)
        fail_usage("--colour has " + std::to_string(colour.size()) + " numbers", "give red,green,blue, each 0 to 255");
    if (!colour.empty()) add_members(document, a, "colour", colour);
    const char* made = !path.empty() ? "line" : nearest.empty() && vertices.empty() ? "region" : "point";
    if (makes) add_members(document, a, "type", type.value_or(made));
    if (outline && action != "delete" && action != "retag") add_members(document, a, "outline", *outline);
    if (action != "delete" && action != "retag")
        add_members(document, a, "frame", frame, "select", StepWriter(*this, a).selected());
    return document;
}

}  // namespace ostraka

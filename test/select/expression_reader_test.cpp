// Reading of selection expressions and recipes into typed values.
#include "select/expression_reader.h"

#include "annotation/example_meshes.h"
#include "ostraka/core/error.h"
#include "select/follow.h"
#include "select/recipe_reader.h"

#include <gtest/gtest.h>

using namespace ostraka;

namespace {

constexpr const char* cameras = R"({"front": {"view": "front", "zoom": 2}, "broken": {"eye": [0, 0, 0]}})";

SelectionExpression read(const std::string& text, PlaceFrame frame = {}) {
    const Json named = parse_json(cameras, "cameras"), json = parse_json(text, "expression");
    return ExpressionReader("r.json", "maps", &named, frame).expression({json, frame, "/annotations/3/select"});
}

template <class Kind>
Kind read_as(const std::string& text, PlaceFrame frame = {}) {
    return std::get<Kind>(read(text, frame).kind);
}

std::string message_of(const std::function<void()>& work) {
    try {
        work();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::input);
        return error.what();
    }
    return "no error";
}

std::string refusal(const std::string& text) {
    return message_of([&] { (void)read(text); });
}

Index index_of(const selection::Pick& pick) { return std::get<Index>(pick.place); }

Recipe recipe_of(const std::string& steps, const std::string& head = "") {
    const std::string text = R"({"format": "ostraka-recipe", "version": 1, )" + head + R"("annotations": [)" + steps + "]}";
    return recipe_from_json(parse_json(text, "r.json"), {}, "r.json");
}

std::string recipe_refusal(const std::string& steps) {
    return message_of([&] { (void)recipe_of(steps); });
}

}  // namespace

TEST(ExpressionReader, ReadsSetsOfElements) {
    EXPECT_EQ(read(R"({"all": true})").at, "/annotations/3/select/all");
    EXPECT_NO_THROW(read_as<selection::WholeMesh>(R"({"all": true})"));
    EXPECT_EQ(read_as<selection::FaceList>(R"({"faces": [3, 1]})").faces, (std::vector<Index>{3, 1}));
    EXPECT_EQ(read_as<selection::LabelledFaces>(R"({"labels": [7, -1, 7]})").labels, (std::set<std::int32_t>{-1, 7}));
    EXPECT_EQ(read_as<selection::EarlierAnnotation>(R"({"annotation": -4})").id, -4);
    const auto component = read_as<selection::Component>(R"({"component": {"seed": 5}})");
    EXPECT_EQ(index_of(component.seed), 5U);
    EXPECT_EQ(component.of, nullptr);
    EXPECT_EQ(read_as<selection::Component>(R"({"component": {"seed": 5, "of": {"all": true}}})").of->at,
              "/annotations/3/select/component/of/all");
}

TEST(ExpressionReader, ReadsPicksByIndexPositionAndPixel) {
    const auto picks =
        read_as<selection::VertexPicks>(R"({"vertices": [8, [1, 2, 3], {"camera": "front", "pixel": [4, 5]}], "frame": "box"})")
            .picks;
    ASSERT_EQ(picks.size(), 3U);
    EXPECT_EQ(index_of(picks[0]), 8U);
    EXPECT_EQ(picks[1].at, "/annotations/3/select/vertices/1");
    const auto position = std::get<selection::Position>(picks[1].place);
    EXPECT_EQ(position.coordinates, (std::array<double, 3>{1, 2, 3}));
    EXPECT_TRUE(position.frame.box);
    const auto pixel = std::get<selection::PixelPick>(picks[2].place);
    EXPECT_EQ(pixel.pixel, (Pixel{4, 5}));
    EXPECT_EQ(pixel.camera->at, "/cameras/front");
    EXPECT_EQ(read_as<selection::NearestVertex>(R"({"nearest": [1, 2, 3]})").position.coordinates[2], 3);
}

TEST(ExpressionReader, ReadsVolumes) {
    const auto box = std::get<selection::Box>(read_as<selection::Volume>(R"({"box": {"min": [0, 1, 2], "max": [3, 4, 5]}})"));
    EXPECT_EQ(box.min.coordinates, (std::array<double, 3>{0, 1, 2}));
    EXPECT_EQ(box.max.coordinates, (std::array<double, 3>{3, 4, 5}));
    const auto sphere = std::get<selection::Sphere>(
        read_as<selection::Volume>(R"({"sphere": {"centre": [0, 1, 2], "radius": 0.5}})", PlaceFrame{true}));
    EXPECT_EQ(sphere.radius, 0.5);
    EXPECT_TRUE(sphere.centre.frame.box);
    const auto half =
        std::get<selection::Halfspace>(read_as<selection::Volume>(R"({"halfspace": {"point": [0, 1, 2], "normal": [0, 0, 2]}})"));
    EXPECT_EQ(half.normal, Vector(0, 0, 2));
    EXPECT_NE(refusal(R"({"halfspace": {"point": [0, 0, 0], "normal": [0, 0, 0]}})")
                  .find("r.json: at /annotations/3/select/halfspace/normal: the normal has no length"),
              std::string::npos);
}

TEST(ExpressionReader, ReadsDrawnAreasAndCameras) {
    const auto rectangle = read_as<selection::DrawnArea>(
        R"({"rectangle": {"camera": {"view": "10,20", "picture": [400, 300]}, "from": [1, 2], "to": [3, 4]}})");
    EXPECT_EQ(std::get<selection::Rectangle>(rectangle.shape).to, (Pixel{3, 4}));
    EXPECT_TRUE(rectangle.visible_only);
    EXPECT_EQ(rectangle.camera->at, "/annotations/3/select/rectangle/camera");
    EXPECT_EQ(rectangle.camera->height, 300);
    EXPECT_EQ(std::get<selection::FittedView>(rectangle.camera->pose).view.azimuth, 10);
    const auto polygon = read_as<selection::DrawnArea>(R"({"polygon": {"visible": false, "points": [[0, 0], [9, 0], [9, 9]],
        "camera": {"eye": [9, 0, 0], "target": [1, 0, 0], "angle": 40, "projection": "perspective", "frame": "box"}}})");
    EXPECT_EQ(std::get<selection::Polygon>(polygon.shape).points.size(), 3U);
    EXPECT_FALSE(polygon.visible_only);
    const auto pose = std::get<selection::EyeView>(polygon.camera->pose);
    EXPECT_TRUE(polygon.camera->perspective);
    EXPECT_TRUE(pose.eye.frame.box);
    EXPECT_EQ(pose.angle, 40);
}

TEST(ExpressionReader, ReadsNamedCamerasOnlyIfUsed) {
    EXPECT_EQ(
        std::get<selection::FittedView>(
            read_as<selection::DrawnArea>(R"({"rectangle": {"camera": "front", "from": [1, 2], "to": [3, 4]}})").camera->pose)
            .zoom,
        2);
    EXPECT_NE(refusal(R"({"rectangle": {"camera": "broken", "from": [1, 2], "to": [3, 4]}})")
                  .find("r.json, at /cameras/broken: a camera with an eye but without a target"),
              std::string::npos);
    EXPECT_NE(refusal(R"({"rectangle": {"camera": "none", "from": [1, 2], "to": [3, 4]}})")
                  .find("at /annotations/3/select/rectangle/camera: no camera has the name 'none'"),
              std::string::npos);
}

TEST(ExpressionReader, ReadsThresholdsOfEachQuantity) {
    const auto read_threshold = [](const std::string& members) {
        return read_as<selection::Threshold>(R"({"threshold": {"above": 0.25, )" + members + "}}", PlaceFrame{true});
    };
    const auto coordinate = read_threshold(R"("coordinate": [0, 1, 0], "quantiles": true)");
    EXPECT_EQ(std::get<selection::CoordinateQuantity>(coordinate.quantity).direction, Vector(0, 1, 0));
    EXPECT_EQ(coordinate.quantity_at, "/annotations/3/select/threshold/coordinate");
    EXPECT_TRUE(coordinate.quantiles && coordinate.frame.box);
    EXPECT_EQ(coordinate.above, 0.25);
    EXPECT_FALSE(coordinate.below.has_value());
    const auto curvature =
        std::get<selection::CurvatureQuantity>(read_threshold(R"("curvature": "mean", "scale": 0.1)").quantity);
    EXPECT_TRUE(curvature.mean);
    EXPECT_EQ(curvature.scale, 0.1);
    EXPECT_TRUE(std::holds_alternative<selection::ThicknessQuantity>(read_threshold(R"("thickness": true)").quantity));
    EXPECT_EQ(std::get<selection::DistanceQuantity>(read_threshold(R"("distance": [1, 2])").quantity).from.size(), 2U);
    const auto colour = std::get<selection::ColourQuantity>(read_threshold(R"("colour": "#010203")").quantity);
    EXPECT_EQ(std::get<Rgb>(colour.reference), (Rgb{1, 2, 3}));
    const auto picked = std::get<selection::ColourQuantity>(read_threshold(R"("colour": {"at": 6})").quantity);
    EXPECT_EQ(std::get<selection::Pick>(picked.reference).at, "/annotations/3/select/threshold/colour/at");
    EXPECT_EQ(std::get<selection::NamedQuantity>(read_threshold(R"("values": "q")").quantity).name, "q");
    const auto map = std::get<selection::MapQuantity>(read_threshold(R"("map": "m.npy", "on": "face")").quantity);
    EXPECT_EQ(map.file, Path("maps") / "m.npy");
    EXPECT_EQ(map.on_faces, true);
}

TEST(ExpressionReader, RefusesContradictingThresholds) {
    for (const auto& [members, problem] : std::vector<std::pair<std::string, std::string>>{
             {R"("above": 1)", "/threshold: a threshold on nothing"},
             {R"("above": 1, "values": "q", "thickness": true)", "/threshold: a threshold on both thickness and values"},
             {R"("thickness": true)", "/threshold: a threshold with neither above nor below"},
             {R"("thickness": true, "quantiles": true, "below": 2)", "/threshold/below: a quantile of 2"},
             {R"("map": "../m.npy", "above": 1)", "/threshold/map: '../m.npy' leads out of the recipe's folder"}})
        EXPECT_NE(refusal(R"({"threshold": {)" + members + "}}").find("r.json: at /annotations/3/select" + problem),
                  std::string::npos)
            << refusal(R"({"threshold": {)" + members + "}}");
}

TEST(ExpressionReader, ReadsBrushesPaintedFiguresAndSegments) {
    const auto brush = read_as<selection::Brush>(R"({"brush": {"points": [1, 2], "radius": 3, "stroke": true}})");
    EXPECT_EQ(brush.points.size(), 2U);
    EXPECT_EQ(brush.radius.value, 3);
    EXPECT_TRUE(brush.stroke);
    const auto painted =
        read_as<selection::Painted>(R"({"painted": {"like": ["#ffffff", "#000000"], "hue": [300, 60], "smallest": 2}})");
    EXPECT_EQ(painted.query.like.size(), 2U);
    EXPECT_EQ(painted.query.hue, (PaintedFigureQuery::Interval{300, 60}));
    EXPECT_FALSE(painted.query.sharpest);
    EXPECT_EQ(painted.smallest.value, 2);
    const auto placed = read_as<selection::Painted>(R"({"painted": {"at": [4]}})");
    EXPECT_TRUE(placed.query.sharpest);
    EXPECT_EQ(placed.places.size(), 1U);
    const auto segments = read_as<selection::Segments>(R"({"segments": {"clusters": 3, "numbers": [2]}})");
    EXPECT_EQ(segments.options.clusters, 3);
    EXPECT_EQ(std::get<std::vector<Index>>(segments.parts), (std::vector<Index>{2}));
    EXPECT_EQ(std::get<std::vector<selection::Pick>>(read_as<selection::Segments>(R"({"segments": {"seeds": [5]}})").parts)[0].at,
              "/annotations/3/select/segments/seeds/0");
    EXPECT_NE(refusal(R"({"segments": {}})").find("segments without seeds or numbers"), std::string::npos);
    EXPECT_NE(refusal(R"({"painted": {}})").find("a painted figure of no colour"), std::string::npos);
    EXPECT_NE(refusal(R"({"painted": {"edge": true, "like": "#ffffff"}})").find("no place in it"), std::string::npos);
    EXPECT_NE(refusal(R"({"painted": {"chroma": [9, 1]}})").find("/painted/chroma: the first bound exceeds"), std::string::npos);
}

TEST(ExpressionReader, ReadsGrowthPathsAndLassos) {
    const auto grown = read_as<selection::Growth>(R"({"grow": {"of": {"all": true}, "rings": 2}})");
    EXPECT_TRUE(grown.larger);
    EXPECT_EQ(std::get<int>(grown.extent), 2);
    const auto shrunk = read_as<selection::Growth>(R"({"frame": "box", "shrink": {"of": {"all": true}, "distance": 0.5}})");
    EXPECT_FALSE(shrunk.larger);
    EXPECT_EQ(std::get<selection::Length>(shrunk.extent).value, 0.5);
    EXPECT_TRUE(std::get<selection::Length>(shrunk.extent).frame.box);
    EXPECT_NE(refusal(R"({"grow": {"of": {"all": true}, "rings": 1, "distance": 2}})").find("/grow: both rings and a distance"),
              std::string::npos);
    const auto path = read_as<selection::SurfacePath>(R"({"path": {"points": [1, 2], "closed": true}})");
    EXPECT_TRUE(path.closed);
    EXPECT_EQ(path.metric, PathMetric::euclidean);
    const auto lasso = read_as<selection::Lasso>(R"({"lasso": {"points": [1, 2, 3], "seed": 9, "metric": "combined"}})");
    EXPECT_EQ(lasso.points.size(), 3U);
    EXPECT_EQ(index_of(lasso.seed), 9U);
    EXPECT_EQ(lasso.metric, PathMetric::combined);
}

TEST(ExpressionReader, ReadsNestedCombinationsWithPlacesAndFrames) {
    using Operator = selection::SetOperator;
    for (const auto& [name, combine] : {std::pair("union", Operator::unite), std::pair("intersection", Operator::intersect),
                                        std::pair("difference", Operator::subtract)}) {
        const auto combination = read_as<selection::Combination>(R"({"frame": "box", ")" + std::string(name) +
                                                                 R"(": [{"all": true}, {"invert": {"nearest": [0, 0, 1]}}]})");
        EXPECT_EQ(combination.combine, combine);
        ASSERT_EQ(combination.operands.size(), 2U);
        const auto& inverted = *std::get<selection::Complement>(combination.operands[1].kind).of;
        EXPECT_EQ(inverted.at, "/annotations/3/select/" + std::string(name) + "/1/invert/nearest");
        EXPECT_TRUE(std::get<selection::NearestVertex>(inverted.kind).position.frame.box);
    }
    EXPECT_NE(refusal(R"({"union": [{"all": true}, {"difference": [{"all": true}, {"threshold": {}}]}]})")
                  .find("r.json: at /annotations/3/select/union/1/difference/1/threshold: a threshold on nothing"),
              std::string::npos);
}

TEST(ExpressionReader, RefusesAnythingButOneKnownKind) {
    EXPECT_NE(refusal(R"({"union": [{"faces": [1], "all": true}]})")
                  .find("r.json: at /annotations/3/select/union/0: selects by two kinds, faces and all (join them by union"),
              std::string::npos);
    EXPECT_NE(refusal(R"({"frame": "box"})").find("at /annotations/3/select: a selection without a kind (give one of all, faces"),
              std::string::npos);
    EXPECT_NE(refusal(R"({"cube": 1})").find("at /annotations/3/select: an unknown kind of selection, 'cube' (give one of"),
              std::string::npos);
}

TEST(RecipeReader, ReadsStepsWithTheirFrames) {
    const Recipe recipe =
        recipe_of(R"({"id": 4, "tag": "t", "type": "line", "colour": [1, 2, 3], "outline": "free", "frame": "mesh",
                                        "select": {"nearest": [0, 0, 1]}},
                                       {"id": 4, "action": "delete"},
                                       {"id": 5, "action": "add to", "select": {"nearest": [0, 0, 1]}, "attributes":
                                        [{"id": 0, "name": "h", "type": "measure", "measure": {"tool": "ruler", "points": [7, [0, 0, 0]]}}]})",
                  R"("frame": "box", "class": "pot", "up": [0, 1, 0], )");
    EXPECT_EQ(recipe.object_class, "pot");
    EXPECT_FALSE(recipe.unit.has_value());
    EXPECT_EQ(recipe.up, (std::array<double, 3>{0, 1, 0}));
    ASSERT_EQ(recipe.steps.size(), 3U);
    const RecipeStep& made = recipe.steps[0];
    EXPECT_EQ(made.action, StepAction::make);
    EXPECT_EQ(made.type, AnnotationType::line);
    EXPECT_EQ(made.outline, StepOutline::free);
    EXPECT_EQ(made.colour, (std::array<int, 3>{1, 2, 3}));
    EXPECT_FALSE(std::get<selection::NearestVertex>(made.select->kind).position.frame.box);
    EXPECT_FALSE(made.attributes.has_value());
    EXPECT_EQ(recipe.steps[1].action, StepAction::erase);
    const RecipeStep& added = recipe.steps[2];
    EXPECT_EQ(added.action, StepAction::add_to);
    EXPECT_TRUE(std::get<selection::NearestVertex>(added.select->kind).position.frame.box);
    ASSERT_EQ(added.attributes->size(), 1U);
    EXPECT_EQ(added.attributes->at(0).attribute.measure()->tool, "ruler");
    EXPECT_EQ(added.attributes->at(0).pins.at(1).at, "/annotations/2/attributes/0/measure/points/1");
}

TEST(RecipeReader, RefusesMembersThatTheActionLacksOrDoesNotUse) {
    for (const auto& [step, problem] : std::vector<std::pair<std::string, std::string>>{
             {R"({"id": 1, "tag": "t", "type": "region"})", "at /annotations/0: a new annotation without \"select\""},
             {R"({"id": 1, "action": "replace"})", "at /annotations/0: the action 'replace' without \"select\""},
             {R"({"id": 1, "action": "retag", "select": {"all": true}})",
              "at /annotations/0/select: the action 'retag' selects nothing"},
             {R"({"id": 1, "action": "retag"})", "at /annotations/0: the action 'retag' changes nothing"},
             {R"({"id": 1, "action": "delete", "tag": "t"})", "at /annotations/0/tag: the action 'delete' keeps nothing"}})
        EXPECT_NE(recipe_refusal(step).find(problem), std::string::npos) << recipe_refusal(step);
}

TEST(RecipeReader, ReportsALaterStepBeforeAnythingIsEvaluated) {
    const std::string first = R"({"id": 1, "tag": "t", "type": "region", "select": {"faces": [4000000]}}, )";
    EXPECT_NE(recipe_refusal(first + R"({"id": 2, "tag": "t", "type": "region", "select": {"all": true, "faces": [1]}})")
                  .find("at /annotations/1/select: selects by two kinds, all and faces"),
              std::string::npos);
}

TEST(RecipeReader, NestedExpressionsNameTheirPlaceInErrorsOfTheMesh) {
    const std::string step =
        R"({"id": 1, "tag": "t", "type": "region", "select": {"union": [{"all": true}, {"grow": {"rings": 1, "of": )"
        R"({"intersection": [{"all": true}, {"component": {"seed": 4000}}]}}}]}})";
    const std::string message = message_of([&] { (void)test::follow(step, example::grid(4)); });
    EXPECT_NE(message.find("r.json: at /annotations/0/select/union/1/grow/of/intersection/1/component/seed: face 4000 of a mesh"),
              std::string::npos)
        << message;
}

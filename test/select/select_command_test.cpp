// 'annotation select' and 'annotation apply --edit', as users run them.
#include "annotation/example_meshes.h"
#include "mutate.h"
#include "ostraka/annotation/annotation_file.h"
#include "ostraka/annotation/colouring.h"
#include "ostraka/core/error.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/operations/table.h"
#include "ostraka/select/recipe.h"
#include "ostraka/synthetic/make_mesh.h"
#include "scratch.h"

using namespace ostraka;
using namespace ostraka::example;
using ostraka::test::run_command;
using ostraka::test::Scratch;

namespace {

struct Folder : Scratch {
    Folder() { write_mesh(*this / "ball.ply", spheres(4)); }
    [[nodiscard]] std::string at(const std::string& name) const { return (*this / name).string(); }
    [[nodiscard]] test::CommandResult select(const std::string& flags, const std::string& to = "a.ant.json") const {
        return run_command("annotation select " + at("ball.ply") + " " + at(to) + " " + flags);
    }
};

}  // namespace

TEST(SelectCommand, StepsAreRecordedAndReplayedToTheByte) {
    const Folder folder;
    const std::string record = " --record " + folder.at("r.recipe.json");
    const std::vector<std::string> steps{
        "--class ball --unit mm --tag front --view front --rectangle 400,300,800,600",
        "--tag cap --sphere 0,0,1,0.5",
        "--tag girdle --type line --path 1,0,0 0,1,0 -1,0,0 0,-1,0 --closed --metric combined",
        "--tag spots --type point --vertices 3 @600,428 0,0,1 --view 45,10",
        "--tag patch --lasso 1,0.3,0.3 1,-0.3,0.3 1,-0.3,-0.3 1,0.3,-0.3 --seed 1,0.02,0.01",
        "--tag drawn --colour 1,2,3 --polygon 400,300,800,300,600,600 --view top --projection perspective --through",
        "--action 'remove from' --id 2 --halfspace 0,0,0.9,0,0,1",
        "--action retag --id 2 --tag ring",
        "--action delete --id 5",
        "--tag rest '{\"difference\": [{\"annotation\": 0}, {\"annotation\": 1}]}'"};
    for (const auto& step : steps) {
        const auto result = folder.select(step + record);
        ASSERT_EQ(result.code, 0) << step << "\n" << result.err;
        EXPECT_EQ(result.err, "") << step;
        ASSERT_EQ(run_command("annotation apply " + folder.at("ball.ply") + " " + folder.at("r.recipe.json") + " " +
                              folder.at("replayed.ant.json"))
                      .code,
                  0);
        ASSERT_EQ(read_file(folder / "replayed.ant.json"), read_file(folder / "a.ant.json")) << step;
    }
    const Mesh mesh = read_mesh(folder / "ball.ply").mesh;
    const AnnotationSet set = read_annotations(folder / "a.ant.json", mesh);
    EXPECT_EQ(set.annotations.size(), 7U);
    EXPECT_EQ(set.find(2)->tag, "ring");
    EXPECT_EQ(set.find(6)->colour, (std::array<int, 3>{1, 2, 3}));
    EXPECT_EQ(run_command("annotation check " + folder.at("ball.ply") + " " + folder.at("a.ant.json")).code, 0);
}

TEST(SelectCommand, ASecondPartWithATagIsReported) {
    const Folder folder;
    ASSERT_EQ(folder.select("--tag cap --sphere 0,0,1,0.5").err, "");
    const auto second = folder.select("--tag cap --sphere 0,0,-1,0.5");
    EXPECT_EQ(second.code, 0);
    EXPECT_NE(second.err.find("a second annotation 'cap' is added beside that of id 0"), std::string::npos) << second.err;
    EXPECT_NE(second.err.find("--action 'add to' --id 0"), std::string::npos) << second.err;
    EXPECT_EQ(folder.select("--action 'add to' --id 0 --sphere 1,0,0,0.5").err, "");
    const auto duplicate = folder.select("--tag cap --id 0 --sphere 1,0,0,0.5");
    EXPECT_EQ(duplicate.code, 1);
    EXPECT_NE(duplicate.err.find("'add to'"), std::string::npos) << duplicate.err;
}

TEST(SelectCommand, ColoursDistinguishPartsFromTheWhole) {
    const Folder folder;
    ASSERT_EQ(folder.select("--class ball --tag cap --sphere 0,0,1,0.5").code, 0);
    ASSERT_EQ(folder.select("--tag nearly --halfspace 0,0,-0.99,0,0,1").code, 0);
    ASSERT_EQ(folder.select("--tag foot --sphere 0,0,-1,0.5").code, 0);
    const Mesh mesh = read_mesh(folder / "ball.ply").mesh;
    const AnnotationSet set = read_annotations(folder / "a.ant.json", mesh);
    ASSERT_EQ(set.annotations.size(), 4U);
    EXPECT_EQ(set.annotations[0].colour, neutral_colour) << "the whole object";
    EXPECT_EQ(set.annotations[1].colour, distinct_colour(0));
    EXPECT_EQ(set.annotations[2].colour, neutral_colour) << "all but a few faces";
    EXPECT_EQ(set.annotations[3].colour, distinct_colour(1));
}

TEST(SelectCommand, ANewFileKeepsClassUnitAndUp) {
    const Folder folder;
    const std::string record = " --record " + folder.at("r.recipe.json");
    const auto first =
        folder.select("--class ball --unit mm --up 0,1,0 --tag top --view top --rectangle 500,350,700,550" + record);
    ASSERT_EQ(first.code, 0) << first.err;
    const Mesh mesh = read_mesh(folder / "ball.ply").mesh;
    const AnnotationSet created = read_annotations(folder / "a.ant.json", mesh);
    EXPECT_EQ(created.object_class, "ball");
    EXPECT_EQ(created.unit, "mm");
    EXPECT_NE(first.out.find("area mm^2"), std::string::npos) << first.out;
    EXPECT_NE(first.out.find("perimeter / length mm"), std::string::npos) << first.out;
    ASSERT_TRUE(created.up);
    EXPECT_EQ(*created.up, (std::array<double, 3>{0, 1, 0}));
    // The next step uses the same direction by default, and another --up rotates only its camera.
    ASSERT_EQ(folder.select("--tag again --view top --rectangle 500,350,700,550" + record).code, 0);
    ASSERT_EQ(folder.select("--tag side --view top --up 0,0,1 --rectangle 500,350,700,550" + record).code, 0);
    const AnnotationSet set = read_annotations(folder / "a.ant.json", mesh);
    EXPECT_EQ(*set.up, *created.up);
    EXPECT_EQ(set.find(2)->faces, set.find(1)->faces);
    EXPECT_NE(set.find(3)->faces, set.find(1)->faces);
    ASSERT_EQ(run_command("annotation apply " + folder.at("ball.ply") + " " + folder.at("r.recipe.json") + " " +
                          folder.at("replayed.ant.json"))
                  .code,
              0);
    EXPECT_EQ(read_file(folder / "replayed.ant.json"), read_file(folder / "a.ant.json"));
    // An existing recipe does not override options for a new file.
    ASSERT_EQ(folder.select("--tag cap --sphere 0,0,1,0.5 --record " + folder.at("s.recipe.json"), "b.ant.json").code, 0);
    ASSERT_EQ(folder
                  .select("--tag cap --unit m --up 1,0,0 --sphere 0,0,1,0.5 --id 5 --record " + folder.at("s.recipe.json"),
                          "c.ant.json")
                  .code,
              0);
    EXPECT_EQ(read_annotations(folder / "c.ant.json", mesh).unit, "m");
    EXPECT_EQ(*read_annotations(folder / "c.ant.json", mesh).up, (std::array<double, 3>{1, 0, 0}));
    EXPECT_EQ(folder.select("--tag cap --up 0,0,0 --all", "d.ant.json").code, 2);
    EXPECT_FALSE(std::filesystem::exists(folder / "d.ant.json"));
}

TEST(SelectCommand, HelpGivesDefaultsAndUnits) {
    const std::string help = run_command("annotation select --help").out;
    for (const char* words : {"=30,20", "=1200x900", "=orthographic", "=mesh", "in degrees", "in pixels", "any text"})
        EXPECT_NE(help.find(words), std::string::npos) << words << "\n" << help;
    // Every order of the arguments, and each argument by name.
    const std::string orders = run_command("annotation apply --help").out;
    for (const char* words : {"[OPTIONS] mesh recipe output\n", "[OPTIONS] mesh output\n", "\n  mesh FILE", "\n  recipe FILE"})
        EXPECT_NE(orders.find(words), std::string::npos) << words << "\n" << orders;
    EXPECT_EQ(orders.find("files"), std::string::npos) << orders;
}

TEST(SelectCommand, EditsBegunWithoutARecipeReplayOnTheExistingAnnotations) {
    const Folder folder;
    ASSERT_EQ(folder.select("--tag cap --sphere 0,0,1,0.5").code, 0);
    write_file(folder / "before.ant.json", read_file(folder / "a.ant.json"));
    const auto result = folder.select("--action 'add to' --id 0 --sphere 0,0,-1,0.5 --record " + folder.at("r.recipe.json"));
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_NE(result.err.find("--edit"), std::string::npos) << "it is said that the recipe alone does not do: " << result.err;
    const std::string replay =
        "annotation apply " + folder.at("ball.ply") + " " + folder.at("r.recipe.json") + " " + folder.at("out.ant.json");
    EXPECT_EQ(run_command(replay).code, 1) << "there is nothing to add to";
    ASSERT_EQ(run_command(replay + " --edit " + folder.at("before.ant.json")).code, 0);
    const Mesh mesh = read_mesh(folder / "ball.ply").mesh;
    EXPECT_EQ(read_annotations(folder / "out.ant.json", mesh).find(0)->faces,
              read_annotations(folder / "a.ant.json", mesh).find(0)->faces);
    EXPECT_EQ(run_command(replay + " --edit " + folder.at("out.ant.json")).code, 2) << "an input is never overwritten";
    EXPECT_EQ(folder.select("--tag x --all --output " + folder.at("other.ant.json")).code, 0);
    EXPECT_EQ(read_annotations(folder / "a.ant.json", mesh).annotations.size(), 1U) << "--output leaves the file as it is";
}

TEST(SelectCommand, TheRecipeMayBeWrittenElsewhere) {
    const Folder folder;
    const std::string record = " --record " + folder.at("r.recipe.json");
    ASSERT_EQ(folder.select("--tag cap --sphere 0,0,1,0.5" + record).code, 0);
    const std::string before = read_file(folder / "a.ant.json"), recipe = read_file(folder / "r.recipe.json");
    const std::string elsewhere = " --output " + folder.at("b.ant.json") + " --recipe " + folder.at("s.recipe.json");
    const auto more = folder.select("--tag foot --sphere 0,0,-1,0.5" + record + elsewhere);
    ASSERT_EQ(more.code, 0) << more.err;
    EXPECT_EQ(more.err, "");
    EXPECT_EQ(read_file(folder / "a.ant.json"), before);
    EXPECT_EQ(read_file(folder / "r.recipe.json"), recipe);
    ASSERT_EQ(run_command("annotation apply " + folder.at("ball.ply") + " " + folder.at("s.recipe.json") + " " +
                          folder.at("replayed.ant.json"))
                  .code,
              0);
    EXPECT_EQ(read_file(folder / "replayed.ant.json"), read_file(folder / "b.ant.json"));
    EXPECT_EQ(folder.select("--tag x --all --output " + folder.at("a.ant.json")).code, 2) << "an input is not an output";
    EXPECT_EQ(folder.select("--tag x --all --record " + folder.at("a.ant.json")).code, 2) << "two outputs of one name";
    EXPECT_EQ(folder.select("--tag x --all", "no/a.ant.json").code, 1) << "there is no such folder";
}

TEST(SelectCommand, StepsOnValuesOfAFileReplayToTheByte) {
    const Folder folder;
    std::string values;
    for (std::size_t i = 0; i < spheres(4).number_of_vertices(); ++i) values += std::to_string(i) + "\n";
    write_file(folder / "v.txt", values);
    const std::string record = " --record " + folder.at("r.recipe.json");
    for (const char* step : {"--tag first --threshold v.txt --below 600", "--tag cap --sphere 0,0,1,0.5"}) {
        const auto result = folder.select(step + record);
        ASSERT_EQ(result.code, 0) << result.err;
        EXPECT_EQ(result.err, "") << step;
        ASSERT_EQ(run_command("annotation apply " + folder.at("ball.ply") + " " + folder.at("r.recipe.json") + " " +
                              folder.at("replayed.ant.json"))
                      .code,
                  0);
        EXPECT_EQ(read_file(folder / "replayed.ant.json"), read_file(folder / "a.ant.json")) << step;
    }
}

TEST(SelectCommand, UpdatesObjectsInMemory) {
    Context context;
    const auto mesh = std::make_shared<const Mesh>(spheres(4));
    std::optional<Object> set, recipe;
    for (const int count : {1, 2}) {
        Call call(find_operation("annotation select"));
        call.set_object("mesh", Object(mesh, "ball.ply"));
        if (set) call.set_object("annotations", *set);
        if (recipe) call.set_object("record", *recipe);
        else call.want("recipe");
        call.set("tag", "part " + std::to_string(count));
        Json sphere = parse_json("[0, 0, 1, 0.5]", "sphere"), values(rapidjson::kObjectType);
        values.AddMember("sphere", sphere, values.GetAllocator());
        call.set(values);
        const Report report = call.run(context);
        EXPECT_TRUE(report.notes().empty()) << "the recipe alone gives it";
        EXPECT_EQ(report.result()["id"].GetInt(), count - 1);
        set = call.object("output");
        recipe = call.object("recipe");
        EXPECT_EQ(set->as<AnnotationSet>()->annotations.size(), static_cast<std::size_t>(count));
        EXPECT_EQ(parse_json(*recipe->as<std::string>(), "recipe")["annotations"].Size(), static_cast<unsigned>(count));
    }
    // The annotations begun in memory, the recipe in a file.
    const Scratch scratch;
    Call call(find_operation("annotation select"));
    call.set_object("mesh", Object(mesh, "ball.ply"));
    call.set_file("record", scratch / "r.recipe.json");
    call.set("tag", "all");
    call.set("all", true);
    static_cast<void>(call.run(context));
    EXPECT_EQ(call.object("output").as<AnnotationSet>()->annotations.size(), 1U);
    EXPECT_TRUE(std::filesystem::exists(scratch / "r.recipe.json"));
}

TEST(SelectCommand, RefusalsLeaveTheFilesUnchanged) {
    const Folder folder;
    const std::string record = " --record " + folder.at("r.recipe.json");
    ASSERT_EQ(folder.select("--tag cap --sphere 0,0,1,0.5" + record).code, 0);
    const std::string before = read_file(folder / "a.ant.json"), recipe = read_file(folder / "r.recipe.json");
    const std::size_t files = test::count_files(folder.path());
    const auto refuse = [&](const std::string& flags, int code, const std::string& expected) {
        const auto result = folder.select(flags + record);
        EXPECT_EQ(result.code, code) << flags << "\n" << result.err;
        EXPECT_NE(result.err.find(expected), std::string::npos) << flags << "\n" << result.err;
        EXPECT_EQ(read_file(folder / "a.ant.json"), before);
        EXPECT_EQ(read_file(folder / "r.recipe.json"), recipe);
        EXPECT_EQ(test::count_files(folder.path()), files);
    };
    refuse("--tag x", 2, "no selection is given");
    refuse("--tag x --all --sphere 0,0,1,1", 2, "two tools at once");
    refuse("--sphere 0,0,1,1", 2, "needs a tag");
    refuse("--tag x --sphere 0,0,1", 2, "takes 4 numbers");
    refuse("--tag x --sphere 0,zero,1,1", 2, "option sphere is '0,zero,1,1' (use a number");
    refuse("--tag x --sphere 0,nan,1,1", 2, "not finite");
    refuse("--tag x --sphere 0,0,9,1", 1, "selects no face");
    refuse("--tag x --sphere 0,0,1,-1", 1, "needs a number");
    refuse("--tag x --rectangle 5000,0,6000,9", 1, "outside the picture");
    refuse("--tag x --rectangle 0,0,10,10 --size big", 2, "size 'big'");
    refuse("--tag x --lasso 0,0,1 1,0,0 0,1,0", 2, "needs a seed");
    refuse("--tag x --brush 0,0,1", 2, "radius");
    refuse("--tag x --type point --vertices @1,1", 1, "background");
    refuse("--tag x --type point --vertices 1,1", 2, "not a pick");
    refuse("--tag x '{\"sphere\": '", 1, "expression");
    refuse("--tag x '{\"cube\": 1}'", 1, "cube");
    refuse("--tag x --all --grow 1 --shrink 1", 2, "both --grow and --shrink");
    refuse("--tag x --all --id 0", 1, "the id 0 is taken");
    refuse("--tag x --all --id 0", 1, "free is 1");
    refuse("--tag x --threshold height --above 1", 2, "gaussian-curvature, thickness, distance, colour, values:NAME");
    refuse("--action delete --id 5", 1, "no annotation has the id 5");
    refuse("--action delete", 2, "needs the annotation's --id");
    refuse("--tag x --all --colour 1,2", 2, "--colour");
    const auto same = run_command("annotation select " + folder.at("ball.ply") + " " + folder.at("ball.ply") + " --tag x --all");
    EXPECT_EQ(same.code, 2) << same.err;
    const auto apply = run_command("annotation apply " + folder.at("ball.ply") + " " + folder.at("none.seg") + " " +
                                   folder.at("o.ant.json") + " --edit " + folder.at("a.ant.json"));
    EXPECT_EQ(apply.code, 2) << apply.err;
}

TEST(SelectCommand, APictureReportsItsCameras) {
    const Folder folder;
    ASSERT_EQ(folder.select("--tag cap --sphere 0,-1,0,0.5").code, 0);
    const auto picture = run_command("render " + folder.at("ball.ply") + " " + folder.at("p.png") + " --annotations " +
                                     folder.at("a.ant.json") + " --view front --size 600x500 --json");
    ASSERT_EQ(picture.code, 0) << picture.err;
    const Json report = parse_json(picture.out, "report");
    const JsonValue& pane = report["result"]["panes"][0];
    // The middle of the pane shows the point nearest to the viewer, regardless of the legend.
    const double x = pane["camera"]["pane"][0].GetDouble() + pane["camera"]["pane"][2].GetDouble() / 2,
                 y = pane["camera"]["pane"][1].GetDouble() + pane["camera"]["pane"][3].GetDouble() / 2;
    EXPECT_LT(x, 299);
    std::string camera = to_text(pane["camera"]);
    const Path recipe =
        folder.file("c.recipe.json", R"({"format": "ostraka-recipe", "version": 1, "annotations": [{"id": 0, "tag": "t",
        "type": "point", "select": {"vertices": [{"camera": )" +
                                         camera + R"(, "pixel": [)" + std::to_string(x) + "," + std::to_string(y) + "]}]}}]}");
    const Mesh mesh = read_mesh(folder / "ball.ply").mesh;
    const AnnotationSet set = apply_recipe(recipe, mesh);
    EXPECT_EQ(mesh.point(Vertex(set.annotations.at(0).points.at(0))), Point(0, -1, 0));
    // The same with flags; the type is that of the tool.
    const auto flags =
        folder.select("--tag nearest --camera '" + camera + "' --vertices @" + std::to_string(x) + "," + std::to_string(y));
    ASSERT_EQ(flags.code, 0) << flags.err;
    EXPECT_EQ(read_annotations(folder / "a.ant.json", mesh).find(1)->points, set.annotations.at(0).points);
    write_file(folder / "named.recipe.json",
               R"({"format": "ostraka-recipe", "version": 1, "frame": "box", "cameras": {"mine": )" + camera +
                   R"(}, "annotations": []})");
    const auto named = folder.select("--tag nearest --camera mine --vertices @" + std::to_string(x) + "," + std::to_string(y) +
                                         " --record " + folder.at("named.recipe.json"),
                                     "b.ant.json");
    ASSERT_EQ(named.code, 0) << named.err;
    EXPECT_EQ(read_annotations(folder / "b.ant.json", mesh).find(0)->points, set.annotations.at(0).points);
    ASSERT_EQ(folder.select("--tag top --sphere 0,0,1,0.3 --record " + folder.at("named.recipe.json"), "b.ant.json").code, 0);
    EXPECT_EQ(read_annotations(folder / "b.ant.json", mesh).find(1)->faces.size(),
              apply_recipe(folder / "named.recipe.json", mesh).find(1)->faces.size())
        << "flags are in the mesh's coordinates whatever the recipe's frame";
    EXPECT_EQ(folder.select("--tag x --camera yours --vertices @1,1").code, 1);
}

TEST(SelectCommand, BrushThresholdAndSegment) {
    const Folder folder;
    const std::string record = " --record " + folder.at("r.recipe.json");
    for (const std::string step :
         {"--tag disc --brush 0,0,1 --radius 0.5", "--tag stroke --brush 1,0,0 0,1,0 --radius 0.1 --stroke",
          "--tag north --threshold z --above 0.5", "--tag near --threshold distance --seed 0,0,-1 --below 0.4",
          "--tag thin --threshold thickness --quantiles --below 0.2", "--tag disc --brush 0,0,1 --radius 0.5 --grow 2",
          "--tag ring --type point --brush 0,0,1 --radius 0.3 --invert"}) {
        const auto result = folder.select(step + record);
        ASSERT_EQ(result.code, 0) << step << "\n" << result.err;
    }
    ASSERT_EQ(run_command("annotation apply " + folder.at("ball.ply") + " " + folder.at("r.recipe.json") + " " +
                          folder.at("o.ant.json"))
                  .code,
              0);
    EXPECT_EQ(read_file(folder / "o.ant.json"), read_file(folder / "a.ant.json"));
    const auto segments = run_command("annotation segment " + folder.at("ball.ply") + " " + folder.at("s.ant.json") +
                                      " --clusters 3 --labels-out " + folder.at("s.seg") + " --json");
    ASSERT_EQ(segments.code, 0) << segments.err;
    const Json report = parse_json(segments.out, "report");
    const JsonValue& list = report["result"]["segments"];
    ASSERT_GE(list.Size(), 1U);
    double area = 0;
    for (rapidjson::SizeType i = 0; i < list.Size(); ++i) {
        area += list[i]["area"].GetDouble();
        if (i > 0) {
            EXPECT_LE(list[i]["area"].GetDouble(), list[i - 1]["area"].GetDouble() * (1 + 1e-12));
        }
    }
    EXPECT_NEAR(area, surface_area(read_mesh(folder / "ball.ply").mesh), 1e-9);
    EXPECT_EQ(run_command("annotation segment " + folder.at("ball.ply") + " " + folder.at("s.ant.json") + " --clusters 1").code,
              2);
}

namespace {

/// Number of 200 damaged copies that can still be followed; the others are refused with a message.
std::size_t survive(const std::string& recipe, const Mesh& mesh) {
    std::size_t done = 0;
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        const std::string text = test::mutate(recipe, seed);
        try {
            (void)apply_recipe(parse_json(text, "r"), mesh, std::vector<std::int32_t>{}, "r");
            ++done;
        } catch (const Error& error) {
            EXPECT_NE(error.kind(), ErrorKind::failure) << error.what();
            EXPECT_FALSE(error.problem().empty());
        }
    }
    return done;
}

}  // namespace

TEST(SelectMutation, DamagedRecipesEndInSuccessOrAClearError) {
    const Mesh mesh = spheres(2);
    const std::string recipe = R"({"format": "ostraka-recipe", "version": 1, "class": "ball", "unit": "mm", "up": [0, 0, 1],
 "cameras": {"front": {"view": "front", "projection": "perspective", "zoom": 1.5, "picture": [600, 500]},
             "eye": {"eye": [0, -9, 1], "target": [0, 0, 0], "projection": "perspective", "angle": 30, "pane": [0, 0, 300, 200]}},
 "annotations": [
  {"id": 1, "tag": "a", "type": "region", "select": {"rectangle": {"camera": "front", "from": [100, 100], "to": [500, 400], "visible": true}}},
  {"id": 2, "tag": "b", "type": "region", "select": {"polygon": {"camera": "eye", "points": [[50, 50], [250, 50], [150, 190]], "visible": false}}},
  {"id": 3, "tag": "c", "type": "point", "select": {"vertices": [{"camera": "front", "pixel": [300, 240]}, [0, 0, 1], 5]}},
  {"id": 4, "tag": "d", "type": "region", "select": {"lasso": {"points": [[1, 0.3, 0.3], [1, -0.4, 0.4], [1, -0.4, -0.4], [1, 0.4, -0.4]], "seed": [1, 0.02, 0.01]}}},
  {"id": 5, "tag": "e", "type": "region", "select": {"grow": {"of": {"brush": {"points": [0, [0, 1, 0]], "radius": 0.5, "stroke": true}}, "rings": 1}}},
  {"id": 6, "tag": "f", "type": "region", "select": {"threshold": {"coordinate": [0, 0, 1], "above": 0.2, "below": 0.8, "quantiles": true}}},
  {"id": 7, "tag": "g", "type": "point", "select": {"threshold": {"curvature": "mean", "scale": 0.1, "above": 0.5}}},
  {"id": 8, "tag": "h", "type": "region", "select": {"shrink": {"of": {"threshold": {"distance": [4], "below": 1.4}}, "distance": 0.2}}},
  {"action": "add to", "id": 1, "select": {"sphere": {"centre": [0, 0, 1], "radius": 0.7}}},
  {"action": "remove from", "id": 3, "select": {"nearest": [0, 0, 1]}},
  {"action": "retag", "id": 2, "tag": "drawn", "colour": [1, 2, 3]},
  {"action": "delete", "id": 4}]})";
    ASSERT_NO_THROW(apply_recipe(parse_json(recipe, "r"), mesh, std::vector<std::int32_t>{}, "r"));
    const std::size_t done = survive(recipe, mesh);
    EXPECT_LT(done, 200U);
    EXPECT_GT(done, 5U);
    // A shipped recipe on its object.
    MakeOptions options;
    options.vertices = 2000;
    EXPECT_LT(survive(read_file(Path(OSTRAKA_SOURCE_DIR) / "data/vase-drawn.recipe.json"),
                      make_mesh(synthetic_object("vase"), options).mesh),
              200U);
}
